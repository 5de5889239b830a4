"""Distance between the outlines of two runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers
from thawslide.contours import areas_beyond
from thawslide.maps import Map

_BLOCK = 256  # points per step of the search for the nearest edge


@dataclass(frozen=True)
class OutlineDistance:
    """Signed distances [m] of the outline of one run from that of another: positive outside of the latter."""

    mean: float
    rms: float
    largest: float  # the 95th percentile of the absolute distance


def outline_distance(field: Map, other: Map, thickness: float) -> OutlineDistance | None:
    """Return the distance of the outline of `field` from that of `other`, both where `thickness` [m] is exceeded.

    Points lie at most half a map cell apart along the outline, holes included. None if one of the maps has no outline.
    """
    edges, others = (_edges(each, thickness) for each in (field, other))
    if not len(edges) or not len(others):
        return None
    points, weights = _points(edges, 0.5 * field.grid.cell_x)
    sign = np.where(np.nan_to_num(_linear(other, points)) > thickness, -1.0, 1.0)
    signed = sign * _distances(points, others)
    mean = float(np.average(signed, weights=weights))
    rms = float(np.sqrt(np.average(signed**2, weights=weights)))
    order = np.argsort(np.abs(signed))
    share = np.cumsum(weights[order]) / weights.sum()
    return OutlineDistance(mean, rms, float(np.abs(signed)[order][np.searchsorted(share, 0.95)]))


def _edges(field: Map, thickness: float) -> Numbers:
    """Return the edges of the outline [m], shape (n, 2, 2): their ends."""
    (area,) = areas_beyond(field, [thickness])
    rings = [ring for polygon in area.polygons for ring in polygon]
    return np.concatenate([np.stack((r[:-1], r[1:]), axis=1) for r in rings]) if rings else np.empty((0, 2, 2))


def _points(edges: Numbers, spacing: float) -> tuple[Numbers, Numbers]:
    """Return points along edges, shape (n, 2), and the length of outline [m] that each represents."""
    points, weights = [], []
    for start, end in edges:
        length = float(np.hypot(*(end - start)))
        count = max(1, int(np.ceil(length / spacing)))
        along = (np.arange(count) + 0.5) / count
        points.append(start + along[:, None] * (end - start))
        weights.append(np.full(count, length / count))
    return np.concatenate(points), np.concatenate(weights)


def _distances(points: Numbers, edges: Numbers) -> Numbers:
    """Return the distance of each point from the nearest edge [m]."""
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    squared = np.maximum(np.sum(along**2, axis=1), 1e-30)
    found = np.empty(len(points))
    for first in range(0, len(points), _BLOCK):
        part = points[first : first + _BLOCK, None] - start
        fraction = np.clip(np.sum(part * along, axis=2) / squared, 0.0, 1.0)
        found[first : first + _BLOCK] = np.sqrt(np.sum((part - fraction[..., None] * along) ** 2, axis=2).min(axis=1))
    return found


def _linear(field: Map, points: Numbers) -> Numbers:
    """Return the map at points, linear between the centres of its cells, 0 where it has no data, as in areas_beyond."""
    grid, values = field.grid, np.pad(np.nan_to_num(field.values), 1)
    column = np.clip((points[:, 0] - grid.x0) / grid.cell_x + 1.0, 0.0, grid.columns + 1.0 - 1e-9)
    row = np.clip((points[:, 1] - grid.y0) / grid.cell_y + 1.0, 0.0, grid.rows + 1.0 - 1e-9)
    i, j = column.astype(int), row.astype(int)
    u, v = column - i, row - j
    low = values[j, i] * (1.0 - u) + values[j, i + 1] * u
    high = values[j + 1, i] * (1.0 - u) + values[j + 1, i + 1] * u
    return np.asarray(low * (1.0 - v) + high * v)
