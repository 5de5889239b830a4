"""Static load on particles of a 2D run, for comparison with pore pressure."""

from __future__ import annotations

import numpy as np

from thawslide.errors import ReportError
from thawslide.run_folder import Numbers, Run, Snapshot

_MOST_SNAPSHOTS = 60  # used for a curve of the load


def overburden(run: Run, shot: Snapshot) -> Numbers:
    """Return the overburden [Pa] at each particle of a 2D run, with half of its own weight, over a grid cell."""
    cell, gravity = float(run.section("grid")["cell"]), float(run.section("case").get("gravity", 9.81))
    mass = np.asarray(shot["mass"], dtype=np.float64) / run.relative_width(shot.points[:, 0])
    column = np.floor(shot.points[:, 0] / cell)
    order = np.lexsort((-shot.points[:, 1], column))
    below = np.cumsum(mass[order]) - mass[order]
    first = np.flatnonzero(np.diff(column[order], prepend=-np.inf))
    before = np.repeat(below[first], np.diff(first, append=len(order)))
    weight = np.empty_like(mass)
    weight[order] = gravity * (below + 0.5 * mass[order] - before) / cell
    return weight


def load_on_band(run: Run) -> tuple[Numbers, Numbers]:
    """Return times [s] and the normal pressure N [Pa] of the overburden of the band, mass-weighted mean.

    N = w cos2(a), with the overburden w and the slope a of the terrain, without centrifugal and impact terms. Both
    are empty in 3D, and if snapshots lack fields or are damaged.
    """
    if run.dimension != 2 or run.terrain is None or run.gravity_tilt or not len(run.times):
        return np.empty(0), np.empty(0)
    chosen = np.unique(np.linspace(0, len(run.times) - 1, _MOST_SNAPSHOTS).round().astype(int))
    slope = np.gradient(run.terrain[1], run.terrain[0])
    loads = []
    for index in chosen:
        try:
            shot = run.snapshot(int(index), fields=("mass", "in_band"))
            band, mass = np.asarray(shot["in_band"]) > 0, np.asarray(shot["mass"], dtype=np.float64)
        except ReportError:
            return np.empty(0), np.empty(0)
        squared = 1.0 / (1.0 + np.interp(shot.points[band, 0], run.terrain[0], slope) ** 2)
        load = overburden(run, shot)[band] * squared
        loads.append(np.average(load, weights=mass[band]) if mass[band].sum() > 0.0 else np.nan)
    return run.times[chosen], np.array(loads)
