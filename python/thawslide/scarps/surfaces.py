"""Failure surfaces, and their height below a DEM.

Plane through (x0, y0, z0) with the dip delta in the direction alpha, clockwise from north:

    z = z0 - tan(delta) [(x - x0) sin(alpha) + (y - y0) cos(alpha)]

The mass between several planes lies above each of them: its failure surface is the highest of the planes.

Ellipsoid with the horizontal half axes a (azimuth alpha) and b, and the vertical depth D below a plane z_p:

    z = z_p - D sqrt(1 - (u/a)^2 - (v/b)^2),   u = (x - x0) sin(alpha) + (y - y0) cos(alpha),
                                               v = (x - x0) cos(alpha) - (y - y0) sin(alpha)

It is half of an ellipsoid that is sheared vertically onto the plane. Its volume below the plane is (2/3) pi a b D.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.number_text import plain_text
from thawslide.scarps.dem_file import Dem, Mask

_STEEPEST = 89.0  # degrees
DEEPEST = 10_000.0  # m, of a release


@dataclass(frozen=True)
class Plane:
    """Plane that passes `depth` [m] below the DEM at the point (x, y), or through the elevation `z` [m].

    dip: angle below the horizontal, 0 to 89 degrees. direction: azimuth in which the plane dips, in degrees clockwise
    from north (of the DEM's grid). x and y are coordinates of the DEM [m].
    """

    x: float
    y: float
    dip: float
    direction: float
    depth: float = 0.0
    z: float | None = None


@dataclass(frozen=True)
class Ellipsoid:
    """Half of an ellipsoid around (x, y), below the mean plane of the DEM in its outline or a given plane.

    half_length, half_width: horizontal half axes [m]. azimuth: direction of the length, in degrees clockwise from
    north. depth: maximum vertical depth below the plane [m]; None if a volume is given. dip, direction: plane through
    the DEM at (x, y), as of `Plane`; by default, the least-squares plane of the DEM in the outline.
    """

    x: float
    y: float
    half_length: float
    half_width: float
    azimuth: float
    depth: float | None = None
    dip: float | None = None
    direction: float | None = None


@dataclass(frozen=True)
class Slbl:
    """Sloping local base level: the parameter C [m], or the maximum depth [m]; neither if a volume is given."""

    tolerance: float | None = None
    max_depth: float | None = None


def check_plane(plane: Plane) -> None:
    """Raise ReportError for a plane with invalid numbers."""
    values = {"x": plane.x, "y": plane.y, "direction": plane.direction, "depth": plane.depth}
    _check_finite("--plane", values | ({} if plane.z is None else {"z": plane.z}))
    _check_dip("--plane", plane.dip)
    if plane.z is not None and plane.depth != 0.0:
        raise ReportError("--plane: depth and z are both specified. Specify one of them.")


def check_ellipsoid(ellipsoid: Ellipsoid) -> None:
    """Raise ReportError for an ellipsoid with invalid numbers."""
    _check_finite("--ellipsoid", {"x": ellipsoid.x, "y": ellipsoid.y, "azimuth": ellipsoid.azimuth})
    for name in ("half_length", "half_width"):
        check_positive(f"--ellipsoid: {name}", getattr(ellipsoid, name), "m")
    if (ellipsoid.dip is None) != (ellipsoid.direction is None):
        raise ReportError("--ellipsoid: only one of dip and direction is specified. Specify both or neither.")
    if ellipsoid.dip is not None and ellipsoid.direction is not None:
        _check_dip("--ellipsoid", ellipsoid.dip)
        _check_finite("--ellipsoid", {"direction": ellipsoid.direction})


def check_positive(subject: str, value: float, unit: str, most: float = math.inf) -> None:
    """Raise ReportError for a number that is not above 0, or that is above `most`."""
    if not (math.isfinite(value) and 0.0 < value <= most):
        limit = f", at most {plain_text(most)}" if math.isfinite(most) else ""
        raise ReportError(f"{subject}: invalid number (found {value:g} {unit}; allowed above 0{limit}). Correct it.")


def _check_finite(subject: str, values: dict[str, float]) -> None:
    for name, value in values.items():
        if not math.isfinite(value):
            raise ReportError(f"{subject}: {name}: not a finite number (found {value}). Correct it.")


def _check_dip(subject: str, dip: float) -> None:
    if not 0.0 <= dip <= _STEEPEST:
        raise ReportError(
            f"{subject}: dip: out of range (found {dip:g}; allowed 0 to {_STEEPEST:g} degrees). Correct it."
        )


def height_above_planes(dem: Dem, planes: Sequence[Plane]) -> Numbers:
    """Return the height of the DEM above the highest of the planes [m], nan without data."""
    highest = np.full(dem.heights.shape, -np.inf)
    for plane in planes:
        level = plane.z if plane.z is not None else dem.height_at(plane.x, plane.y, "--plane") - plane.depth
        np.maximum(highest, level + _slope_of(dem, plane.x, plane.y, plane.dip, plane.direction), out=highest)
    height: Numbers = dem.heights - highest
    return height


def ellipsoid_parts(dem: Dem, ellipsoid: Ellipsoid) -> tuple[Mask, Numbers, Numbers]:
    """Return the cells in the outline, the height of the DEM above the plane [m], and the depth for D = 1 m."""
    x, y = dem.offsets(ellipsoid.x, ellipsoid.y)
    azimuth = math.radians(ellipsoid.azimuth)
    along = x * math.sin(azimuth) + y * math.cos(azimuth)
    across = x * math.cos(azimuth) - y * math.sin(azimuth)
    inside = 1.0 - (along / ellipsoid.half_length) ** 2 - (across / ellipsoid.half_width) ** 2
    cells = inside > 0.0
    dem.require_extent(*_ellipse_extent(ellipsoid), "--ellipsoid")
    dem.require_data(cells, "--ellipsoid")
    if ellipsoid.dip is not None and ellipsoid.direction is not None:
        level = dem.height_at(ellipsoid.x, ellipsoid.y, "--ellipsoid")
        plane = level + _slope_of(dem, ellipsoid.x, ellipsoid.y, ellipsoid.dip, ellipsoid.direction)
    else:
        plane = _fitted_plane(dem, cells, x, y)
    return cells, dem.heights - plane, np.sqrt(np.maximum(inside, 0.0))


def _ellipse_extent(ellipsoid: Ellipsoid) -> tuple[float, float, float, float]:
    azimuth = math.radians(ellipsoid.azimuth)
    a, b = ellipsoid.half_length, ellipsoid.half_width
    half_x = math.hypot(a * math.sin(azimuth), b * math.cos(azimuth))
    half_y = math.hypot(a * math.cos(azimuth), b * math.sin(azimuth))
    return ellipsoid.x - half_x, ellipsoid.y - half_y, ellipsoid.x + half_x, ellipsoid.y + half_y


def _fitted_plane(dem: Dem, cells: Mask, x: Numbers, y: Numbers) -> Numbers:
    count = int(np.count_nonzero(cells))
    columns = np.column_stack([np.broadcast_to(each, cells.shape)[cells] for each in (np.ones(1), x, y)])
    if count < 3 or np.linalg.matrix_rank(columns) < 3:
        cell = plain_text(max(dem.cell_x, dem.cell_y))
        raise ReportError(f"--ellipsoid: too small for the DEM ({count} cells of {cell} m). Enlarge the half axes.")
    level, slope_x, slope_y = np.linalg.lstsq(columns, dem.heights[cells], rcond=None)[0]
    plane: Numbers = level + slope_x * x + slope_y * y
    return plane


def _slope_of(dem: Dem, x0: float, y0: float, dip: float, direction: float) -> Numbers:
    """Return the height of a plane above its height at (x0, y0) [m]."""
    x, y = dem.offsets(x0, y0)
    azimuth = math.radians(direction)
    slope: Numbers = -math.tan(math.radians(dip)) * (x * math.sin(azimuth) + y * math.cos(azimuth))
    return slope
