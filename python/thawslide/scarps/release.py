"""Release between a DEM and a failure surface: thickness, outline and volume."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np
from rasterio.features import shapes

from thawslide.arrays import Numbers
from thawslide.contours import Polygon
from thawslide.errors import ReportError, errors_with_parameters
from thawslide.number_text import plain_text
from thawslide.scarps.dem_file import Dem, Mask, read_dem
from thawslide.scarps.regions import part_with
from thawslide.scarps.search import JumpError, matching_parameter
from thawslide.scarps.slbl import SlblSolver
from thawslide.scarps.surfaces import (
    DEEPEST,
    Ellipsoid,
    Plane,
    Slbl,
    check_ellipsoid,
    check_plane,
    check_positive,
    ellipsoid_parts,
    height_above_planes,
)

LEAST_THICKNESS = 0.001  # m: smaller thicknesses are 0
VOLUME_ACCURACY = 1e-3  # relative

Surface = Plane | Sequence[Plane] | Ellipsoid | Slbl


@dataclass(frozen=True)
class Release:
    """Mass between a DEM and a failure surface, on the cells of the DEM.

    thickness: vertical thickness [m], shape (rows, columns), rows from north to south, 0 outside the release.
    dem: the DEM, with `heights` [m] of the same shape, nan without data. surface: the failure surface, with the
    depth or the parameter C that was found.
    """

    dem: Dem
    thickness: Numbers
    surface: tuple[Plane, ...] | Ellipsoid | Slbl

    @property
    def cells(self) -> Mask:
        """Cells of the release."""
        return self.thickness > 0.0

    @property
    def volume(self) -> float:
        """Volume [m3]: the sum of thickness times area of the cells."""
        return float(self.thickness.sum()) * self.dem.cell_area

    @property
    def area(self) -> float:
        """Horizontal area [m2]."""
        return int(np.count_nonzero(self.cells)) * self.dem.cell_area

    @property
    def mean_thickness(self) -> float:
        """Volume over area [m]."""
        return self.volume / self.area

    @property
    def max_thickness(self) -> float:
        """Maximum vertical thickness [m]."""
        return float(self.thickness.max())

    @property
    def failure_surface(self) -> Numbers:
        """Elevation of the failure surface [m], that of the DEM outside the release."""
        below: Numbers = self.dem.heights - self.thickness
        return below

    @property
    def parts(self) -> int:
        """Number of separate parts; cells that share an edge are joined."""
        return len(self.outline())

    def outline(self) -> list[Polygon]:
        """Return the edges of the cells as polygons: closed rings of shape (n, 2) [m], the outline, then its holes."""
        found = shapes(self.cells.astype(np.uint8), mask=self.cells, connectivity=4, transform=self.dem.transform)
        return [[np.array(ring) for ring in geometry["coordinates"]] for geometry, _ in found]


def scarp(
    dem: str | PathLike[str],
    surface: Surface,
    *,
    within: str | PathLike[str] | None = None,
    volume: float | None = None,
    crs: str | None = None,
) -> Release:
    """Build a release from a failure surface below a DEM, as `thawslide scarp`.

    Parameters
    ----------
    dem : str or path
        GeoTIFF or ESRI ASCII file, in a map projection in metres.
    surface : Plane, sequence of Plane, Ellipsoid or Slbl
        Failure surface; several planes release the mass above all of them.
    within : str or path, optional
        File of polygons (GeoPackage, GeoJSON, Shapefile or KML) that limit the release; an `Slbl` requires it.
        Planes without it release the part that contains the point of the first plane.
    volume : float, optional
        Volume of the release [m3], reached within 0.1 %. It determines the depth of the planes (all are shifted
        equally), the depth of the ellipsoid, or the parameter C of the SLBL.
    crs : str, optional
        Coordinate reference system of the DEM, for example "EPSG:31287", by default that of its file.

    Returns
    -------
    Release
        The release; notes on the files are in its `dem.notes`.

    Raises
    ------
    ReportError
        For invalid numbers or files, an outline outside the DEM or with cells without data, no cell of the DEM above
        the surface, or a volume that cannot be reached.

    Examples
    --------
    >>> valley, plane = "cases/valley3d", Plane(x=401900, y=6502900, dip=25, direction=110)
    >>> release = scarp(f"{valley}/valley.tif", plane, within=f"{valley}/release.geojson", volume=1e6)
    >>> round(release.volume, -4)
    1000000.0

    """
    with errors_with_parameters():
        return release_below(Path(dem), surface, None if within is None else Path(within), volume, crs)


def release_below(dem: Path, surface: Surface, within: Path | None, volume: float | None, crs: str | None) -> Release:
    """Return the release of `scarp`; errors name the options of the command line."""
    terrain = read_dem(dem, crs)
    if volume is not None:
        check_positive("--volume", volume, "m3", DEEPEST * terrain.heights.size * terrain.cell_area)
    inside = None if within is None else terrain.cells_within(within)
    if isinstance(surface, Slbl):
        release = _slbl_release(terrain, surface, inside, volume)
    elif isinstance(surface, Ellipsoid):
        release = _ellipsoid_release(terrain, surface, inside, volume)
    else:
        planes = (surface,) if isinstance(surface, Plane) else tuple(surface)
        release = _plane_release(terrain, planes, inside, volume)
    if not release.cells.any():
        raise ReportError(f"{dem}: no cell of the DEM is above the failure surface. Lower the surface or move it.")
    return release


def _cut(thickness: Numbers, cells: Mask) -> Numbers:
    return np.where(cells & (thickness >= LEAST_THICKNESS), thickness, 0.0)


def _matched(thickness: Callable[[float], Numbers], dem: Dem, volume: float, low: float, step: float) -> float:
    """Return the parameter at which the release has the volume."""
    try:
        return matching_parameter(
            lambda parameter: float(thickness(parameter).sum()) * dem.cell_area, volume, low, step, VOLUME_ACCURACY
        )
    except JumpError as jump:
        if jump.below == 0.0 and np.isfinite(jump.above):
            reason = f"{plain_text(jump.above)} m3 is the minimum"
        elif np.isfinite(jump.above):
            reason = f"at one depth, the volume jumps from {plain_text(jump.below)} m3 to {plain_text(jump.above)} m3"
        else:
            reason = f"{plain_text(jump.below)} m3 is the maximum"
        raise ReportError(
            f"--volume: {plain_text(volume)} m3 cannot be reached ({reason}). Change the volume, the surface or "
            "the outline."
        ) from jump


def _plane_release(dem: Dem, planes: tuple[Plane, ...], inside: Mask | None, volume: float | None) -> Release:
    if not planes:
        raise ReportError("--plane: none is specified. Specify at least one.")
    for plane in planes:
        check_plane(plane)
    height = height_above_planes(dem, planes)
    first = dem.cell_of(planes[0].x, planes[0].y)
    dem.require_extent(planes[0].x, planes[0].y, planes[0].x, planes[0].y, "--plane")
    if inside is None and not np.isfinite(height[first]):
        raise ReportError(
            f"--plane: no data in {dem.path} at x = {planes[0].x:.10g}, y = {planes[0].y:.10g}. Select another point, "
            "or fill the DEM."
        )
    known = np.isfinite(height) if inside is None else inside
    height = np.where(known, height, -np.inf)
    start = float(height.max() if inside is not None else height[first])

    def thickness(shift: float) -> Numbers:
        cut = _cut(height + shift, known)
        return cut if inside is not None else np.where(part_with(cut > 0.0, *first), cut, 0.0)

    shift = 0.0
    if volume is not None:
        shift = _matched(thickness, dem, volume, -start, max(volume / dem.cell_area / known.size, 1.0))
    elif inside is None and start < LEAST_THICKNESS:
        raise ReportError(
            f"--plane: not below the DEM at x = {planes[0].x:.10g}, y = {planes[0].y:.10g}. Increase depth or "
            "lower z, or limit the release by --within."
        )
    release = Release(dem, thickness(shift), tuple(_shifted(plane, shift) for plane in planes))
    if inside is None:
        _require_closed(release)
    return release


def _shifted(plane: Plane, shift: float) -> Plane:
    """Return a plane lowered by a height [m]."""
    return replace(plane, depth=plane.depth + shift) if plane.z is None else replace(plane, z=plane.z - shift)


def _require_closed(release: Release) -> None:
    """Raise ReportError if the release reaches the edge of the DEM or cells without data."""
    padded = np.pad(np.isfinite(release.dem.heights), 1)
    enclosed = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    open_cells = np.argwhere(release.cells & ~enclosed)
    if open_cells.size:
        x, y = release.dem.centre(*map(int, open_cells[0]))
        raise ReportError(
            f"--plane: the release reaches the edge of the DEM or cells without data (at x = {x:.10g}, y = {y:.10g}). "
            "Limit it by --within, or change the plane."
        )


def _ellipsoid_release(dem: Dem, ellipsoid: Ellipsoid, inside: Mask | None, volume: float | None) -> Release:
    check_ellipsoid(ellipsoid)
    cells, height, shape = ellipsoid_parts(dem, ellipsoid)
    if inside is not None:
        cells = cells & inside

    def thickness(depth: float) -> Numbers:
        return _cut(height + depth * shape, cells)

    depth = ellipsoid.depth
    if volume is not None:
        if depth is not None:
            raise ReportError("--ellipsoid: depth and a volume are both specified. Specify one of them.")
        depth = _matched(thickness, dem, volume, 0.0, 1.0)
    elif depth is None:
        raise ReportError("--ellipsoid: neither depth nor a volume is specified. Specify one of them.")
    check_positive("--ellipsoid: depth", depth, "m", DEEPEST)
    return Release(dem, thickness(depth), replace(ellipsoid, depth=depth))


def _slbl_release(dem: Dem, slbl: Slbl, inside: Mask | None, volume: float | None) -> Release:
    if inside is None:
        raise ReportError("--slbl: no outline is specified. Specify --within FILE.")
    given = {"--tolerance": slbl.tolerance, "--max-depth": slbl.max_depth, "--volume": volume}
    stated = [name for name, value in given.items() if value is not None]
    if len(stated) != 1:
        raise ReportError(
            f"--slbl: specify one of --tolerance, --max-depth and --volume (found: {' and '.join(stated) or 'none'})."
        )
    tolerance = slbl.tolerance
    if tolerance is not None and not 0.0 <= tolerance <= DEEPEST:
        raise ReportError(f"--tolerance: invalid number (found {tolerance:g} m; allowed 0 to 10,000). Correct it.")
    _require_border(dem, inside)
    solver = SlblSolver(dem, inside)

    def thickness(parameter: float) -> Numbers:
        return _cut(solver.depth(parameter), inside)

    if volume is not None:
        tolerance = _matched(thickness, dem, volume, 0.0, 0.01)
    elif slbl.max_depth is not None:
        check_positive("--max-depth", slbl.max_depth, "m", DEEPEST)
        tolerance = _matched_depth(thickness, slbl.max_depth)
    assert tolerance is not None
    return Release(dem, thickness(tolerance), Slbl(tolerance=tolerance))


def _matched_depth(thickness: Callable[[float], Numbers], depth: float) -> float:
    try:
        return matching_parameter(lambda parameter: float(thickness(parameter).max()), depth, 0.0, 0.01, 1e-6)
    except JumpError as jump:
        raise ReportError(
            f"--max-depth: {depth:g} m cannot be reached ({jump.above:.3g} m is the minimum). Increase it."
        ) from jump


def _require_border(dem: Dem, inside: Mask) -> None:
    """Raise ReportError if a cell of the outline has a neighbour outside the DEM or without data."""
    padded = np.pad(inside, 1)
    around = padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:]
    at_edge = inside[0].any() or inside[-1].any() or inside[:, 0].any() or inside[:, -1].any()
    if at_edge:
        raise ReportError(f"--slbl: the outline reaches the edge of {dem.path}. Use a larger DEM.")
    dem.require_data(around, "--slbl: next to the outline")
