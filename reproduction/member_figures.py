"""Members with initial noise over time, with the reported values shifted to it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from reproduction.members import MODEL, QUANTITIES, SET_SPEED, SET_TIME
from thawslide.figures.motion import plot_targets
from thawslide.figures.style import BLUE, COLUMN_WIDTH, GREEN, NOTE, TIME_LABEL, styled, title_panels
from thawslide.run_folder import Numbers, Run
from thawslide.time_reference import time_of_speed

STEP = 0.1  # s, of the median's curve
MEMBER = "#B5B5B5"


def on_common_times(runs: Sequence[Run], column: str) -> tuple[Numbers, Numbers]:
    """Return the common times [s] of all runs, and a column of each, shape (runs, times)."""
    all_times = [run.series["time_s"] for run in runs]
    time = np.arange(max(times[0] for times in all_times), min(times[-1] for times in all_times), STEP)
    values = [np.interp(time, times, run.series[column]) for run, times in zip(runs, all_times, strict=True)]
    return time, np.array(values)


@styled
def members_over_time(runs: Sequence[Run]) -> Figure:
    """Plot mean velocity and mean displacement of all members and their median, with the reported values."""
    figure = Figure(figsize=(COLUMN_WIDTH, 4.3), layout="constrained")
    speed, distance = figure.subplots(1, 2)
    for axes, column, divisor, colour, reported in (
        (speed, "mean_velocity_m_s", 1.0, BLUE, ("mean_velocity",)),
        (distance, "mean_displacement_m", 1e3, GREEN, ("mean_displacement",)),
    ):
        time, values = on_common_times(runs, column)
        # The median is thinner than the members and does not hide them.
        wide = axes.plot(time, values.T / divisor, color=MEMBER, linewidth=2.4, solid_capstyle="butt", zorder=2)
        wide[0].set_label(f"each of {len(runs)} runs with initial noise")
        axes.plot(time, np.median(values, axis=0) / divisor, color=colour, linewidth=1.2, label="median", zorder=3)
        plot_targets(axes, runs[0], reported, divisor, NOTE)
        axes.set_xlim(min(0.0, float(time[0])), max(205.0, float(time[-1])))
        axes.set_xlabel(TIME_LABEL)
        axes.set_ylim(bottom=0.0)
        axes.grid(True)
    speed.set_ylabel("mean velocity (m/s)")
    distance.set_ylabel("mean displacement (km)")
    _draw_accepted_range(speed, time_of_speed(runs[0], SET_SPEED))
    for axes in (speed, distance):
        # Legends below the panels do not cover curves.
        axes.legend(loc="upper left", bbox_to_anchor=(-0.14, -0.2), handlelength=1.5)
    title_panels((speed, distance), ("mean velocity", "mean displacement"))
    return figure


def _draw_accepted_range(axes: Axes, start: float) -> None:
    """Shade the accepted range of the peak, and mark the end of the run of the other model, which is at rest.

    start: the time [s] at which the first run attains SET_SPEED, to which the times of that model are shifted.
    """
    wanted = {each.name: each for each in QUANTITIES}
    peak, rise, stop = wanted["peak"], wanted["rise"], wanted["stop"]
    axes.set_ylim(top=max(axes.get_ylim()[1], 1.1 * peak.most))
    box = (start + rise.least, peak.least), rise.most - rise.least, peak.most - peak.least
    words = f"{MODEL}: peak {peak.reported} m/s, accepted {peak.wanted}"
    axes.add_patch(Rectangle(*box, facecolor=NOTE, alpha=0.15, linewidth=0, label=words))
    end = stop.most - SET_TIME + start
    axes.axvline(end, color=NOTE, linewidth=0.9, linestyle=":", label=f"{MODEL}: end of the run, at rest")
