"""Members of starting noise over time, on the clock that the reported values have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from thawslide.figures.motion import draw_targets
from thawslide.figures.style import BLACK, BLUE, GREEN, NOTE, letters, styled
from thawslide.paper.members import QUANTITIES, SET_TIME
from thawslide.run import History, Numbers, Run

STEP = 0.1  # s, of the median's curve


def on_clock_set(run: Run, start: float) -> Run:
    """Return a run with the times of its history on the clock set, `start` [s] being when it came to that speed."""
    moved = Run(run.folder)
    columns = dict(run.history)
    moved.history = History(run.history.file, columns | {"time_s": columns["time_s"] + SET_TIME - start})
    return moved


def on_one_clock(runs: Sequence[Run], starts: Sequence[float], column: str) -> tuple[Numbers, Numbers]:
    """Return times [s] on the clock set that all runs have, and a column of each at them, shape (runs, times)."""
    clocks = [run.history["time_s"] + SET_TIME - start for run, start in zip(runs, starts, strict=True)]
    time = np.arange(max(clock[0] for clock in clocks), min(clock[-1] for clock in clocks), STEP)
    values = [np.interp(time, clock, run.history[column]) for run, clock in zip(runs, clocks, strict=True)]
    return time, np.array(values)


@styled
def members_over_time(runs: Sequence[Run], starts: Sequence[float]) -> Figure:
    """Draw mean velocity and mean displacement of all members and their median, with the reported values."""
    figure = Figure(figsize=(10.0, 4.6), layout="constrained")
    speed, way = figure.subplots(1, 2)
    for axes, column, divisor, colour, reported in (
        (speed, "mean_velocity_m_s", 1.0, BLUE, ("mean_velocity",)),
        (way, "mean_displacement_m", 1e3, GREEN, ("mean_displacement",)),
    ):
        time, values = on_one_clock(runs, starts, column)
        # Members on top of their median: they may lie so close together that it would hide them.
        middle = np.median(values, axis=0) / divisor
        axes.plot(time, middle, color=colour, linewidth=6.0, alpha=0.45, label=f"median of {len(runs)} members")
        thin = axes.plot(time, values.T / divisor, color=BLACK, linewidth=0.4)
        thin[0].set_label("each member")
        draw_targets(axes, on_clock_set(runs[0], starts[0]), reported, divisor, NOTE)
        axes.set_xlim(min(0.0, float(time[0])), max(205.0, float(time[-1])))
        axes.set_xlabel("time (s), 8 m/s at 40 s")
        axes.set_ylim(bottom=0.0)
        axes.grid(True)
    speed.set_ylabel("mean velocity (m/s)")
    way.set_ylabel("mean displacement (km)")
    _draw_wanted(speed)
    for axes, place in ((speed, "upper right"), (way, "lower right")):
        axes.legend(loc=place, frameon=True, framealpha=1.0, edgecolor="none")
    letters((speed, way), ("mean velocity", "mean displacement"))
    return figure


def _draw_wanted(axes: Axes) -> None:
    """Shade where the peak is wanted, and mark the end of the run of the other model, by when the slide stands."""
    wanted = {each.name: each for each in QUANTITIES}
    peak, rise, stop = wanted["peak"], wanted["rise"], wanted["stop"]
    axes.set_ylim(top=max(axes.get_ylim()[1], 1.5 * peak.most))
    box = (SET_TIME + rise.least, peak.least), rise.most - rise.least, peak.most - peak.least
    axes.add_patch(Rectangle(*box, facecolor=NOTE, alpha=0.15, linewidth=0, label="peak wanted, that of another model"))
    axes.axvline(stop.most, color=NOTE, linewidth=0.9, linestyle=":", label="at rest before, end of that model's run")
