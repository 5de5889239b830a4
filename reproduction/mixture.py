"""Properties of the mixture for the reference solutions, implemented from the equations of the paper.

Nothing is read from the simulator: a reference with the same formulas could not find an error in them.
Symbols: n porosity, S liquid saturation, T temperature [C], r = rho_I/rho_L.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thawslide.run_folder import Numbers


@dataclass(frozen=True)
class Mixture:
    """Phases of Table 1 and a porosity; densities [kg/m3], capacities [J/kg/K], conductivities [W/m/K]."""

    porosity: float = 0.375
    rock_density: float = 2750.0
    ice_density: float = 917.0
    water_density: float = 1000.0
    rock_heat: float = 858.0
    ice_heat: float = 2040.0
    water_heat: float = 4180.0
    rock_conductivity: float = 3.0
    ice_conductivity: float = 2.22
    water_conductivity: float = 0.58
    rock_expansion: float = 3.0e-5
    water_expansion: float = 2.75e-4
    water_bulk_modulus: float = 1.0e9
    latent_heat: float = 333.5e3
    unit_weight: float = 9810.0

    def density(self) -> float:
        """Return the density [kg/m3] of the frozen mixture."""
        return (1.0 - self.porosity) * self.rock_density + self.porosity * self.ice_density

    def capacity(self, saturation: Numbers) -> Numbers:
        """Return C = sum of n_a rho_a C_a [J/m3/K] (Eq. 9)."""
        water = saturation * self.water_density * self.water_heat
        ice = (1.0 - saturation) * self.ice_density * self.ice_heat
        return (1.0 - self.porosity) * self.rock_density * self.rock_heat + self.porosity * (water + ice)

    def conductivity(self, saturation: Numbers) -> Numbers:
        """Return k = sum of n_a k_a [W/m/K] (Eq. 9)."""
        pore = saturation * self.water_conductivity + (1.0 - saturation) * self.ice_conductivity
        return (1.0 - self.porosity) * self.rock_conductivity + self.porosity * pore

    def melting_heat(self) -> float:
        """Return rho_I n L_f [J/m3]."""
        return self.ice_density * self.porosity * self.latent_heat

    def pressurization(self) -> float:
        """Return K_L beta_m/n [Pa/K] of melted material (Eq. 8 at S = 1, undrained)."""
        expansion = (1.0 - self.porosity) * self.rock_expansion + self.porosity * self.water_expansion
        return self.water_bulk_modulus * expansion / self.porosity

    def hydraulic_diffusivity(self, hydraulic_conductivity: float) -> float:
        """Return K_L k_L/(n gamma_w) [m2/s] of melted material."""
        return self.water_bulk_modulus * hydraulic_conductivity / (self.porosity * self.unit_weight)


# Sec. 3.1, after McKenzie et al. (2007).
FREEZING_BAR = Mixture(
    porosity=0.95, rock_density=2600.0, ice_density=920.0, rock_heat=840.0, ice_heat=2108.0, water_heat=4187.0,
    rock_conductivity=2.9, ice_conductivity=2.14, water_conductivity=0.58,
)  # fmt: skip
TABLE_1 = Mixture()
_KNOTS = 30001


def linear_saturation(slope: float) -> Callable[[Numbers], Numbers]:
    """Return S = 1 + m T between 0 and 1 (Sec. 3.1); slope m [1/K]."""
    return lambda temperature: np.clip(1.0 + slope * temperature, 0.0, 1.0)


def power_saturation(temperature: Numbers) -> Numbers:
    """Return S = (1 - T)^-5 below 0 C and 1 above (Eq. 24)."""
    return np.power(1.0 - np.minimum(temperature, 0.0), -5.0)


class HeatTable:
    """Heat content H [J/m3] over temperature by quadrature on a fine table, and its inverse."""

    def __init__(
        self, mixture: Mixture, saturation: Callable[[Numbers], Numbers], low: float, latent: bool, high: float = 0.0
    ) -> None:
        """Tabulate finely from `low` to 0 C, and by the end point alone to `high` [C], because H is linear there."""
        above = [high] if high > 0.0 else []
        self.temperatures: Numbers = np.concatenate((np.linspace(low, 0.0, _KNOTS), above))
        liquid = saturation(self.temperatures)
        middle = mixture.capacity(saturation(0.5 * (self.temperatures[1:] + self.temperatures[:-1])))
        sensible = np.concatenate(([0.0], np.cumsum(middle * np.diff(self.temperatures))))
        self.contents: Numbers = sensible + (mixture.melting_heat() * liquid if latent else 0.0)

    def temperature(self, content: Numbers) -> Numbers:
        """Return T [C] at which the heat content is H."""
        return np.interp(content, self.contents, self.temperatures)

    def content(self, temperature: Numbers) -> Numbers:
        """Return H [J/m3]."""
        return np.interp(temperature, self.temperatures, self.contents)
