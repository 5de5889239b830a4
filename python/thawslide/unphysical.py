"""Unphysical values: water above its boiling point, heat that would melt rock, pore pressure above the load.

The model has no boiling in particles and no melting of rock, so that nothing in a run prevents such values.
"""

from __future__ import annotations

import numpy as np

from thawslide.boiling import boiling_temperature
from thawslide.run import Numbers, Run

ROCK_MELTS = 1000.0  # C: about where granite is molten throughout
ROUND_OFF = 1e-3  # of N, and of temperatures
MOST_OF_WEIGHT = 2.0  # of the static load, that bends and impact may add up to
EDGES = 0.05  # fraction of particles that are ignored


def boils(run: Run) -> bool:
    """Return whether water boils in a run, so that what is hotter is dry."""
    return run.has_band_columns and bool(run.section("heat").get("steam", True))


def temperature_limit(run: Run, pressure: Numbers) -> Numbers:
    """Return the temperature [C] above which values are unphysical at a pore pressure [Pa].

    It is the boiling point at that pressure if water does not boil in the model, else the melting point of rock.
    """
    if boils(run):
        return np.full_like(pressure, ROCK_MELTS)
    return np.asarray(boiling_temperature(np.maximum(pressure, 0.0)))


def too_hot(run: Run, temperature: Numbers, pressure: Numbers) -> str:
    """Return a warning for temperatures [C] above their limit at pore pressures [Pa], "" for none."""
    above = temperature > (1.0 + ROUND_OFF) * temperature_limit(run, pressure)
    if not above.any():
        return ""
    highest = f"{float(temperature[above].max()):,.0f} °C"
    if boils(run):
        return f"unphysical: up to {highest}, where rock melts ({ROCK_MELTS:,.0f} °C); the model has no melting of rock"
    return f"unphysical: up to {highest}, where water boils at its pressure; the model has no boiling here"


def too_much_pressure(ratio: Numbers) -> str:
    """Return a warning for pore pressures over the N that loads them, "" where none is above 1."""
    highest = float(np.max(ratio, initial=0.0, where=np.isfinite(ratio)))
    return f"unphysical: P exceeds N, by up to a factor of {highest:.3g}" if highest > 1.0 + ROUND_OFF else ""


def too_much_for_weight(ratio: Numbers, left_out: float = 0.0) -> str:
    """Return a warning for pore pressures over the weight above them, "" while that is less than twice the weight.

    A static load leaves out bends and impact. `left_out` is the share of the highest values that do not count, as the
    weight above a particle at an edge is next to nothing.
    """
    finite = ratio[np.isfinite(ratio)]
    high = float(np.quantile(finite, 1.0 - left_out)) if finite.size else 0.0
    if high <= MOST_OF_WEIGHT:
        return ""
    where = f"in {100 * left_out:.0f} % of particles P is at least" if left_out else "P is up to"
    return f"unphysical: {where} {high:.3g} times the weight above"
