"""Releases from planes and ellipsoids against closed forms, their files, and matched volumes."""

import math
from pathlib import Path

import numpy as np
import pytest
import rasterio
from rasterio.warp import transform
from scarp_files import NORTH, WEST, centre, rectangle, write_dem, write_outline

import thawslide
from thawslide.arrays import Numbers
from thawslide.geopackage import read_layer
from thawslide.scarps import Ellipsoid, Plane
from thawslide.scarps.command import main
from thawslide.scarps.regions import part_with

X, Y = centre()
STEEP, GENTLE = 40.0, 30.0  # degrees
DIFFERENCE = math.tan(math.radians(STEEP)) - math.tan(math.radians(GENTLE))


def slope(x: Numbers, _y: Numbers) -> Numbers:
    return 2000.0 - math.tan(math.radians(STEEP)) * x


def flat(x: Numbers, _y: Numbers) -> Numbers:
    return 0.0 * x + 1500.0


def test_wedge_between_planes_is_exact_in_cells_of_the_outline(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope)
    within = write_outline(tmp_path / "within.geojson", rectangle((-300.0, 0.0), (-100.0, 100.0)))
    release = thawslide.scarp(dem, Plane(X, Y, GENTLE, 90.0), within=within)
    assert release.volume == pytest.approx(0.5 * DIFFERENCE * 300.0**2 * 200.0, rel=1e-9)
    assert release.area == 300.0 * 200.0
    assert release.max_thickness == pytest.approx(DIFFERENCE * 295.0, rel=1e-9)
    assert release.mean_thickness == pytest.approx(DIFFERENCE * 150.0, rel=1e-9)
    expected = np.where(release.cells, DIFFERENCE * (X - (WEST + 10.0 * (np.arange(100) + 0.5))), 0.0)
    assert release.thickness == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("cell", [25.0, 12.5, 6.25, 3.125])
def test_wedge_that_daylights_within_cells_is_second_order(tmp_path: Path, cell: float) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope, cell)
    within = write_outline(tmp_path / "within.geojson", rectangle((-300.0, 200.0), (-100.0, 100.0)))
    depth = 7.3  # m: the plane meets the slope at x = depth / DIFFERENCE, inside a cell
    release = thawslide.scarp(dem, Plane(X, Y, GENTLE, 90.0, depth=depth), within=within)
    exact = 0.5 * DIFFERENCE * (300.0 + depth / DIFFERENCE) ** 2 * 200.0
    assert abs(release.volume - exact) <= DIFFERENCE * cell**2 / 8.0 * 200.0 * 1.001


def test_mass_above_four_planes_is_a_pyramid_around_the_point(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", flat, 5.0)
    planes = [Plane(X, Y, 45.0, direction, depth=100.0) for direction in (0.0, 90.0, 180.0, 270.0)]
    release = thawslide.scarp(dem, planes)
    assert (release.volume, release.parts) == (pytest.approx(4.0 / 3.0 * 100.0**3, rel=2e-3), 1)
    deeper = thawslide.scarp(dem, planes, volume=2e6)
    assert deeper.volume == pytest.approx(2e6, rel=1e-3) and isinstance(deeper.surface, tuple)
    assert [plane.depth for plane in deeper.surface] == pytest.approx([1.5e6 ** (1.0 / 3.0)] * 4, rel=2e-3)


def test_planes_release_the_part_with_their_point(tmp_path: Path) -> None:
    def hills(x: Numbers, _y: Numbers) -> Numbers:
        return 1500.0 + 50.0 * np.cos(2.0 * np.pi * x / 500.0) * np.cos(np.pi * _y / 1000.0)

    dem = write_dem(tmp_path / "dem.tif", hills)
    one = thawslide.scarp(dem, Plane(X, Y, 0.0, 0.0, z=1510.0))
    columns = np.nonzero(one.cells)[1]
    assert one.parts == 1
    assert WEST + 10.0 * columns.min() > X - 125.0 and WEST + 10.0 * columns.max() < X + 125.0
    within = write_outline(tmp_path / "within.geojson", rectangle((-499.0, 499.0), (-499.0, 499.0)))
    assert thawslide.scarp(dem, Plane(X, Y, 0.0, 0.0, z=1510.0), within=within).parts == 3


def test_part_of_a_spiral_is_found() -> None:
    cells = np.array([[1, 1, 1, 1, 1], [0, 0, 0, 0, 1], [1, 1, 1, 0, 1], [1, 0, 0, 0, 1], [1, 1, 1, 1, 1]], bool)
    assert np.array_equal(part_with(cells, 0, 0), cells)
    cells[4, 2] = False
    assert np.count_nonzero(part_with(cells, 2, 2)) == 6 and not part_with(cells, 1, 1).any()


def ellipsoid_error(path: Path, cell: float, azimuth: float) -> float:
    dem = write_dem(path, slope, cell)
    release = thawslide.scarp(dem, Ellipsoid(X + 1.3, Y - 2.1, 300.0, 150.0, azimuth, depth=60.0))
    exact = 2.0 / 3.0 * math.pi * 300.0 * 150.0 * 60.0
    return abs(release.volume / exact - 1.0)


def test_half_of_an_ellipsoid_converges_with_the_cells(tmp_path: Path) -> None:
    cells = (40.0, 20.0, 10.0, 5.0, 2.5)
    azimuths = (0.0, 20.0, 45.0, 70.0, 90.0, 130.0)
    errors = [np.mean([ellipsoid_error(tmp_path / "dem.tif", cell, each) for each in azimuths]) for cell in cells]
    assert 1.5 < np.polyfit(np.log(cells), np.log(errors), 1)[0] < 2.5
    assert errors[-1] < 2e-4


def test_given_tilt_of_an_ellipsoid_is_that_of_the_slope(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope)
    fitted = thawslide.scarp(dem, Ellipsoid(X, Y, 300.0, 150.0, 90.0, depth=60.0))
    given = thawslide.scarp(dem, Ellipsoid(X, Y, 300.0, 150.0, 90.0, depth=60.0, dip=STEEP, direction=90.0))
    assert given.thickness == pytest.approx(fitted.thickness, abs=1e-8)
    rows, columns = np.nonzero(given.cells)
    assert np.ptp(columns) > 1.8 * np.ptp(rows)  # azimuth 90: the length is east-west
    assert given.max_thickness == pytest.approx(60.0, rel=1e-3)
    deepest = np.unravel_index(np.argmax(given.thickness), given.thickness.shape)
    x, y = given.dem.centre(int(deepest[0]), int(deepest[1]))
    assert given.failure_surface[deepest] == pytest.approx(slope(np.array(x - X), np.array(y - Y)) - 60.0, abs=0.06)


def test_ellipsoids_and_planes_reach_a_volume(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope, 5.0)
    release = thawslide.scarp(dem, Ellipsoid(X, Y, 300.0, 150.0, 10.0), volume=3e6)
    assert release.volume == pytest.approx(3e6, rel=1e-3) and isinstance(release.surface, Ellipsoid)
    assert release.surface.depth == pytest.approx(3e6 / (2.0 / 3.0 * math.pi * 300.0 * 150.0), rel=2e-3)
    dem = write_dem(tmp_path / "dem.tif", slope)
    within = write_outline(tmp_path / "within.geojson", rectangle((-300.0, 0.0), (-100.0, 100.0)))
    exact = 0.5 * DIFFERENCE * 300.0**2 * 200.0
    release = thawslide.scarp(dem, Plane(X, Y, GENTLE, 90.0, depth=55.0), within=within, volume=exact)
    assert release.volume == pytest.approx(exact, rel=1e-3) and isinstance(release.surface, tuple)
    assert release.surface[0].depth == pytest.approx(0.0, abs=0.2)


def test_formats_of_outlines_give_equal_cells(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", flat)
    outline, hole = rectangle((-203.0, 107.0), (-151.0, 149.0)), rectangle((-50.0, 31.0), (-20.0, 40.0))
    surface = Plane(X, Y, 0.0, 0.0, depth=20.0)
    projected = thawslide.scarp(dem, surface, within=write_outline(tmp_path / "a.geojson", outline, hole))
    assert projected.area == 310.0 * 300.0 - 80.0 * 60.0
    degrees = [
        [list(point) for point in zip(*transform("EPSG:32608", "EPSG:4326", *zip(*ring, strict=True)), strict=True)]
        for ring in (outline, hole)
    ]
    other = write_outline(tmp_path / "b.geojson", *degrees, crs=None)
    assert main([str(dem), f"--plane=x={X},y={Y},dip=0,direction=0,depth=20", "--within", str(other),
                 "--output", str(tmp_path / "d.tif")]) == 0  # fmt: skip
    for within in (other, tmp_path / "d.gpkg"):
        assert np.array_equal(thawslide.scarp(dem, surface, within=within).thickness, projected.thickness), within


def test_command_writes_raster_outline_and_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope)
    raster, figure = tmp_path / "out.tif", tmp_path / "out.png"
    surface = f"x={X},y={Y},half_length=300,half_width=150,azimuth=0,depth=60"
    words = [str(dem), "--ellipsoid", surface, "--output", str(raster), "--picture", str(figure)]
    assert main(words) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[0] == "release: 5,660,000 m3, area 142,000 m2, mean thickness 39.9 m, maximum 60 m"
    assert printed[1] == "surface: ellipsoid, depth 60 m"
    assert printed[-1] == f"To continue: thawslide new FOLDER --dem {dem} --release {raster} --cut"
    with rasterio.open(raster) as file, rasterio.open(dem) as source:
        assert (file.crs, file.transform, file.shape) == (source.crs, source.transform, source.shape)
        assert file.units == ("m",)
        thickness = file.read(1)
    release = thawslide.scarp(dem, Ellipsoid(X, Y, 300.0, 150.0, 0.0, depth=60.0))
    assert np.array_equal(thickness, release.thickness)
    (feature,) = read_layer(tmp_path / "out.gpkg", "release")
    assert (feature.attributes["volume_m3"], feature.attributes["area_m2"]) == (release.volume, release.area)
    assert feature.attributes["mean_thickness_m"] == release.mean_thickness
    assert feature.attributes["max_thickness_m"] == release.max_thickness
    (ring,) = feature.parts
    x, y = (ring - [WEST, NORTH]).T
    assert abs(0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) == pytest.approx(release.area)
    assert figure.stat().st_size > 10_000
    assert main([*words, "--overwrite"]) == 0


def test_large_release_is_confirmed_in_the_printed_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    dem = write_dem(tmp_path / "a dem.tif", slope, 100.0, 10_000.0, crs=None)
    x, y = centre(10_000.0)
    surface = f"x={x},y={y},half_length=2000,half_width=1000,azimuth=0"
    raster = tmp_path / "out.tif"
    words = [str(dem), "--ellipsoid", surface, "--volume", "3e8", "--output", str(raster), "--crs", "EPSG:32608"]
    assert main(words) == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.endswith("--crs EPSG:32608 --largest-volume 303000000") and "'" in last
