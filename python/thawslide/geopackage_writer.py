"""Polygons with attributes as a layer of a new GeoPackage (OGC 12-128r18)."""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import rasterio

from thawslide.run_folder import Numbers

_APPLICATION_ID = 0x47504B47  # "GPKG"
_VERSION = 10300
_OWN_SYSTEM = 100000  # number of a coordinate system without an EPSG code
_TABLES = """
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
    organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
    description TEXT DEFAULT '', last_change DATETIME NOT NULL, min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE,
    srs_id INTEGER REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL REFERENCES gpkg_contents(table_name),
    column_name TEXT NOT NULL, geometry_type_name TEXT NOT NULL,
    srs_id INTEGER NOT NULL REFERENCES gpkg_spatial_ref_sys(srs_id), z TINYINT NOT NULL, m TINYINT NOT NULL,
    PRIMARY KEY (table_name, column_name));
INSERT INTO gpkg_spatial_ref_sys VALUES ('Undefined Cartesian', -1, 'NONE', -1, 'undefined', '');
INSERT INTO gpkg_spatial_ref_sys VALUES ('Undefined geographic', 0, 'NONE', 0, 'undefined', '');
"""


def write_polygons(
    path: Path,
    layer: str,
    features: Sequence[list[list[Numbers]]],
    attributes: Sequence[dict[str, Any]],
    crs: rasterio.crs.CRS | None,
) -> None:
    """Write a layer with one feature per list of polygons; each polygon is its outline and its holes [m].

    `attributes` are texts and numbers with equal names in all features. The date of the file is constant, which keeps
    files of equal content identical.
    """
    corners = np.concatenate([ring for polygons in features for rings in polygons for ring in rings])
    (west, south), (east, north) = corners.min(axis=0), corners.max(axis=0)
    with closing(sqlite3.connect(path)) as database:
        database.execute(f"PRAGMA application_id = {_APPLICATION_ID}")
        database.execute(f"PRAGMA user_version = {_VERSION}")
        database.executescript(_TABLES)
        wgs84 = rasterio.crs.CRS.from_epsg(4326)
        _add_system(database, 4326, wgs84)
        system = _number(crs)
        if crs is not None and system != 4326:
            _add_system(database, system, crs)
        names = list(attributes[0])
        types = ["TEXT" if isinstance(attributes[0][name], str) else "DOUBLE" for name in names]
        columns = ", ".join(f'"{name}" {kind}' for name, kind in zip(names, types, strict=True))
        database.execute(
            f'CREATE TABLE "{layer}" (fid INTEGER PRIMARY KEY AUTOINCREMENT, geom MULTIPOLYGON, {columns})'
        )
        database.execute(
            "INSERT INTO gpkg_contents VALUES (?, 'features', ?, '', '1970-01-01T00:00:00.000Z', ?, ?, ?, ?, ?)",
            (layer, layer, west, south, east, north, system),
        )
        database.execute(
            "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', 'MULTIPOLYGON', ?, 0, 0)", (layer, system)
        )
        places = ", ".join("?" for _ in range(len(names) + 1))
        columns = ", ".join(f'"{name}"' for name in ["geom", *names])
        for polygons, values in zip(features, attributes, strict=True):
            row = [_geometry(polygons, system), *(values[name] for name in names)]
            database.execute(f'INSERT INTO "{layer}" ({columns}) VALUES ({places})', row)
        database.commit()


def _number(crs: rasterio.crs.CRS | None) -> int:
    return -1 if crs is None else crs.to_epsg() or _OWN_SYSTEM


def _add_system(database: sqlite3.Connection, number: int, crs: rasterio.crs.CRS) -> None:
    name = str(crs.to_dict(projjson=True).get("name", "unnamed"))
    organization = "NONE" if number == _OWN_SYSTEM else "EPSG"
    row = (name, number, organization, number, crs.to_wkt(version="WKT1_GDAL"), "")
    database.execute("INSERT INTO gpkg_spatial_ref_sys VALUES (?, ?, ?, ?, ?, ?)", row)


def _geometry(polygons: list[list[Numbers]], system: int) -> bytes:
    """Return polygons as a GeoPackage geometry: a header, then well-known binary."""
    parts = [struct.pack("<2sBBi", b"GP", 0, 1, system), struct.pack("<BII", 1, 6, len(polygons))]
    for rings in polygons:
        parts.append(struct.pack("<BII", 1, 3, len(rings)))
        for ring in rings:
            parts += [struct.pack("<I", len(ring)), np.ascontiguousarray(ring, "<f8").tobytes()]
    return b"".join(parts)
