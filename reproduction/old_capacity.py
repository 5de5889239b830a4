"""Sec. 3.1 in one dimension: effect of the capacity of the old state in three updates.

Two particles a cell with linear shape functions, as in the bar along x, without subgrid diffusion. C_old is the slope
of the heat content H(T) at the temperature before the step, on the frozen side at 0 C; dT is the change of temperature
of a particle from the nodes. Updates:

  "printed"   T += dT                        Eqs. 18 and 19 as published; heat is not conserved
  "carried"   H += C_old dT,  T = H^-1(H)    heat is conserved for any C_old
  "secant"    H += C dT,      T = H^-1(H)    with C = [H(T + dT) - H(T)]/dT of a predicted dT, as in Thawslide
"""

from __future__ import annotations

import numpy as np

from reproduction.freezing import COLD_END, COMPARED, LENGTH, reference
from reproduction.mixture import FREEZING_BAR, HeatTable, linear_saturation
from thawslide.run_folder import Numbers

CELL, DAY, STEP = 0.01, 86400.0, 21.6  # m, s, s
COLDEST = -400.0  # C: lower end of the table of heat content


class Bar:
    """A bar at 0 C with COLD_END at its end node: by one jump at t = 0, or prescribed in each step."""

    def __init__(self, slope: float, is_prescribed: bool, cell: float = CELL, step: float = STEP) -> None:
        """Create particles for a slope m [1/K] of the freezing curve."""
        self.slope, self.is_prescribed, self.cell, self.step = slope, is_prescribed, cell, step
        self.saturation = linear_saturation(slope)
        self.table = HeatTable(FREEZING_BAR, self.saturation, COLDEST, True)
        self.nodes = round(LENGTH / cell) + 1
        self.x: Numbers = np.asarray((np.arange(2 * (self.nodes - 1)) + 0.5) * 0.5 * cell, dtype=np.float64)
        self.left = (self.x / cell).astype(int)
        self.fraction = self.x / cell - self.left
        self.temperature: Numbers = np.zeros_like(self.x)
        self.content = self.table.content(self.temperature)
        self.first = True

    def _sum(self, values: Numbers) -> Numbers:
        left = np.bincount(self.left, (1.0 - self.fraction) * values, self.nodes)
        return np.asarray(left + np.bincount(self.left + 1, self.fraction * values, self.nodes))

    def _change(self, power: Numbers, mapped: Numbers, capacity: Numbers) -> Numbers:
        """Return dT of the particles for a nodal power [W/m2] and their capacities [J/m3/K]."""
        rate = power / (0.5 * self.cell * self._sum(capacity))
        rate[0] = (COLD_END - mapped[0]) / self.step if self.first or self.is_prescribed else 0.0
        return np.asarray(self.step * ((1.0 - self.fraction) * rate[self.left] + self.fraction * rate[self.left + 1]))

    def advance(self, update: str) -> None:
        """Advance by one step with one of the updates above."""
        saturation = self.saturation(self.temperature)
        freezing = (self.temperature <= 0.0) & (self.temperature > -1.0 / self.slope)
        old = FREEZING_BAR.capacity(saturation) + np.where(freezing, self.slope * FREEZING_BAR.melting_heat(), 0.0)
        mapped = self._sum(self.temperature) / self._sum(np.ones_like(self.x))
        nodal = mapped.copy()
        nodal[0] = COLD_END
        flow = -0.5 * FREEZING_BAR.conductivity(saturation) * (nodal[self.left + 1] - nodal[self.left])
        into, out_of = (np.bincount(node, flow / self.cell, self.nodes) for node in (self.left + 1, self.left))
        power: Numbers = np.asarray(into - out_of, dtype=np.float64)
        change = self._change(power, mapped, old)
        if update == "printed":
            self.temperature = self.temperature + change
        else:
            if update == "secant":
                gain = self.table.content(self.temperature + change) - self.table.content(self.temperature)
                old = np.where(np.abs(change) > 1e-9, gain / np.where(change == 0.0, 1.0, change), old)
                change = self._change(power, mapped, old)
            self.content = self.content + old * change
            self.temperature = self.table.temperature(self.content)
        self.first = False


def error(slope: float, update: str, is_prescribed: bool = False, time: float = DAY, cell: float = CELL) -> float:
    """Return the maximum error [K] over 0 < x < 0.95 m at a time [s] relative to the finite volumes of Fig. 4."""
    bar = Bar(slope, is_prescribed, cell)
    for _ in range(round(time / bar.step)):
        bar.advance(update)
    x, exact = reference(slope, True, time)
    difference = bar.temperature - np.interp(bar.x, np.concatenate(([0.0], x)), np.concatenate(([COLD_END], exact)))
    return float(np.max(np.abs(difference[bar.x < COMPARED])))


def measures() -> dict[str, float]:
    """Return the errors [K] of each update, by slope, and the maximum of the secant."""
    slopes = {"m025": 0.25, "m050": 0.5, "m100": 1.0}
    found = {}
    for name, slope in slopes.items():
        found[f"old_{name}_printed"] = error(slope, "printed")
        found[f"old_{name}_carried"] = error(slope, "carried")
        found[f"old_{name}_pulled"] = error(slope, "carried", is_prescribed=True)
    found["old_secant"] = max(error(slope, "secant") for slope in slopes.values())
    found["old_secant_pulled"] = max(error(slope, "secant", is_prescribed=True) for slope in slopes.values())
    return found
