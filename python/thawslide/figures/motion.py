"""Mean velocity, mean displacement and runout over time, against reported values (paper Fig. 16)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.clock import has_clock
from thawslide.figures.style import (
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    NOTE,
    RED,
    give_title,
    letters,
    prefixed,
    styled,
    time_axis,
    time_line,
)
from thawslide.run import Run
from thawslide.targets import KINDS

_MARKERS = "osD^vP*X"


def draw_targets(
    axes: Axes, run: Run, quantities: tuple[str, ...], divisor: float, colour: str, words: str = ""
) -> int:
    """Mark the reported values within the run's time, one marker a source, filled if observed; return their number.

    A note says how many lie outside of it.
    """
    begin, end = (float(run.shown_time[row]) for row in (0, -1))
    asked = [target for target in run.targets if target.quantity in quantities]
    found = [target for target in asked if begin <= target.time <= end and has_clock(run)]
    if len(found) < len(asked):
        # One line of note for each call on the same panel.
        height = 0.02 + 0.06 * len(axes.texts)
        early = sum(target.time < begin for target in asked)
        counts = {"before the start": early, "after the end": len(asked) - len(found) - early}
        note = ", ".join(f"{count} reported{words} {when} of the run" for when, count in counts.items() if count)
        if not has_clock(run):
            note = f"{len(asked)} reported{words} not drawn: the run never reaches the speed that sets the clock"
        axes.text(0.98, height, note, transform=axes.transAxes, ha="right", size=7.5, color=NOTE)
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
            label=f"{adjective}{words}: {source or 'no source given'}",
            clip_on=False,
            zorder=5,
        )
    return len(found)


@styled
def motion(run: Run) -> Figure:
    """Draw (a) mean and largest velocity, (b) mean displacement, runout and the travel distance of the front.

    Particles of a slide at rest vibrate without net motion. The largest velocity is therefore drawn until rest only.
    """
    history = run.history
    time = run.shown_time
    figure = Figure(figsize=(COLUMN_WIDTH, 4.3), layout="constrained")
    give_title(figure, run.titled("motion of the slide"))
    speed, distance = figure.subplots(1, 2)

    if "max_velocity_m_s" in history:
        moves = history["time_s"] <= run.rest_since
        time_line(
            speed,
            time[moves],
            history["max_velocity_m_s"][moves],
            color="#B5B5B5",
            linewidth=1.0,
            label="fastest particle" if moves.all() else "fastest particle, until rest",
        )
    time_line(speed, time, history["mean_velocity_m_s"], color=BLUE, label="mean (of mass)")
    draw_targets(speed, run, ("mean_velocity",), 1.0, BLUE)
    speed.set_ylabel("velocity (m/s)")

    lengths = [history[name] for name in ("mean_displacement_m", "runout_m") if name in history]
    divisor, unit = prefixed(np.concatenate(lengths) if lengths else 0.0, "m")
    time_line(distance, time, history["mean_displacement_m"] / divisor, color=GREEN, label="mean path length (of mass)")
    draw_targets(distance, run, ("mean_displacement",), divisor, GREEN, " mean")
    if "runout_m" in history:
        time_line(
            distance,
            time,
            history["runout_m"] / divisor,
            color=RED,
            linestyle="--",
            label="runout (front − rear at the start)",
        )
        if "front_position_m" in history:
            front = history["front_position_m"]
            first = int(np.argmax(np.isfinite(front)))  # without maps.path there is none before the slide moves
            way = (history["runout_m"] - history["runout_m"][first]) / divisor  # in 2D slides go towards -x too
            time_line(distance, time, way, color=RED, linestyle=":", label="travel distance of the front")
        draw_targets(distance, run, ("front_distance",), divisor, RED, " runout")
    distance.set_ylabel(f"distance ({unit})")

    for axes in (speed, distance):
        time_axis(axes, time, run.clock.label)
        axes.set_ylim(bottom=0.0)
        # Below the panel: with many reported values it would hide the curves.
        axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.2))
    letters((speed, distance), ("velocity", "displacement"))
    return figure
