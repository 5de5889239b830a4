"""Flow thickness of a 2D section: area of the particles in each interval of x over its length."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from thawslide.binning import fractions
from thawslide.errors import ReportError
from thawslide.run_folder import Numbers, Run, Snapshot

_MOST_SNAPSHOTS = 60  # read for the maximum
_FIELDS = ("volume",)


def spaced(count: int, most: int) -> list[int]:
    """Return at most `most` of the numbers 0 to count - 1, evenly spaced, with the first and the last."""
    return sorted({round(float(each)) for each in np.linspace(0, count - 1, min(count, most))}) if count else []


def particle_thickness(run: Run, shot: Snapshot) -> Numbers:
    """Return the vertical flow thickness [m] at each particle of a 2D run, mean over a grid cell along x.

    The area of a particle is distributed over the width of a cell around it. Invalid particles have nan.
    """
    x = shot.points[:, 0]
    thickness = np.full(len(x), np.nan)
    profile = _profile(run, shot)
    if profile is not None:
        start, cell, values, valid = profile
        thickness[valid] = values[((x[valid] - start) / cell).astype(np.intp)]
    return thickness


def _profile(run: Run, shot: Snapshot) -> tuple[float, float, Numbers, NDArray[np.bool_]] | None:
    """Return start and length [m] of intervals of x, their thickness [m], and which particles are valid.

    None without valid particles, or for too many intervals.
    """
    cell = float(run.section("grid").get("cell", 0.0))
    x, area = shot.points[:, 0], run.section_areas(shot)
    valid = np.isfinite(x) & np.isfinite(area)
    if cell <= 0.0 or not valid.any():
        return None
    start = float(x[valid].min()) - cell
    count = int((float(x[valid].max()) - start) / cell) + 2
    if count > _MOST_CELLS:
        return None
    total = np.zeros(count)
    for index, fraction in fractions(x[valid], start, cell, count, cell):
        inside = index >= 0
        total += np.bincount(index[inside], fraction[inside] * area[valid][inside], count)
    return start, cell, total / cell, valid


def thickness_at(run: Run, shot: Snapshot, x: Numbers) -> Numbers:
    """Return the flow thickness [m] of a 2D run at distances x [m], 0 outside the mass."""
    profile = _profile(run, shot)
    if profile is None:
        return np.zeros_like(x)
    start, cell, values, _ = profile
    index = np.floor((x - start) / cell)
    inside = (index >= 0) & (index < len(values))
    return np.where(inside, values[np.where(inside, index, 0).astype(np.intp)], 0.0)


def maximum_thickness_at(run: Run, x: Numbers) -> Numbers:
    """Return the maximum flow thickness [m] of the snapshots of a 2D run at distances x [m]."""
    most = np.zeros_like(x)
    for index in spaced(len(run.times), _MOST_SNAPSHOTS):
        np.maximum(most, thickness_at(run, run.snapshot(index, fields=_FIELDS), x), out=most)
    return most


def peak_thickness(run: Run) -> tuple[float, float] | None:
    """Return the maximum flow thickness [m] of the snapshots of a 2D run and its time [s], None without any."""
    best: tuple[float, float] | None = None
    try:
        for index in spaced(len(run.times), _MOST_SNAPSHOTS):
            shot = run.snapshot(index, fields=_FIELDS)
            thickness = particle_thickness(run, shot)
            if np.isfinite(thickness).any() and (best is None or np.nanmax(thickness) > best[0]):
                best = float(np.nanmax(thickness)), shot.time
    except ReportError:
        return best
    return best


_MOST_CELLS = 10_000_000
