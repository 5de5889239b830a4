"""Sec. 4: Lamplugh avalanche. Figs. 14 to 20 are those of any report; this module adds deposit and rigid block."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from reproduction.block import at
from reproduction.runs import LAMPLUGH_BLOCKS
from reproduction.stages import balance
from thawslide.errors import NotInRunError
from thawslide.figures.force import force_in_band, seismic_force
from thawslide.figures.motion import plot_targets
from thawslide.figures.style import (
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    NOTE,
    ORANGE,
    RED,
    TIME_LABEL,
    styled,
    time_axis,
    time_line,
    title_panels,
    vertical_exaggeration,
)
from thawslide.history import History, read_history
from thawslide.key_numbers import STOPPED_FRACTION, stop_time
from thawslide.run_folder import Numbers, Run
from thawslide.targets import Band
from thawslide.time_reference import time_of_speed

# Slopes of the profile in the text [degrees]: source, ramp.
SLOPE, RAMP = 48.0, 8.0
BIN = 100.0  # m
PHASE = 75.0  # s: the time of the peak in the paper
FRONT = 10500.0  # m: the reported front
COHESION = 6.0e5  # Pa: along the base at the start
MARGIN = 1000.0  # m: what counts as the distal margin before it
INVERSION = Band(35.0, 150.0)  # s: periods of inversions of long waves; that of the report is assumed
WIDER = Band(20.0, 150.0)

_COLOURS = (RED, ORANGE, GREEN)


@dataclass(frozen=True)
class Zone:
    """A zone of Fig. 12b: letter, description in the text, and assumed range [m] (the text states no place)."""

    letter: str
    text: str
    start: float
    end: float
    accumulates: bool


def deposit(run: Run) -> tuple[Numbers, Numbers]:
    """Return (x [m], thickness [m]) at the end of the run: area of the section over 100 m of distance."""
    shot = run.snapshot(-1)
    x = shot.points[:, 0]
    edges = np.arange(np.floor(x.min() / BIN) * BIN, x.max() + BIN, BIN)
    area, _ = np.histogram(x, edges, weights=run.section_areas(shot))
    return 0.5 * (edges[1:] + edges[:-1]), area / BIN


def breaks(run: Run) -> tuple[float, float]:
    """Return x [m] of the foot of the slope and of the ramp, at slopes of 28 and 4 degrees."""
    assert run.terrain is not None
    x, z = run.terrain
    slope = np.degrees(np.arctan(-np.gradient(z, x)))
    steep = x[slope > 0.5 * (SLOPE + RAMP)]
    ramp = x[slope > 0.5 * RAMP]
    return float(steep.max()), float(ramp.max())


def zones(run: Run) -> list[Zone]:
    """Return the zones downhill: B ends with the ramp, F is the last km before the front, C to E are equal parts."""
    foot, valley = breaks(run)
    first, second = valley + (FRONT - MARGIN - valley) * np.array([1.0, 2.0]) / 3.0
    return [
        Zone("B", "accumulation just below the source", foot, valley, True),
        Zone("C", "none simulated; eroded in the field", valley, float(first), False),
        Zone("D", "accumulation, a toe in the middle of the deposit", float(first), float(second), True),
        Zone("E", "transport: both accumulation and depletion", float(second), FRONT - MARGIN, False),
        Zone("F", "accumulation along the distal margin", FRONT - MARGIN, FRONT, True),
    ]


def zone_fractions(run: Run) -> dict[str, tuple[float, float]]:
    """Return by letter the fraction of the volume [%] and the mean thickness [m] in each zone at the end of the run."""
    shot = run.snapshot(-1)
    x, volume, area = shot.points[:, 0], np.asarray(shot["volume"], dtype=np.float64), run.section_areas(shot)
    found = {}
    for zone in zones(run):
        inside = (x >= zone.start) & (x < zone.end)
        fraction = float(volume[inside].sum() / volume.sum())
        found[zone.letter] = (100.0 * fraction, float(area[inside].sum()) / (zone.end - zone.start))
    return found


def read_block(path: Path) -> History:
    """Return the columns of a table of `thawslide block`; NotInRunError without the file."""
    if not path.is_file():
        raise NotInRunError(f"{path}: no such file. Run the rigid block.")
    return read_history(path, [])


def blocks(run: Run) -> dict[str, History]:
    """Return the histories of the rigid blocks next to a run folder, by name."""
    return {each.key: read_block(run.folder.parent / f"{each.key}.csv") for each in LAMPLUGH_BLOCKS}


def block_measures(run: Run) -> dict[str, float]:
    """Return peak [m/s], its time [s], displacement [m] and stop [s] of each rigid block."""
    found = {}
    for name, history in blocks(run).items():
        time, speed = history["time_s"], history["velocity_m_s"]
        peak = int(np.argmax(speed))
        moving = np.flatnonzero(speed > STOPPED_FRACTION * max(float(speed[peak]), 1e-300))
        stopped = moving.size > 0 and int(moving[-1]) + 1 < len(time)
        key = name.replace("-", "_")
        found[f"{key}_peak"] = float(speed[peak])
        found[f"{key}_peak_time"] = float(time[peak])
        found[f"{key}_displacement"] = float(history["displacement_m"][-1])
        found[f"{key}_stop"] = float(time[int(moving[-1]) + 1]) if stopped else float("nan")
        found[f"{key}_safety"] = float(history["sliding_strength_Pa"][0] / history["driving_traction_Pa"][0])
    first = LAMPLUGH_BLOCKS[0]
    return found | balance(read_block(run.folder.parent / f"{first.key}.csv"), COHESION)


def base_traction(run: Run, start: float = 100.0, end: float = 140.0) -> float:
    """Return the mean basal traction [kPa] on the valley floor, from the deceleration between two times [s].

    Mass and length are those of half the time; gravity acts along the mean slope of the terrain below.
    """
    history = run.series
    if float(history["time_s"][-1]) < end:
        return float("nan")
    assert run.terrain is not None
    deceleration = (at(run, "mean_velocity_m_s", start) - at(run, "mean_velocity_m_s", end)) / (end - start)
    shot = run.snapshot(time=0.5 * (start + end))
    order = np.argsort(shot.points[:, 0])
    mass = np.cumsum(np.asarray(shot["mass"], dtype=np.float64)[order])
    rear, front = shot.points[order, 0][np.searchsorted(mass, (0.005 * mass[-1], 0.995 * mass[-1]))]
    low, high = np.interp((rear, front), *run.terrain)
    slope = np.arctan2(low - high, front - rear)
    gravity = 9.81
    return float(mass[-1] * (deceleration + gravity * np.sin(slope)) / (front - rear) * np.cos(slope) / 1e3)


def near_ground(run: Run, time: float, height: float = 5.0, column: float = 10.0) -> float:
    """Return the mean number of particles within `height` [m] normal to the terrain, in each `column` [m] of x."""
    shot = run.snapshot(time=time)
    assert run.terrain is not None
    x, z = run.terrain
    across = np.cos(np.interp(shot.points[:, 0], x, np.arctan(np.gradient(z, x))))
    above = (shot.points[:, 1] - np.interp(shot.points[:, 0], x, z)) * across
    columns = np.unique(np.floor(shot.points[:, 0] / column))
    return float(np.count_nonzero(above < height) / len(columns))


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return the numbers of Sec. 4."""
    run, other = runs["lamplugh"], runs["lamplugh-no-pressurization"]
    history, time = run.series, run.series["time_s"]
    speed = history["mean_velocity_m_s"]
    peak = int(np.argmax(speed))
    _, force = seismic_force(run)
    strongest = int(np.nanargmax(force))
    stopped, other_stopped = stop_time(run), stop_time(other)
    x, thickness = deposit(run)
    foot, valley = breaks(run)
    whole = max(float(thickness.sum()), 1e-300)
    found = {
        "lamplugh_peak": float(speed[peak]),
        "lamplugh_peak_time": float(time[peak]),
        "lamplugh_8_time": time_of_speed(run, 8.0),
        "lamplugh_speed_40s": at(run, "mean_velocity_m_s", 40.0),
        "lamplugh_speed_200s": at(run, "mean_velocity_m_s", 200.0),
        "lamplugh_displacement": float(history["mean_displacement_m"][-1]),
        "lamplugh_displacement_40s": at(run, "mean_displacement_m", 40.0),
        "lamplugh_runout_km": float(history["runout_m"][-1]) / 1e3,
        "lamplugh_front_km": float(history["front_position_m"][-1]) / 1e3,
        "lamplugh_stop": stopped if stopped is not None else float("nan"),
        "lamplugh_saturation_40s": at(run, "band_saturation", 40.0),
        "lamplugh_saturation_75s": at(run, "band_saturation", PHASE),
        "lamplugh_friction_start": float(
            history["band_friction_coefficient"][np.isfinite(history["band_friction_coefficient"])][0]
        ),
        "lamplugh_pressure_start": float(history["band_pore_pressure_Pa"][0]) / 1e6,
        "lamplugh_friction_40s": at(run, "band_friction_coefficient", 40.0),
        "lamplugh_friction_75s": at(run, "band_friction_coefficient", PHASE),
        "lamplugh_force_TN": float(force[strongest]) / 1e12,
        "lamplugh_force_time": float(time[strongest]),
        "lamplugh_force_inverted_TN": float(np.nanmax(force_in_band(run, INVERSION))) / 1e12,
        "lamplugh_force_wider_TN": float(np.nanmax(force_in_band(run, WIDER))) / 1e12,
        "lamplugh_temperature_40s": at(run, "band_temperature_C", 40.0),
        "lamplugh_temperature_75s": at(run, "band_temperature_C", PHASE),
        "lamplugh_temperature_80s": at(run, "band_temperature_C", 80.0),
        "lamplugh_temperature_200s": at(run, "band_temperature_C", 200.0),
        "lamplugh_temperature_peak": float(np.nanmax(history["band_temperature_C"])),
        "lamplugh_temperature_at_peak": float(history["band_temperature_C"][peak]),
        "lamplugh_pressure_40s": at(run, "band_pore_pressure_Pa", 40.0) / 1e6,
        "lamplugh_pressure_75s": at(run, "band_pore_pressure_Pa", PHASE) / 1e6,
        "lamplugh_pressure_200s": at(run, "band_pore_pressure_Pa", 200.0) / 1e6,
        "lamplugh_strain_40s": at(run, "mean_plastic_strain", 40.0),
        "lamplugh_strain_75s": at(run, "mean_plastic_strain", PHASE),
        "lamplugh_strain_end": float(history["mean_plastic_strain"][-1]),
        "lamplugh_rescale_PJ": float(history["band_rescale_J"][-1]) / 1e15,
        "lamplugh_friction_PJ": float(history["friction_heat_J"][-1]) / 1e15,
        "lamplugh_deposit_slope": 100.0 * float(thickness[x < foot].sum()) / whole,
        "lamplugh_deposit_ramp": 100.0 * float(thickness[(x >= foot) & (x < valley)].sum()) / whole,
        "lamplugh_deposit_valley": 100.0 * float(thickness[x >= valley].sum()) / whole,
        "lamplugh_deposit_thickest": float(thickness.max()),
        "lamplugh_deposit_thickest_km": float(x[int(np.argmax(thickness))]) / 1e3,
        "lamplugh_deposit_length_km": float(np.ptp(x[thickness > 1.0])) / 1e3,
        "lamplugh_dry_peak": float(other.series["mean_velocity_m_s"].max()),
        "lamplugh_dry_displacement": float(other.series["mean_displacement_m"][-1]),
        "lamplugh_dry_stop": other_stopped if other_stopped is not None else float("nan"),
        "lamplugh_particles": float(len(run.snapshot(0).points)),
    }
    for letter, (fraction, mean) in zone_fractions(run).items():
        found[f"lamplugh_zone_{letter}"] = fraction
        found[f"lamplugh_zone_{letter}_thickness"] = mean
    found["lamplugh_base_traction"] = base_traction(run)
    found |= block_measures(run)
    found["lamplugh_rise_time"] = found["lamplugh_peak_time"] - found["lamplugh_8_time"]
    return found


@styled
def figure_deposit(runs: dict[str, Run]) -> Figure:
    """Plot terrain, initial state and deposit along the profile, and the thickness of the deposit."""
    run = runs["lamplugh"]
    figure = Figure(figsize=(COLUMN_WIDTH, 4.0), layout="constrained")
    section, thick = figure.subplots(2, 1, sharex=True, height_ratios=(1.0, 1.0))
    assert run.terrain is not None
    ground_x, ground_z = run.terrain
    section.fill_between(ground_x / 1e3, ground_z, ground_z.min() - 50.0, color="#E4E0DA")
    for index, colour, words in (
        (0, NOTE, "start"),
        (-1, RED, f"end, t = {run.times[-1]:.4g} s"),
    ):
        points = run.snapshot(index).points
        section.plot(points[:, 0] / 1e3, points[:, 1], ".", color=colour, markersize=1.5, label=words)
    section.set_ylim(0.8 * float(run.snapshot(-1).points[:, 1].min()), None)
    section.set_ylabel("elevation (m)")
    section.legend(loc="upper right", markerscale=6)
    x, thickness = deposit(run)
    thick.bar(x / 1e3, thickness, width=BIN / 1e3, color=BLUE, edgecolor="white", linewidth=0.3)
    thick.set_ylabel("thickness (m)")
    thick.set_xlabel("distance (km)")
    for number, zone in enumerate(zones(run)):
        thick.axvspan(zone.start / 1e3, zone.end / 1e3, color=GREEN, alpha=0.14 if number % 2 else 0.06, linewidth=0)
        middle = 0.5 * (zone.start + zone.end) / 1e3
        words = "accumulation" if zone.accumulates else "none" if zone.letter == "C" else "both"
        thick.annotate(f"{zone.letter}\n{words}", (middle, 0.97), xycoords=("data", "axes fraction"), ha="center",
                       va="top", size=7, color=NOTE)  # fmt: skip
    thick.axvline(FRONT / 1e3, color=RED, linewidth=1.0, linestyle="--")
    thick.annotate("front, Bessette-\nKirton et al.\n(2018)", (FRONT / 1e3, 0.6), xytext=(4, 0),
                   xycoords=("data", "axes fraction"), textcoords="offset points", va="top", size=8,
                   color=RED)  # fmt: skip
    thick.set_ylim(0.0, 1.35 * float(thickness.max()))
    for axes in (section, thick):
        axes.grid(True)
        axes.set_axisbelow(True)
        axes.set_xlim(ground_x[0] / 1e3, max(FRONT + 1500.0, float(x.max()) + BIN) / 1e3)
    figure.draw_without_rendering()  # sets the sizes of panels
    title_panels(
        [section, thick],
        (
            f"profile, vertical exaggeration {vertical_exaggeration(section, 1e3):.2g}×",
            "deposit thickness, means over 100 m; zones of Lei et al. at assumed places",
        ),
    )
    return figure


@styled
def figure_blocks(runs: dict[str, Run]) -> Figure:
    """Plot velocity and displacement of the deforming body and of the rigid blocks, with the reported values."""
    run = runs["lamplugh"]
    time = run.series["time_s"]
    figure = Figure(figsize=(COLUMN_WIDTH, 4.2), layout="constrained")
    speed, distance = figure.subplots(1, 2)
    time_line(speed, time, run.series["mean_velocity_m_s"], color=BLUE, label="deforming (MPM)")
    time_line(distance, time, run.series["mean_displacement_m"] / 1e3, color=BLUE, label="deforming (MPM)")
    histories = blocks(run)
    for block, colour, dashes in zip(LAMPLUGH_BLOCKS, _COLOURS[:2], ("--", "-."), strict=True):
        history, style = histories[block.key], {"color": colour, "linestyle": dashes}
        for axes, column, divisor in ((speed, "velocity_m_s", 1.0), (distance, "displacement_m", 1e3)):
            time_line(axes, history["time_s"], history[column] / divisor, **style, label=block.words)
    plot_targets(speed, run, ("mean_velocity",), 1.0, NOTE)
    plot_targets(distance, run, ("mean_displacement",), 1e3, NOTE)
    speed.set_ylabel("mean velocity (m/s)")
    distance.set_ylabel("mean displacement (km)")
    for axes in (speed, distance):
        time_axis(axes, time, TIME_LABEL)
        axes.set_ylim(bottom=0.0)
        # Legends below the panels do not cover reported values.
        axes.legend(loc="upper left", bbox_to_anchor=(-0.14, -0.2), handlelength=1.5)
    title_panels((speed, distance), ("velocity", "displacement"))
    return figure
