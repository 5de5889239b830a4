"""Units of reported and observed values, and their conversion."""

from __future__ import annotations

import math
from collections.abc import Mapping

Units = Mapping[str, tuple[float, float]]  # by the unit's name: (factor, offset) of first unit = factor * x + offset

LENGTHS: Units = {"m": (1.0, 0.0), "km": (1e3, 0.0), "cm": (1e-2, 0.0)}
TIMES: Units = {"s": (1.0, 0.0), "min": (60.0, 0.0), "h": (3600.0, 0.0)}
SPEEDS: Units = {"m/s": (1.0, 0.0), "km/h": (1.0 / 3.6, 0.0)}
TEMPERATURES: Units = {"C": (1.0, 0.0), "degC": (1.0, 0.0), "°C": (1.0, 0.0), "K": (1.0, -273.15)}
FORCES: Units = {"N": (1.0, 0.0), "kN": (1e3, 0.0), "MN": (1e6, 0.0), "GN": (1e9, 0.0), "TN": (1e12, 0.0)}
PRESSURES: Units = {"Pa": (1.0, 0.0), "kPa": (1e3, 0.0), "MPa": (1e6, 0.0), "GPa": (1e9, 0.0)}
AREAS: Units = {"m2": (1.0, 0.0), "m²": (1.0, 0.0), "ha": (1e4, 0.0), "km2": (1e6, 0.0), "km²": (1e6, 0.0)}
VOLUMES: Units = {
    "m3": (1.0, 0.0),
    "m³": (1.0, 0.0),
    "million m3": (1e6, 0.0),
    "million m³": (1e6, 0.0),
    "km3": (1e9, 0.0),
    "km³": (1e9, 0.0),
}
ANGLES: Units = {"degrees": (1.0, 0.0), "deg": (1.0, 0.0), "°": (1.0, 0.0), "rad": (math.degrees(1.0), 0.0)}
RATIOS: Units = {"-": (1.0, 0.0), "1": (1.0, 0.0), "": (1.0, 0.0), "%": (1e-2, 0.0)}

_CF = {"C": "degC", "-": "1", "": "1"}  # other units are written as in the conventions


def cf_unit(unit: str) -> str:
    """Return a unit as in the CF conventions, which tools such as xarray and pint read."""
    return _CF.get(unit, unit)
