"""Balances of mass and energy: the maximum residual of a run as a percentage, and whether the balance closes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers
from thawslide.figures.energy import relative_residual
from thawslide.number_text import number_text
from thawslide.run_folder import Run

MASS_LIMIT = 1e-4  # of the initial and entrained mass
ENERGY_LIMIT = 1e-2  # of the maximum change of any term of the budget
_LEAST = 0.0001  # %, of residuals above rounding errors


@dataclass(frozen=True)
class Balance:
    """One balance: its name, maximum residual as a fraction of a reference, the limit, and that reference in words."""

    words: str
    residual: float
    limit: float
    reference: str

    @property
    def closes(self) -> bool:
        """Whether the residual is at most the limit; False if it is not finite."""
        return self.residual <= self.limit

    @property
    def verdict(self) -> str:
        """The verdict with its limit."""
        verdict = "closes" if self.closes else "does not close"
        return f"{verdict} (limit {number_text(100.0 * self.limit)} %)"

    @property
    def percentage(self) -> str:
        """The residual as a percentage of its reference."""
        value = f"{number_text(100.0 * self.residual)} %"
        return f"{f'below {_LEAST} %' if 0.0 < 100.0 * self.residual < _LEAST else value} of {self.reference}"


def balances(run: Run) -> list[Balance]:
    """Return the balances for which the history has columns; without any change of a term, a residual is zero."""
    found = []
    if "mass_residual_kg" in run.series:
        residual = _largest(np.abs(run.series["mass_residual_kg"]))
        mass = float(run.series["mass_kg"][0])
        if "entrained_mass_kg" in run.series:
            mass += float(np.nanmax(run.series["entrained_mass_kg"], initial=0.0))
        fraction = residual / mass if mass > 0.0 else 0.0
        found.append(Balance("Mass", fraction, MASS_LIMIT, "the initial and entrained mass"))
    for words, column in (("Mechanical energy", "mechanical_residual_J"), ("Thermal energy", "thermal_residual_J")):
        if column in run.series:
            values = relative_residual(run, column)
            largest = 0.0 if values is None else _largest(values)
            found.append(Balance(words, largest, ENERGY_LIMIT, "the maximum change of any term"))
    return found


def _largest(values: Numbers) -> float:
    """Return the maximum of the finite values; NaN if there is none."""
    finite = values[np.isfinite(values)]
    return float(finite.max()) if finite.size else float("nan")


def balance_note(run: Run) -> str:
    """Return a sentence on balances that do not close, "" if all close."""
    open_ones = [each.words.lower() for each in balances(run) if not each.closes]
    if not open_ones:
        return ""
    return f"The balance of {' and of '.join(open_ones)} does not close. Check the time step before using the results."
