"""Substrates, beds in polygons, and sections of varying width: what `check` states and a run uses."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
import terrain_files
from conftest import ROOT, Program, Ran, Slope, datasets, history, sets, snapshot_files
from terrain_files import SOUTH, WEST, place, toml, write_dem, write_features, write_rectangle, write_release

WIDE = ROOT / "cases" / "lamplugh-columns" / "wide-valley.toml"


def test_a_variable_width_is_stated_resolved_and_kept(thawslide: Program, ran: Ran, tmp_path: Path) -> None:
    printed = thawslide.ok("check", WIDE)
    assert "slide: 84,300 m3 and 174,000 t per metre of the width at x = 2190 m, along 1,050 m; " in printed
    assert "case.width" not in printed, "1,883 m over 2 km is no reason to warn"
    printed = thawslide.ok("check", WIDE, "--set", "case.width={ x = [2190.0, 3190.0], value = [617.0, 2500.0] }")
    lateral = "The neglected lateral motion would have 0.3 of the kinetic energy there."
    assert f"it changes by 1.9 m per m. {lateral}" in printed
    folder = ran("--set", "time.end=0.1", "--threads", "1", case=WIDE, name="wide")
    resolved = (folder / "case.toml").read_text(encoding="utf-8")
    assert "\nwidth = { x = [2190.0, 4190.0], value = [617.0, 2500.0] }  # m\n" in resolved
    ran("--threads", "1", case=folder, name="again")
    assert (folder / "history.csv").read_bytes() == (tmp_path / "again" / "history.csv").read_bytes()
    message = thawslide.error("resume", folder, "--set", "time.end=0.2", "--set", "case.width=617.0")
    assert "error: case.width cannot be changed on resume" in message
    thawslide.ok("resume", folder, "--set", "time.end=0.2", "--threads", "1")


# A stiff block slides down a slope, without friction up to a substrate. While the block crosses the border, the
# friction work grows with the square of the distance, and then in proportion to it. The line of the second part begins
# where the middle of the load reaches the border at which the substrate acts.
BLOCK = toml("""
[case] title = "Onto a substrate"
[time] stepping = "adaptive" | output_interval = 10.0 | history_interval = 0.05
[grid] cell = 5.0
[basal] friction = "coefficient" | friction_coefficient = 0.0
[substrate.far] friction = "coefficient" | friction_coefficient = 0.02
[material.rock] law = "elastic" | youngs_modulus = 5.0e8 | poisson_ratio = 0.2 | viscosity_time = 0.02
[body.block] material = "rock" | temperature = -1.0 | porosity = 0.3
""")
BLOCK_CELL, LONG, HIGH = 5.0, 20.0, 5.0  # m; length along x, height


def distance_beyond(
    border: float, thawslide: Program, folder: Path, slope: float, elevation: float, **keys: object
) -> float:
    """Run the block down a plane [radians]; return how far beyond a border the substrate acts, along x [m].

    `elevation`: of the plane at x = 0.
    """
    (folder / "case.toml").write_text(BLOCK)
    thawslide.ok("run", folder / "case.toml", "--output", folder / "run", "--threads", "1", *sets(**keys))
    particles = datasets(snapshot_files(folder / "run")[0])
    mass, points = particles["VTKHDF/PointData/mass"], particles["VTKHDF/Points"]
    centre = mass @ points[:, : 2 if points[:, 2].max() == 0.0 else 3] / mass.sum()
    above = centre[-1] - (elevation - np.tan(slope) * centre[0])
    middle = centre[0] - above * np.cos(slope) * np.sin(slope)  # of the load, below the centre along the normal
    columns = history(folder / "run")
    along, work = columns["mean_displacement_m"] * np.cos(slope), columns["friction_work_J"]
    is_across = middle + along > border + LONG / 2.0 + 3.0 * BLOCK_CELL
    assert is_across.sum() > 10
    force, offset = np.polyfit(along[is_across], work[is_across], 1)
    return float(middle - offset / force - border)


@pytest.mark.parametrize("degrees", [0.0, 30.0, 45.0])
@pytest.mark.parametrize("border", [65.01, 67.5, 69.99])
def test_a_substrate_of_a_section_acts_in_it(thawslide: Program, tmp_path: Path, degrees: float, border: float) -> None:
    slope = np.radians(degrees)
    down, up = np.array([np.cos(slope), -np.sin(slope)]), np.array([np.sin(slope), np.cos(slope)])
    foot = np.array([30.0, -30.0 * np.tan(slope)])
    corners = [foot, foot + LONG * down, foot + LONG * down + HIGH * up, foot + HIGH * up]
    keys = {
        "case__gravity_tilt": -degrees, "time__end": 4.5, "grid__min": [0.0, -200.0], "grid__max": [150.0, 50.0],
        "terrain__type": '"plane"', "terrain__slope": degrees, "terrain__elevation": 0.0,
        "substrate__far__x_min": border, "body__block__shape": '"polygon"',
        "body__block__vertices": [list(map(float, corner)) for corner in corners],
        "body__block__velocity": list(map(float, 15.0 * down / np.cos(slope))),
    }  # fmt: skip
    assert abs(distance_beyond(border, thawslide, tmp_path, slope, 0.0, **keys)) < 0.51 * BLOCK_CELL


@pytest.mark.parametrize("border", [65.01, 69.99])
def test_a_substrate_of_a_map_acts_where_it_is_drawn(thawslide: Program, tmp_path: Path, border: float) -> None:
    slope, turn = np.radians(30.0), 0.4  # of the border, in x per y
    dem = write_dem(tmp_path / "dem.tif", lambda x, y: 300.0 - np.tan(slope) * x, columns=30, rows=14)
    release = write_release(tmp_path / "release.geojson", [(30.0, 60.0), (50.0, 60.0), (50.0, 80.0), (30.0, 80.0)])
    at = [border - 70.0 * turn, border + 70.0 * turn]  # at the edges of the DEM, 70 m from the middle of the block
    far = write_release(tmp_path / "far.geojson", [(at[0], 0.0), (280.0, 0.0), (280.0, 140.0), (at[1], 140.0)])
    west, south = place(10.0, 10.0)
    keys = {
        "case__dimension": 3, "time__end": 7.0, "grid__min": [west, south, 100.0],
        "grid__max": [west + 280.0, south + 120.0, 400.0], "terrain__type": '"dem"', "terrain__file": f'"{dem}"',
        "substrate__far__outline": f'"{far}"', "body__block__shape": '"release"',
        "body__block__release": f'"{release}"', "body__block__thickness": HIGH,
        "body__block__placement": '"on_top"',
    }  # fmt: skip
    found = distance_beyond(
        terrain_files.EAST + border, thawslide, tmp_path, slope, 300.0 + np.tan(slope) * terrain_files.EAST, **keys
    )
    assert abs(found) < 0.5 * BLOCK_CELL


BED = toml("""
[bed] law = "strength" | outline = "bed.geojson" | depth = { attribute = "depth" } | strength = 0.0
  depth_per_slip = 0.2 | material = "rock_ice" | temperature = -5.0 | porosity = 0.375
""")
MOVING = ("--threads", "1", *sets(body__slide__velocity="[15,0,-8]", time__end=0.6, time__history_interval=0.1),
          *sets(time__stepping='"fixed"', time__step=0.005))  # fmt: skip
BELOW_RELEASE = [(190.0, 240.0), (420.0, 240.0), (420.0, 361.0), (190.0, 361.0)]


@pytest.fixture
def case(slope: Slope) -> Path:
    """Return the folder of a slide on a slope with a bed in the polygons of bed.geojson, which do not exist yet."""
    slope.ok()
    file = slope.case / "case.toml"
    file.write_text(file.read_text() + BED)
    return slope.case


def volume_of(thawslide: Program, case: Path) -> float:
    volume: float = thawslide.json("check", case)["bed_volume_m3"]
    return volume


def test_a_run_and_its_copies_entrain_from_polygons(thawslide: Program, case: Path, tmp_path: Path) -> None:
    ring = [[WEST + x, SOUTH + y] for x, y in (*BELOW_RELEASE, BELOW_RELEASE[0])]
    write_features(case / "bed.geojson", "Polygon", [([ring], {"depth": 1.0})], terrain_files.SLOPE_CRS)
    volume = volume_of(thawslide, case)
    run, parts = tmp_path / "run", tmp_path / "parts"
    thawslide.ok("run", case, "--output", run, *MOVING)
    rows = history(run)
    mass = rows["bed_mass_kg"][0]
    assert rows["entrained_mass_kg"][-1] > 0.01 * mass
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
    assert volume_of(thawslide, slope.case) == pytest.approx(1.0 * terrain_files.WIDTH * terrain_files.DEPTH, rel=1e-11)
    assert "warning: bed" not in thawslide("check", slope.case).stderr
