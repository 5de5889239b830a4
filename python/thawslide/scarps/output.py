"""Files of a release: the thickness as GeoTIFF, and the outline as GeoPackage."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from pathlib import Path

import rasterio

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.geopackage_writer import write_polygons
from thawslide.scarps.release import Release

_TILE = 256  # cells


def outline_file(path: Path) -> Path:
    """Return the file of the outline of a raster."""
    return path.with_suffix(".gpkg")


def require_output(path: Path, picture: Path | None, inputs: Sequence[Path], overwrites: bool) -> None:
    """Raise ReportError if the files of a release cannot be created, or would replace others."""
    if path.suffix.lower() not in (".tif", ".tiff"):
        raise ReportError(f"--output: {path}: unknown format (allowed: .tif). Change the name.")
    files = [("--output", path), ("--output", outline_file(path))]
    if picture is not None:
        if picture.suffix.lower() != ".png":
            raise ReportError(f"--picture: {picture}: unknown format (allowed: .png). Change the name.")
        files.append(("--picture", picture))
    for option, file in files:
        replaced = next((each for each in inputs if each.resolve() == file.resolve()), None)
        if replaced is not None:
            raise ReportError(f"{option}: {file}: would replace the input {replaced}. Change the name.")
        if not file.parent.is_dir():
            raise ReportError(f"{option}: {file}: the folder does not exist. Create it, or change the name.")
        if file.exists() and (not overwrites or file.is_dir()):
            raise ReportError(f"{option}: {file}: exists. Change the name, or specify --overwrite.")


def write_release(release: Release, path: Path) -> None:
    """Write the thickness [m], 0 outside the release, and next to it the outline with its numbers."""
    outline = outline_file(path)
    attributes = {
        "volume_m3": release.volume,
        "area_m2": release.area,
        "mean_thickness_m": release.mean_thickness,
        "max_thickness_m": release.max_thickness,
    }
    dem = release.dem
    rows, columns = dem.heights.shape
    try:
        with atomic_file(path) as raster, atomic_file(outline) as polygons:
            write_polygons(polygons, "release", [release.outline()], [attributes], dem.crs)
            with rasterio.open(
                raster,
                "w",
                driver="GTiff",
                dtype="float64",
                count=1,
                width=columns,
                height=rows,
                transform=dem.transform,
                crs=dem.crs,
                compress="deflate",
                tiled=True,
                blockxsize=_TILE,
                blockysize=_TILE,
            ) as file:
                file.set_band_description(1, "vertical thickness of the release")
                file.set_band_unit(1, "m")
                file.write(release.thickness, 1)
    except (OSError, sqlite3.Error) as error:
        raise ReportError(f"{path}: cannot be written ({error}). Select another --output.") from error
