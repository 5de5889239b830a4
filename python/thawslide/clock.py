"""The clock of a run's figures: a target `start_velocity` says when a slide had which speed, and so sets it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from thawslide.targets import SETS_CLOCK, Target

if TYPE_CHECKING:
    from thawslide.run import Run


@dataclass(frozen=True)
class Clock:
    """The clock that all figures of a run share: what it adds [s] to the time since the start of the run, in words."""

    shift: float
    words: str

    @property
    def label(self) -> str:
        """The label of an axis of times."""
        return f"time (s), {self.words}"


def clock_of(run: Run) -> Clock:
    """Return the clock that a target `start_velocity` sets, or the run's own where none does or the run never starts.

    On it the mean velocity first reaches the target's speed at the target's time.
    """
    sets = _sets_clock(run)
    start = float("nan") if sets is None else time_of_speed(run, sets.value)
    if sets is None or np.isnan(start):
        return Clock(0.0, "0 at the start of the run")
    return Clock(sets.time - start, f"mean velocity {sets.value:g} m/s at {sets.time:g} s")


def _sets_clock(run: Run) -> Target | None:
    return next((one for one in run.targets if one.quantity == SETS_CLOCK), None)


def time_of_speed(run: Run, speed: float) -> float:
    """Return when [s] the mean velocity first reaches a speed [m/s], between the rows of the history; nan for never."""
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


def has_clock(run: Run) -> bool:
    """Return whether reported values can be compared at their times: not where the run never starts."""
    sets = _sets_clock(run)
    return sets is None or not np.isnan(time_of_speed(run, sets.value))


def clock_note(run: Run) -> str:
    """Return a sentence on the clock of the page and its figures."""
    sets = _sets_clock(run)
    if sets is None:
        return "Times count from the start of the run. A row start_velocity (time and speed) would set another clock."
    clock = f"{sets.value:g} m/s at {sets.time:g} s"
    if not has_clock(run):
        return f"Times count from the start of the run. It never reaches {clock}, so nothing is compared at a time."
    return (
        f"Times on this page and in its figures are on the clock of the reported values: the mean velocity first "
        f"reaches {clock}. The run starts at {run.shown_time[0]:.3g} s on it."
    )
