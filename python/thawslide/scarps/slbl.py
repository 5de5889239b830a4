"""Sloping local base level (SLBL) below a DEM.

Jaboyedoff et al. (2004, 2009, 2020) lower each point of the DEM inside an outline until its neighbours no longer allow
it:

    z_new = min(z, mean of the 4 neighbours - C)

Points outside the outline keep the elevation of the DEM. The iteration converges to the highest surface below the DEM
that satisfies z <= mean - C. For the depth d = z_DEM - z, with the mean M of the neighbours, this is

    d = max(0, M d + f),   f = C + z_DEM - M z_DEM

a linear complementarity problem with a symmetric positive definite matrix. Projected successive over-relaxation in
red-black order (Cryer 1971) converges to it from any start. If cells are not square, the weights of the mean are
proportional to 1/cell^2 along each axis.

The residual r = max |d - max(0, M d + f)| bounds the error by r times the depth for C = 1 on a flat DEM, which is at
most n^2 / (8 w): n cells across the outline, and the weight w of each of the two neighbours in that direction. The
iteration ends when this bound is at most 1e-6 m, or when the residual is at the rounding level.
"""

from __future__ import annotations

import math

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.scarps.dem_file import Dem, Mask

ACCURACY = 1e-6  # m: bound of the error of the depth
_MAX_SWEEPS = 200_000
_SWEEPS_PER_CHECK = 10
_ROUNDING = 4.0 * float(np.finfo(np.float64).eps)


class SlblSolver:
    """Depths of the SLBL within an outline for different C; each solution starts from the previous one."""

    def __init__(self, dem: Dem, inside: Mask) -> None:
        """Prepare the cells of an outline, which must be inside the DEM by at least one cell."""
        rows, columns = np.nonzero(inside)
        self._window = (slice(rows.min() - 1, rows.max() + 2), slice(columns.min() - 1, columns.max() + 2))
        self._shape = inside.shape
        self._inside = inside[self._window][1:-1, 1:-1]
        square_x, square_y = dem.cell_x**2, dem.cell_y**2
        # Of each of the two neighbours along x and along y.
        self._weight_x = square_y / (2.0 * (square_x + square_y))
        self._weight_y = square_x / (2.0 * (square_x + square_y))
        heights = dem.heights[self._window]
        heights = np.where(np.isfinite(heights), heights, 0.0)  # only corners: the others are required
        heights = heights - heights.mean()
        self._convexity = np.where(self._inside, heights[1:-1, 1:-1] - self._mean(heights), 0.0)
        n_y, n_x = (extent + 1 for extent in self._inside.shape)
        radius = 2.0 * (self._weight_x * math.cos(math.pi / n_x) + self._weight_y * math.cos(math.pi / n_y))
        self._relaxation = 2.0 / (1.0 + math.sqrt(1.0 - radius**2))
        largest = min(n_x**2 / (8.0 * self._weight_x), n_y**2 / (8.0 * self._weight_y))
        self._residual = ACCURACY / largest
        self._depth = np.zeros(heights.shape)

    def depth(self, tolerance: float) -> Numbers:
        """Return the depth [m] of the SLBL for C [m], shape of the DEM, 0 outside the outline."""
        source = self._convexity + tolerance
        for sweep in range(_MAX_SWEEPS):
            for first in ((0, 0), (1, 1), (0, 1), (1, 0)):  # red, then black
                self._relax(source, *first)
            if sweep % _SWEEPS_PER_CHECK == 0 and self._error(source) <= self._limit():
                found = np.zeros(self._shape)
                found[self._window] = self._depth
                return found
        raise ReportError("--slbl: the iteration does not converge. Use a DEM with larger cells.")

    def _relax(self, source: Numbers, row: int, column: int) -> None:
        """Update every second cell of every second row."""
        depth, cells = self._depth, (slice(row, None, 2), slice(column, None, 2))
        own = depth[1:-1, 1:-1][cells]
        found = depth[1:-1, :-2][cells] + depth[1:-1, 2:][cells]
        found *= self._weight_x
        found += self._weight_y * (depth[:-2, 1:-1][cells] + depth[2:, 1:-1][cells])
        found += source[cells]
        found *= self._relaxation
        found += (1.0 - self._relaxation) * own
        np.maximum(found, 0.0, out=found)
        np.multiply(found, self._inside[cells], out=own)

    def _limit(self) -> float:
        limit: float = max(self._residual, _ROUNDING * float(self._depth.max()))
        return limit

    def _error(self, source: Numbers) -> float:
        inner = self._depth[1:-1, 1:-1]
        return float(np.abs(inner - np.maximum(self._mean(self._depth) + source, 0.0))[self._inside].max())

    def _mean(self, values: Numbers) -> Numbers:
        mean: Numbers = self._weight_x * (values[1:-1, :-2] + values[1:-1, 2:])
        mean += self._weight_y * (values[:-2, 1:-1] + values[2:, 1:-1])
        return mean
