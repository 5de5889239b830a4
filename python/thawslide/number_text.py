"""Numbers with units for readers: three significant digits, SI prefixes, commas between thousands."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

_SMALLEST, _LARGEST = 0.001, 1e7  # of numbers without a power of ten
_PREFIXES = ((1e15, "P"), (1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"))
_PREFIXED_UNITS = ("Pa", "N", "J", "N/m of width")
_LEAST_PREFIXED = 1e4
_POWERS = str.maketrans("23", "²³")


def number_text(value: float, digits: int = 3) -> str:
    """Return a number with at most so many significant digits, "none" if it is not finite."""
    if not np.isfinite(value):
        return "none"
    rounded = float(f"{value:.{digits - 1}e}")
    if rounded == 0.0 or _SMALLEST <= abs(rounded) < _LARGEST:
        return exact_text(rounded)
    return _power_text(rounded, digits)


def exact_text(value: float) -> str:
    """Return a number with up to ten significant digits."""
    text = f"{value:,.10g}".replace("-", "−")
    return _power_text(value, 10) if _LARGEST <= abs(value) < np.inf else text


def plain_text(value: float, digits: int = 3) -> str:
    """Return a number with so many significant digits and commas in ASCII, e.g. 20,000,000."""
    return f"{float(f'{value:.{digits}g}'):,.15g}"


def _power_text(value: float, digits: int) -> str:
    """Return a number with a power of ten, e.g. 1.1e11."""
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    return f"{float(mantissa):.{digits}g}e{int(power)}".replace("-", "−")


def integer_text(value: float) -> str:
    """Return a number with at least its integer digits, and with three significant digits if it is small."""
    return f"{value:,.0f}".replace("-", "−") if 1e3 <= abs(value) < 1e10 else number_text(value)


def prefixed(values: ArrayLike, unit: str) -> tuple[float, str]:
    """Return (divisor, unit with its SI prefix) that bring the largest finite value below 1000."""
    numbers = np.abs(np.asarray(values, dtype=np.float64)).ravel()
    numbers = numbers[np.isfinite(numbers)]
    largest = float(numbers.max()) if numbers.size else 0.0
    for size, prefix in _PREFIXES:
        if largest >= size:
            return size, prefix + unit
    return 1.0, unit


def quantity_text(value: float, unit: str = "", digits: int = 3) -> str:
    """Return a number and its unit, with an SI prefix for large values of units that accept one."""
    if not np.isfinite(value):
        return "none"
    if unit == "m3":
        return volume_text(value, digits)
    if unit in _PREFIXED_UNITS and abs(value) >= _LEAST_PREFIXED:
        divisor, unit = prefixed(value, unit)
        value /= divisor
    return f"{number_text(value, digits)} {unit_text(unit)}".strip()


def unit_text(unit: str) -> str:
    """Return a unit of a file or key as pages and figures show it, e.g. °C for C and m³/s² for m3/s2."""
    return "°C" if unit in ("C", "degC") else unit.translate(_POWERS)


def volume_text(value: float, digits: int = 3) -> str:
    """Return a volume [m3] with its unit."""
    return f"{number_text(value / 1e6, digits)} million m³" if value >= 1e6 else f"{number_text(value, digits)} m³"


def area_text(value: float) -> str:
    """Return an area [m2] with its unit."""
    return f"{number_text(value / 1e6)} km²" if value >= 1e5 else f"{number_text(value)} m²"


def length_unit(span: float) -> tuple[float, str]:
    """Return (divisor, unit) for an axis over `span` metres: km from 3 km up."""
    return (1000.0, "km") if span >= 3000.0 else (1.0, "m")
