"""Unphysical values: water above its boiling point, rock above its melting point, pore pressure above the load.

The model has no boiling in particles and no melting of rock. Therefore a run can produce such values.
"""

from __future__ import annotations

import numpy as np

from thawslide.boiling import boiling_temperature
from thawslide.number_text import number_text
from thawslide.run_folder import Numbers, Run

ROCK_MELTING_POINT = 1000.0  # C: about the temperature at which granite is completely molten
ROUND_OFF = 1e-3  # of N, and of temperatures
MAX_OVERBURDEN_RATIO = 2.0  # P over the static load; bends and impact increase the load
EDGES = 0.05  # fraction of particles that are ignored


def has_boiling(run: Run) -> bool:
    """Return whether water boils in a run."""
    return run.has_band_columns and bool(run.section("heat").get("steam", True))


def temperature_limit(run: Run, pressure: Numbers) -> Numbers:
    """Return the temperature [C] above which values are unphysical at a pore pressure [Pa].

    It is the boiling point at that pressure if water does not boil in the model, else the melting point of rock.
    """
    if has_boiling(run):
        return np.full_like(pressure, ROCK_MELTING_POINT)
    return np.asarray(boiling_temperature(np.maximum(pressure, 0.0)))


def too_hot(run: Run, temperature: Numbers, pressure: Numbers) -> str:
    """Return a warning for temperatures [C] above their limit at pore pressures [Pa], "" for none."""
    above = temperature > (1.0 + ROUND_OFF) * temperature_limit(run, pressure)
    if not above.any():
        return ""
    highest = f"{number_text(float(temperature[above].max()))} °C"
    if has_boiling(run):
        limit = f"{number_text(ROCK_MELTING_POINT)} °C"
        return f"unphysical: {highest} exceeds the melting point of rock ({limit}); rock melting is not modelled"
    return f"unphysical: {highest} exceeds the boiling point of water; boiling is not modelled"


def too_much_pressure(ratio: Numbers) -> str:
    """Return a warning for ratios of pore pressure to N above 1, "" for none."""
    highest = float(np.max(ratio, initial=0.0, where=np.isfinite(ratio)))
    return f"unphysical: P/N up to {number_text(highest)}" if highest > 1.0 + ROUND_OFF else ""


def too_much_for_overburden(ratio: Numbers, ignored: float = 0.0) -> str:
    """Return a warning for ratios of pore pressure to overburden above twice the overburden, "" for none.

    The static load omits centrifugal and impact terms. `ignored` is the fraction of the highest values to ignore,
    because the overburden of a particle at an edge is small.
    """
    finite = ratio[np.isfinite(ratio)]
    high = float(np.quantile(finite, 1.0 - ignored)) if finite.size else 0.0
    if high <= MAX_OVERBURDEN_RATIO:
        return ""
    particles = f" in {100 * ignored:.0f} % of particles" if ignored else ""
    bound = "at least" if ignored else "up to"
    return f"unphysical: P/overburden {bound} {number_text(high)}{particles}"
