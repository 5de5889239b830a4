"""Outlines of a release: polygons of a GeoPackage, GeoJSON file or Shapefile, as cells of a DEM."""

from __future__ import annotations

import json
import sqlite3
import struct
from contextlib import closing
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from rasterio._err import CPLE_BaseError
from rasterio.crs import CRS
from rasterio.errors import CRSError
from rasterio.features import rasterize
from rasterio.warp import transform

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.geopackage import read_layer
from thawslide.scarps.dem_file import Dem, Mask

Rings = list[Numbers]  # outline and holes of a feature, each of shape (n, 2)
_SHAPES = (5, 15, 25)  # polygons of a Shapefile: plain, with z, with m
_UNREADABLE = (
    OSError, AttributeError, LookupError, RecursionError, TypeError, ValueError, CRSError, sqlite3.Error, struct.error,
)  # fmt: skip
_HEADER = 100  # bytes of a Shapefile


def cells_within(path: Path, dem: Dem) -> Mask:
    """Return the cells of a DEM whose centres are inside the polygons of a file."""
    features, crs = _read(path)
    features = [[ring for ring in rings if len(ring) > 3] for rings in features]
    features = [rings for rings in features if rings]
    if not features:
        raise ReportError(f"{path}: no polygons. Specify a file with the outline of the release.")
    if crs is not None and dem.crs is None:
        raise ReportError(
            f"{dem.path}: no coordinate system, but {path} has {crs.to_string()}. Specify that of the DEM with --crs."
        )
    if crs is not None and crs != dem.crs:
        features = [[_reprojected(ring, crs, dem, path) for ring in rings] for rings in features]
    corners = np.concatenate([ring for rings in features for ring in rings])
    if not np.isfinite(corners).all():
        raise ReportError(f"--within {path}: coordinates that are not finite. Correct the outline.")
    (west, south), (east, north) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    dem.require_extent(west, south, east, north, f"--within {path}")
    shapes = [{"type": "Polygon", "coordinates": [ring.tolist() for ring in rings]} for rings in features]
    inside = rasterize(shapes, out_shape=dem.heights.shape, transform=dem.transform, dtype="uint8") > 0
    if not inside.any():
        raise ReportError(f"--within {path}: no centre of a cell of {dem.path} is inside. Draw a larger outline.")
    dem.require_data(inside, f"--within {path}")
    return np.asarray(inside)


def _reprojected(ring: Numbers, crs: CRS, dem: Dem, path: Path) -> Numbers:
    try:
        return np.column_stack(transform(crs, dem.crs, ring[:, 0], ring[:, 1]))
    except (CRSError, CPLE_BaseError) as error:
        raise ReportError(
            f"--within {path}: cannot be transformed to the coordinate system of {dem.path} ({error}). Correct the "
            "coordinates or their system."
        ) from error


def _read(path: Path) -> tuple[list[Rings], CRS | None]:
    """Return the polygons of a file, and its coordinate system."""
    if not path.is_file():
        raise ReportError(f"{path}: no such file. Correct the path of the outline.")
    readers = {".gpkg": _read_geopackage, ".geojson": _read_geojson, ".json": _read_geojson, ".shp": _read_shapefile}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise ReportError(f"{path}: unknown format (allowed: {', '.join(readers)}). Convert the outline.")
    try:
        return reader(path)
    except _UNREADABLE as error:
        raise ReportError(f"{path}: cannot be read as polygons ({error}). Repair or convert the file.") from error


def _read_geopackage(path: Path) -> tuple[list[Rings], CRS | None]:
    with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True)) as database:
        layers = database.execute(
            "SELECT table_name, geometry_type_name, srs_id FROM gpkg_geometry_columns"
            " WHERE upper(geometry_type_name) IN ('POLYGON', 'MULTIPOLYGON', 'GEOMETRY')"
        ).fetchall()
        if len(layers) != 1:
            raise ReportError(f"{path}: {len(layers)} layers of polygons (allowed: 1). Export the outline separately.")
        layer, _, number = layers[0]
        (definition,) = database.execute(
            "SELECT definition FROM gpkg_spatial_ref_sys WHERE srs_id = ?", (number,)
        ).fetchone()
    crs = CRS.from_wkt(definition) if number > 0 else None
    return [feature.parts for feature in read_layer(path, layer)], crs


def _read_geojson(path: Path) -> tuple[list[Rings], CRS | None]:
    content = json.loads(path.read_text(encoding="utf-8"))
    stated = content.get("crs")
    crs = CRS.from_user_input(stated["properties"]["name"] if stated else "EPSG:4326")
    features = content["features"] if content["type"] == "FeatureCollection" else [content]
    return [_polygon_rings(feature.get("geometry", feature)) for feature in features], crs


def _polygon_rings(geometry: Any) -> Rings:
    kind = (geometry or {}).get("type")
    if kind == "GeometryCollection":
        return [ring for each in geometry["geometries"] for ring in _polygon_rings(each)]
    if kind not in ("Polygon", "MultiPolygon"):
        return []
    polygons = [geometry["coordinates"]] if kind == "Polygon" else geometry["coordinates"]
    return [np.array([(point[0], point[1]) for point in ring], float) for rings in polygons for ring in rings]


def _read_shapefile(path: Path) -> tuple[list[Rings], CRS | None]:
    projection = path.with_suffix(".prj")
    crs = CRS.from_wkt(projection.read_text(encoding="utf-8", errors="replace")) if projection.is_file() else None
    content, at, features = path.read_bytes(), _HEADER, []
    while at < len(content):
        (words,) = struct.unpack_from(">i", content, at + 4)
        (kind,) = struct.unpack_from("<i", content, at + 8)
        if kind in _SHAPES:
            part_count, point_count = struct.unpack_from("<2i", content, at + 44)
            ends = [*struct.unpack_from(f"<{part_count}i", content, at + 52), point_count]
            points = np.frombuffer(content, "<f8", 2 * point_count, at + 52 + 4 * part_count).reshape(-1, 2)
            features.append([points[first:last] for first, last in pairwise(ends)])
        elif kind != 0:
            raise ValueError(f"shape type {kind}")
        at += 8 + 2 * max(words, 2)
    return features, crs
