"""Layers of a GeoPackage as arrays: an SQLite file whose geometries are well-known binary.

Formats: OGC 12-128r18 (GeoPackage), clause 2.1.3; OGC 06-103r4 (simple features), clause 8.
"""

from __future__ import annotations

import sqlite3
import struct
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from thawslide.errors import NotInRunError, ReportError
from thawslide.run_folder import Numbers
from thawslide.text_files import is_file

_ENVELOPE_BYTES = {0: 0, 1: 32, 2: 48, 3: 48, 4: 64}
_LONGEST_VALUE = 8 * 1024 * 1024  # bytes of one geometry or text
_INSTRUCTIONS = 10_000  # of the virtual machine of SQLite between two checks of the budget
_MAX_CHECKS = 10_000  # a few seconds
_DEEPEST = 8  # nested collections
_POINT, _LINE, _POLYGON, _COLLECTIONS = 1, 2, 3, (4, 5, 6, 7)


@dataclass(frozen=True)
class Feature:
    """One row of a layer: its points, lines or rings, each of shape (n, 2) [m], and its other columns by name."""

    parts: list[Numbers]
    attributes: dict[str, Any]


def read_layer(path: Path, layer: str) -> list[Feature]:
    """Read all features of a layer; NotInRunError without the file or the layer, ReportError if it is damaged."""
    if not is_file(path):
        raise NotInRunError(f"{path}: no such file. Only a 3D run on a DEM writes it.")
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as database:
            column, rows = _rows(database, path, layer)
        return [Feature(geometry_parts(row.pop(column)), row) for row in rows]
    except (sqlite3.Error, ValueError, KeyError, MemoryError) as error:
        raise ReportError(f"{path}: cannot be read as a GeoPackage ({error}). Repeat the run.") from error


def _rows(database: sqlite3.Connection, path: Path, layer: str) -> tuple[str, list[dict[str, Any]]]:
    """Return the name of the geometry column of a layer, and its rows by column.

    A damaged or foreign file can contain queries in the place of tables, or computed columns, which could run forever.
    """
    database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _LONGEST_VALUE)
    database.execute("PRAGMA trusted_schema = OFF")
    database.set_progress_handler(_Budget(_MAX_CHECKS).spend, _INSTRUCTIONS)
    tables = {name for (name,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()}
    if "gpkg_geometry_columns" not in tables:
        raise ValueError("no table gpkg_geometry_columns")
    layers = dict(database.execute("SELECT table_name, column_name FROM gpkg_geometry_columns").fetchall())
    if layer not in layers:
        raise NotInRunError(f"{path}: no layer {layer} (found: {', '.join(map(str, layers)) or 'none'}).")
    if layer not in tables:
        raise ValueError(f"{layer} is no table")
    quoted = '"' + layer.replace('"', '""') + '"'
    cursor = database.execute(f"SELECT * FROM {quoted}")
    names = [column[0] for column in cursor.description]
    rows, size, limit = [], 0, path.stat().st_size
    for row in cursor:
        rows.append(dict(zip(names, row, strict=True)))
        size += 1 + sum(len(value) for value in row if isinstance(value, bytes | str))
        if size > limit:
            raise ValueError(f"{layer} is larger than the file")
    return str(layers[layer]), rows


class _Budget:
    """Limit of the steps of a query."""

    def __init__(self, calls: int) -> None:
        self.left = calls

    def spend(self) -> bool:
        """Count one check; return whether the budget is exhausted."""
        self.left -= 1
        return self.left < 0


def geometry_parts(blob: Any) -> list[Numbers]:
    """Return the points, lines and rings of a GeoPackage geometry, x and y only; ValueError if it is invalid."""
    if blob is None:
        return []
    if not isinstance(blob, bytes) or blob[:2] != b"GP" or len(blob) < 8:
        raise ValueError("a geometry does not begin with GP")
    kind = (blob[3] >> 1) & 7
    if kind not in _ENVELOPE_BYTES:
        raise ValueError(f"a geometry has an envelope of unknown kind {kind}")
    parts: list[Numbers] = []
    try:
        _read_geometry(blob, 8 + _ENVELOPE_BYTES[kind], parts, _DEEPEST)
    except struct.error as error:
        raise ValueError(f"a geometry ends too early: {error}") from error
    return parts


def _read_geometry(blob: bytes, at: int, parts: list[Numbers], levels: int) -> int:
    """Append the parts of the well-known binary at an offset of the blob; return the offset of its end."""
    if levels == 0:
        raise ValueError(f"a geometry has more than {_DEEPEST} nested collections")
    (first,) = struct.unpack_from("B", blob, at)
    order = "<" if first == 1 else ">"
    (code,) = struct.unpack_from(f"{order}I", blob, at + 1)
    kind, dimension = code % 1000, {0: 2, 1: 3, 2: 3, 3: 4}.get(code // 1000, 0)
    if not dimension:
        raise ValueError(f"a geometry has the unknown type {code}")
    at += 5
    if kind == _POINT:
        return _read_points(blob, at, 1, dimension, order, parts)
    (count,) = struct.unpack_from(f"{order}I", blob, at)
    at += 4
    if kind == _LINE:
        return _read_points(blob, at, count, dimension, order, parts)
    for _ in range(count):
        if kind == _POLYGON:
            (points,) = struct.unpack_from(f"{order}I", blob, at)
            at = _read_points(blob, at + 4, points, dimension, order, parts)
        elif kind in _COLLECTIONS:
            at = _read_geometry(blob, at, parts, levels - 1)
        else:
            raise ValueError(f"a geometry has the unknown type {code}")
    return at


def _read_points(blob: bytes, at: int, count: int, dimension: int, order: str, parts: list[Numbers]) -> int:
    numbers = np.frombuffer(blob, f"{order}f8", count * dimension, at).reshape(count, dimension)
    parts.append(numbers[:, :2].astype(np.float64))
    return at + 8 * count * dimension
