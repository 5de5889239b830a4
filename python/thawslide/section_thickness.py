"""Flow thickness of a 2D section: area of the particles in each interval of x over its length."""

from __future__ import annotations

import numpy as np

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
    cell = float(run.section("grid").get("cell", 0.0))
    x, area = shot.points[:, 0], run.section_areas(shot)
    thickness = np.full(len(x), np.nan)
    valid = np.isfinite(x) & np.isfinite(area)
    if cell <= 0.0 or not valid.any():
        return thickness
    start = float(x[valid].min()) - cell
    count = int((float(x[valid].max()) - start) / cell) + 2
    if count > _MOST_CELLS:
        return thickness
    total = np.zeros(count)
    for index, fraction in fractions(x[valid], start, cell, count, cell):
        inside = index >= 0
        total += np.bincount(index[inside], fraction[inside] * area[valid][inside], count)
    thickness[valid] = (total / cell)[((x[valid] - start) / cell).astype(np.intp)]
    return thickness


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
