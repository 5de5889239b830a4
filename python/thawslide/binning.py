"""Averages of particles on the cells of a map: thickness, and means over the column above a cell.

The material of a particle is distributed evenly over a square as wide as the grid cell of the simulator, which is the
resolution of its motion. With the fraction s_pc of this square in map cell c (area A), volume V_p and mass m_p,

    thickness_c = sum_p s_pc V_p / A,      mean_c(f) = sum_p s_pc m_p f_p / sum_p s_pc m_p

The fractions of a particle sum to 1. The volume of the map is therefore that of the particles inside it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from thawslide.errors import ReportError
from thawslide.maps import Grid, Map
from thawslide.run_folder import Numbers, Snapshot

Indices = NDArray[np.intp]

_MAX_WIDTH_IN_CELLS = 100  # of a particle: the cost increases with its square

FIELDS = ("volume", "mass", "velocity", "temperature", "in_band")  # of a snapshot that `gather` reads


@dataclass(frozen=True)
class Columns:
    """Thickness, speed and temperature in each cell of a grid at one time [s]."""

    time: float
    thickness: Map  # m, vertical; 0 in empty cells
    speed: Map  # m/s, mass-weighted mean over the column; nan in empty cells
    temperature: Map  # C, mass-weighted mean over the particles next to the terrain; nan without any
    pore_pressure: Map | None  # Pa, the same mean; None if the snapshot was read without it


def fractions(place: Numbers, start: float, cell: float, count: int, width: float) -> Iterator[tuple[Indices, Numbers]]:
    """Yield (cell, fraction) of intervals of a width [m] around positions [m], in cells from `start` on, for one axis.

    Each pass gives one cell of every interval. The fractions of an interval sum to 1 over all passes if it is inside.
    A cell outside is -1.
    """
    if not width <= _MAX_WIDTH_IN_CELLS * cell:
        raise ReportError(
            f"maps.cell: too small for particles {width:g} m wide (found {cell:g} m; allowed "
            f"{width / _MAX_WIDTH_IN_CELLS:g} m or more). Increase maps.cell."
        )
    low = (place - 0.5 * width - start) / cell
    high = (place + 0.5 * width - start) / cell
    first = np.floor(low).astype(np.intp)
    for step in range(int(np.ceil(width / cell)) + 1):
        index = first + step
        fraction = np.clip(np.minimum(high, index + 1.0) - np.maximum(low, index), 0.0, None) * cell / width
        yield np.where((index >= 0) & (index < count), index, -1), fraction


def spread(grid: Grid, x: Numbers, y: Numbers, width: float, amounts: list[Numbers]) -> list[Numbers]:
    """Return each amount (one number per particle) summed in the cells of a grid, shape (rows, columns).

    The square of a particle is at least as wide as a cell, to avoid stripes of empty cells between particles.
    """
    west, _, south, _ = grid.box
    totals = [np.zeros(grid.rows * grid.columns) for _ in amounts]
    across = list(fractions(x, west, grid.cell_x, grid.columns, max(width, grid.cell_x)))
    for row, fraction_y in fractions(y, south, grid.cell_y, grid.rows, max(width, grid.cell_y)):
        for column, fraction_x in across:
            fraction = fraction_y * fraction_x
            at = np.flatnonzero((row >= 0) & (column >= 0) & (fraction > 0.0))
            cells = row[at] * grid.columns + column[at]
            for total, amount in zip(totals, amounts, strict=True):
                total += np.bincount(cells, fraction[at] * amount[at], len(total))
    return [total.reshape(grid.rows, grid.columns) for total in totals]


def gather(grid: Grid, snapshot: Snapshot, width: float) -> Columns:
    """Return the averages in the cells of a grid; `width` [m] is the grid cell of the simulator.

    Particles of a failed run without a valid position or volume are ignored.
    """
    mass = np.asarray(snapshot["mass"], dtype=np.float64)
    volume = np.asarray(snapshot["volume"], dtype=np.float64)
    speed = np.linalg.norm(np.asarray(snapshot["velocity"], dtype=np.float64), axis=1)
    base = mass * (np.asarray(snapshot["in_band"]) != 0)
    warm = base * np.asarray(snapshot["temperature"], dtype=np.float64)
    pressure = [base * np.asarray(snapshot["pore_pressure"], dtype=np.float64)] if "pore_pressure" in snapshot else []
    x, y = snapshot.points[:, 0], snapshot.points[:, 1]
    valid = np.isfinite(x) & np.isfinite(y) & np.isfinite(volume)
    amounts = [amount[valid] for amount in (volume, mass, mass * speed, base, warm, *pressure)]
    volumes, masses, momenta, bases, warmth, *pressures = spread(grid, x[valid], y[valid], width, amounts)
    return Columns(
        snapshot.time,
        Map(grid, volumes / grid.cell_area, "m", "thickness"),
        Map(grid, _ratio(momenta, masses), "m/s", "speed"),
        Map(grid, _ratio(warmth, bases), "degC", "basal temperature"),
        Map(grid, _ratio(pressures[0], bases), "Pa", "basal pore pressure") if pressures else None,
    )


@dataclass(frozen=True)
class BaseColumns:
    """Area-weighted means over the band columns in each cell of a grid; nan without basal segments."""

    pressure_ratio: Map  # pore pressure over normal pressure
    temperature: Map  # C, of the band


def gather_base(grid: Grid, snapshot: Snapshot, width: float) -> BaseColumns:
    """Return the averages of the basal segments of a snapshot in the cells of a grid; each is `width` [m] wide."""
    segments = snapshot.base
    if not segments:
        nothing = np.full((grid.rows, grid.columns), np.nan)
        return BaseColumns(Map(grid, nothing, "1", ""), Map(grid, nothing, "degC", ""))
    x, y = segments["position_m"][:, 0], segments["position_m"][:, 1]
    area = segments["area_m2"]
    amounts = [area * segments[name] for name in ("normal_pressure_Pa", "pore_pressure_Pa", "temperature_C")]
    areas, loads, pressures, warmth = spread(grid, x, y, width, [area, *amounts])
    return BaseColumns(
        Map(grid, _ratio(pressures, loads), "1", "pore pressure over normal pressure"),
        Map(grid, _ratio(warmth, areas), "degC", "band temperature"),
    )


def _ratio(above: Numbers, below: Numbers) -> Numbers:
    return np.divide(above, below, out=np.full_like(above, np.nan), where=below > 0.0)
