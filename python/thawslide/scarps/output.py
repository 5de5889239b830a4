"""Files of a release: the thickness as GeoTIFF, and the outline as GeoPackage."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from thawslide.errors import ReportError
from thawslide.map_files import write_polygons, write_raster
from thawslide.scarps.release import Release


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
    raster = release.dem.raster
    write_polygons(outline, "release", [release.outline()], [attributes], raster.crs)
    write_raster(path, raster, release.thickness[::-1], "m", "vertical thickness of the release")
