"""Shear band as a small system of ordinary differential equations, independent of the simulator.

The column has rows of particles over rigid terrain, two rows to a cell of height e (the scaled cell of heat and pore
pressure), and linear shape functions with weights 3/4 and 1/4. Unknowns are heat content and liquid pressure of each
row. A slab of normal pressure N slides over it at a given speed v:

    tau = mu max(0, N - P_base),   P_base = 3/4 P_1 + 1/4 P_2
    dH_p/dt = C_p sum_i w_ip Q_i / sum_q w_iq C_q V_q,     Q_0 = tau v + conduction, Q_i = conduction
    dP_p/dt = Lambda dT_p/dt + seepage,  once melted; before, P_p = S P_L + (1 - S) P_I with Clapeyron's P_L
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reproduction.mixture import TABLE_1, HeatTable, Mixture, power_saturation
from thawslide.run_folder import Numbers

Flags = NDArray[np.bool_]

KELVIN = 273.15
GRAVITY = 9.81
DIMENSIONS = 2  # subgrid diffusion counts both axes of the section


@dataclass(frozen=True)
class Drive:
    """A slab driven over its band: thickness e [m], speed [m/s], height [m], start [C], k_L [m/s], coefficient mu."""

    thickness: float
    end: float
    speed: float = 1.0
    height: float = 50.0
    temperature: float = -10.0
    friction: float = 0.2
    hydraulic_conductivity: float = 0.0
    conduction: bool = False
    latent: bool = True
    cells: int = 5


@dataclass(frozen=True)
class BandHistory:
    """Means over the two rows of the band at each time [s]: temperature [C], saturation, pore pressure [Pa]."""

    time: Numbers
    temperature: Numbers
    saturation: Numbers
    pressure: Numbers


class Column:
    """Weights and gradients of the linear shape functions on a column of `cells` cells of height e, two rows a cell."""

    def __init__(self, cells: int, height: float) -> None:
        """Build the matrices, shape (nodes, rows)."""
        rows = 2 * cells
        place = (np.arange(rows) + 0.5) / 2.0
        below = place.astype(int)
        self.weights: Numbers = np.zeros((cells + 1, rows))
        self.slopes: Numbers = np.zeros((cells + 1, rows))
        for row, (cell, x) in enumerate(zip(below, place, strict=True)):
            self.weights[cell : cell + 2, row] = 1.0 - (x - cell), x - cell
            self.slopes[cell : cell + 2, row] = -1.0 / height, 1.0 / height
        self.volume = 0.5 * height  # of a row, per area of base
        self.sums: Numbers = self.weights.sum(axis=1)

    def at_nodes(self, values: Numbers) -> Numbers:
        """Return the average of the rows at each node."""
        return self.weights @ values / self.sums


def solve(drive: Drive, step: float = 0.005, mixture: Mixture = TABLE_1) -> BandHistory:
    """Integrate the column with steps of `step` seconds; rows of history every 20 steps."""
    state = _State(drive, mixture)
    rows = []
    steps = int(np.ceil(drive.end / step))
    for number in range(steps + 1):
        if number % 20 == 0:
            band = slice(0, 2)
            means = (state.temperature[band].mean(), state.saturation[band].mean(), state.pressure[band].mean())
            rows.append((number * step, *means))
        state.advance(step)
    return BandHistory(*np.array(rows).T)


class _State:
    """Temperature, saturation and pressure of the rows, and how they change."""

    def __init__(self, drive: Drive, mixture: Mixture) -> None:
        self.drive, self.mixture = drive, mixture
        self.column = Column(drive.cells, drive.thickness)
        self.table = HeatTable(mixture, power_saturation, drive.temperature - 1.0, drive.latent, 3000.0)
        rows = 2 * drive.cells
        self.temperature = np.full(rows, drive.temperature)
        self.saturation = power_saturation(self.temperature)
        self.normal_pressure = mixture.density() * GRAVITY * drive.height
        # Rows of the band have the whole height, others their depth (in the slab, not in the scaled column).
        depth = drive.height * (1.0 - (np.arange(rows) + 0.5) / rows)
        depth[:2] = drive.height
        self.ice_pressure = mixture.ice_density * GRAVITY * depth
        self.liquid_pressure = self._clapeyron()
        self.pressure = self._mean_pressure()

    def _clapeyron(self) -> Numbers:
        mixture = self.mixture
        below = np.minimum(self.temperature, 0.0)
        cold = mixture.water_density * mixture.latent_heat * np.log((below + KELVIN) / KELVIN)
        melting = self.ice_pressure * mixture.water_density / mixture.ice_density
        return np.asarray(melting + cold, dtype=np.float64)

    def _mean_pressure(self) -> Numbers:
        return self.saturation * self.liquid_pressure + (1.0 - self.saturation) * self.ice_pressure

    def advance(self, step: float) -> None:
        """Advance by one explicit step."""
        drive, column, mixture = self.drive, self.column, self.mixture
        melted = self.temperature >= 0.0
        strength = drive.friction * max(0.0, self.normal_pressure - column.at_nodes(self.pressure)[0])
        power = np.zeros(drive.cells + 1)
        power[0] = strength * drive.speed
        node_pressure = column.at_nodes(self.pressure)
        if drive.conduction:
            gradient = column.slopes.T @ column.at_nodes(self.temperature)
            power -= column.slopes @ (column.volume * mixture.conductivity(self.saturation) * gradient)
            power += column.weights @ (self._advection(melted, gradient, node_pressure) * column.volume)
        change, gain = self._heating(power, step)
        new = self.table.temperature(self.table.content(self.temperature) + gain)
        new = np.where(np.abs(change) < 1e-12, self.temperature, new)  # no heating by round-off of the table
        seepage = self._seepage(melted, node_pressure, step)
        self._pressurize(melted, new, seepage)

    def _heating(self, power: Numbers, step: float) -> tuple[Numbers, Numbers]:
        """Return the predicted change of temperature and the gain of heat content of each row."""
        column = self.column
        content = self.table.content(self.temperature)
        slope = (self.table.content(self.temperature + 1e-3) - content) / 1e-3
        rate = power / (column.weights @ (column.volume * slope))
        change = step * (column.weights.T @ rate)
        steep = np.abs(change) > 1e-9
        secant = np.where(
            steep, (self.table.content(self.temperature + change) - content) / np.where(steep, change, 1.0), slope
        )
        rate = power / (column.weights @ (column.volume * secant))
        return change, secant * step * (column.weights.T @ rate)

    def _advection(self, melted: Flags, gradient: Numbers, node_pressure: Numbers) -> Numbers:
        mixture = self.mixture
        mobility = self.drive.hydraulic_conductivity / mixture.unit_weight
        pressure_gradient = self.column.slopes.T @ node_pressure
        heat = mixture.water_density * mixture.water_heat * mobility * pressure_gradient * gradient
        return np.where(melted, heat, 0.0)

    def _seepage(self, melted: Flags, node_pressure: Numbers, step: float) -> Numbers:
        """Return the change of pressure by seepage in a step: between nodes, and by subgrid diffusion."""
        column, drive = self.column, self.drive
        if drive.hydraulic_conductivity == 0.0:
            return np.zeros_like(self.pressure)
        diffusivity = self.mixture.hydraulic_diffusivity(drive.hydraulic_conductivity)
        fraction = -np.expm1(-step * diffusivity * 2.0 * DIMENSIONS / drive.thickness**2)
        subgrid = np.where(melted, (column.weights.T @ node_pressure - self.pressure) * fraction, 0.0)
        flux = np.where(melted, -diffusivity * (column.slopes.T @ node_pressure), 0.0)
        between = (step * (column.slopes @ flux) - column.weights @ subgrid) / column.sums
        return subgrid + column.weights.T @ between

    def _pressurize(self, melted: Flags, new: Numbers, seepage: Numbers) -> None:
        density_ratio = self.mixture.water_density / self.mixture.ice_density
        rise = self.mixture.pressurization() * (new - np.where(melted, self.temperature, 0.0))
        before = np.where(melted, self.liquid_pressure, self.ice_pressure * density_ratio)
        warm = new >= 0.0
        self.temperature = new
        self.saturation = power_saturation(new)
        self.liquid_pressure = np.where(warm, before + rise + np.where(melted, seepage, 0.0), self._clapeyron())
        self.pressure = self._mean_pressure()
