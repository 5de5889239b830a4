"""Command `thawslide scarp`: a release from a plane, an ellipsoid or a sloping local base level below a DEM."""

from __future__ import annotations

import argparse
import shlex
import sys
from collections.abc import Sequence
from dataclasses import MISSING, fields
from pathlib import Path

from thawslide.commands import print_line
from thawslide.errors import ReportError, nearest, quoted
from thawslide.number_text import plain_text
from thawslide.scarps.output import outline_file, require_output, write_release
from thawslide.scarps.picture import write_picture
from thawslide.scarps.release import Release, Surface, release_below
from thawslide.scarps.surfaces import Ellipsoid, Plane, Slbl

_LARGE = 200e6  # m3: the usual body.NAME.largest_volume


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code: 0 for success, 2 for an error of the user."""
    given = _parser().parse_args(arguments)
    try:
        inputs = [given.dem, *([given.within] if given.within else [])]
        require_output(given.output, given.picture, inputs, given.overwrite)
        release = release_below(given.dem, _surface(given), given.within, given.volume, given.crs)
        write_release(release, given.output)
        if given.picture:
            write_picture(release, given.picture)
    except ReportError as error:
        print_line(f"thawslide scarp: error: {error}", sys.stderr)
        return 2
    for note in release.dem.notes:
        print_line(f"thawslide scarp: {note}", sys.stderr)
    for line in _lines(release, given):
        print_line(line)
    if release.parts > 1:
        warning = f"the release has {release.parts} separate parts. To select one, limit the release by --within."
        print_line(f"thawslide scarp: warning: {warning}", sys.stderr)
    return 0


def _surface(given: argparse.Namespace) -> Surface:
    if sum((bool(given.plane), bool(given.ellipsoid), given.slbl)) != 1:
        raise ReportError("failure surface: specify one of --plane, --ellipsoid and --slbl.")
    if not given.slbl and (given.tolerance is not None or given.max_depth is not None):
        raise ReportError("--tolerance and --max-depth: allowed with --slbl only. Omit them.")
    if given.plane:
        return [Plane(**_values("--plane", text, Plane)) for text in given.plane]
    if given.ellipsoid:
        if len(given.ellipsoid) > 1:
            raise ReportError("--ellipsoid: specified more than once. Specify one.")
        return Ellipsoid(**_values("--ellipsoid", given.ellipsoid[0], Ellipsoid))
    return Slbl(given.tolerance, given.max_depth)


def _values(option: str, text: str, kind: type[Plane] | type[Ellipsoid]) -> dict[str, float]:
    """Read NAME=NUMBER,... of a surface."""
    names = [each.name for each in fields(kind)]
    found: dict[str, float] = {}
    for part in text.split(","):
        name, equals, number = (each.strip() for each in part.partition("="))
        if not equals or name not in names:
            allowed = f"allowed: {', '.join(names)}"
            raise ReportError(f"{option}: no key {quoted(name)} ({allowed}){nearest(name, names)} Use KEY=NUMBER.")
        if name in found:
            raise ReportError(f"{option}: {name}: specified twice. Omit one.")
        try:
            found[name] = float(number)
        except ValueError as error:
            raise ReportError(f"{option}: {name}: not a number (found {quoted(number)}). Correct it.") from error
    absent = [each.name for each in fields(kind) if each.default is MISSING and each.name not in found]
    if absent:
        raise ReportError(f"{option}: missing: {', '.join(absent)}. Specify {'them' if len(absent) > 1 else 'it'}.")
    return found


def _lines(release: Release, given: argparse.Namespace) -> list[str]:
    lines = [
        f"release: {plain_text(release.volume)} m3, area {plain_text(release.area)} m2, "
        f"mean thickness {plain_text(release.mean_thickness)} m, maximum {plain_text(release.max_thickness)} m",
        f"surface: {_surface_text(release)}",
        f"thickness: {given.output}",
        f"outline: {outline_file(given.output)}",
    ]
    command = ["thawslide", "new", "FOLDER", "--dem", str(given.dem), "--release", str(given.output), "--cut"]
    command += ["--crs", given.crs] if given.crs else []
    command += ["--largest-volume", f"{release.volume * 1.01:.0f}"] if release.volume > _LARGE else []
    lines += [f"picture: {given.picture}"] if given.picture else []
    return [*lines, f"To continue: {shlex.join(command)}"]


def _surface_text(release: Release) -> str:
    surface = release.surface
    if isinstance(surface, Slbl):
        return f"SLBL, C = {plain_text(surface.tolerance or 0.0, 4)} m"
    if isinstance(surface, Ellipsoid):
        return f"ellipsoid, depth {plain_text(surface.depth or 0.0, 4)} m"
    levels = [f"z = {plane.z:.2f} m" if plane.z is not None else f"depth {plane.depth:.2f} m" for plane in surface]
    given = "plane, {} at the given point" if len(levels) == 1 else "planes, {} at the given points"
    return given.format(", ".join(levels))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide scarp",
        description="Build a release from a failure surface below a DEM: planes, an ellipsoid, or a sloping local base "
        "level.",
    )
    add = parser.add_argument
    add("dem", metavar="DEM", type=Path, help="DEM in a map projection in metres: GeoTIFF or ESRI ASCII grid")
    add(
        "--plane",
        metavar="KEY=NUMBER,...",
        action="append",
        help="plane: x, y, dip, direction, and depth (below the DEM at x, y; default: 0) or z (may be repeated: the "
        "release is above all planes)",
    )
    add(
        "--ellipsoid",
        metavar="KEY=NUMBER,...",
        action="append",
        help="ellipsoid: x, y, half_length, half_width, azimuth, depth; dip and direction (default: mean "
        "plane of the DEM)",
    )
    add("--slbl", action="store_true", help="sloping local base level; requires --within")
    add("--tolerance", metavar="C", type=float, help="parameter C of the SLBL [m]")
    add("--max-depth", metavar="M", type=float, help="maximum depth of the SLBL, in place of C [m]")
    add(
        "--within",
        metavar="FILE",
        type=Path,
        help="polygons that limit the release: GeoPackage, GeoJSON, Shapefile or KML (default: planes release the part "
        "that contains the point of the first plane)",
    )
    add(
        "--volume",
        metavar="M3",
        type=float,
        help="volume of the release, which determines the depth of the planes or of the ellipsoid, or C [m3]",
    )
    add(
        "--crs",
        metavar="CRS",
        help="coordinate reference system of the DEM, such as EPSG:31287 (default: its own)",
    )
    add(
        "--output",
        metavar="FILE",
        type=Path,
        default=Path("scarp.tif"),
        help="raster of the thickness; the outline is in FILE with the suffix .gpkg (default: scarp.tif)",
    )
    add("--overwrite", action="store_true", help="replace existing files")
    add("--picture", metavar="FILE", type=Path, help="plot a map and a cross section of the release to a PNG file")
    return parser


if __name__ == "__main__":
    sys.exit(main())
