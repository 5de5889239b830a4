"""Releases from planes, ellipsoids and sloping local base levels: closed forms, files, volumes, and refusals."""

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
from thawslide.scarps import Ellipsoid, Plane, Slbl
from thawslide.scarps.command import main
from thawslide.scarps.regions import part_with

X, Y = centre()
STEEP, GENTLE = 40.0, 30.0  # degrees
DIFFERENCE = math.tan(math.radians(STEEP)) - math.tan(math.radians(GENTLE))
WEDGE = 0.5 * DIFFERENCE * 300.0**2 * 200.0  # m3


def slope(x: Numbers, _y: Numbers) -> Numbers:
    return 2000.0 - math.tan(math.radians(STEEP)) * x


def flat(x: Numbers, _y: Numbers) -> Numbers:
    return 0.0 * x + 1500.0


def test_wedge_between_planes_is_exact_in_cells_of_the_outline(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope)
    within = write_outline(tmp_path / "within.geojson", rectangle((-300.0, 0.0), (-100.0, 100.0)))
    release = thawslide.scarp(dem, Plane(X, Y, GENTLE, 90.0), within=within)
    assert (release.volume, release.area) == (pytest.approx(WEDGE, rel=1e-9), 300.0 * 200.0)
    found = (release.max_thickness, release.mean_thickness)
    assert found == pytest.approx((DIFFERENCE * 295.0, DIFFERENCE * 150.0), rel=1e-9)
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
    assert one.parts == 1 and (abs(WEST + 10.0 * np.nonzero(one.cells)[1] - X) < 125.0).all()
    within = write_outline(tmp_path / "within.geojson", rectangle((-499.0, 499.0), (-499.0, 499.0)))
    assert thawslide.scarp(dem, Plane(X, Y, 0.0, 0.0, z=1510.0), within=within).parts == 3
    cells = np.array([[1, 1, 1, 1, 1], [0, 0, 0, 0, 1], [1, 1, 1, 0, 1], [1, 0, 0, 0, 1], [1, 1, 1, 1, 1]], bool)
    assert np.array_equal(part_with(cells, 0, 0), cells)
    cells[4, 2] = False
    assert np.count_nonzero(part_with(cells, 2, 2)) == 6 and not part_with(cells, 1, 1).any()


def test_half_of_an_ellipsoid_converges_with_the_cells(tmp_path: Path) -> None:
    cells, errors = (40.0, 20.0, 10.0, 5.0, 2.5), []
    surfaces = [
        Ellipsoid(X + 1.3, Y - 2.1, 300.0, 150.0, each, depth=60.0) for each in (0.0, 20.0, 45.0, 70.0, 90.0, 130.0)
    ]
    for cell in cells:
        dem = write_dem(tmp_path / "dem.tif", slope, cell)
        volumes = np.array([thawslide.scarp(dem, surface).volume for surface in surfaces])
        errors.append(np.mean(abs(volumes / (2.0 / 3.0 * math.pi * 300.0 * 150.0 * 60.0) - 1.0)))
    assert 1.5 < np.polyfit(np.log(cells), np.log(errors), 1)[0] < 2.5 and errors[-1] < 2e-4


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
    release = thawslide.scarp(dem, Plane(X, Y, GENTLE, 90.0, depth=55.0), within=within, volume=WEDGE)
    assert release.volume == pytest.approx(WEDGE, rel=1e-3) and isinstance(release.surface, tuple)
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
    words = [f"--plane=x={X},y={Y},dip=0,direction=0,depth=20", f"--within={other}", f"--output={tmp_path / 'd.tif'}"]
    assert main([str(dem), *words]) == 0
    for within in (other, tmp_path / "d.gpkg"):
        assert np.array_equal(thawslide.scarp(dem, surface, within=within).thickness, projected.thickness), within


def test_command_writes_raster_outline_and_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    dem = write_dem(tmp_path / "dem.tif", slope)
    raster, figure = tmp_path / "out.tif", tmp_path / "out.png"
    surface = f"x={X},y={Y},half_length=300,half_width=150,azimuth=0,depth=60"
    words = [str(dem), "--ellipsoid", surface, "--output", str(raster), "--picture", str(figure)]
    assert main(words) == 0
    numbers, words_of_surface, *_, last = capsys.readouterr().out.splitlines()
    assert numbers == "release: 5,660,000 m3, area 142,000 m2, mean thickness 39.9 m, maximum 60 m"
    assert words_of_surface == "surface: ellipsoid, depth 60 m"
    assert last == f"To continue: thawslide new FOLDER --dem {dem} --release {raster} --cut"
    with rasterio.open(raster) as file, rasterio.open(dem) as source:
        assert (file.crs, file.transform, file.shape) == (source.crs, source.transform, source.shape)
        assert file.units == ("m",)
        thickness = file.read(1)
    release = thawslide.scarp(dem, Ellipsoid(X, Y, 300.0, 150.0, 0.0, depth=60.0))
    assert np.array_equal(thickness, release.thickness)
    (feature,) = read_layer(tmp_path / "out.gpkg", "release")
    for name in ("volume_m3", "area_m2", "mean_thickness_m", "max_thickness_m"):
        assert feature.attributes[name] == getattr(release, name.rpartition("_")[0])
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


SIZE = 2200.0  # m, of the DEMs; cells of 10 m


def tilted(x: Numbers, y: Numbers) -> Numbers:
    """Return a plane, which has no effect on the depth."""
    return 2000.0 - 0.7 * x + 0.3 * y


def rough(x: Numbers, y: Numbers) -> Numbers:
    noise = np.random.default_rng(5).normal(size=x.shape)
    return 2000.0 - 0.7 * x + 20.0 * np.sin(x / 25.0) * np.cos(y / 30.0) + noise


def depth_in(tmp_path: Path, columns: int, rows: int, surface: Slbl, **dem: object) -> Numbers:
    """Return the depth in an outline of so many cells, shape (rows, columns)."""
    shape = dem.pop("shape", tilted)
    cell_y = float(dem.get("cell_y") or 10.0)  # type: ignore[arg-type]
    path = write_dem(tmp_path / "dem.tif", shape, 10.0, SIZE, **dem)  # type: ignore[arg-type]
    corner = rectangle((0.0, 10.0 * columns), (0.0, cell_y * rows), SIZE)
    release = thawslide.scarp(path, surface, within=write_outline(tmp_path / "within.geojson", corner))
    top, left = round(SIZE / 2 / cell_y) - rows, round(SIZE / 20)
    depth: Numbers = release.thickness[top : top + rows, left : left + columns]
    assert release.volume == pytest.approx(depth.sum() * 10.0 * cell_y)
    return depth


def test_rows_of_cells_long_strips_and_gullies_have_closed_forms(tmp_path: Path) -> None:
    # 4 d_i - d_(i-1) - d_(i+1) = 4 C, with d = 0 at the ends, has the solution
    # d_i = 2 C [1 - cosh(k (i - n/2)) / cosh(k n/2)], cosh k = 2.
    depth = depth_in(tmp_path, 19, 1, Slbl(tolerance=1.5))
    k, i = np.arccosh(2.0), np.arange(1, 20)
    assert depth[0] == pytest.approx(3.0 * (1.0 - np.cosh(k * (i - 10.0)) / np.cosh(k * 10.0)), abs=1e-6)
    # 4 C = -(d_(i-1) - 2 d_i + d_(i+1)): d_i = 2 C i (n - i), far from the ends of the strip
    depth, i = depth_in(tmp_path, 9, 101, Slbl(tolerance=0.2)), np.arange(1, 10)
    assert depth[50] == pytest.approx(0.4 * i * (10.0 - i), rel=1e-6)
    # The neighbours along x have the weight 20^2 / (2 (10^2 + 20^2)) = 0.4 each.
    depth = depth_in(tmp_path, 9, 51, Slbl(tolerance=0.2), cell_y=20.0)
    assert depth[25] == pytest.approx(0.2 / (2.0 * 0.4) * i * (10.0 - i), rel=1e-6)
    # The mean of the neighbours in z = x^2 / 1000 m is 100 m2 / (2 x 1000 m) = 0.05 m above z.
    plane = depth_in(tmp_path, 20, 15, Slbl(tolerance=0.15))
    gully = depth_in(tmp_path, 20, 15, Slbl(tolerance=0.2), shape=lambda x, y: tilted(x, y) + x**2 / 1000.0)
    assert gully == pytest.approx(plane, abs=1e-6)


def test_rectangle_has_the_depth_of_the_sine_series(tmp_path: Path) -> None:
    rows, columns, tolerance = 12, 17, 0.8
    depth = depth_in(tmp_path, columns, rows, Slbl(tolerance=tolerance))
    modes = [np.sin(np.pi * np.outer(np.arange(1, n + 1), np.arange(1, n + 1)) / (n + 1)) for n in (rows, columns)]
    across, along = (np.cos(np.pi * np.arange(1, n + 1) / (n + 1)) for n in (rows, columns))
    source = modes[0] @ np.full((rows, columns), tolerance) @ modes[1] * 4.0 / ((rows + 1) * (columns + 1))
    exact = modes[0] @ (source / (1.0 - 0.5 * (across[:, None] + along[None, :]))) @ modes[1]
    assert depth == pytest.approx(exact, abs=1e-6)


@pytest.mark.parametrize("tolerance", [0.0, 0.3, 3.0])
def test_rough_slope_has_the_depth_of_the_published_iteration(tmp_path: Path, tolerance: float) -> None:
    depth = depth_in(tmp_path, 14, 11, Slbl(tolerance=tolerance), shape=rough)
    x, y = np.meshgrid(10.0 * (np.arange(220) + 0.5) - 1100.0, 1100.0 - 10.0 * (np.arange(220) + 0.5))
    heights = rough(x, y)[110 - 12 : 110 + 1, 110 - 1 : 110 + 15]
    lowered = heights.copy()
    for _ in range(3000):
        mean = 0.25 * (lowered[1:-1, :-2] + lowered[1:-1, 2:] + lowered[:-2, 1:-1] + lowered[2:, 1:-1])
        lowered[1:-1, 1:-1] = np.minimum(lowered[1:-1, 1:-1], mean - tolerance)
    expected = (heights - lowered)[1:-1, 1:-1]
    assert depth == pytest.approx(np.where(expected >= 0.001, expected, 0.0), abs=2e-6)
    assert tolerance > 1.0 or (depth == 0.0).any()


def test_maximum_depth_and_volume_are_reached(tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", rough, 10.0, SIZE)
    within = write_outline(tmp_path / "within.geojson", rectangle((-250.0, 250.0), (-150.0, 150.0), SIZE))
    deep = thawslide.scarp(dem, Slbl(max_depth=60.0), within=within)
    assert deep.max_thickness == pytest.approx(60.0, rel=1e-6)
    large = thawslide.scarp(dem, Slbl(), within=within, volume=4e6)
    assert large.volume == pytest.approx(4e6, rel=1e-3) and isinstance(large.surface, Slbl)
    again = thawslide.scarp(dem, Slbl(tolerance=large.surface.tolerance), within=within)
    assert again.thickness == pytest.approx(large.thickness, abs=1e-5)


AT = f"x={X},y={Y}"
PLANE = f"--plane {AT},dip=30,direction=90"
ELLIPSOID = f"--ellipsoid {AT},half_length=300,half_width=150,azimuth=0"
WITHIN = "--slbl --within"
SLBL = f"dem.tif {WITHIN} in.geojson"
INSIDE = rectangle((-200.0, 200.0), (-100.0, 100.0))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_dem(tmp_path / "dem.tif", slope)
    write_dem(tmp_path / "flat.tif", flat)
    write_dem(tmp_path / "hole.tif", slope, no_data=(50, 52))
    write_dem(tmp_path / "kelvin.tif", slope, unit="K")
    write_dem(tmp_path / "degrees.tif", slope, crs="EPSG:4326")
    write_dem(tmp_path / "nowhere.tif", slope, crs=None)
    (tmp_path / "text.tif").write_text("no raster")
    write_outline(tmp_path / "in.geojson", INSIDE)
    write_outline(tmp_path / "out.geojson", rectangle((300.0, 600.0), (0.0, 100.0)))
    write_outline(tmp_path / "edge.geojson", rectangle((300.0, 500.0), (0.0, 100.0)))
    write_outline(tmp_path / "tiny.geojson", rectangle((1.0, 2.0), (1.0, 2.0)))
    write_outline(tmp_path / "empty.geojson", [])
    (tmp_path / "text.geojson").write_text("[")
    (tmp_path / "line.shp").write_bytes(bytes(200))
    (tmp_path / "outline.kml").write_text("<kml/>")
    return tmp_path


# Arguments, and the beginning of the message.
REFUSED = f"""
dem.tif -> failure surface: specify one of --plane, --ellipsoid and --slbl.
dem.tif --slbl {PLANE} -> failure surface: specify one of
dem.tif {PLANE} --tolerance 1 -> --tolerance and --max-depth: allowed with --slbl only.
dem.tif --plane x=1,y=2 -> --plane: missing: dip, direction. Specify them.
dem.tif --plane x=1,y=2,dipp=3 -> --plane: no key 'dipp' (allowed: x, y, dip, direction, depth, z); did you mean
dem.tif --plane x=1,y=two -> --plane: y: not a number (found 'two'). Correct it.
dem.tif --plane x=1,x=2 -> --plane: x: specified twice. Omit one.
dem.tif {PLANE},depth=nan -> --plane: depth: not a finite number (found nan).
dem.tif --plane {AT},dip=90,direction=0 -> --plane: dip: out of range (found 90; allowed 0 to 89 degrees).
dem.tif {PLANE},depth=10,z=1000 -> --plane: depth and z are both specified.
dem.tif {PLANE} -> --plane: not below the DEM at x = 400500, y = 6503500. Increase depth or
dem.tif {PLANE},depth=10 -> --plane: the release reaches the edge of the DEM or cells without data
hole.tif {PLANE},depth=10 -> --plane: the release reaches the edge
dem.tif --plane x=1,y=2,dip=30,direction=0,depth=1 -> --plane: outside the DEM dem.tif (found x = 1, y = 2; allowed
dem.tif {PLANE},z=9000 --within in.geojson -> dem.tif: no cell of the DEM is above the failure surface.
dem.tif {ELLIPSOID} -> --ellipsoid: neither depth nor a volume is specified.
dem.tif {ELLIPSOID},depth=10 --volume 1e6 -> --ellipsoid: depth and a volume are both specified.
dem.tif {ELLIPSOID},depth=-5 -> --ellipsoid: depth: invalid number (found -5 m; allowed above 0, at most 10,000).
dem.tif {ELLIPSOID},depth=5,dip=3 -> --ellipsoid: only one of dip and direction is specified.
hole.tif {ELLIPSOID},depth=5 -> --ellipsoid: cells without data in hole.tif (found 1; the first at x = 400525
dem.tif --ellipsoid {AT},half_length=900,half_width=9,azimuth=0,depth=5 -> \
--ellipsoid: outside the DEM dem.tif (found x = 400491 to 400509, y = 6502600 to 6504400; allowed
dem.tif --ellipsoid {AT},half_length=5,half_width=5,azimuth=0,depth=5 -> \
--ellipsoid: too small for the DEM (0 cells of 10 m). Enlarge the half axes.
dem.tif {ELLIPSOID} --volume 0 -> --volume: invalid number (found 0 m3; allowed above 0, at most 10,000,000,000).
{SLBL} --volume 1e300 -> --volume: invalid number (found 1e+300 m3; allowed
dem.tif --slbl --tolerance 1 -> --slbl: no outline is specified. Specify --within FILE.
{SLBL} -> --slbl: specify one of --tolerance, --max-depth and --volume (found: none).
{SLBL} --tolerance -1 -> --tolerance: invalid number (found -1 m; allowed 0 to 10,000).
{SLBL} --max-depth 0 -> --max-depth: invalid number (found 0 m; allowed above 0, at most 10,000).
flat.tif {WITHIN} in.geojson --tolerance 0 -> flat.tif: no cell of the DEM is above the failure surface.
dem.tif {WITHIN} edge.geojson --tolerance 1 -> --slbl: the outline reaches the edge of dem.tif.
dem.tif {WITHIN} out.geojson --tolerance 1 -> --within out.geojson: outside the DEM dem.tif (found x = 400800
hole.tif {WITHIN} in.geojson --tolerance 1 -> --within in.geojson: cells without data in hole.tif (found 1;
dem.tif {WITHIN} tiny.geojson --tolerance 1 -> --within tiny.geojson: no centre of a cell of dem.tif is inside.
dem.tif {WITHIN} empty.geojson --tolerance 1 -> empty.geojson: polygon 1 has no geometry; needed: polygons.
dem.tif {WITHIN} text.geojson --tolerance 1 -> text.geojson: the file cannot be opened
dem.tif {WITHIN} line.shp --tolerance 1 -> line.shp: the index of the Shapefile, line.shx, is missing.
dem.tif {WITHIN} outline.kml --tolerance 1 -> outline.kml: the layer is empty; needed: polygons.
dem.tif {WITHIN} absent.gpkg --tolerance 1 -> absent.gpkg: there is no such file.
absent.tif {PLANE} -> absent.tif: there is no such file. Correct the path.
text.tif {PLANE} -> text.tif: the raster cannot be opened
in.geojson {PLANE} -> in.geojson: the file has polygons, lines or points; needed: a raster
dem.tif {WITHIN} hole.tif --tolerance 1 -> hole.tif: the file is a raster; needed: polygons
kelvin.tif {PLANE} -> kelvin.tif: the unit of the values is 'K'; allowed: a unit of length
degrees.tif {PLANE} -> degrees.tif: the tag specifies degrees (EPSG:4326), but the numbers are metric
nowhere.tif {PLANE} --crs EPSG:0 -> --crs: 'EPSG:0' is not a known coordinate reference system;
nowhere.tif {PLANE} -> nowhere.tif: the file names no coordinate reference system (x from 400000 to 401000, y
dem.tif {PLANE} --output a.asc -> --output: a.asc: unknown format (allowed: .tif). Change the name.
dem.tif {PLANE} --output dem.tif --overwrite -> --output: dem.tif: would replace the input dem.tif.
dem.tif {PLANE} --output flat.tif -> --output: flat.tif: exists. Change the name, or specify --overwrite.
dem.tif {PLANE} --output no/a.tif -> --output: no/a.tif: the folder does not exist.
dem.tif {ELLIPSOID},depth=5 --picture a.pdf -> --picture: a.pdf: unknown format (allowed: .png). Change the name.
""".strip().splitlines()


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    words, message = case.split(" -> ")
    monkeypatch.chdir(folder)
    before = {path: path.read_bytes() for path in folder.iterdir()}
    assert main(words.split()) == 2
    printed = capsys.readouterr()
    assert printed.err.startswith(f"thawslide scarp: error: {message}"), printed.err
    assert printed.err.endswith((".\n", ".shp\n", ".tif\n")) and printed.out == ""  # a sentence or a command
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


def test_volumes_that_join_parts_or_are_below_that_of_bumps_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def terraces(x: object, _y: object) -> object:
        return 1000.0 + 100.0 * ((x > -200.0) & (x < 200.0) & (abs(_y) < 300.0)) - 50.0 * (abs(x) < 20.0)  # type: ignore

    dem = write_dem(tmp_path / "dem.tif", terraces)  # type: ignore[arg-type]
    surface = f"x={X - 100.0},y={Y},dip=0,direction=0"
    assert main([str(dem), "--plane", surface, "--volume", "6e6", "--output", str(tmp_path / "a.tif")]) == 2
    message = capsys.readouterr().err
    assert "--volume: 6,000,000 m3 cannot be reached (at one depth, the volume jumps from" in message
    dem = write_dem(tmp_path / "dem.tif", lambda x, y: slope(x, y) - (x**2 + y**2) / 1000.0)
    within = write_outline(tmp_path / "in.geojson", INSIDE)
    words = [str(dem), "--slbl", "--within", str(within), "--output", str(tmp_path / "a.tif")]
    for limit, remedy in ("--volume=1000", "Change the volume"), ("--max-depth=0.01", "Increase it."):
        assert main([*words, limit]) == 2
        assert f"is the minimum). {remedy}" in capsys.readouterr().err
