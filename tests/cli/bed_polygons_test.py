"""Erodible beds in polygons: their volume on a tilted plane, errors, runs, copies of their file, and beds of `new`."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Program, Slope, history, sets
from rasterio.warp import transform
from terrain_files import DEPTH, SLOPE_CRS, SOUTH, WEST, WIDTH, toml, write_rectangle

Corner = tuple[float, float]  # from the corner of the slope [m]

BED = toml("""
[bed] law = "strength" | outline = "bed.geojson" | depth = { attribute = "depth" } | strength = 0.0
  depth_per_slip = 0.2 | material = "rock_ice" | temperature = -5.0 | porosity = 0.375
""")
MOVING = ("--threads", "1", *sets(body__slide__velocity="[15,0,-8]", time__end=0.6, time__history_interval=0.1),
          *sets(time__stepping='"fixed"', time__step=0.005))  # fmt: skip
BELOW_RELEASE = [(190.0, 240.0), (420.0, 240.0), (420.0, 361.0), (190.0, 361.0)]


def write_bed(folder: Path, polygons: list[tuple[list[Corner], dict[str, Any]]], crs: str = SLOPE_CRS) -> Path:
    """Write polygons with their attributes in a reference system."""
    features = []
    for corners, attributes in polygons:
        x, y = np.transpose([*corners, corners[0]])
        ring = np.transpose(transform(SLOPE_CRS, crs, WEST + x, SOUTH + y)).tolist()
        geometry = {"type": "Polygon", "coordinates": [ring]}
        features.append({"type": "Feature", "properties": attributes, "geometry": geometry})
    system = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:{crs.replace(':', '::')}"}}
    file = folder / "bed.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "crs": system, "features": features}))
    return file


def box(west: float, south: float, east: float, north: float) -> list[Corner]:
    return [(west, south), (east, south), (east, north), (west, north)]


@pytest.fixture
def case(slope: Slope) -> Path:
    """Return the folder of a slide on a slope with a bed in the polygons of bed.geojson, which do not exist yet."""
    slope.ok()
    file = slope.case / "case.toml"
    file.write_text(file.read_text() + BED)
    return slope.case


def volume_of(thawslide: Program, case: Path, *words: object) -> float:
    volume: float = thawslide.json("check", case, *words)["bed_volume_m3"]
    return volume


def test_check_states_the_volume_of_polygons_in_any_system(thawslide: Program, case: Path) -> None:
    """It is exact, and in other systems as exact as their transformation."""
    triangle = [(103.3, 121.9), (271.6, 121.9), (103.3, 307.2)]
    write_bed(case, [(triangle, {"depth": 2.5}), (box(301.7, 99.1, 398.2, 204.6), {"depth": 0.7, "name": "fan"})])
    of_triangle, of_box = 2.5 * 0.5 * 168.3 * 185.3, 0.7 * 96.5 * 105.5
    assert volume_of(thawslide, case) == pytest.approx(of_triangle + of_box, rel=1e-11)
    assert "  bed         46,100 m3 can be entrained\n" in thawslide.ok("check", case)
    assert volume_of(thawslide, case, *sets(bed__polygons='["fan"]')) == pytest.approx(of_box, rel=1e-11)
    write_bed(case, [(triangle, {"depth": 2.5})], "EPSG:4326")
    assert volume_of(thawslide, case) == pytest.approx(of_triangle, rel=1e-5)


def test_invalid_polygons_are_refused(thawslide: Program, case: Path) -> None:
    """Messages are compared in tests/cpp/gis; a missing attribute and an overlap are those of any polygons."""
    file = case / "bed.geojson"
    write_bed(case, [(box(100.0, 100.0, 200.0, 200.0), {"depth": -2})])
    for command in ("check", "run"):
        message = thawslide.error(command, case)
        assert f": bed.depth: {file}: the attribute 'depth' of polygon 1 is -2 m; allowed: " in message
        assert re.match(rf"error: {re.escape(str(case))}/case\.toml:\d+:9: ", message)


def test_a_run_entrains_from_polygons_with_an_exact_mass_budget(thawslide: Program, case: Path, tmp_path: Path) -> None:
    write_bed(case, [(BELOW_RELEASE, {"depth": 1.0})])
    volume = volume_of(thawslide, case)
    run, parts = tmp_path / "run", tmp_path / "parts"
    thawslide.ok("run", case, "--output", run, *MOVING)
    rows = history(run)
    mass = rows["bed_mass_kg"][0]
    assert rows["entrained_mass_kg"][-1] > 0.01 * mass
    assert np.abs(rows["bed_residual_kg"]).max() < 1e-12 * mass
    assert np.abs(rows["entrained_mass_kg"] + rows["bed_mass_kg"] - mass).max() < 1e-12 * mass
    density = rows["entrained_mass_kg"][-1] / rows["entrained_volume_m3"][-1]
    assert mass == pytest.approx(density * volume, rel=1e-12)
    written = tomllib.loads((run / "case.toml").read_text())["bed"]
    assert written["outline"] == "inputs/bed.geojson" and written["depth"] == {"attribute": "depth"}
    assert (run / "inputs" / "bed.geojson").read_bytes() == (case / "bed.geojson").read_bytes()
    (case / "bed.geojson").unlink()
    thawslide.ok("run", run, "--output", parts, *MOVING, *sets(time__end=0.3))
    thawslide.ok("resume", parts, "--end", 0.6, "--threads", 1)
    resumed = history(parts)
    for name in ("time_s", "entrained_mass_kg", "bed_mass_kg", "mean_velocity_m_s"):
        assert resumed[name][-1] == rows[name][-1], name


def test_new_writes_a_bed_in_the_valley_floor_as_comments(thawslide: Program, slope: Slope) -> None:
    slope.ok("--valley-floor", write_rectangle(slope.folder / "ground.geojson", WEST + 400.0, SOUTH + 100.0))
    file = slope.case / "case.toml"
    assert "bed" not in tomllib.loads(file.read_text())
    before, bed = file.read_text().split("# [bed]\n")
    table, after = bed.split("\n\n", 1)
    table = "\n".join(line.removeprefix("# ") for line in table.splitlines())
    file.write_text(f"{before}[bed]\n{table}\n\n{after}")
    assert volume_of(thawslide, slope.case) == pytest.approx(1.0 * WIDTH * DEPTH, rel=1e-11)
    assert "warning: bed" not in thawslide("check", slope.case).stderr
