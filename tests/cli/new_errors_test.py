"""Errors about unusable DEMs and releases, and about slides that leave the known terrain."""

from __future__ import annotations

import json
import math
import re
import tomllib
from pathlib import Path

import pytest
import rasterio
from conftest import Program, run_facts, sets
from rasterio.transform import from_origin
from slope_files import (
    CELL,
    COLUMNS,
    DEPTH,
    SOUTH,
    THICKNESS,
    WEST,
    WIDTH,
    Slope,
    assert_refused,
    made,
    without_folder,
    write_release,
    write_thickness,
)


def test_unusable_raster_releases_are_refused(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    folder, dem = tmp_path / "slide", slope()
    raster = write_thickness(tmp_path / "thick.tif", dem, THICKNESS)
    assert_refused(
        made(thawslide, folder, dem, raster, "--thickness", 3),
        tmp_path,
        "--thickness: thick.tif is a raster, whose values are the thickness in metres; leave --thickness out, or give "
        "polygons to --release.",
    )
    assert_refused(
        made(thawslide, folder, dem, write_thickness(raster, dem, 1000.0 * THICKNESS)),
        tmp_path,
        "--release: thick.tif: the release has 288,000,000 m3, is up to 24,000 m thick, and --largest-volume allows "
        "200,000,000 m3. Is the thickness in the wrong unit? Metres are needed. If the volume is right, "
        "confirm it by a "
        "larger --largest-volume.",
    )
    assert_refused(
        made(thawslide, folder, dem, write_thickness(raster, dem, 0.0)),
        tmp_path,
        "--release: thick.tif: the thickness is not above 0 at any point: there is no release.",
    )


def test_a_dem_without_a_reference_system_needs_crs(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    bare, folder = slope("bare.tif", crs=None), tmp_path / "slide"
    assert_refused(
        made(thawslide, folder, bare, release, "--thickness", THICKNESS),
        tmp_path,
        "--dem: bare.tif: the file names no coordinate reference system (x from 411995 to 412895, y from 5159995 to "
        '5160595). Set --crs to the one that the data provider states, such as --crs "EPSG:31287".',
    )
    assert_refused(
        made(thawslide, folder, bare, release, "--thickness", THICKNESS, "--crs", "EPSG:4326"),
        tmp_path,
        '--crs: EPSG:4326 is in degrees; allowed: a map projection in metres, such as "EPSG:31287".',
    )
    given = made(thawslide, folder, bare, release, "--thickness", THICKNESS, "--crs", "EPSG:32632")
    assert given.returncode == 0, given.stderr


def test_a_dem_with_a_wrong_reference_system_needs_crs(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    wrong, folder = slope("wrong.tif", crs="EPSG:4326"), tmp_path / "slide"
    assert_refused(
        made(thawslide, folder, wrong, release, "--thickness", THICKNESS),
        tmp_path,
        "--dem: wrong.tif: the tag specifies degrees (EPSG:4326), but the numbers are metric (x from 411995 to "
        "412895, y from "
        '5159995 to 5160595). Set --crs "EPSG:..." to the system of the coordinates, which the data provider states.',
    )
    given = made(thawslide, folder, wrong, release, "--thickness", THICKNESS, "--crs", "EPSG:32632")
    assert given.returncode == 0, given.stderr
    assert given.stdout.startswith(
        "note: wrong.tif is read as EPSG:32632, as set by --crs; the file specifies EPSG:4326\n"
    )


def test_a_dem_in_degrees_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    degrees = slope("degrees.tif", crs="EPSG:4326")
    with rasterio.open(degrees, "r+") as file:
        file.transform = from_origin(7.9, 46.5, 1e-4, 1e-4)
    assert_refused(
        made(thawslide, tmp_path / "slide", degrees, release, "--thickness", THICKNESS),
        tmp_path,
        "--dem: degrees.tif: the coordinates are degrees (EPSG:4326; x from 7.9 to 7.909, y from 46.494 to 46.5); "
        "allowed: a map projection in metres. Reproject: gdalwarp -t_srs EPSG:32632 -tr 11 11 -r bilinear degrees.tif "
        "degrees-EPSG32632.tif",
    )


def test_an_unreadable_dem_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    """The DEM is truncated in its values, truncated in its header, or absent."""
    dem, folder = slope(), tmp_path / "slide"
    complete = dem.read_bytes()
    for size, begin, end in (
        (
            9000,
            "the values cannot be read; GDAL says: ",
            ". The file seems to be damaged or truncated: copy it again.\n",
        ),
        (
            100,
            "the raster cannot be opened; GDAL says: ",
            ". Allowed: a GeoTIFF or an ESRI ASCII grid; check that the file is complete and readable.\n",
        ),
    ):
        dem.write_bytes(complete[:size])
        outcome = made(thawslide, folder, dem, release, "--thickness", THICKNESS)
        assert outcome.returncode == 2 and not folder.exists()
        text = without_folder(outcome.stderr, tmp_path)
        assert text.startswith(f"error: --dem: dem.tif: {begin}") and text.endswith(end), text
    dem.unlink()
    assert_refused(
        made(thawslide, folder, dem, release, "--thickness", THICKNESS),
        tmp_path,
        "--dem: dem.tif: there is no such file. Correct the path.",
    )


def test_a_missing_thickness_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release),
        tmp_path,
        "--release: release.geojson: there is no attribute 'thickness', which is needed without --thickness; the file "
        "has: name. Correct the name, or add the attribute.",
    )
    nothing = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 0)
    assert nothing.returncode == 2
    assert nothing.stderr.startswith("error: --thickness: 0 found; allowed: above 0. Run with --help")
    unit = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", "20m")
    assert unit.stderr.startswith("error: --thickness: 20m found; allowed: a number above 0, without a unit. Run")


def test_a_thickness_in_millimetres_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    words = ["--thickness", 1000.0 * THICKNESS]
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, *words),
        tmp_path,
        "--release: release.geojson: the release has 288,000,000 m3, is up to 24,000 m thick, and --largest-volume "
        "allows 200,000,000 m3. Is the thickness in the wrong unit? Metres are needed. If the volume is "
        "right, confirm it by a "
        "larger --largest-volume.",
    )


def test_a_release_too_thin_for_its_area_is_refused(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 0.3)
    assert outcome.returncode == 2 and not (tmp_path / "slide").exists()
    assert re.search(
        r"^error: --thickness: a release 0\.3 m thick requires cells of 0\.\d+ m and \S+ particles; allowed without "
        r"--cell: 5,000,000\. Is the thickness in metres\? If it is, set --cell 0\.\d+ or more, which is "
        r"coarser, or use "
        r"a depth-averaged program",
        outcome.stderr,
    ), outcome.stderr


@pytest.mark.parametrize("content", ["", '{"type": "FeatureColl'])
def test_an_unreadable_release_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, content: str) -> None:
    broken, folder = tmp_path / "broken.geojson", tmp_path / "slide"
    broken.write_text(content)
    outcome = made(thawslide, folder, slope(), broken, "--thickness", THICKNESS)
    assert outcome.returncode == 2 and not folder.exists()
    text = without_folder(outcome.stderr, tmp_path)
    assert text.startswith("error: --release: broken.geojson: the file cannot be opened; GDAL says: "), text
    assert text.endswith(
        ". Allowed: Shapefile (with its .shx and .dbf), GeoPackage, GeoJSON or KML; check that the file is complete "
        "and readable.\n"
    ), text
    assert_refused(
        made(thawslide, folder, slope(), tmp_path / "absent.shp", "--thickness", THICKNESS),
        tmp_path,
        "--release: absent.shp: there is no such file. Correct the path.",
    )


def test_a_release_outside_the_dem_is_refused(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    for east, place, found in (
        (5000.0, "outside the DEM, by 4,230 m in the east", "x from 417000 to 417120"),
        (820.0, "partly outside the DEM, by 50 m in the east", "x from 412820 to 412940"),
    ):
        outside = write_release(tmp_path / "outside.geojson", WEST + east, SOUTH)
        assert_refused(
            made(thawslide, tmp_path / "slide", slope(), outside, "--thickness", THICKNESS),
            tmp_path,
            f"--release: outside.geojson: the release lies {place}; found: {found}, y from 5160000 to 5160100; "
            "allowed: x from 412000 to 412890, y from 5160000 to 5160590. Check that both have the same location and "
            "reference system (the DEM has EPSG:32632), or use a larger DEM.",
        )


def test_a_release_without_valid_polygons_is_refused(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    content = json.loads(release.read_text())
    ring = content["features"][0]["geometry"]["coordinates"][0]
    ring[1], ring[2] = ring[2], ring[1]
    release.write_text(json.dumps(content))
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", THICKNESS),
        tmp_path,
        "--release: release.geojson: polygon 1 (slide) crosses itself at or near 412260 5160300. Correct its outline "
        "there (QGIS: Vector > Geometry Tools > Check Validity).",
    )
    content["features"] = []
    release.write_text(json.dumps(content))
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", THICKNESS),
        tmp_path,
        "--release: release.geojson: the layer is empty; needed: polygons. Draw them, or name the file that has them.",
    )


def test_a_release_over_nodata_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(hole=slice(20, 30)), release, "--thickness", THICKNESS),
        tmp_path,
        "--release: release.geojson: the release lies over nodata of the DEM at 100 of its points, such as "
        "412200, 5160250. Fill the holes (gdal_fillnodata.py dem.tif filled.tif), or move the release.",
    )


def test_overlapping_bodies_are_refused_and_adjoining_ones_run(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    """A second body is refused if outlines overlap, and seeded next to the first one if they touch."""
    folder, run = tmp_path / "slide", tmp_path / "run"
    assert made(thawslide, folder, slope(), release, "--thickness", THICKNESS).returncode == 0
    with (folder / "case.toml").open("a") as case:
        case.write('[body.toe]\nmaterial = "rock_ice"\nshape = "release"\nrelease = "toe.geojson"\nthickness = 12.0\n')
    write_release(folder / "toe.geojson", WEST + 310.0, SOUTH + 250.0)
    outcome = thawslide("run", folder, "--output", run, "--set", "time.end=0.01")
    line = 1 + (folder / "case.toml").read_text().splitlines().index('release = "toe.geojson"')
    assert outcome.returncode == 2 and not run.exists()
    assert without_folder(outcome.stderr, tmp_path) == (
        f"error: slide/case.toml:{line}:11: body.toe.release: the bodies 'slide' and 'toe' overlap by 1,000 m2 about "
        "412315, 5160300; allowed: bodies that touch or lie apart, but for slivers up to 12 m2, 0.1 % of the smaller "
        "one. Draw them apart (QGIS: Vector > Geoprocessing Tools > Difference).\n"
    )
    write_release(folder / "toe.geojson", WEST + 320.0, SOUTH + 250.0)
    done = thawslide("run", folder, "--output", run, "--set", "time.end=0.01")
    assert done.returncode == 0, done.stderr
    with rasterio.open(run / "maps" / "release.tif") as file:
        assert file.read(1, masked=True).sum() * CELL**2 == pytest.approx(WIDTH * DEPTH * (THICKNESS + 12.0), rel=1e-9)


def test_an_existing_folder_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    folder = tmp_path / "full"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    assert_refused(
        made(thawslide, folder, slope(), release, "--thickness", THICKNESS),
        tmp_path,
        "full: it exists and is not an empty folder. Choose another name.",
    )


CREATE_AGAIN = (
    r"`thawslide new` crops the DEM to the domain: create the case again with a smaller --reach-angle, which uses "
    r"more of the DEM, or from a larger DEM\."
)
FURTHER = (
    r"With 8 degrees of friction, the reach angle that `thawslide new` assumes, it would go about (\d+) m "
    r"further on level ground, and more where the ground falls\. "
)
# Message about a particle over nodata.
NO_GROUND = (
    r"error: the run failed at t = \S+ s \(step \d+\): particle \d+ of body 'slide' at \((\S+), (\S+), \S+\) m: the "
    r"terrain below it is not known: the DEM ends or has a hole there\. It moves at (\S+) m/s towards the east\. "
    rf"{FURTHER}Give a DEM that reaches further there, and \[grid\] with it, or set grid\.leaving = \"remove\" to "
    rf"remove such particles\. {CREATE_AGAIN}\n"
)
# Message about a particle at the edge of the domain.
LEFT_DOMAIN = (
    r"error: the run failed at t = \S+ s \(step \d+\): particle \d+ of body 'slide' at \((\S+), (\S+), \S+\) m: "
    r"it left the domain\. It moves at (\S+) m/s towards the east, the slide at \S+ m/s on average\. Likely cause: "
    rf"the slide ran further than \[grid\] min and max allow\. {FURTHER}"
)
DEM_ENDS = rf"The DEM ends (\d+) m ahead of it: it has to be larger, and \[grid\] with it\. {CREATE_AGAIN}\n"


def stopping_distance(speed: str) -> float:
    """Return the stopping distance [m] from a speed [m/s] on level ground at 8 degrees, in tens of metres."""
    return 10.0 * math.ceil(float(speed) ** 2 / (2.0 * 9.81 * math.tan(math.radians(8.0))) / 10.0)


@pytest.mark.parametrize("hole", [None, slice(60, 70)])
def test_a_slide_that_leaves_the_known_terrain_fails_the_run(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path, hole: slice | None
) -> None:
    """At the DEM's edge and at a hole, the run exits with 3, reports the position, and keeps the maps."""
    folder, run = tmp_path / "slide", tmp_path / "run"
    assert made(thawslide, folder, slope(hole=hole), release, "--thickness", THICKNESS).returncode == 0
    case = folder / "case.toml"
    case.write_text(case.read_text().replace("temperature = ", "velocity = [80.0, 0.0, 0.0]\ntemperature = ", 1))
    words = sets(basal__friction_angle=1, basal__friction="constant", grid__leaving="stop")
    done = thawslide("run", folder, "--output", run, *words)
    assert done.returncode == 3, done.stderr
    reported = re.fullmatch(NO_GROUND, done.stderr)
    if not hole:
        reported = reported or re.fullmatch(LEFT_DOMAIN + DEM_ENDS, done.stderr)
    assert reported, done.stderr
    east = WEST + CELL * ((hole.start if hole else COLUMNS) - 1)
    assert east - 3.0 * CELL < float(reported[1]) < east + CELL
    assert SOUTH + 200.0 < float(reported[2]) < SOUTH + 400.0
    assert float(reported[3]) > 20.0
    assert float(reported[4]) == pytest.approx(stopping_distance(reported[3]), rel=0.02)  # of a speed with three digits
    assert run_facts(run)["status"] == "failed"
    with rasterio.open(run / "maps" / "max_speed.tif") as file:
        assert file.read(1, masked=True).max() > 40.0


def test_the_distance_beyond_a_steep_dem_is_reported(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    """On 38 degrees the vertical velocity is large: the horizontal distance counts, and the DEM ends there."""
    folder = tmp_path / "slide"
    dem = slope(degrees=38.0, foot=CELL * COLUMNS)
    assert made(thawslide, folder, dem, release, "--thickness", THICKNESS).returncode == 0
    case = folder / "case.toml"
    case.write_text(case.read_text().replace("temperature = ", "velocity = [48.0, 0.0, -36.0]\ntemperature = ", 1))
    words = sets(basal__friction_angle=5, basal__friction="constant", grid__leaving="stop")
    done = thawslide("run", folder, "--output", tmp_path / "run", *words)
    assert done.returncode == 3, done.stderr
    reported = re.fullmatch(LEFT_DOMAIN + DEM_ENDS, done.stderr)
    assert reported, done.stderr
    assert float(reported[3]) > 60.0
    assert float(reported[4]) == pytest.approx(stopping_distance(reported[3]), rel=0.02)
    assert float(reported[5]) == pytest.approx(WEST + CELL * (COLUMNS - 1) - float(reported[1]), abs=2.0)


def test_a_domain_smaller_than_its_dem_is_to_be_widened(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    """If the DEM is large enough, the message names the domain only."""
    folder = tmp_path / "slide"
    assert made(thawslide, folder, slope(), release, "--thickness", THICKNESS).returncode == 0
    grid = tomllib.loads((folder / "case.toml").read_text())["grid"]
    # A cell or two ahead of the release, which ends at 320 m; the DEM of the case extends further.
    grid["max"][0] = grid["min"][0] + math.ceil((WEST + 330.0 - grid["min"][0]) / grid["cell"]) * grid["cell"]
    with rasterio.open(folder / "dem.tif") as file:
        end = file.bounds.right - 0.5 * CELL
    words = sets(basal__friction_angle=5, basal__friction="constant", grid__max=grid["max"], grid__leaving="stop")
    done = thawslide("run", folder, "--output", tmp_path / "run", *words)
    assert done.returncode == 3, done.stderr
    reported = re.fullmatch(LEFT_DOMAIN + r"The DEM ends (\d+) m ahead of it: widen \[grid\] that way\.\n", done.stderr)
    assert reported, done.stderr
    assert float(reported[4]) < float(reported[5]) == pytest.approx(end - float(reported[1]), abs=5.0)
