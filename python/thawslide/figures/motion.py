"""Mean velocity, mean displacement and runout distance over time, with reported values (paper Fig. 16)."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.figures.style import (
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    RED,
    TIME_LABEL,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.number_text import prefixed
from thawslide.run_folder import Run
from thawslide.targets import KINDS
from thawslide.time_reference import has_time_reference

_MARKERS = "osD^vP*X"
_NOTE_WIDTH = 40  # characters


def plot_targets(
    axes: Axes, run: Run, quantities: tuple[str, ...], divisor: float, colour: str, words: str = ""
) -> list[str]:
    """Mark the reported values within the run's time, one marker a source, filled if observed.

    Return a note on values outside the time of the run, if there are any.
    """
    begin, end = (float(run.series["time_s"][row]) for row in (0, -1))
    asked = [target for target in run.targets if target.quantity in quantities]
    found = [target for target in asked if begin <= target.time <= end and has_time_reference(run)]
    groups = list(dict.fromkeys((target.adjective, target.source) for target in found))
    for number, (adjective, source) in enumerate(groups):
        of_source = [target for target in found if (target.adjective, target.source) == (adjective, source)]
        axes.plot(
            [target.time for target in of_source],
            [target.value / divisor for target in of_source],
            marker=_MARKERS[number % len(_MARKERS)],
            markerfacecolor=colour if adjective == KINDS["observation"][0] else "white",
            markeredgecolor=colour,
            markeredgewidth=1.4,
            markersize=6.5,
            linestyle="",
            label=f"{adjective}{words}: {source or 'no source'}",
            clip_on=False,
            zorder=5,
        )
    if len(found) == len(asked):
        return []
    of_words = f" of{words}" if words else ""
    if not has_time_reference(run):
        return [f"{_reported(len(asked))}{of_words} not shown: the run never attains start_velocity"]
    early = sum(target.time < begin for target in asked)
    counts = {"before the start": early, "after the end": len(asked) - len(found) - early}
    return [", ".join(f"{_reported(count)}{of_words} {when} of the run" for when, count in counts.items() if count)]


def _reported(count: int) -> str:
    return f"{count} reported value{'' if count == 1 else 's'}"


def add_to_legend(axes: Axes, notes: list[str]) -> None:
    """Add notes to the legend of a panel."""
    for note in notes:
        axes.plot([], [], linestyle="", label=textwrap.fill(note, _NOTE_WIDTH))


@styled
def motion(run: Run) -> Figure:
    """Plot (a) mean and maximum speed, (b) mean displacement, runout distance and front travel distance.

    Particles at rest vibrate without net motion. The maximum speed is therefore plotted until rest only.
    """
    history = run.series
    time = run.series["time_s"]
    figure = Figure(figsize=(COLUMN_WIDTH, 4.3), layout="constrained")
    title_figure(figure, run.titled("motion"))
    speed, distance = figure.subplots(1, 2)

    if "max_velocity_m_s" in history:
        moving = history["time_s"] <= run.rest_since
        time_line(
            speed,
            time[moving],
            history["max_velocity_m_s"][moving],
            color="#B5B5B5",
            linewidth=1.0,
            label="maximum" if moving.all() else "maximum, until rest",
        )
    time_line(speed, time, history["mean_velocity_m_s"], color=BLUE, label="mean (mass-weighted)")
    add_to_legend(speed, plot_targets(speed, run, ("mean_velocity",), 1.0, BLUE))
    speed.set_ylabel("speed (m/s)")

    lengths = [history[name] for name in ("mean_displacement_m", "runout_m") if name in history]
    divisor, unit = prefixed(np.concatenate(lengths) if lengths else 0.0, "m")
    time_line(
        distance, time, history["mean_displacement_m"] / divisor, color=GREEN, label="mean path length (mass-weighted)"
    )
    notes = plot_targets(distance, run, ("mean_displacement",), divisor, GREEN, " mean displacement")
    add_to_legend(distance, notes)
    if "runout_m" in history:
        time_line(
            distance,
            time,
            history["runout_m"] / divisor,
            color=RED,
            linestyle="--",
            label="runout distance (front minus initial rear)",
        )
        if "front_position_m" in history:
            front = history["front_position_m"]
            first = int(np.argmax(np.isfinite(front)))  # without maps.path there is no front before the first motion
            travelled = (history["runout_m"] - history["runout_m"][first]) / divisor  # in 2D also towards -x
            time_line(distance, time, travelled, color=RED, linestyle=":", label="front travel distance")
        notes = plot_targets(distance, run, ("front_distance",), divisor, RED, " runout distance")
        add_to_legend(distance, notes)
    distance.set_ylabel(f"distance ({unit})")

    for axes in (speed, distance):
        time_axis(axes, time, TIME_LABEL)
        axes.set_ylim(bottom=0.0)
        # Legends below the panels do not cover curves.
        axes.legend(loc="upper left", bbox_to_anchor=(-0.14, -0.2), handlelength=1.5)
    title_panels((speed, distance), ("speed", "distance"))
    return figure
