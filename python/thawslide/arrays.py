"""Array type of readers and figures, and the comparison of results."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
_ROUNDING = 1e-12  # relative difference of equal results


def is_constant(values: Numbers) -> bool:
    """Return whether finite values are equal, apart from rounding errors."""
    return bool(np.ptp(values) <= _ROUNDING * np.abs(values).max())
