"""Entrainment of an erodible bed: mass and work over time, and depth along x."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
from thawslide.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    ORANGE,
    RED,
    TIME_LABEL,
    explain_empty,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.figures.water import MASSES, scaled
from thawslide.number_text import prefixed
from thawslide.run_folder import Numbers, Run


def entrained_depth(run: Run) -> tuple[Numbers, Numbers]:
    """Return edges along x [m], four cells apart, and the entrained depth [m] between them.

    The particles of the bed are those of the last snapshot. Their displacement gives the place where they joined, to
    half a cell. The depth is a mean over the width, in 3D too.
    """
    wide = 4.0 * float(run.section("grid")["cell"])
    low, high = float(run.section("grid")["min"][0]), float(run.section("grid")["max"][0])
    edges: Numbers = low + wide * np.arange(int((high - low) / wide) + 2, dtype=np.float64)
    shot = run.snapshot(len(run.times) - 1)
    of_bed = np.asarray(shot["body"]) == len(run.section("body"))
    joined_at = shot.points[of_bed, 0] - np.asarray(shot["displacement"])[of_bed, 0]
    mass, entrained = run.series["entrained_mass_kg"][-1], run.series["entrained_volume_m3"][-1]
    volume = np.asarray(shot["mass"])[of_bed] * (entrained / mass if mass > 0.0 else 0.0)
    across = 1.0 if run.dimension == 2 else float(run.section("grid")["max"][1]) - float(run.section("grid")["min"][1])
    return edges, np.histogram(joined_at, edges, weights=volume)[0] / (wide * across)


@styled
def entrainment(run: Run) -> Figure:
    """Plot (a) entrained and loose mass, (b) work and heat of entrainment, (c) entrained depth along x."""
    if "entrained_mass_kg" not in run.series:
        raise NotInRunError("history.csv: no entrained mass (found no [bed] in the case).")
    time = run.series["time_s"]
    figure = Figure(figsize=(COLUMN_WIDTH, 6.4), layout="constrained")
    title_figure(figure, run.titled("entrained bed material"))
    mass, work, depth = figure.subplots(3, 1)
    per = "/m of width" if run.per_metre else ""
    divisor, unit = scaled(float(np.nanmax(run.series["mass_kg"])), MASSES)
    for name, words, colour in (
        ("mass_kg", "sliding mass", BLACK),
        ("entrained_mass_kg", "entrained", BLUE),
        ("loose_mass_kg", "entrained, not yet joined", ORANGE),
    ):
        time_line(mass, time, run.series[name] / divisor, color=colour, label=words)
    mass.set_ylabel(f"mass ({unit}{per})")
    divisor, unit = prefixed([float(np.nanmax(run.series["entrained_work_J"]))], "J")
    work.set_ylabel(f"energy ({unit}{per})")
    if np.any(run.series["entrained_mass_kg"] > 0.0):
        time_line(work, time, run.series["entrained_work_J"] / divisor, color=RED, label="work of entrainment")
        time_line(work, time, run.series["entrained_heat_J"] / divisor, color=GREEN, label="heat in joined particles")
        work.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    else:
        explain_empty(work, "no entrainment")
    mass.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    for axes in (mass, work):
        time_axis(axes, time, TIME_LABEL if axes is work else "")
    _plot_depth(depth, run)
    title_panels(
        (mass, work, depth),
        ("sliding and entrained mass", "work of entrainment", "entrained depth"),
    )
    return figure


def _plot_depth(axes: Axes, run: Run) -> None:
    edges, depth = entrained_depth(run)
    entrained = np.flatnonzero(depth > 0.0)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("depth (m)")
    if not entrained.size:
        explain_empty(axes, "no entrainment")
        return
    window = slice(max(int(entrained[0]) - 3, 0), int(entrained[-1]) + 4)
    axes.stairs(depth[window], edges[window.start : window.start + len(depth[window]) + 1], fill=True, color=BLUE)
