"""Search for the parameter at which an increasing function reaches a value."""

from __future__ import annotations

from collections.abc import Callable

_CLOSE = 1e-7  # relative deviation at which the search ends
_MAX_STEPS = 200
_MAX_DOUBLINGS = 60


class JumpError(Exception):
    """The function jumps over the value, or never reaches it."""

    def __init__(self, below: float, above: float) -> None:
        super().__init__()
        self.below = below  # values of the function on both sides of the jump; inf: never reached
        self.above = above


def matching_parameter(
    function: Callable[[float], float], target: float, low: float, step: float, accuracy: float
) -> float:
    """Return a parameter above `low` at which an increasing function deviates at most `accuracy` from the target.

    The bracket grows by doubling the step. The Illinois form of the rule of false position, alternated with bisection,
    then narrows it. `accuracy` is relative; JumpError if it cannot be reached.
    """
    value_low = function(low)
    if value_low > target:
        raise JumpError(0.0, value_low)
    high, value_high = low + step, function(low + step)
    for _ in range(_MAX_DOUBLINGS):
        if value_high >= target:
            break
        low, value_low, step = high, value_high, 2.0 * step
        high, value_high = low + step, function(low + step)
    else:
        raise JumpError(value_high, float("inf"))
    best = min((abs(value_low - target), low), (abs(value_high - target), high))
    error_low, error_high, last = value_low - target, value_high - target, 0
    for count in range(_MAX_STEPS):
        if best[0] <= _CLOSE * target or high - low <= 1e-14 * max(abs(low), abs(high)):
            break
        middle = 0.5 * (low + high)
        if count % 3 < 2 and error_high > error_low:
            middle = low - error_low * (high - low) / (error_high - error_low)
        error = function(middle) - target
        best = min(best, (abs(error), middle))
        if error < 0.0:
            error_high *= 0.5 if last < 0 else 1.0
            low, value_low, error_low, last = middle, error + target, error, -1
        else:
            error_low *= 0.5 if last > 0 else 1.0
            high, value_high, error_high, last = middle, error + target, error, 1
    if best[0] > accuracy * target:
        raise JumpError(value_low, value_high)
    return best[1]
