"""Layers of a GeoPackage as plain arrays: an SQLite file whose geometries are well-known binary.

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
from thawslide.run import Numbers

_ENVELOPE_BYTES = {0: 0, 1: 32, 2: 48, 3: 48, 4: 64}
_POINT, _LINE, _POLYGON, _COLLECTIONS = 1, 2, 3, (4, 5, 6, 7)


@dataclass(frozen=True)
class Feature:
    """One row of a layer: its points, lines or rings, each of shape (n, 2) [m], and its other columns by name."""

    parts: list[Numbers]
    attributes: dict[str, Any]


def read_layer(path: Path, layer: str) -> list[Feature]:
    """Read all features of a layer; NotInRunError without the file or the layer, ReportError when it is damaged."""
    if not path.is_file():
        raise NotInRunError(f"{path}: no such file; only a 3D run on a DEM writes it")
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as database:
            layers = dict(database.execute("SELECT table_name, column_name FROM gpkg_geometry_columns").fetchall())
            if layer not in layers:
                raise NotInRunError(f"{path}: no layer {layer}; there are: {', '.join(layers) or 'none'}")
            quoted = '"' + layer.replace('"', '""') + '"'
            cursor = database.execute(f"SELECT * FROM {quoted}")
            names = [column[0] for column in cursor.description]
            rows = [dict(zip(names, row, strict=True)) for row in cursor.fetchall()]
        return [Feature(geometry_parts(row.pop(layers[layer])), row) for row in rows]
    except (sqlite3.Error, struct.error, ValueError) as error:
        raise ReportError(f"{path}: cannot be read as a GeoPackage ({error}); run the case again") from error


def geometry_parts(blob: bytes | None) -> list[Numbers]:
    """Return the points, lines and rings of a GeoPackage geometry, x and y only; ValueError when it is none."""
    if blob is None:
        return []
    if blob[:2] != b"GP":
        raise ValueError("a geometry does not begin with GP")
    kind = (blob[3] >> 1) & 7
    if kind not in _ENVELOPE_BYTES:
        raise ValueError(f"a geometry has an envelope of unknown kind {kind}")
    parts: list[Numbers] = []
    _read_geometry(blob, 8 + _ENVELOPE_BYTES[kind], parts)
    return parts


def _read_geometry(blob: bytes, at: int, parts: list[Numbers]) -> int:
    """Append the parts of the well-known binary at a place of the blob; return where it ends."""
    order = "<" if blob[at] == 1 else ">"
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
            at = _read_geometry(blob, at, parts)
        else:
            raise ValueError(f"a geometry has the unknown type {code}")
    return at


def _read_points(blob: bytes, at: int, count: int, dimension: int, order: str, parts: list[Numbers]) -> int:
    numbers = np.frombuffer(blob, f"{order}f8", count * dimension, at).reshape(count, dimension)
    parts.append(numbers[:, :2].astype(np.float64))
    return at + 8 * count * dimension
