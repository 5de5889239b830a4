"""Force inverted from seismic waves: file, direction of travel, reversal.

Columns: time_s, up_N, north_N, east_N, and, all or none of them, the range of the inversion, as up_low_N and up_high_N.
The force is that of the sliding mass on the Earth.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.targets import Band
from thawslide.text_files import MEGABYTE, finite_number, read_table

PARTS = ("up", "north", "east")
LEAST_MAXIMUM = 0.1
_ENDS = ("low", "high")
_COLUMNS = ("time_s", *(f"{part}_N" for part in PARTS))
_OF_RANGE = tuple(f"{part}_{end}_N" for part in PARTS for end in _ENDS)


@dataclass(frozen=True)
class ForceRecord:
    """Components [N] by name, shape (rows,), with the ends of their range, which can be empty."""

    time: Numbers  # s, ascending
    best: dict[str, Numbers]
    low: dict[str, Numbers]
    high: dict[str, Numbers]
    band: Band  # periods of the waves that were inverted
    source: str


@dataclass(frozen=True)
class Reversal:
    """Times [s] of the maximum upward value of a vertical force, of its zero, and of the maximum downward value."""

    upward: float
    zero: float
    downward: float

    @property
    def duration(self) -> float:
        """The time [s] between the two maxima."""
        return self.downward - self.upward

    def moved(self, shift: float) -> Reversal:
        """Return the reversal with times shifted by `shift` [s]."""
        return Reversal(self.upward + shift, self.zero + shift, self.downward + shift)


def read_force_record(path: Path, band: Band, source: str) -> ForceRecord:
    """Read the file; the ReportError states the line, the found and the allowed value."""
    table = read_table(path, _COLUMNS, _OF_RANGE, MEGABYTE)
    absent = [name for name in _OF_RANGE if name not in table.columns]
    if 0 < len(absent) < len(_OF_RANGE):
        raise ReportError(
            f"{path}:{table.line}: the range is not complete (found no {', '.join(absent)}; allowed: all of "
            f"{', '.join(_OF_RANGE)}, or none). Add what is missing."
        )
    if len(table.rows) < 2:
        raise ReportError(f"{path}: too few rows (found {len(table.rows)}; allowed: 2 or more). Add the history.")
    rows = [[finite_number(row[name], f"{path}:{line}") for name in table.columns] for line, row in table.rows]
    found = dict(zip(table.columns, np.array(rows).T, strict=True))
    back = np.flatnonzero(np.diff(found["time_s"]) <= 0.0)
    if back.size:
        line, row = table.rows[int(back[0]) + 1]
        before = table.rows[int(back[0])][1]["time_s"]
        raise ReportError(
            f"{path}:{line}: time_s does not rise (found {row['time_s']} after {before}; allowed: more than that). "
            "Sort the rows by time."
        )
    ends = {end: {part: found[f"{part}_{end}_N"] for part in PARTS if not absent} for end in _ENDS}
    for part in PARTS if not absent else ():
        out = np.flatnonzero((found[f"{part}_N"] < ends["low"][part]) | (found[f"{part}_N"] > ends["high"][part]))
        if out.size:
            line, row = table.rows[int(out[0])]
            low, high = (row[f"{part}_{end}_N"] for end in _ENDS)
            raise ReportError(
                f"{path}:{line}: {part}_N is outside its range (found {row[f'{part}_N']}; allowed: {low} to {high}). "
                "Correct one of the three."
            )
    best = {part: found[f"{part}_N"] for part in PARTS}
    return ForceRecord(found["time_s"], best, ends["low"], ends["high"], band, source)


def projected(north: Numbers, east: Numbers, azimuth: float) -> Numbers:
    """Return the component of a horizontal vector in a direction, F_N cos(a) + F_E sin(a).

    The azimuth a [degrees] is clockwise from north.
    """
    angle = np.radians(azimuth)
    return np.asarray(north * np.cos(angle) + east * np.sin(angle))


def projected_ends(low: dict[str, Numbers], high: dict[str, Numbers], azimuth: float) -> tuple[Numbers, Numbers]:
    """Return minimum and maximum of `projected` over all components within their ranges."""
    corners = [projected(north["north"], east["east"], azimuth) for north in (low, high) for east in (low, high)]
    return np.min(corners, axis=0), np.max(corners, axis=0)


def travel_azimuth(record: ForceRecord) -> float:
    """Return the azimuth [degrees, from -180 to 180] of the maximum horizontal momentum of the sliding mass.

    The force on the mass is the reaction: its momentum is p(t) = -int F dt, by the trapezoidal rule.
    """
    steps = np.diff(record.time)
    north, east = (
        -np.concatenate(([0.0], np.cumsum(0.5 * (part[1:] + part[:-1]) * steps)))
        for part in (record.best["north"], record.best["east"])
    )
    largest = int(np.argmax(np.hypot(north, east)))
    return float(np.degrees(np.arctan2(east[largest], north[largest])))


def reversal(time: Numbers, up: Numbers) -> Reversal | None:
    """Return the reversal of a vertical force [N], None if it is not first upward and then downward."""
    top = int(np.argmax(up))
    bottom = top + int(np.argmin(up[top:]))
    if not up[top] > 0.0 > up[bottom]:
        return None
    below = top + int(np.argmax(up[top : bottom + 1] < 0.0))
    zero = np.interp(0.0, up[[below, below - 1]], time[[below, below - 1]])
    return Reversal(_vertex(time, up, top), float(zero), _vertex(time, up, bottom))


def extreme_times(time: Numbers, up: Numbers, along: Numbers) -> dict[str, float]:
    """Return the times [s] of the extremes of a force [N]; nan for those that it does not have.

    `downward`: largest downward value; `upward`: last upward maximum before it; `dip`: lowest minimum between the first
    upward maximum and the last; `along`: maximum magnitude in the direction of travel. Maxima below LEAST_MAXIMUM of
    the largest are those of the filter.
    """
    bottom = int(np.argmin(up))
    inner = np.arange(1, max(bottom, 1))
    is_large = up[inner] > LEAST_MAXIMUM * np.max(np.abs(up))
    tops = inner[is_large & (up[inner] >= up[inner - 1]) & (up[inner] > up[inner + 1])]
    dip = tops[0] + int(np.argmin(up[tops[0] : tops[-1] + 1])) if tops.size > 1 else None
    return {
        "dip": float("nan") if dip is None else _vertex(time, up, dip),
        "upward": _vertex(time, up, int(tops[-1])) if tops.size else float("nan"),
        "downward": _vertex(time, up, bottom),
        "along": _vertex(time, along, int(np.argmax(np.abs(along)))),
    }


def _vertex(time: Numbers, values: Numbers, row: int) -> float:
    """Return the time [s] of the vertex of the parabola through a row and its two evenly spaced neighbours."""
    if not 0 < row < len(time) - 1:
        return float(time[row])
    before, here, after = values[row - 1 : row + 2]
    bend = before - 2.0 * here + after
    return float(time[row] + (0.5 * (before - after) / bend * (time[row + 1] - time[row]) if bend else 0.0))
