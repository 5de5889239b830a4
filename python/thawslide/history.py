"""Tables of a run: history.csv, probes.csv and the table of a rigid block as columns by name, and terrain.csv."""

from __future__ import annotations

import difflib
import math
from array import array
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError, ReportError, quoted
from thawslide.text_files import finite_number, number, read_table

if TYPE_CHECKING:
    import pandas as pd

_MOST_BYTES = 4 * 1024**3
_LONGEST_LINE = 1024 * 1024  # bytes
_RESUME = "Repeat the rows after the last checkpoint with `thawslide resume`."
_NO_HISTORY = "Select the folder of a run."


class History(Mapping[str, Numbers]):
    """The columns of history.csv or probes.csv by name, each of shape (rows,), in the unit its name ends with."""

    def __init__(self, file: str, columns: dict[str, Numbers]) -> None:
        self.file = file
        self._columns = columns
        self.rows = len(columns["time_s"])

    def __getitem__(self, name: str) -> Numbers:
        if name not in self._columns:
            near = difflib.get_close_matches(name, self._columns, 1)
            hint = f" (nearest: {near[0]})" if near else ""
            raise NotInRunError(f"{self.file}: no column {name}{hint}.")
        return self._columns[name]

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"History({self.file!r}, {self.rows} rows, {len(self)} columns)"

    def to_pandas(self) -> pd.DataFrame:
        """Return the columns as a pandas.DataFrame with one row per time."""
        import pandas as pd  # at first use: the report starts faster without it

        return pd.DataFrame(self._columns)


def read_history(path: Path, warnings: list[str]) -> History:
    """Read a time series; incomplete rows at the end, after a kill or a power failure, are skipped with a warning.

    ReportError for any other row that is not of numbers at a later time than the previous row.
    """
    try:
        if not path.is_file():
            raise ReportError(f"{path}: {'not a file' if path.exists() else 'no such file'}. {_NO_HISTORY}")
        if path.stat().st_size > _MOST_BYTES:
            raise ReportError(
                f"{path}: too large (allowed 4 GB). Set a longer time.history_interval and repeat the run."
            )
        with path.open("rb") as file:
            names = _header(file, path)
            values = _values(file, names, path, warnings)
    except OSError as error:
        raise ReportError(
            f"{path}: cannot be read ({error.strerror or error}). Check the permissions of the file."
        ) from error
    if not values:
        raise ReportError(f"{path}: no rows after the header. Wait for the first row of the run.")
    table = np.array(values, dtype=np.float64).reshape(-1, len(names))
    return History(path.name, {name: table[:, place].copy() for place, name in enumerate(names)})


def read_terrain(path: Path) -> tuple[Numbers, Numbers]:
    """Return distance and elevation [m] of a terrain; ReportError if it is damaged."""
    rows = read_table(path, ("distance_m", "terrain_elevation_m")).rows
    if not rows:
        raise ReportError(f"{path}: no rows after the header. Repeat the run.")
    distance, height = (
        np.array([finite_number(row[name], f"{path}:{line}") for line, row in rows])
        for name in ("distance_m", "terrain_elevation_m")
    )
    back = np.flatnonzero(np.diff(distance) <= 0.0)
    if back.size:
        raise ReportError(f"{path}:{rows[int(back[0]) + 1][0]}: distance_m does not increase. Repeat the run.")
    return distance, height


def _header(file: BinaryIO, path: Path) -> list[str]:
    line = file.readline(_LONGEST_LINE)
    if not line.endswith(b"\n"):  # a row is one write: without its end it is incomplete
        raise ReportError(f"{path}: empty. Wait for the first row of the run.")
    try:
        names = line.decode("ascii").rstrip("\r\n").split(",")
    except UnicodeDecodeError as error:
        raise ReportError(f"{path}:1: column names are not ASCII. {_NO_HISTORY}") from error
    if "time_s" not in names:
        raise ReportError(f"{path}:1: no column time_s. {_NO_HISTORY}")
    if len(set(names)) < len(names):
        twice = next(name for place, name in enumerate(names) if name in names[:place])
        raise ReportError(f"{path}:1: duplicate column {quoted(twice)}. {_NO_HISTORY}")
    return names


def _values(file: BinaryIO, names: list[str], path: Path, warnings: list[str]) -> array[float]:
    """Return all numbers, row after row."""
    values = array("d")
    time_at, before, place = names.index("time_s"), -math.inf, 1
    while line := file.readline(_LONGEST_LINE):
        place += 1
        where = f"{path}:{place}"
        if not line.endswith(b"\n") and len(line) < _LONGEST_LINE:
            warnings.append(f"{path}: the last row is incomplete and is ignored")
            break
        if b"\0" in line:
            warnings.append(
                f"{where}: zero bytes, for example after a power failure; this row and all later rows are ignored"
            )
            break
        row = _row(line, len(names), where)
        if not math.isfinite(row[time_at]) or row[time_at] <= before:
            raise ReportError(f"{where}: time_s does not increase (found {row[time_at]:g} after {before:g}). {_RESUME}")
        before = row[time_at]
        values.extend(row)
    return values


def _row(line: bytes, columns: int, where: str) -> list[float]:
    cells = line.rstrip(b"\r\n").split(b",")
    if len(cells) != columns:
        raise ReportError(f"{where}: damaged row (found {len(cells)} values for {columns} columns). {_RESUME}")
    if b"_" not in line:
        try:
            return [float(cell) for cell in cells]
        except ValueError:
            pass  # the slower conversion below identifies the cell
    return [number(cell.decode("ascii", "backslashreplace"), where) for cell in cells]
