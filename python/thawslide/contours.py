"""Areas in which a map of a run exceeds a threshold, as polygons of a GeoPackage or GeoJSON file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import cast

import numpy as np
from contourpy import FillType, contour_generator
from rasterio.warp import transform_geom

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError, nearest, quoted
from thawslide.map_files import write_polygons
from thawslide.maps import Map, Maps, read_map
from thawslide.number_text import exact_text
from thawslide.run_folder import Numbers, Run

Polygon = list[Numbers]  # closed rings of shape (n, 2) [m]: the outline, then its holes

# In these maps, no data does not mean 0: the sliding mass never reached the cell.
_WITHOUT_ZERO = ("arrival_time", "max_basal_temperature", "terrain", "ground")
_DEGREES = 8  # decimals, about 1 mm


@dataclass(frozen=True)
class Area:
    """Area in which a map is above a threshold, or below it."""

    threshold: float  # in the unit of the map
    polygons: list[Polygon]

    @property
    def size(self) -> float:
        """Horizontal area [m2]."""
        return sum(abs(_signed_area(rings[0])) - sum(map(abs, map(_signed_area, rings[1:]))) for rings in self.polygons)


def areas_beyond(field: Map, thresholds: Sequence[float], below: bool = False, zero: bool = True) -> list[Area]:
    """Return the area beyond each threshold; the map is linear between the centres of its cells.

    With `zero`, cells without data and the surroundings of the map are 0; otherwise they belong to no area.
    """
    grid = field.grid
    x = grid.x0 + grid.cell_x * np.arange(-1, grid.columns + 1)
    y = grid.y0 + grid.cell_y * np.arange(-1, grid.rows + 1)
    values = np.pad(field.values, 1, constant_values=np.nan)
    values = np.nan_to_num(values) if zero else np.ma.masked_invalid(values)
    generator = contour_generator(x, y, values, fill_type=FillType.OuterOffset)
    found = []
    for threshold in thresholds:
        filled = generator.filled(-np.inf, threshold) if below else generator.filled(threshold, np.inf)
        corners, offsets = cast(tuple[list[Numbers], list[Numbers]], filled)  # of this fill type
        polygons = [
            [np.asarray(points[first:last]) for first, last in pairwise(ends)]
            for points, ends in zip(corners, offsets, strict=True)
        ]
        found.append(Area(threshold, polygons))
    return found


def write_contours(run: Run, name: str, thresholds: Sequence[float], below: bool, output: Path | None) -> Path:
    """Write the areas of a map of a run, one feature per threshold, and return the file.

    The default file is contours-NAME.gpkg in the run folder. A name that ends with .geojson selects GeoJSON.
    """
    maps = Maps(run)
    if name not in maps:
        raise ReportError(f"--map: no map {quoted(name)}{nearest(name, maps.names)} Allowed: {', '.join(maps.names)}.")
    path = output or run.folder / f"contours-{name}.gpkg"
    if path.suffix.lower() not in (".gpkg", ".geojson"):
        raise ReportError(f"--output: {path}: unknown format (allowed: .gpkg, .geojson). Change the name.")
    zero = name not in _WITHOUT_ZERO
    if zero and any(threshold >= 0.0 if below else threshold <= 0.0 for threshold in thresholds):
        raise ReportError(
            f"--threshold: the area would include all ground that the sliding mass never reached, where {name} is 0. "
            + ("Use negative thresholds with --below." if below else "Use thresholds above 0, or --below.")
        )
    source = maps.folder / f"{name}.tif"
    field = read_map(source)
    areas = [area for area in areas_beyond(field, thresholds, below, zero) if area.polygons]
    if not areas:
        texts = ", ".join(exact_text(threshold) for threshold in thresholds)
        raise ReportError(
            f"{source}: no value {'below' if below else 'above'} {texts} {field.unit}. Change --threshold."
        )
    attributes = [
        {
            "map": name,
            "side": "below" if below else "above",
            "threshold": area.threshold,
            "unit": field.unit,
            "area_m2": area.size,
            "run": run.folder.resolve().name,
            "description": field.description,
        }
        for area in areas
    ]
    try:
        polygons = [area.polygons for area in areas]
        if path.suffix.lower() == ".gpkg":
            write_polygons(path, f"{name}_contours", polygons, attributes, field.wkt)
            return path
        with atomic_file(path) as temporary:
            temporary.write_text(_geojson(polygons, attributes, field.wkt, source), encoding="utf-8")
    except OSError as error:
        raise ReportError(f"{path}: cannot be written ({error.strerror or error}). Select another --output.") from error
    return path


def _geojson(
    polygons: list[list[Polygon]],
    attributes: list[dict[str, str | float]],
    crs: str,
    source: Path,
) -> str:
    """Return GeoJSON, whose coordinates are longitude and latitude (RFC 7946)."""
    if not crs:
        raise ReportError(
            f"{source}: no coordinate system, which GeoJSON requires. Use an --output that ends with .gpkg."
        )
    features = []
    for parts, values in zip(polygons, attributes, strict=True):
        coordinates = [[ring.tolist() for ring in rings] for rings in parts]
        geometry = {"type": "MultiPolygon", "coordinates": coordinates}
        geometry = transform_geom(crs, "EPSG:4326", geometry, precision=_DEGREES)
        features.append({"type": "Feature", "properties": values, "geometry": geometry})
    return json.dumps({"type": "FeatureCollection", "features": features})


def _signed_area(ring: Numbers) -> float:
    x, y = (ring - ring[0]).T
    return float(0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
