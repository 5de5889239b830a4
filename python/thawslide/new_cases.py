"""New cases from a DEM and a release area, by the program `thawslide`."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from os import PathLike, fspath

from thawslide import _core
from thawslide.case import Case
from thawslide.errors import with_parameters
from thawslide.program import find_program
from thawslide.simulation import print_message

__all__ = ["new_case"]


def new_case(
    dem: str | PathLike[str],
    release: str | PathLike[str],
    folder: str | PathLike[str],
    *,
    thickness: float | None = None,
    cut: bool = False,
    crs: str | None = None,
    reach_angle: float | None = None,
    cell: float | None = None,
    resolution: str | None = None,
    largest_volume: float | None = None,
    glacier: str | PathLike[str] | None = None,
    snow: str | PathLike[str] | None = None,
    valley_floor: str | PathLike[str] | None = None,
    on_message: Callable[[str], None] = print_message,
) -> Case:
    """Create a case folder from a DEM and a release area, as `thawslide new`.

    Parameters
    ----------
    dem : str or path
        GeoTIFF or ESRI ASCII file, in projected metres.
    release : str or path
        Polygons (Shapefile, GeoPackage, GeoJSON), or a raster of the thickness.
    folder : str or path
        The folder to create.
    thickness : float, optional
        Vertical thickness of the polygons [m], by default their attribute `thickness`.
    cut : bool
        Cut the release out of the DEM, which is then the surface before the slide; by default, the release is put
        on top of the DEM.
    crs : str, optional
        Coordinate reference system of a DEM whose file has none, for example "EPSG:31287".
    reach_angle : float, optional
        The domain includes all terrain below a line that descends at this angle from the top of the release, 1 to
        45 degrees, by default 8.
    cell : float, optional
        Size of the grid cells [m], by default that of `resolution`.
    resolution : str, optional
        "quick", "standard" or "fine".
    largest_volume : float, optional
        Confirms a release above the usual limit of `body.slide.largest_volume` [m3].
    glacier, snow, valley_floor : str or path, optional
        Polygons of this ground on the path, which become substrates with assumed friction coefficients.
    on_message : callable
        Receives the lines of the command.

    Returns
    -------
    Case
        The case in the folder.

    Raises
    ------
    UserError
        For invalid numbers or files, and a folder that exists.

    Examples
    --------
    >>> valley = "cases/valley3d"
    >>> case = new_case(f"{valley}/valley.tif", f"{valley}/release.geojson", "my-slide", on_message=lambda line: None)
    >>> case.dimension
    3

    """
    options = {
        "--thickness": thickness,
        "--crs": crs,
        "--reach-angle": reach_angle,
        "--cell": cell,
        "--resolution": resolution,
        "--largest-volume": largest_volume,
        "--glacier": glacier,
        "--snow": snow,
        "--valley-floor": valley_floor,
    }
    program = find_program()
    if program is None:
        raise _core.UserError("the program thawslide is not found. Install the package again, or add it to PATH.")
    command = [program, "new", f"--dem={fspath(dem)}", f"--release={fspath(release)}"]
    command += [f"{option}={value}" for option, value in options.items() if value is not None]
    command += ["--cut"] if cut else []
    done = subprocess.run([*command, "--", fspath(folder)], capture_output=True, text=True)
    if done.returncode != 0:
        error = done.stderr.strip().removeprefix("error: ").removesuffix(" Run with --help for more information.")
        raise _core.UserError(with_parameters(error))
    for line in (*done.stderr.splitlines(), *done.stdout.splitlines()):
        on_message(with_parameters(line))
    return Case(folder)
