"""The clock of reported values: a target `start_velocity` says when a slide had which speed, and so sets it."""

from __future__ import annotations

import numpy as np

from thawslide.run import Run
from thawslide.targets import SETS_CLOCK, Target


def time_of_speed(run: Run, speed: float) -> float:
    """Return when [s] the mean velocity first reaches a speed [m/s], between the rows of the history; nan for never."""
    time, found = run.history["time_s"], run.history["mean_velocity_m_s"]
    reached = np.flatnonzero(found >= speed)
    if not reached.size:
        return float("nan")
    at = int(reached[0])
    if at == 0:
        return float(time[0])
    return float(np.interp(speed, found[at - 1 : at + 1], time[at - 1 : at + 1]))


def own_time(run: Run, target: Target) -> float:
    """Return the run's own time [s] that a reported value is compared at; nan where the run never starts."""
    sets = next((one for one in run.targets if one.quantity == SETS_CLOCK), None)
    return target.time if sets is None else target.time + time_of_speed(run, sets.value) - sets.time


def clock_note(run: Run) -> str:
    """Return a sentence on the clock that reported values are compared on."""
    sets = next((one for one in run.targets if one.quantity == SETS_CLOCK), None)
    if sets is None:
        return "Compared at the run's own times. A row start_velocity (time and speed) would set another clock."
    start = time_of_speed(run, sets.value)
    clock = f"Reported times are on the clock on which the mean velocity comes to {sets.value:g} m/s at {sets.time:g} s"
    if np.isnan(start):
        return f"{clock}. This run never does, so nothing is compared at a time."
    later = start - sets.time
    return (
        f"{clock}, as this run does at {start:.3g} s of its own: compared {abs(later):.3g} s "
        f"{'later' if later >= 0.0 else 'earlier'} there, in the figures too."
    )
