"""Parts of a raster whose cells are joined by edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from thawslide.scarps.dem_file import Mask


def part_with(cells: Mask, row: int, column: int) -> Mask:
    """Return the cells that are joined by edges with a given cell; none if that cell is not among them."""
    rows, columns = _runs(cells), _runs(cells.T)
    reached = np.zeros_like(cells)
    reached[row, column] = cells[row, column]
    count = 0
    while np.count_nonzero(reached) > count:
        count = int(np.count_nonzero(reached))
        reached = _spread(reached, rows) & cells
        reached = _spread(reached.T, columns).T & cells
    return reached


def _runs(cells: Mask) -> NDArray[np.intp]:
    """Return for each cell the number of its run in its row."""
    starts = np.ones(cells.shape, dtype=bool)
    starts[:, 1:] = cells[:, 1:] != cells[:, :-1]
    return np.cumsum(starts.ravel()).reshape(cells.shape)


def _spread(reached: Mask, runs: NDArray[np.intp]) -> Mask:
    """Return the cells of all runs with a reached cell."""
    hit = np.zeros(int(runs.max()) + 1, dtype=bool)
    hit[runs[reached]] = True
    spread: Mask = hit[runs]
    return spread
