"""Projections that distort lengths, and vertical reference systems that differ, are noted or refused."""

from pathlib import Path

import odd_files as odd
import pytest
import rasterio
from conftest import Program, sets
from rasterio.warp import transform

NONE, NOTED, REFUSED = "none", "noted", "refused"

# Longitude and latitude of the DEM in each projection, and what becomes of it.
PROJECTIONS = {
    "EPSG:32633": [(15.0, 47.0, NONE), (19.0, 47.0, NONE), (25.0, 10.0, NOTED), (45.0, 47.0, REFUSED)],  # UTM
    "EPSG:3395": [(15.0, 3.0, NONE), (15.0, 12.0, NOTED), (15.0, 47.0, REFUSED)],  # World Mercator
    "EPSG:3857": [(15.0, 47.0, REFUSED)],  # Web Mercator
    "EPSG:3035": [(10.0, 47.0, NONE), (27.0, 64.0, NOTED)],  # Lambert equal area of Europe
    "EPSG:3413": [(-45.0, 69.0, NONE), (-45.0, 61.0, NOTED), (-45.0, 50.0, REFUSED)],  # polar stereographic
    "EPSG:27572": [(6.0, 46.0, NONE)],  # Lambert of France, in grads from Paris
    "EPSG:6933": [(15.0, 30.0, NONE), (15.0, 47.0, REFUSED)],  # equal-area cylinder, with a standard parallel at 30
    "ESRI:54009": [(15.0, 47.0, REFUSED)],  # Mollweide
    "EPSG:4087": [(15.0, 47.0, REFUSED)],  # plate carree
    "EPSG:5070": [(-105.0, 45.5, NONE), (-105.0, 40.0, NOTED), (-105.0, 60.0, REFUSED)],  # Albers of the United States
}


def placed(file: Path, crs: str, longitude: float, latitude: float) -> Path:
    """Write the DEM with its south-west corner at a place."""
    (west,), (south,) = transform("EPSG:4326", crs, [longitude], [latitude])
    corner = rasterio.Affine(odd.CELL, 0.0, west, 0.0, -odd.CELL, south + odd.ROWS * odd.CELL)
    return odd.raster(file, odd.heights(), crs=crs, place=corner)


@pytest.mark.parametrize(
    ("crs", "east", "north", "expected"), [(crs, *each) for crs, places in PROJECTIONS.items() for each in places]
)
def test_projection(thawslide: Program, tmp_path: Path, crs: str, east: float, north: float, expected: str) -> None:
    dem = placed(tmp_path / "dem.tif", crs, east, north)
    with rasterio.open(dem) as file:
        x, y = file.transform.c + 105.0, file.transform.f - 305.0
    line = odd.geojson(tmp_path / "line.geojson", "LineString", [(x, y), (x + 400.0, y)], crs)
    outcome = thawslide("section", tmp_path / "section", "--dem", dem, "--line", line)
    if expected == REFUSED:
        assert outcome.returncode == 2
        assert "lengths in the map projection" in outcome.stderr and "Reproject: gdalwarp -t_srs" in outcome.stderr
        return
    assert outcome.returncode == 0, outcome.stderr
    note = f"note: lengths in the map projection of dem.tif, {crs}, are "
    assert (note in outcome.stdout) == (expected == NOTED), outcome.stdout


@pytest.fixture
def case(thawslide: Program, tmp_path: Path) -> Path:
    """Return a case whose DEM has heights above the geoid of EGM96; `new` keeps this in its copy."""
    dem = odd.raster(tmp_path / "dem.tif", odd.heights(), crs="EPSG:32633+5773")
    release = odd.geojson(tmp_path / "release.geojson", "Polygon", [odd.ring(odd.SQUARE)])
    thawslide.ok("new", tmp_path / "slide", "--dem", dem, "--release", release, "--thickness", odd.THICK)
    return tmp_path / "slide"


SURFACES = {
    "EPSG:32633": "",
    "EPSG:32633+5773": "",
    "EPSG:25833+5773": "",
    "EPSG:32633+7837": "Deutsches Haupthoehennetz 2016",
    "EPSG:32633+5728": "Landesnivellement 1902",
    "EPSG:32633+3855": "EGM2008 geoid",
}


@pytest.mark.parametrize("crs", SURFACES)
def test_surfaces_have_one_vertical_system(thawslide: Program, case: Path, tmp_path: Path, crs: str) -> None:
    before = odd.raster(tmp_path / "before.tif", odd.heights() + odd.THICK, crs=crs)
    words = sets(body__slide__thickness=f'{{ surface = "{before}" }}', terrain__smooth=0)
    if not SURFACES[crs]:
        checked = thawslide.json("check", case, *words)
        assert checked["bodies"][0]["volume_m3"] == pytest.approx(odd.FULL, rel=1e-3)
        return
    message = thawslide.error("check", case, *words)
    assert f"{before}: the elevations refer to '" in message and "those of the DEM to 'EGM96 geoid'" in message


def test_ellipsoidal_heights_differ_from_those_above_a_geoid(thawslide: Program, case: Path, tmp_path: Path) -> None:
    ellipsoidal = rasterio.crs.CRS.from_user_input("+proj=utm +zone=33 +datum=WGS84 +units=m +vunits=m +type=crs")
    before = odd.raster(tmp_path / "before.tif", odd.heights() + odd.THICK)
    with rasterio.open(before, "r+") as file:
        file.crs = ellipsoidal
    words = sets(body__slide__thickness=f'{{ surface = "{before}" }}', terrain__smooth=0)
    outcome = thawslide("check", case, *words)
    assert outcome.returncode == 2, outcome.stdout
