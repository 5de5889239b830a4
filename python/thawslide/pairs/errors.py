"""Errors of a result from runs on cells of 4h, 2h and h."""

from __future__ import annotations

import math
from dataclasses import dataclass

# Observed orders between which a result is extrapolated; no part of the scheme has an order above 2.
LOWEST, HIGHEST = 0.5, 2.0
SAFETY = 1.25  # of the error from three cells (Roache 1994, Perspective: a method for uniform reporting, Eq. 6)


@dataclass(frozen=True)
class Error:
    """Error of a result on cells of h. order: observed, nan if the result is not extrapolated, for `reason`."""

    value: float  # on cells of h
    coarse: float  # on cells of 2h
    coarsest: float  # on cells of 4h; nan without a run
    order: float
    limit: float  # extrapolated to cells of size 0; nan if it is not
    error: float  # of `value`, in its unit
    reason: str


def error_of(coarsest: float, coarse: float, value: float) -> Error:
    """Return the error of a result on cells of h, from those on 4h and 2h as well.

    With an observed order p = log2((f2 - f4)/(f1 - f2)) between LOWEST and HIGHEST, the limit is
    f1 + (f1 - f2)/(2^p - 1) (Richardson), and the error SAFETY times the distance from it. Otherwise the result is not
    extrapolated: its error is the largest difference among the runs.
    """
    first, second = coarse - coarsest, value - coarse
    known = [each for each in (coarsest, coarse, value) if math.isfinite(each)]
    spread = max(known) - min(known) if len(known) > 1 else math.nan
    order, reason = math.nan, ""
    if not (math.isfinite(first) and math.isfinite(second)):
        reason = "a run has no such result"
    elif second == 0.0:
        reason = "the results on 2h and h are equal"
    elif first * second <= 0.0:
        reason = "not monotonic"
    else:
        order = math.log2(first / second)
        if not LOWEST <= order <= HIGHEST:
            reason = f"observed order {round(order, 1) + 0.0:.1f}, not {LOWEST:g} to {HIGHEST:g}"
    if reason:
        return Error(value, coarse, coarsest, math.nan, math.nan, spread, reason)
    step = second / (2.0**order - 1.0)
    return Error(value, coarse, coarsest, order, value + step, SAFETY * abs(step), "")
