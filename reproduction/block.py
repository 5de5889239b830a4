"""Sec. 3.2: driven block (Figs. 6 and 7), compared with a system of ordinary differential equations."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction.band_model import BandHistory, Drive, solve
from reproduction.mixture import TABLE_1
from reproduction.runs import BLOCKS, NO_LATENT
from thawslide.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    NOTE,
    ORANGE,
    PURPLE,
    RED,
    TIME_LABEL,
    styled,
    title_panels,
)
from thawslide.run_folder import Numbers, Run

COLUMNS = (
    ("band_temperature_C", "temperature", "temperature (°C)", 1.0),
    ("band_saturation", "saturation", "liquid saturation", 1.0),
    ("band_pore_pressure_Pa", "pressure", "pore pressure (kPa)", 1e3),
)
MELTED = 0.99  # mean saturation above which the band is melted
EARLY = 5.0  # s: the time at which, in the paper, the band of 0.05 m has melted


def drive_of(run: Run) -> Drive:
    """Return the drive of a run's resolved case."""
    thickness = float(run.section("band")["thickness"])
    material = next(iter(run.section("material").values()))
    heat = run.section("heat")
    return Drive(
        thickness,
        float(run.series["time_s"][-1]),
        hydraulic_conductivity=float(material.get("hydraulic_conductivity", 0.0)),
        conduction=bool(heat.get("conduction", True)),
        latent=bool(heat.get("latent", True)),
    )


@lru_cache(maxsize=32)
def _solved(drive: Drive) -> BandHistory:
    return solve(drive, 0.1 * drive.thickness)


def reference(run: Run) -> BandHistory:
    """Return the solution of the ordinary differential equations for the band of a run."""
    return _solved(drive_of(run))


def at(run: Run, column: str, time: float) -> float:
    """Return a column's value at a time [s]; nan after the end of the run."""
    times = run.series["time_s"]
    return float(np.interp(time, times, run.series[column])) if time <= times[-1] + 1e-9 else float("nan")


def first_time(run: Run, column: str, value: float) -> float:
    """Return the time [s] at which a column first attains a value; nan if it never does."""
    reached = np.flatnonzero(run.series[column] >= value)
    return float(run.series["time_s"][reached[0]]) if reached.size else float("nan")


def differences(one: Run, other: Run, column: str) -> tuple[float, float]:
    """Return the maximum and the root mean square difference of a column between two runs over their common time."""
    end = min(one.series["time_s"][-1], other.series["time_s"][-1])
    times = np.linspace(0.1, end, 600)
    first, second = (np.interp(times, run.series["time_s"], run.series[column]) for run in (one, other))
    return float(np.max(np.abs(first - second))), float(np.sqrt(np.mean((first - second) ** 2)))


def clapeyron(temperature: float) -> float:
    """Return P_L - P_I/r [MPa] of ice and water in equilibrium (Eq. 4 with the usual sign) at a temperature [C]."""
    zero = 273.15
    return TABLE_1.water_density * TABLE_1.latent_heat * float(np.log((temperature + zero) / zero)) / 1e6


def surge_saturation(run: Run) -> float:
    """Return the mean saturation of the band at the time at which its pressure rises fastest, over 2 % of the run."""
    time, pressure = run.series["time_s"], run.series["band_pore_pressure_Pa"]
    span = 0.02 * time[-1]
    rise = np.interp(time + 0.5 * span, time, pressure) - np.interp(time - 0.5 * span, time, pressure)
    return float(run.series["band_saturation"][int(np.argmax(rise))])


def _of_run(run: Run) -> dict[str, float]:
    history, time = run.series, run.series["time_s"]
    model = reference(run)
    pressure = history["band_pore_pressure_Pa"]
    lowest = int(np.argmin(pressure))
    found = {
        "melted": first_time(run, "band_saturation", MELTED),
        "half_melted": first_time(run, "band_saturation", 0.495),
        "temperature_5s": at(run, "band_temperature_C", EARLY),
        "saturation_5s": at(run, "band_saturation", EARLY),
        "temperature_end": float(history["band_temperature_C"][-1]),
        "saturation_end": float(history["band_saturation"][-1]),
        "pressure_start": float(pressure[0]) / 1e3,
        "pressure_lowest": float(pressure[lowest]) / 1e3,
        "pressure_lowest_time": float(time[lowest]),
        "pressure_highest": float(pressure.max()) / 1e3,
        "pressure_end": float(pressure[-1]) / 1e3,
        "pressure_drift": (float(pressure[-1]) - at(run, "band_pore_pressure_Pa", 0.9 * time[-1])) / 1e3,
        "saturation_5_5s": at(run, "band_saturation", 1.1 * EARLY),
        "start_warming": (at(run, "band_temperature_C", 0.02 * time[-1]) - float(history["band_temperature_C"][0]))
        / (0.02 * time[-1]),
        "end_warming": (float(history["band_temperature_C"][-1]) - at(run, "band_temperature_C", 0.9 * time[-1]))
        / (0.1 * time[-1]),
    }
    found["pressure_60s"] = at(run, "band_pore_pressure_Pa", 60.0) / 1e3
    half = found["half_melted"]
    found["pressure_half"] = at(run, "band_pore_pressure_Pa", half) / 1e3 if np.isfinite(half) else float("nan")
    found["surge_saturation"] = surge_saturation(run)
    found["heat"] = float(history["friction_heat_J"][-1]) / 1e9
    found["ice_start"], found["ice_lowest"] = (1.0 - float(history["band_saturation"][k]) for k in (0, lowest))
    for column, name, _, scale in COLUMNS:
        values = np.interp(model.time, time, history[column])
        found[f"{name}_off"] = float(np.max(np.abs(values - getattr(model, name)))) / scale
    return found


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return the numbers of Sec. 3.2, by the name of the run and of the quantity."""
    found = {"block_clapeyron_start": clapeyron(-10.0), "block_clapeyron_end": clapeyron(0.0)}
    for name in [each for base in BLOCKS for each in (base, base + NO_LATENT)] + ["e050-no-viscosity"]:
        key = "block_" + name.replace("-", "_")
        found |= {f"{key}_{quantity}": value for quantity, value in _of_run(runs[f"block-{name}"]).items()}
    for ending in ("", NO_LATENT):
        suffix = ending.replace("-", "_")
        for column, name, _, scale in COLUMNS:
            pairs = (("e100", "e100-L5"), ("e100", "e100-L20"), ("e100-L5", "e100-L20"))
            apart = [differences(runs[f"block-{one}{ending}"], runs[f"block-{other}{ending}"], column)
                     for one, other in pairs]  # fmt: skip
            found[f"block_mesh_{name}{suffix}"] = max(largest for largest, _ in apart) / scale
            found[f"block_mesh_{name}_rms{suffix}"] = max(rms for _, rms in apart) / scale
            conduction, _ = differences(runs[f"block-k0{ending}"], runs[f"block-e050{ending}"], column)
            found[f"block_conduction_{name}{suffix}"] = conduction / scale
        found[f"block_permeability_saturation{suffix}"] = max(
            differences(runs[f"block-{one}{ending}"], runs[f"block-e050{ending}"], "band_saturation")[0]
            for one in ("k0", "k10", "k9", "k8")
        )
    # Maximum difference of the runs from their ordinary differential equations, for each figure and latent heat.
    for figure, drawn in (("figure_6", FIGURE_6), ("figure_7", FIGURE_7)):
        for ending in ("", "_no_latent"):
            for _, name, _, _ in COLUMNS:
                every = [found[f"block_{each.replace('-', '_')}{ending}_{name}_off"] for each, *_ in drawn]
                found[f"block_{figure}_{name}_off{ending}"] = max(every)
    for number, (one, other) in enumerate((("k0", "k10"), ("k10", "k9"), ("k9", "k8")), 1):
        for column, name, _, scale in COLUMNS:
            gap, _ = differences(runs[f"block-{one}"], runs[f"block-{other}"], column)
            found[f"block_apart_{name}_{number}"] = gap / scale
    still = runs["block-e050-no-viscosity"].series
    found["block_ringing_speed"] = float(np.max(still["max_velocity_m_s"]))
    found["block_calm_speed"] = float(np.max(runs["block-e050"].series["max_velocity_m_s"]))
    lost = np.abs(still["mechanical_residual_J"][-1]) / max(still["friction_work_J"][-1], 1e-300)
    found["block_ringing_residual"] = 100.0 * float(lost)
    return found


Drawn = tuple[tuple[str, str, str], ...]  # run, words, colour
FIGURE_6: Drawn = (
    ("e050", "e 0.05 m, L_e 10 m", RED),
    ("e100", "e 0.1 m, L_e 10 m", GREEN),
    ("e200", "e 0.2 m, L_e 10 m", BLUE),
    ("e100-L5", "e 0.1 m, L_e 5 m", ORANGE),
    ("e100-L20", "e 0.1 m, L_e 20 m", PURPLE),
)
FIGURE_7: Drawn = (
    ("e050", "KT0 KL0", BLACK),
    ("k0", "KT KL0", RED),
    ("k10", "KT KL10", ORANGE),
    ("k9", "KT KL9", GREEN),
    ("k8", "KT KL8", BLUE),
)


def mark(axes: Axes, time: float, value: float, words: str, colour: str = BLACK) -> None:
    """Mark a value of the paper by a circle with words, if it is within the axes."""
    if time <= axes.get_xlim()[1]:
        axes.plot(time, value, "o", color=colour, fillstyle="none", clip_on=False)
        axes.annotate(words, (time, value), xytext=(7, -9), textcoords="offset points", color=NOTE, size=8)


def _panel(axes: Axes, time: Numbers, values: Numbers, colour: str, words: str, model: tuple[Numbers, Numbers]) -> None:
    axes.plot(time, values, color=colour, linewidth=1.6, alpha=0.75, label=words)
    axes.plot(*model, color=colour, linewidth=0.9, linestyle=(0, (4, 2)))


@styled
def _plot(runs: dict[str, Run], drawn: Drawn, end: float) -> Figure:
    figure = Figure(figsize=(COLUMN_WIDTH, 8.0), layout="constrained")
    panels = figure.subplots(3, 2)
    for side, ending in enumerate(("", NO_LATENT)):
        for name, words, colour in drawn:
            run = runs[f"block-{name}{ending}"]
            model = reference(run)
            for row, (column, quantity, _, scale) in enumerate(COLUMNS):
                line = (model.time, getattr(model, quantity) / scale)
                _panel(panels[row][side], run.series["time_s"], run.series[column] / scale, colour, words, line)
        for row, (_, _, words, _) in enumerate(COLUMNS):
            axes = panels[row][side]
            axes.set_ylabel(words)
            axes.grid(True)
            axes.set_xlim(0.0, min(end, max(runs[f"block-{name}"].series["time_s"][-1] for name, *_ in drawn)))
        panels[2][side].set_xlabel(TIME_LABEL)
        panels[1][side].set_ylim(-0.02, 1.02)
        mark(panels[1][side], EARLY, 1.0, "Lei et al.: melted", drawn[0][2])  # of e = 0.05 m
        panels[0][side].plot(
            [], [], color=BLACK, linewidth=0.9, linestyle=(0, (4, 2)), label="ordinary differential equations"
        )
    panels[0][0].legend(loc="best")
    titles = [f"{words}, {heat}" for words in ("temperature", "saturation", "pore pressure")
              for heat in ("latent heat on", "latent heat off")]  # fmt: skip
    title_panels(list(panels.flat), titles)
    return figure


def figure_6(runs: dict[str, Run]) -> Figure:
    """Plot band temperature, saturation and pressure for three band thicknesses and three meshes."""
    return _plot(runs, FIGURE_6, 240.0)


def figure_7(runs: dict[str, Run]) -> Figure:
    """Plot the same for four hydraulic conductivities, and without heat conduction."""
    return _plot(runs, FIGURE_7, 60.0)
