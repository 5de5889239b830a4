"""Errors about unusable DEMs and releases, and about slides that leave the known terrain."""

import math
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import rasterio
from conftest import Program, Slope, edit, run_facts, sets
from terrain_files import CELL, COLUMNS, SOUTH, THICKNESS, WEST, write_rectangle, write_thickness


def raster(slope: Slope, thickness: float) -> Path:
    return write_thickness(slope.folder / "thick.tif", slope(), thickness)


def rectangle(slope: Slope, name: str, east: float, north: float, *size: float) -> Path:
    return write_rectangle(slope.folder / f"{name}.geojson", WEST + east, SOUTH + north, *size)


TOO_LARGE = """--release: {}: the release has 288,000,000 m3, is up to 24,000 m thick, and --largest-volume allows
    200,000,000 m3. {} If the volume is right, confirm it by a larger --largest-volume.\n""".format
IN_ANOTHER_UNIT = "Is the thickness in the wrong unit? Metres are needed."
A_DEM = "Is this raster a DEM, swapped with the raster of the thickness? It needs the thickness."
SWAPPED = """--dem: release.geojson is not a raster, and dem.tif is one: the DEM and the release are swapped. Give
    --dem dem.tif --release release.geojson.\n"""
MERCATOR = """{} lengths in the map projection EPSG:3857 are 1.34 to 1.35, by direction, times those on the ground at
    the corner 411995, 5160595; allowed: a projection that preserves lengths to within 5 %. Reproject: gdalwarp -t_srs
    EPSG:32631 -tr 7.4 7.4 -r bilinear dem.tif dem-EPSG32631.tif\n"""
RASTER = """--thickness: thick.tif is a raster, whose values are the thickness in metres; leave --thickness out, or give
    polygons to --release.\n"""
NO_CRS = """--dem: bare.tif: the file names no coordinate reference system (x from 411995 to 412895, y from 5159995 to
    5160595). Set --crs to the one that the data provider states, such as --crs "EPSG:31287".\n"""
EDGE = """--release: edge.geojson: the release reaches the outermost points of the DEM in the west (needed: at least
    10 m, one cell, beyond the release). Use a DEM that covers the flow path too.\n"""
OUTSIDE = "--release: outside.geojson: the release lies outside the DEM, by 4,230 m in the east; found: x from 417000"
HELP = "Run with --help for more information.\n"
COMMA = "allowed: a number above 0, without a unit; write a decimal point"
# Messages of `new`, and its arguments. A text that ends with a line break is the whole message. Others are its start,
# because tests/cpp/gis compares the rest.
REFUSED: list[tuple[str, Callable[[Slope], dict[str, Any]]]] = [
    (RASTER, lambda slope: {"release": raster(slope, THICKNESS), "thickness": 3}),
    (TOO_LARGE("thick.tif", A_DEM), lambda slope: {"release": raster(slope, 1000 * THICKNESS), "thickness": None}),
    (TOO_LARGE("release.geojson", IN_ANOTHER_UNIT), lambda _: {"thickness": 1000 * THICKNESS}),
    (NO_CRS, lambda slope: {"dem": slope("bare.tif", crs=None)}),
    (MERCATOR.format("--dem: dem.tif:"), lambda slope: {"dem": slope(crs="EPSG:3857")}),
    (MERCATOR.format("--crs: dem.tif:").replace("-t_srs", "-s_srs EPSG:3857 -t_srs"),
     lambda _: {"words": ["--crs", "EPSG:3857"]}),
    ("--dem: absent.tif: there is no such file. Correct the path.\n",
     lambda slope: {"dem": slope.folder / "absent.tif"}),
    (f"--thickness: 0 found; allowed: above 0. {HELP}", lambda _: {"thickness": 0}),
    (SWAPPED, lambda slope: {"dem": slope.release(), "release": slope(), "thickness": None}),
    (f"--thickness: 20,5 found; {COMMA}: 20.5. {HELP}", lambda _: {"thickness": "20,5"}),
    (f"--cell: 12,5 found; {COMMA}: 12.5. {HELP}", lambda _: {"words": ["--cell", "12,5"]}),
    (f"--reach-angle: 8,5 found; {COMMA}: 8.5. {HELP}", lambda _: {"words": ["--reach-angle", "8,5"]}),
    (f"--thickness: 20m found; allowed: a number above 0, without a unit. {HELP}", lambda _: {"thickness": "20m"}),
    (OUTSIDE, lambda slope: {"release": rectangle(slope, "outside", 5000.0, 0.0)}),
    (EDGE, lambda slope: {"release": rectangle(slope, "edge", 1.0, 100.0)}),
    (f"--cut excludes --on-top. {HELP}", lambda _: {"words": ["--cut", "--on-top"]}),
    (f"--cell excludes --resolution. {HELP}", lambda _: {"words": ["--cell", 12, "--resolution", "fine"]}),
]  # fmt: skip


@pytest.mark.parametrize(("start", "given"), REFUSED)
def test_unusable_inputs_are_refused(slope: Slope, start: str, given: Callable[[Slope], dict[str, Any]]) -> None:
    arguments = {"words": [], **given(slope)}
    message = slope.error(*arguments.pop("words"), **arguments)
    assert message.count("\n") == 1 and message.startswith("error: " + re.sub(r"\n +", " ", start)), message


def test_crs_supplies_and_replaces_a_reference_system(slope: Slope) -> None:
    slope.ok("--crs", "EPSG:32632", dem=slope("bare.tif", crs=None))
    printed = slope.ok("--crs", "EPSG:32632", dem=slope("wrong.tif", crs="EPSG:4326"), folder=slope.folder / "wrong")
    assert printed.startswith("note: wrong.tif is read as EPSG:32632, as set by --crs; the file specifies EPSG:4326\n")


def test_releases_too_thin_and_existing_folders_are_refused(slope: Slope) -> None:
    message = slope.error(thickness=0.3)
    assert re.search(
        r"^error: --thickness: a release 0\.3 m thick requires cells of 0\.\d+ m and \S+ particles; allowed without "
        r"--cell: 5,000,000\. Is the thickness in metres\? If it is, set --cell 0\.\d+ or more, which is coarser, or "
        r"use a depth-averaged program",
        message,
    ), message
    folder = slope.folder / "full"
    folder.mkdir()
    (folder / "notes.txt").write_text("mine")
    message = slope.error(folder=folder)
    assert message == "error: full: it exists and is not an empty folder. Choose another name.\n"


CREATE_AGAIN = r"`thawslide new` crops the DEM to the domain: create the case again with a smaller --reach-angle.*\n"
# Position, speed, and distance to go.
START = r"error: the run failed at t = \S+ s \(step \d+\): particle \d+ of body 'slide' at \((\S+), (\S+), \S+\) m: "
FURTHER = (
    r"With 8 degrees of friction, the reach angle that `thawslide new` assumes, it would go about (\d+) m "
    r"further on level ground, and more where the ground falls\. "
)
NO_GROUND = (
    rf"{START}the terrain below it is not known: the DEM ends or has a hole there\. It moves at (\S+) m/s towards the "
    rf"east\. {FURTHER}Give a DEM that reaches further there, .* or set grid\.leaving = \"remove\" .*{CREATE_AGAIN}"
)
LEFT_DOMAIN = (
    rf"{START}it left the domain\. It moves at (\S+) m/s towards the east, the slide at \S+ m/s on average\. Likely "
    rf"cause: the slide ran further than \[grid\] min and max allow\. {FURTHER}"
)
DEM_ENDS = rf"The DEM ends (\d+) m ahead of it: it has to be larger, and \[grid\] with it\. {CREATE_AGAIN}"


def stopping_distance(speed: str) -> float:
    """Return the stopping distance [m] from a speed [m/s] on level ground at 8 degrees, in tens of metres."""
    return 10.0 * math.ceil(float(speed) ** 2 / (2.0 * 9.81 * math.tan(math.radians(8.0))) / 10.0)


def failed(thawslide: Program, slope: Slope, velocity: list[float], *patterns: str, **changes: object) -> re.Match[str]:
    edit(slope.case / "case.toml", "\ntemperature = ", f"\nvelocity = {velocity}\ntemperature = ")
    words = sets(basal__friction="constant", grid__leaving="stop", **changes)
    message = thawslide.error("run", slope.case, "--output", slope.folder / "run", *words, code=3)
    reported = next(filter(None, (re.fullmatch(pattern, message) for pattern in patterns)), None)
    assert reported, message
    return reported


@pytest.mark.parametrize("hole", [None, slice(60, 70)])
def test_a_slide_off_the_known_terrain_fails_the_run(thawslide: Program, slope: Slope, hole: slice | None) -> None:
    slope.ok("--cell", 8, dem=slope(hole=hole))
    patterns = [NO_GROUND] if hole else [NO_GROUND, LEFT_DOMAIN + DEM_ENDS]
    reported = failed(thawslide, slope, [80.0, 0.0, 0.0], *patterns, basal__friction_angle=1)
    east = WEST + CELL * ((hole.start if hole else COLUMNS) - 1)
    assert east - 3.0 * CELL < float(reported[1]) < east + CELL
    assert SOUTH + 200.0 < float(reported[2]) < SOUTH + 400.0
    assert float(reported[3]) > 20.0
    assert float(reported[4]) == pytest.approx(stopping_distance(reported[3]), rel=0.02)  # of a speed with three digits
    assert run_facts(slope.folder / "run")["status"] == "failed"
    with rasterio.open(slope.folder / "run" / "maps" / "max_speed.tif") as file:
        assert file.read(1, masked=True).max() > 40.0


def test_the_distance_beyond_a_steep_dem_is_reported(thawslide: Program, slope: Slope) -> None:
    """On 38 degrees the vertical velocity is large: the horizontal distance counts, and the DEM ends there."""
    slope.ok(dem=slope(degrees=38.0, foot=CELL * COLUMNS))
    reported = failed(thawslide, slope, [48.0, 0.0, -36.0], LEFT_DOMAIN + DEM_ENDS, basal__friction_angle=5)
    assert float(reported[3]) > 60.0
    assert float(reported[4]) == pytest.approx(stopping_distance(reported[3]), rel=0.02)
    assert float(reported[5]) == pytest.approx(WEST + CELL * (COLUMNS - 1) - float(reported[1]), abs=2.0)


def test_a_domain_smaller_than_its_dem_is_to_be_widened(thawslide: Program, slope: Slope) -> None:
    slope.ok()
    grid = tomllib.loads((slope.case / "case.toml").read_text())["grid"]
    # A cell or two ahead of the release, which ends at 320 m; the DEM of the case extends further.
    grid["max"][0] = grid["min"][0] + math.ceil((WEST + 330.0 - grid["min"][0]) / grid["cell"]) * grid["cell"]
    with rasterio.open(slope.case / "dem.tif") as file:
        end = file.bounds.right - 0.5 * CELL
    widen = LEFT_DOMAIN + r"The DEM ends (\d+) m ahead of it: widen \[grid\] that way\.\n"
    reported = failed(thawslide, slope, [0.0] * 3, widen, basal__friction_angle=5, grid__max=grid["max"])
    assert float(reported[4]) < float(reported[5]) == pytest.approx(end - float(reported[1]), abs=5.0)


def test_swapped_files_of_a_case_are_named(thawslide: Program, slope: Slope) -> None:
    polygons, thick = slope.release(), raster(slope, THICKNESS)
    slope.ok()
    slope.ok(folder=slope.folder / "thick", release=thick, thickness=None)
    dem, of_raster = slope.folder / "dem.tif", slope.folder / "thick"
    other_kind = "release.geojson: the file has polygons, lines or points; needed: a raster"
    elevations = "Is this raster a DEM, swapped with the raster of the thickness?"
    as_raster = f'{{ raster = "{dem}" }}'
    for case, keys, words in (
        (slope.case, {"terrain__file": polygons, "body__slide__release": dem}, other_kind),
        (of_raster, {"body__slide__thickness": f'{{ raster = "{polygons}" }}'}, other_kind),
        (of_raster, {"terrain__file": thick, "body__slide__thickness": as_raster}, elevations),
        (slope.case, {"terrain__file": thick}, "or correct terrain.file"),
        (slope.case, {"maps__path": thick}, "the file is a raster; needed: lines"),
    ):
        for command in (["check", case], ["run", case, "--output", slope.folder / "run"]):
            assert words in thawslide.error(*command, *sets(**keys)), keys
