"""Boiling of the pore water of band columns: the formulas of src/physics/boiling.hpp.

L_v(T) = 2.5e6 - 2360 T [J/kg], T in C; dP_abs/dT = L_v P_abs/(R_v T^2) with steam as an ideal gas, integrated from
100 C at one atmosphere.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from thawslide.run_folder import Numbers

ATMOSPHERE = 101325.0  # Pa
GAS_CONSTANT = 461.5  # J/kg/K, of steam
AT_ATMOSPHERE = 100.0  # C
KELVIN = 273.15
HEAT_AT_ZERO, HEAT_LOST_PER_KELVIN = 2.5e6, 2360.0  # J/kg, J/kg/K
_ITERATIONS = 30


def _log_of_pressure(temperature: Numbers) -> Numbers:
    """Return ln(P_abs/P_atm) at which water of a temperature [C] boils."""
    absolute, boiling = temperature + KELVIN, AT_ATMOSPHERE + KELVIN
    extrapolated = HEAT_AT_ZERO + HEAT_LOST_PER_KELVIN * KELVIN
    cooler = extrapolated * (1.0 / boiling - 1.0 / absolute) - HEAT_LOST_PER_KELVIN * np.log(absolute / boiling)
    return np.asarray(cooler / GAS_CONSTANT)


def saturation_pressure(temperature: ArrayLike) -> Numbers:
    """Return the absolute pressure [Pa] at which water of a temperature [C] boils."""
    return np.asarray(ATMOSPHERE * np.exp(_log_of_pressure(np.asarray(temperature, dtype=np.float64))))


def boiling_temperature(pressure: ArrayLike) -> Numbers:
    """Return the temperature [C] at which water boils under a pressure [Pa] above that of the air; nan stays nan."""
    wanted = np.log1p(np.asarray(pressure, dtype=np.float64) / ATMOSPHERE)
    temperature = np.full_like(wanted, AT_ATMOSPHERE)
    for _ in range(_ITERATIONS):  # Newton's method: ln P is concave in T
        latent = HEAT_AT_ZERO - HEAT_LOST_PER_KELVIN * temperature
        residual = wanted - _log_of_pressure(temperature)
        temperature = temperature + residual * GAS_CONSTANT * (temperature + KELVIN) ** 2 / latent
    return temperature
