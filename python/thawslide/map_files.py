"""Rasters and polygons, read and written by the extension module, which checks them as the commands of the program do.

Python opens no raster or vector file of a user by other means.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from thawslide import _core
from thawslide.arrays import Numbers
from thawslide.errors import ReportError


@contextmanager
def errors_of(path: Path) -> Iterator[None]:
    """Turn errors of reading and writing a file into ReportError."""
    if not hasattr(_core, "RasterFile"):
        raise ReportError(f"{path}: this build of thawslide lacks maps. Install libgdal-dev and build again.")
    try:
        yield
    except _core.UserError as error:
        text = _with_options(str(error))
        raise ReportError(text if str(path) in text else f"--crs: {text}") from error


def _with_options(text: str) -> str:
    """Return a message with the option in place of the key of a case."""
    return text.replace("terrain.crs = ", "--crs ").replace("terrain.crs", "--crs")


def _notes(warnings: list[str]) -> list[str]:
    return [text if text.startswith("note: ") else f"warning: {text}" for text in map(_with_options, warnings)]


def read_raster(path: Path, crs: str) -> tuple[_core.Raster, list[str]]:
    """Return a DEM [m], its points from south to north, and notes; `crs` is the value of an option --crs."""
    with errors_of(path):
        raster, warnings = _core.read_dem(str(path), crs)
    return raster, _notes(warnings)


def read_polygons(path: Path, crs: str) -> tuple[list[list[Numbers]], list[str], list[str]]:
    """Return polygons in a coordinate system, each its outline and its holes, their names, and notes.

    A ring has the shape (n, 2). A polygon without the attribute `name` has an empty name.
    """
    with errors_of(path):
        polygons, names, warnings = _core.read_polygons(str(path), crs)
    return [[np.asarray(ring) for ring in rings] for rings in polygons], names, _notes(warnings)


def open_raster(path: Path, quantity: _core.Quantity) -> tuple[_core.RasterFile, list[str]]:
    """Return an open raster of a quantity, and notes."""
    with errors_of(path):
        file = _core.RasterFile(str(path), quantity)
    return file, _notes([file.warning] if file.warning else [])


def write_polygons(
    path: Path,
    layer: str,
    features: Sequence[list[list[Numbers]]],
    attributes: Sequence[dict[str, Any]],
    crs: str,
) -> None:
    """Write a GeoPackage with one feature per list of polygons; each polygon is its outline and its holes [m].

    `attributes` are texts and numbers with equal names in all features.
    """
    rings = [[[np.ascontiguousarray(ring, float) for ring in polygon] for polygon in each] for each in features]
    columns = {name: [values[name] for values in attributes] for name in attributes[0]}
    with errors_of(path):
        _core.write_polygons(str(path), layer, rings, columns, crs)


def write_raster(path: Path, layout: _core.Raster, values: Numbers, unit: str, description: str) -> None:
    """Write values at the points of another raster as a GeoTIFF; rows from the south."""
    with errors_of(path):
        _core.write_raster(str(path), layout, np.ascontiguousarray(values, float), unit, description)
