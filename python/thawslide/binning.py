"""Particles gathered on the cells of a map: thickness, and means over what stands above a cell.

The matter of a particle lies evenly under a square as wide as the simulator's grid cell, which is what its motion is
resolved to. With the share s_pc of this square that lies in map cell c (area A), volume V_p and mass m_p,

    thickness_c = sum_p s_pc V_p / A,      mean_c(f) = sum_p s_pc m_p f_p / sum_p s_pc m_p

The shares of a particle sum to 1, so the map's volume is that of the particles inside it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thawslide.errors import ReportError
from thawslide.maps import Grid, Map
from thawslide.run import Numbers, Snapshot

Indices = NDArray[np.intp]

_MOST_CELLS_WIDE = 100  # that a particle may be: the work grows with its square

FIELDS = ("volume", "mass", "velocity", "temperature", "in_band")  # what `gather` reads of a snapshot


@dataclass(frozen=True)
class Columns:
    """What stands on each cell of a grid at one time [s]."""

    time: float
    thickness: Map  # m, along the vertical; 0 where nothing is
    speed: Map  # m/s, mean of mass over the column; nan where nothing is
    temperature: Map  # C, mean of mass over the particles next to the ground; nan where there is none


def shares(place: Numbers, start: float, cell: float, count: int, width: float) -> Iterator[tuple[Indices, Numbers]]:
    """Yield (cell, share) of intervals of a width [m] about places [m] in cells from `start` on, for one axis.

    Each pass gives every place one of the cells it may reach; the shares of a place sum to 1 over all passes as long as
    the interval stays inside. A cell outside is -1.
    """
    if not width <= _MOST_CELLS_WIDE * cell:
        raise ReportError(f"particles {width:g} m wide on map cells of {cell:g} m: above {_MOST_CELLS_WIDE} cells each")
    low = (place - 0.5 * width - start) / cell
    high = (place + 0.5 * width - start) / cell
    first = np.floor(low).astype(np.intp)
    for step in range(int(np.ceil(width / cell)) + 1):
        index = first + step
        share = np.clip(np.minimum(high, index + 1.0) - np.maximum(low, index), 0.0, None) * cell / width
        yield np.where((index >= 0) & (index < count), index, -1), share


def spread(grid: Grid, x: Numbers, y: Numbers, width: float, amounts: list[Numbers]) -> list[Numbers]:
    """Return each amount (one number a particle) summed in the cells of a grid, shape (rows, columns).

    The square of a particle is at least as wide as a cell, so that no stripes of empty cells appear between particles.
    """
    west, _, south, _ = grid.box
    totals = [np.zeros(grid.rows * grid.columns) for _ in amounts]
    across = list(shares(x, west, grid.cell_x, grid.columns, max(width, grid.cell_x)))
    for row, share_y in shares(y, south, grid.cell_y, grid.rows, max(width, grid.cell_y)):
        for column, share_x in across:
            share = share_y * share_x
            at = np.flatnonzero((row >= 0) & (column >= 0) & (share > 0.0))
            cells = row[at] * grid.columns + column[at]
            for total, amount in zip(totals, amounts, strict=True):
                total += np.bincount(cells, share[at] * amount[at], len(total))
    return [total.reshape(grid.rows, grid.columns) for total in totals]


def gather(grid: Grid, snapshot: Snapshot, width: float) -> Columns:
    """Return what stands on the cells of a grid; `width` [m] is the simulator's grid cell.

    Particles of a failed run without a valid position or volume are left out.
    """
    mass = np.asarray(snapshot["mass"], dtype=np.float64)
    volume = np.asarray(snapshot["volume"], dtype=np.float64)
    speed = np.linalg.norm(np.asarray(snapshot["velocity"], dtype=np.float64), axis=1)
    base = mass * (np.asarray(snapshot["in_band"]) != 0)
    warm = base * np.asarray(snapshot["temperature"], dtype=np.float64)
    x, y = snapshot.points[:, 0], snapshot.points[:, 1]
    sound = np.isfinite(x) & np.isfinite(y) & np.isfinite(volume)
    amounts = [amount[sound] for amount in (volume, mass, mass * speed, base, warm)]
    volumes, masses, momenta, bases, warmth = spread(grid, x[sound], y[sound], width, amounts)
    return Columns(
        snapshot.time,
        Map(grid, volumes / grid.cell_area, "m", "thickness"),
        Map(grid, _ratio(momenta, masses), "m/s", "speed"),
        Map(grid, _ratio(warmth, bases), "C", "temperature next to the ground"),
    )


@dataclass(frozen=True)
class BaseColumns:
    """Means over the band columns of each cell of a grid, by area; nan where no piece of base lies."""

    pressure_ratio: Map  # pore pressure over normal pressure
    temperature: Map  # C, of the band


def gather_base(grid: Grid, snapshot: Snapshot, width: float) -> BaseColumns:
    """Return what the pieces of base in a snapshot have on the cells of a grid; each is `width` [m] wide."""
    pieces = snapshot.base
    if not pieces:
        nothing = np.full((grid.rows, grid.columns), np.nan)
        return BaseColumns(Map(grid, nothing, "1", ""), Map(grid, nothing, "C", ""))
    x, y = pieces["position_m"][:, 0], pieces["position_m"][:, 1]
    area = pieces["area_m2"]
    amounts = [area * pieces[name] for name in ("normal_pressure_Pa", "pore_pressure_Pa", "temperature_C")]
    areas, loads, pressures, warmth = spread(grid, x, y, width, [area, *amounts])
    return BaseColumns(
        Map(grid, _ratio(pressures, loads), "1", "pore pressure over normal pressure"),
        Map(grid, _ratio(warmth, areas), "C", "temperature of the band"),
    )


def _ratio(above: Numbers, below: Numbers) -> Numbers:
    return np.divide(above, below, out=np.full_like(above, np.nan), where=below > 0.0)
