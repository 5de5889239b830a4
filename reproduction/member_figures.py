"""Members of starting noise over time, on the clock that the reported values have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from reproduction.members import MODEL, QUANTITIES, SET_TIME
from thawslide.figures.motion import draw_targets
from thawslide.figures.style import BLUE, COLUMN_WIDTH, GREEN, NOTE, letters, styled
from thawslide.run import Numbers, Run

STEP = 0.1  # s, of the median's curve
MEMBER = "#B5B5B5"


def on_one_clock(runs: Sequence[Run], column: str) -> tuple[Numbers, Numbers]:
    """Return times [s] on the clock of the figures that all runs have, and a column of each, shape (runs, times)."""
    clocks = [run.shown_time for run in runs]
    time = np.arange(max(clock[0] for clock in clocks), min(clock[-1] for clock in clocks), STEP)
    values = [np.interp(time, clock, run.history[column]) for run, clock in zip(runs, clocks, strict=True)]
    return time, np.array(values)


@styled
def members_over_time(runs: Sequence[Run]) -> Figure:
    """Draw mean velocity and mean displacement of all members and their median, with the reported values."""
    figure = Figure(figsize=(COLUMN_WIDTH, 3.7), layout="constrained")
    speed, way = figure.subplots(1, 2)
    for axes, column, divisor, colour, reported in (
        (speed, "mean_velocity_m_s", 1.0, BLUE, ("mean_velocity",)),
        (way, "mean_displacement_m", 1e3, GREEN, ("mean_displacement",)),
    ):
        time, values = on_one_clock(runs, column)
        # A thin median upon wider members: neither hides the other, however close they lie.
        wide = axes.plot(time, values.T / divisor, color=MEMBER, linewidth=2.4, solid_capstyle="butt", zorder=2)
        wide[0].set_label(f"each of {len(runs)} runs with starting noise")
        axes.plot(time, np.median(values, axis=0) / divisor, color=colour, linewidth=1.2, label="median", zorder=3)
        draw_targets(axes, runs[0], reported, divisor, NOTE)
        axes.set_xlim(min(0.0, float(time[0])), max(205.0, float(time[-1])))
        axes.set_xlabel(runs[0].clock.label)
        axes.set_ylim(bottom=0.0)
        axes.grid(True)
    speed.set_ylabel("mean velocity (m/s)")
    way.set_ylabel("mean displacement (km)")
    _draw_wanted(speed)
    way.set_ylim(top=1.6 * way.get_ylim()[1])  # room for the legend above the curves
    for axes, place in ((speed, "upper right"), (way, "upper left")):
        axes.legend(loc=place, frameon=True, framealpha=1.0, edgecolor="none")
    letters((speed, way), ("mean velocity", "mean displacement"))
    return figure


def _draw_wanted(axes: Axes) -> None:
    """Shade where the peak is wanted, and mark the end of the run of the other model, by when the slide stands."""
    wanted = {each.name: each for each in QUANTITIES}
    peak, rise, stop = wanted["peak"], wanted["rise"], wanted["stop"]
    axes.set_ylim(top=max(axes.get_ylim()[1], 1.5 * peak.most))
    box = (SET_TIME + rise.least, peak.least), rise.most - rise.least, peak.most - peak.least
    words = f"{MODEL}: peak {peak.reported} m/s, accepted {peak.wanted}"
    axes.add_patch(Rectangle(*box, facecolor=NOTE, alpha=0.15, linewidth=0, label=words))
    axes.axvline(stop.most, color=NOTE, linewidth=0.9, linestyle=":", label=f"{MODEL}: end of the run, at rest")
