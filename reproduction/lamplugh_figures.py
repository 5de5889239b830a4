"""Figs. 14, 15, 17 and 20 in the layout of the paper: zones between dotted lines, two curves a panel."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction.lamplugh import INVERSION, PHASE, zones
from thawslide.figures.colours import PLASTIC_STRAIN, SPEED
from thawslide.figures.force import force_in_band, seismic_force
from thawslide.figures.load import load_on_band
from thawslide.figures.snapshots import Zone as SnapshotZone
from thawslide.figures.snapshots import plot_field
from thawslide.figures.style import (
    BLUE,
    COLUMN_WIDTH,
    NOTE,
    RED,
    TIME_LABEL,
    styled,
    time_axis,
    time_line,
    title_panels,
    warn,
)
from thawslide.run_folder import Numbers, Run
from thawslide.unphysical import too_hot, too_much_for_overburden

INVERTED = 0.28  # TN: maximum force inverted from seismic waves


def snapshot_zones(run: Run) -> list[SnapshotZone]:
    """Return the zones of Fig. 12b at the places that Thawslide assumes."""
    return [SnapshotZone(zone.letter, zone.start, zone.end) for zone in zones(run)]


@styled
def figure_14(runs: dict[str, Run]) -> Figure:
    """Plot the velocity with the zones."""
    return plot_field(runs["lamplugh"], SPEED, snapshot_zones(runs["lamplugh"]))


@styled
def figure_15(runs: dict[str, Run]) -> Figure:
    """Plot the plastic strain with the zones."""
    return plot_field(runs["lamplugh"], PLASTIC_STRAIN, snapshot_zones(runs["lamplugh"]))


def _pair(axes: Axes, run: Run, left: tuple[Numbers, str], right: tuple[Numbers, str]) -> Axes:
    """Plot one curve on the left axis in red, another on the right axis in blue; return the right axes."""
    other, time = axes.twinx(), run.series["time_s"]
    for panel, (values, words), colour in ((axes, left, RED), (other, right, BLUE)):
        time_line(panel, time, values, color=colour)
        panel.set_ylabel(words, color=colour)
        panel.tick_params(axis="y", colors=colour)
    other.spines["right"].set_visible(True)
    time_axis(axes, time, TIME_LABEL)
    return other


def _reported(axes: Axes, time: float, value: float, words: str, offset: tuple[float, float]) -> None:
    """Mark a reported value of the red curve within the time of the run, with words."""
    if time > axes.get_xlim()[1]:
        return
    style: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": RED, "markersize": 6.5, "clip_on": False}
    axes.plot(time, value, "o", zorder=6, **style)
    axes.annotate(words, (time, value), xytext=offset, textcoords="offset points", size=8, color=NOTE)


def _at_the_peak(axes: Axes, words: str, height: float, alignment: str) -> None:
    """Draw a dotted line with words at the time of the peak in the paper, if it is within the axes."""
    if axes.get_xlim()[1] >= PHASE:
        axes.axvline(PHASE, color="#8A8A8A", linestyle=":", linewidth=1.1)
        axes.annotate(words, (PHASE, height), xycoords=("data", "axes fraction"), va=alignment, size=8,
                      xytext=(4, 0), textcoords="offset points", color=NOTE)  # fmt: skip


@styled
def figure_17(runs: dict[str, Run]) -> Figure:
    """Plot the contact force (red) and the mean plastic strain (blue) in one panel."""
    run = runs["lamplugh"]
    time = run.series["time_s"]
    _, magnitude = seismic_force(run)
    force = magnitude / 1e12
    figure = Figure(figsize=(COLUMN_WIDTH, 3.7), layout="constrained")
    axes = figure.subplots()
    strain = run.series["mean_plastic_strain"]
    names = ("force on the terrain minus static weight (TN)", "mean equivalent plastic strain")
    other = _pair(axes, run, (force, names[0]), (strain, names[1]))
    passed = force_in_band(run, INVERSION) / 1e12
    time_line(axes, time, passed, color=RED, linewidth=1.0, linestyle="-.", label=f"band-pass {INVERSION.words}")
    axes.legend(loc="upper left")
    axes.axhline(INVERTED, color=RED, linewidth=1.0, linestyle="--")
    words = "Dufresne et al. (2019), seismic inversion: maximum force 0.28 TN"
    axes.annotate(words, (0.99, INVERTED), va="bottom", ha="right", size=8,
                  xycoords=("axes fraction", "data"), xytext=(0, 2), textcoords="offset points",
                  color=NOTE)  # fmt: skip
    _at_the_peak(axes, "Lei et al., MPM: arrival at the glacier", 0.985, "top")
    first = int(np.nanargmax(np.where(time <= 0.01 * time[-1], force, -np.inf)))
    axes.annotate("initial stress adjustment", (time[first], force[first]), xytext=(8, 8), size=8, color=NOTE,
                  textcoords="offset points")  # fmt: skip
    axes.set_ylim(0.0, 1.25 * max(float(np.nanmax(force)), INVERTED))
    other.set_ylim(0.0, 1.6 * max(float(np.nanmax(strain)), 1e-9))
    return figure


@styled
def figure_20(runs: dict[str, Run]) -> Figure:
    """Plot (a) temperature and pore pressure, (b) saturation and friction coefficient of the band."""
    run = runs["lamplugh"]
    history = run.series
    figure = Figure(figsize=(COLUMN_WIDTH, 5.8), layout="constrained")
    heat, melt = figure.subplots(2, 1, sharex=True)
    pressure = _pair(
        heat, run, (history["band_temperature_C"], "temperature (°C)"),
        (history["band_pore_pressure_Pa"] / 1e6, "pore pressure (MPa)"),
    )  # fmt: skip
    friction = _pair(
        melt, run, (history["band_saturation"], "liquid saturation"),
        (history["band_friction_coefficient"], "friction coefficient"),
    )  # fmt: skip
    heat.set_xlabel("")
    pressure.set_ylim(bottom=0.0)
    when, load = load_on_band(run)
    over = np.interp(when, run.series["time_s"], history["band_pore_pressure_Pa"]) / load
    found = (
        too_hot(run, history["band_temperature_C"], history["band_pore_pressure_Pa"]),
        too_much_for_overburden(over),
    )
    warn(pressure, "; ".join(filter(None, found)))
    low, high = heat.get_ylim()
    for level, words in ((0.0, "melting point"), (100.0, "boiling point")):
        if low < level < high:
            heat.axhline(level, color=NOTE, linewidth=0.8, linestyle=":")
            heat.annotate(words, (0.995, level), xycoords=("axes fraction", "data"), xytext=(0, 2 if level else -9),
                          textcoords="offset points", ha="right", size=7.5, color=NOTE)  # fmt: skip
    melt.set_ylim(0.0, 1.04)
    friction.set_ylim(0.0, 1.0)
    _reported(melt, 40.0, 0.3, "Lei et al., MPM: 0.3 at 40 s", (9, -3))
    _reported(melt, 75.0, 0.9, "Lei et al., MPM: 0.9 at 75 s", (9, -10))
    _at_the_peak(heat, "band thickness 0.5 m from here on", 0.14, "bottom")
    _at_the_peak(melt, "", 0.0, "bottom")
    title_panels((heat, melt), ("temperature and pore pressure of the band", "saturation and friction coefficient"))
    return figure
