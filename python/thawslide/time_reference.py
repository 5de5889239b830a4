"""Times of the figures of a run: a target `start_velocity` aligns them with reported times."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thawslide.number_text import exact_text, number_text
from thawslide.targets import REFERENCE, Target

if TYPE_CHECKING:
    from thawslide.run_folder import Run


@dataclass(frozen=True)
class TimeReference:
    """Common time reference of all figures: shift [s] from the time since the start of the run, and words for it."""

    shift: float
    words: str

    @property
    def label(self) -> str:
        """The label of a time axis."""
        return f"time (s), {self.words}"


def time_reference_of(run: Run) -> TimeReference:
    """Return the time reference of a target `start_velocity`, or that of the run if there is none or it is not reached.

    With it, the mean velocity first attains the velocity of the target at the time of the target.
    """
    target = _reference_target(run)
    start = float("nan") if target is None else time_of_speed(run, target.value)
    if target is None or np.isnan(start):
        return TimeReference(0.0, "0 at the start of the run")
    return TimeReference(
        target.time - start, f"mean velocity {exact_text(target.value)} m/s at {exact_text(target.time)} s"
    )


def _reference_target(run: Run) -> Target | None:
    return next((one for one in run.targets if one.quantity == REFERENCE), None)


def time_of_speed(run: Run, speed: float) -> float:
    """Return the time [s] at which the mean velocity first attains a value [m/s], interpolated; nan for never."""
    if "mean_velocity_m_s" not in run.history:
        return float("nan")
    time, found = run.history["time_s"], run.history["mean_velocity_m_s"]
    reached = np.flatnonzero(found >= speed)
    if not reached.size:
        return float("nan")
    at = int(reached[0])
    if at == 0:
        return float(time[0])
    return float(np.interp(speed, found[at - 1 : at + 1], time[at - 1 : at + 1]))


def has_time_reference(run: Run) -> bool:
    """Return whether reported values can be compared at their times; false if the run never attains the velocity."""
    target = _reference_target(run)
    return target is None or not np.isnan(time_of_speed(run, target.value))


def time_note(run: Run) -> str:
    """Return a sentence on the times of the page and its figures."""
    target = _reference_target(run)
    if target is None:
        return (
            "Times are measured from the start of the run. A row start_velocity (time and velocity) would align them."
        )
    start = f"{exact_text(target.value)} m/s at {exact_text(target.time)} s"
    if not has_time_reference(run):
        return (
            f"Times are measured from the start of the run. It never attains {start}. No value is compared at its time."
        )
    return (
        "Times on this page and in its figures are aligned with the reported values: the mean velocity first attains "
        f"{start}. The run starts at {number_text(float(run.shown_time[0]))} s."
    )
