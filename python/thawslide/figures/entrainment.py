"""What a slide takes up of an erodible bed: how much over time, from where along the ground, and what it costs."""

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
    give_title,
    letters,
    prefixed,
    say,
    styled,
    time_axis,
    time_line,
)
from thawslide.figures.water import MASSES, scaled
from thawslide.run import Numbers, Run


def depth_taken(run: Run) -> tuple[Numbers, Numbers]:
    """Return edges along x [m], four cells apart, and the depth [m] between them that particles of the bed stood for.

    Those of the last snapshot; where each of them joined, half a cell out at most, follows from its displacement. The
    depth is a mean over the width in 3D too.
    """
    wide = 4.0 * float(run.section("grid")["cell"])
    low, high = float(run.section("grid")["min"][0]), float(run.section("grid")["max"][0])
    edges: Numbers = low + wide * np.arange(int((high - low) / wide) + 2, dtype=np.float64)
    shot = run.snapshot(len(run.times) - 1)
    of_bed = np.asarray(shot["body"]) == len(run.section("body"))
    joined_at = shot.points[of_bed, 0] - np.asarray(shot["displacement"])[of_bed, 0]
    mass, volume_taken = run.history["entrained_mass_kg"][-1], run.history["entrained_volume_m3"][-1]
    volume = np.asarray(shot["mass"])[of_bed] * (volume_taken / mass if mass > 0.0 else 0.0)
    across = 1.0 if run.dimension == 2 else float(run.section("grid")["max"][1]) - float(run.section("grid")["min"][1])
    return edges, np.histogram(joined_at, edges, weights=volume)[0] / (wide * across)


@styled
def entrainment(run: Run) -> Figure:
    """Draw (a) mass taken up and still loose, (b) work lost to it and heat, (c) depth taken up along x."""
    if "entrained_mass_kg" not in run.history:
        raise NotInRunError("the case has no bed: history.csv has no account of what was taken up")
    time = run.shown_time
    figure = Figure(figsize=(COLUMN_WIDTH, 6.4), layout="constrained")
    give_title(figure, run.titled("entrained bed material"))
    mass, work, depth = figure.subplots(3, 1)
    per = "/m of width" if run.per_metre else ""
    divisor, unit = scaled(float(np.nanmax(run.history["mass_kg"])), MASSES)
    for name, words, colour in (
        ("mass_kg", "mass of the slide", BLACK),
        ("entrained_mass_kg", "taken up", BLUE),
        ("loose_mass_kg", "of that, not joined yet", ORANGE),
    ):
        time_line(mass, time, run.history[name] / divisor, color=colour, label=words)
    mass.set_ylabel(f"mass ({unit}{per})")
    divisor, unit = prefixed([float(np.nanmax(run.history["entrained_work_J"]))], "J")
    time_line(work, time, run.history["entrained_work_J"] / divisor, color=RED, label="work that the slide lost")
    time_line(work, time, run.history["entrained_heat_J"] / divisor, color=GREEN, label="of that, heat in what joined")
    work.set_ylabel(f"energy ({unit}{per})")
    for axes in (mass, work):
        time_axis(axes, time, run.clock.label if axes is work else "")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    _draw_depth(depth, run)
    letters(
        (mass, work, depth),
        ("mass of the slide, and what it took up", "what taking it up cost", "depth taken up, by where it joined"),
    )
    return figure


def _draw_depth(axes: Axes, run: Run) -> None:
    edges, depth = depth_taken(run)
    taken = np.flatnonzero(depth > 0.0)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("depth (m)")
    if not taken.size:
        say(axes, "nothing has been taken up")
        return
    window = slice(max(int(taken[0]) - 3, 0), int(taken[-1]) + 4)
    axes.stairs(depth[window], edges[window.start : window.start + len(depth[window]) + 1], fill=True, color=BLUE)
