"""Times of reported values: a target `start_velocity` shifts them to the time since the start of the run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from thawslide.number_text import exact_text, number_text
from thawslide.targets import REFERENCE, Target

if TYPE_CHECKING:
    from thawslide.run_folder import Run


def shifted_targets(run: Run, targets: Sequence[Target]) -> list[Target]:
    """Return reported values with times [s] since the start of the run.

    If there is a value `start_velocity`, all times are shifted so that its time is that at which the mean velocity of
    the run first attains it. A run that never does shifts none.
    """
    reference = _reference_of(targets)
    start = float("nan") if reference is None else time_of_speed(run, reference.value)
    if reference is None or np.isnan(start):
        return list(targets)
    return [replace(target, time=target.time + (start - reference.time)) for target in targets]


def _reference_of(targets: Sequence[Target]) -> Target | None:
    return next((one for one in targets if one.quantity == REFERENCE), None)


def time_of_speed(run: Run, speed: float) -> float:
    """Return the time [s] at which the mean velocity first attains a value [m/s], interpolated; nan for never."""
    if "mean_velocity_m_s" not in run.series:
        return float("nan")
    time, found = run.series["time_s"], run.series["mean_velocity_m_s"]
    reached = np.flatnonzero(found >= speed)
    if not reached.size:
        return float("nan")
    at = int(reached[0])
    if at == 0:
        return float(time[0])
    return float(np.interp(speed, found[at - 1 : at + 1], time[at - 1 : at + 1]))


def has_time_reference(run: Run) -> bool:
    """Return whether reported values can be compared at their times; false if the run never attains the velocity."""
    reference = _reference_of(run.targets)
    return reference is None or not np.isnan(time_of_speed(run, reference.value))


def time_note(run: Run) -> str:
    """Return a sentence on the times of the page and its figures."""
    reference = _reference_of(run.targets)
    clock = "Times are measured from the start of the run."
    if reference is None:
        return clock
    speed = f"{exact_text(reference.value)} m/s"
    if not has_time_reference(run):
        return f"{clock} It never attains {speed}. No value is compared at its time."
    return (
        f"{clock} Those of reported values are shifted: the mean velocity first attains {speed} at "
        f"{number_text(reference.time)} s."
    )
