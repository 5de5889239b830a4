"""The three terrains of the comparison with AvaFrame: DEMs and releases, each written into a folder."""

from __future__ import annotations

import json
import math
import shutil
import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import rasterio
from rasterio.transform import from_origin

from thawslide.errors import ReportError

CASES = Path(__file__).resolve().parent / "cases"
CRS = "EPSG:31287"  # of the alr DEM, also used for the two synthetic terrains
WEST, SOUTH = 400_000.0, 400_000.0  # lower left corner of the synthetic DEMs [m], arbitrary
POINT = 5.0  # spacing of the points of the DEMs [m]
THICKNESS = 10.0  # of the releases, along the normal [m]


@dataclass(frozen=True)
class Variant:
    """A run that differs in single settings, to isolate a cause."""

    name: str  # name of its folder
    words: str
    changes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Ground:
    """Input of the two programs, and its description on the page."""

    name: str
    title: str
    text: str
    friction_angle: float  # along the ground [degrees]
    is_straight: bool  # whether the centre of the slide moves due east
    avaframe: tuple[Variant, ...] = ()  # in addition to the run with AvaFrame's defaults
    thawslide: tuple[Variant, ...] = ()  # in addition to the run of the case file


INVISCID = Variant("avaframe-inviscid", "no artificial viscosity", ("viscOption=0",))
NO_PRESSURE = Variant("avaframe-no-pressure", "no pressure gradient", ("sphOption=0",))
WIDE = Variant("thawslide-wide", "filter of 10 m", ("terrain.smooth=10",))
ROUGH = Variant("thawslide-rough", "no filter", ("terrain.smooth=0",))

PLANE = Ground(
    "plane",
    "A plane that runs out on the flat",
    "A slope of 30 degrees, rounded by a parabola over 300 m, then level ground; 200 m x 200 m of release on it.",
    20.0,
    is_straight=True,
    avaframe=(INVISCID,),
)
BOWL = Ground(
    "bowl",
    "A bowl",
    "A paraboloid, z = r2/2000 m; 150 m x 150 m of release where it is 600 m from the middle, a slope of 31 degrees.",
    15.0,
    is_straight=True,
    avaframe=(INVISCID, NO_PRESSURE),
)
ALR = Ground(
    "alr",
    "A slope of the Alps",
    "A DEM of 5 m and a mapped release polygon of a snow avalanche, from the test data of AvaFrame (data: Land Tirol, "
    "data.tirol.gv.at). The 10 m of rock and ice instead of the snow are an assumption.",
    25.0,
    is_straight=False,
    thawslide=(WIDE, ROUGH),
)
GROUNDS = {ground.name: ground for ground in (PLANE, BOWL, ALR)}


def plane_profile(x: np.ndarray) -> np.ndarray:
    """Return the elevation [m] of the plane that runs out, over the distance [m] from its upper edge."""
    slope, foot, half = math.tan(math.radians(30.0)), 1_000.0, 150.0
    bend = np.clip(x - (foot - half), 0.0, 2.0 * half)
    rounded = slope * half - slope * bend + slope * bend**2 / (4.0 * half)
    return np.where(x < foot - half, slope * (foot - x), rounded)


def write_dem(file: Path, elevation: np.ndarray, corner: tuple[float, float] = (WEST, SOUTH)) -> None:
    """Write elevations [m], rows from south to north, as a GeoTIFF; `corner` is the lower left one."""
    rows, columns = elevation.shape
    place = from_origin(corner[0], corner[1] + POINT * rows, POINT, POINT)
    options = {"driver": "GTiff", "count": 1, "dtype": "float64", "crs": CRS, "transform": place, "nodata": -9999.0}
    with rasterio.open(file, "w", width=columns, height=rows, **options) as raster:
        raster.write(elevation[::-1], 1)


def write_release(folder: Path, corners: list[list[float]]) -> None:
    """Write the outline [m] for AvaFrame (release.json) and for Thawslide (release.geojson)."""
    (folder / "release.json").write_text(json.dumps({"corners": corners, "thickness": THICKNESS}))
    feature = {
        "type": "Feature",
        "properties": {"name": "slide", "thickness": THICKNESS},
        "geometry": {"type": "Polygon", "coordinates": [corners]},
    }
    crs = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{CRS.split(':')[1]}"}}
    collection = {"type": "FeatureCollection", "crs": crs, "features": [feature]}
    (folder / "release.geojson").write_text(json.dumps(collection))


def rectangle(x: float, y: float, long: float, wide: float) -> list[list[float]]:
    """Return the closed corners of a rectangle around a point [m]."""
    signs = [(-1, -1), (-1, 1), (1, 1), (1, -1), (-1, -1)]
    return [[WEST + x + a * long / 2.0, SOUTH + y + b * wide / 2.0] for a, b in signs]


def first_polygon(shapefile: Path) -> list[list[float]]:
    """Return the first ring of the first polygon of a shapefile [m] (ESRI 1998, Shapefile Technical Description)."""
    content = shapefile.read_bytes()[108:]
    kind, _, _, _, _, parts, points = struct.unpack_from("<i4d2i", content)
    if kind % 10 != 5:
        raise ReportError(f"{shapefile}: its first shape is of kind {kind}; a polygon is required")
    starts = struct.unpack_from(f"<{parts}i", content, 44)
    end = starts[1] if parts > 1 else points
    return np.frombuffer(content, dtype="<f8", count=2 * end, offset=44 + 4 * parts).reshape(-1, 2).tolist()


def write_plane(folder: Path) -> None:
    """Write the plane that runs out: 2,600 m x 1,000 m."""
    x = POINT * (np.arange(520) + 0.5)
    write_dem(folder / "dem.tif", np.tile(plane_profile(x), (200, 1)))
    write_release(folder, rectangle(300.0, 500.0, 200.0, 200.0))


def write_bowl(folder: Path) -> None:
    """Write the bowl: 1,800 m x 1,800 m."""
    across = POINT * (np.arange(360) + 0.5) - 900.0
    write_dem(folder / "dem.tif", (across[:, None] ** 2 + across[None, :] ** 2) / 2_000.0)
    write_release(folder, rectangle(300.0, 900.0, 150.0, 150.0))


def write_case(ground: Ground, case: str, runs: Path, alr: Path) -> None:
    """Write a terrain and its case file into a folder below `runs`."""
    folder = runs / ground.name
    if not (folder / "dem.tif").exists():
        write_ground(ground, folder, alr)
    for name in ("common.toml", f"{case}.toml"):
        shutil.copy(CASES / name, folder / name)


def write_ground(ground: Ground, folder: Path, alr: Path) -> None:
    """Write dem.tif and both releases of a terrain into a folder; `alr` is the folder of alr.tif and release.shp."""
    folder.mkdir(parents=True, exist_ok=True)
    if ground is PLANE:
        write_plane(folder)
    elif ground is BOWL:
        write_bowl(folder)
    else:
        shutil.copyfile(alr / "alr.tif", folder / "dem.tif")
        write_release(folder, first_polygon(alr / "release.shp"))
