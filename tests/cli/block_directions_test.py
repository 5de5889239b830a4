"""thawslide block moves in the direction of a run of the same case, and warns of unusual paths."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from block_valley_test import CASE, CELL, MIDDLE
from conftest import Program, history, sets
from terrain_files import place, write_dem, write_geojson, write_line

PLANE_2D = """
[case]
dimension = 2
[time]
end = 6.0
step = 0.005
history_interval = 0.5
output_interval = 6.0
[grid]
cell = 5.0
min = [-100.0, -600.0]
max = [900.0, 200.0]
[terrain]
type = "plane"
elevation = 0.0
slope = 26.565051177078
[material.rock]
law = "elastic"
youngs_modulus = 5.0e7
poisson_ratio = 0.2
[body.b]
material = "rock"
shape = "polygon"
vertices = [[100.0, -50.0], [180.0, -90.0], [180.0, -70.0], [100.0, -30.0]]
velocity = [-5.0, 2.5]
[basal]
friction = "constant"
friction_angle = 15.0
[heat]
enabled = false
[pressure]
enabled = false
"""


def block_rows(thawslide: Program, case: Path, output: Path, *words: str) -> dict[str, np.ndarray]:
    done = thawslide("block", case, "--output", output, *words)
    assert done.returncode == 0, done.stderr
    with output.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_a_block_that_turns_back_moves_downhill_as_the_run_does(thawslide: Program, tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text(PLANE_2D)
    rows = block_rows(thawslide, case, tmp_path / "block.csv")
    assert rows["velocity_m_s"][0] == pytest.approx(-np.hypot(5.0, 2.5), rel=1e-3)
    # Upward with sin + mu cos, then downward with sin - mu cos.
    sine, cosine, friction = np.sin(np.radians(26.565)), np.cos(np.radians(26.565)), np.tan(np.radians(15.0))
    up, down = 9.81 * (sine + friction * cosine), 9.81 * (sine - friction * cosine)
    speed = np.hypot(5.0, 2.5)
    turned = speed / up
    assert rows["velocity_m_s"][-1] == pytest.approx(down * (6.0 - turned), rel=0.01)
    assert rows["displacement_m"][-1] == pytest.approx(0.5 * down * (6.0 - turned) ** 2 - 0.5 * speed**2 / up, rel=0.01)
    done = thawslide("run", case, "--output", tmp_path / "run")
    assert done.returncode == 0, done.stderr
    run = history(tmp_path / "run")
    assert rows["front_position_m"][-1] == pytest.approx(run["front_position_m"][-1], abs=3.0)
    assert run["runout_m"][-1] > 0.0


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Make a case on a plane that falls along x, with a path from its upper end downhill."""
    write_dem(tmp_path / "dem.tif", lambda x, _: 1000.0 - 0.5 * x, columns=160, rows=41, cell=CELL)
    corners = [(100.0, MIDDLE - 20.0), (200.0, MIDDLE - 20.0), (200.0, MIDDLE + 20.0), (100.0, MIDDLE + 20.0)]
    write_geojson(tmp_path / "release.geojson", "Polygon", [[place(*corner) for corner in [*corners, corners[0]]]])
    write_line(tmp_path / "path.geojson", [(50.0, MIDDLE), (790.0, MIDDLE)])
    (tmp_path / "case.toml").write_text(CASE)
    return tmp_path


def test_a_path_along_the_contour_has_a_warning(thawslide: Program, slope: Path) -> None:
    assert "steepest descent" not in thawslide("block", slope).stdout
    write_line(slope / "path.geojson", [(150.0, 10.0), (150.0, 195.0)])
    done = thawslide("block", slope)
    assert done.returncode == 0, done.stderr
    assert "warning: maps.path is at 90 degrees to the steepest descent at the middle of the release" in done.stdout


def test_a_path_of_no_length_is_refused(thawslide: Program, slope: Path) -> None:
    write_line(slope / "path.geojson", [(150.0, MIDDLE), (150.0, MIDDLE)])
    for command in (("block", slope), ("run", slope, "--output", slope / "run", *sets(time__end=0.1))):
        refused = thawslide(*command)
        assert refused.returncode == 2
        assert "the path has no length; allowed: a line of at least two different points" in refused.stderr


def test_a_path_next_to_the_release_is_reported(thawslide: Program, slope: Path) -> None:
    assert "misses the release by" not in thawslide("check", slope).stdout
    write_line(slope / "path.geojson", [(50.0, 190.0), (790.0, 190.0)])
    done = thawslide("check", slope)
    assert done.returncode == 0, done.stderr
    # From the release's edge at y = 122.5 m, whose points reach half a cell further.
    assert "warning: maps.path: path.geojson misses the release by 6" in done.stdout


def test_a_probe_without_terrain_is_reported(thawslide: Program, slope: Path) -> None:
    case = (slope / "case.toml").read_text()
    x, y = place(500.0, 100.0)
    (slope / "case.toml").write_text(f"{case}[probe.gate]\npoint = [{x}, {y}]\n")
    note = "probe.gate: the DEM has no data there, and the probe reports zeros"
    assert note not in thawslide("check", slope).stdout
    hole = np.array([500.0, 100.0])
    write_dem(
        slope / "dem.tif",
        lambda x, y: np.where(np.hypot(x - hole[0], y - hole[1]) < 30.0, np.nan, 1000.0 - 0.5 * x),
        columns=160,
        rows=41,
        cell=CELL,
    )
    assert note in thawslide("check", slope).stdout


def test_a_block_ends_with_its_profile(thawslide: Program, tmp_path: Path) -> None:
    (tmp_path / "profile.csv").write_text("distance_m,terrain_elevation_m\n-100,50\n400,-200\n")
    plane = 'type = "plane"\nelevation = 0.0\nslope = 26.565051177078'
    assert plane in PLANE_2D
    text = PLANE_2D.replace(plane, 'type = "profile"\nfile = "profile.csv"').replace("[900.0, 200.0]", "[400.0, 200.0]")
    (tmp_path / "case.toml").write_text(text)
    done = thawslide("block", tmp_path / "case.toml", "--output", tmp_path / "a.csv", *sets(time__end=20.0))
    assert done.returncode == 0, done.stderr
    assert "warning: the profile is known from -100 to 400 m; the front leaves it at" in done.stdout
    rows = list(csv.DictReader((tmp_path / "a.csv").open()))
    assert max(float(row["front_position_m"]) for row in rows) <= 400.0
    assert float(rows[-1]["time_s"]) < 20.0
