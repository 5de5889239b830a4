"""`thawslide block` moves as a run of the same case, on planes, profiles and in valleys, and warns of unusual paths."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Program, Ran, columns_of, history, sets
from terrain_files import EAST, NORTH, Height, place, toml, write_dem, write_line, write_release

SLOPE, FRICTION, CELL = 35.0, 15.0, 5.0  # degrees, degrees, m
MIDDLE = 102.5  # y of the thalweg [m], on points of the DEM
CASE = toml(f"""
[case] dimension = 3
[time] end = 6.0 | stepping = "adaptive" | history_interval = 1.0 | output_interval = 6.0
[grid] cell = {CELL} | min = [{EAST + 5.0}, {NORTH + 5.0}, 400.0] | max = [{EAST + 795.0}, {NORTH + 200.0}, 1200.0]
[terrain] type = "dem" | file = "dem.tif"
[maps] path = "path.geojson"
[material.rock] law = "elastic" | youngs_modulus = 5.0e7 | poisson_ratio = 0.2
[body.slide] material = "rock" | shape = "release" | release = "release.geojson" | thickness = 15.0
[basal] friction = "constant" | friction_angle = {FRICTION}
[heat] enabled = false
[pressure] enabled = false
""")


def write_case(folder: Path, height: Height) -> Path:
    """Write the case with its terrain, a release of 100 m by 40 m and a path along x."""
    write_dem(folder / "dem.tif", height, columns=160, rows=41, cell=CELL)
    corners = [(100.0, MIDDLE - 20.0), (200.0, MIDDLE - 20.0), (200.0, MIDDLE + 20.0), (100.0, MIDDLE + 20.0)]
    write_release(folder / "release.geojson", corners)
    write_line(folder / "path.geojson", [(50.0, MIDDLE), (790.0, MIDDLE)])
    (folder / "case.toml").write_text(CASE)
    return folder


@pytest.mark.parametrize(("opening", "note"), [(160.0, False), (120.0, True)])
def test_friction_of_the_sides_is_noted(thawslide: Program, tmp_path: Path, opening: float, note: bool) -> None:
    slope, half = np.radians(SLOPE), np.radians(opening / 2.0)
    side = 1.0 / np.tan(half) / np.cos(slope)  # across, in the map
    write_case(tmp_path, lambda x, y: 1000.0 - np.tan(slope) * x + side * np.abs(y - MIDDLE))
    printed = thawslide.ok("block", tmp_path, "--output", tmp_path / "block.csv")
    assert columns_of(tmp_path / "block.csv")["valley_factor"] == pytest.approx(1.0 / np.sin(half), rel=1e-6)
    assert ("the path follows a valley, whose sides raise friction by a factor of" in printed) == note


PLANE_2D = toml("""
[case] dimension = 2
[time] end = 6.0 | step = 0.005 | history_interval = 0.5 | output_interval = 6.0
[grid] cell = 5.0 | min = [-100.0, -600.0] | max = [900.0, 200.0]
[terrain] type = "plane" | elevation = 0.0 | slope = 26.565051177078
[material.rock] law = "elastic" | youngs_modulus = 5.0e7 | poisson_ratio = 0.2
[body.b] material = "rock" | shape = "polygon"
  vertices = [[100.0, -50.0], [180.0, -90.0], [180.0, -70.0], [100.0, -30.0]] | velocity = [-5.0, 2.5]
[basal] friction = "constant" | friction_angle = 15.0
[heat] enabled = false
[pressure] enabled = false
""")


def test_a_block_that_turns_back_moves_downhill_as_the_run_does(ran: Ran, thawslide: Program, tmp_path: Path) -> None:
    case = tmp_path / "case.toml"
    case.write_text(PLANE_2D)
    thawslide.ok("block", case, "--output", tmp_path / "block.csv")
    rows = columns_of(tmp_path / "block.csv")
    assert rows["velocity_m_s"][0] == pytest.approx(-np.hypot(5.0, 2.5), rel=1e-3)
    # Upward with sin + mu cos, then downward with sin - mu cos.
    sine, cosine, friction = np.sin(np.radians(26.565)), np.cos(np.radians(26.565)), np.tan(np.radians(15.0))
    up, down = 9.81 * (sine + friction * cosine), 9.81 * (sine - friction * cosine)
    speed = np.hypot(5.0, 2.5)
    turned = speed / up
    assert rows["velocity_m_s"][-1] == pytest.approx(down * (6.0 - turned), rel=0.01)
    assert rows["displacement_m"][-1] == pytest.approx(0.5 * down * (6.0 - turned) ** 2 - 0.5 * speed**2 / up, rel=0.01)
    ran(case=case)
    run = history(tmp_path / "run")
    assert rows["front_position_m"][-1] == pytest.approx(run["front_position_m"][-1], abs=3.0)
    assert run["runout_m"][-1] > 0.0
    # The rear is at x = 100 m, and the highest particle half a spacing below the upper corner at y = -30 m.
    assert rows["travel_distance_m"] == pytest.approx(rows["front_position_m"] - 100.0)
    assert rows["drop_height_m"] == pytest.approx(0.5 * rows["front_position_m"] - 30.0, abs=3.0)
    assert np.ptp(rows["drop_height_m"] - 0.5 * rows["front_position_m"]) < 1e-6


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Make a case on a plane that falls along x, with a path from its upper end downhill."""
    return write_case(tmp_path, lambda x, _: 1000.0 - 0.5 * x)


def test_unusual_paths_are_reported_or_refused(thawslide: Program, slope: Path) -> None:
    assert "steepest descent" not in thawslide.ok("block", slope)
    write_line(slope / "path.geojson", [(150.0, 10.0), (150.0, 195.0)])
    printed = thawslide.ok("block", slope)
    assert "warning: maps.path is at 90 degrees to the steepest descent at the middle of the release" in printed
    assert "misses the release by" not in thawslide.ok("check", slope)
    write_line(slope / "path.geojson", [(50.0, 190.0), (790.0, 190.0)])
    printed = thawslide.ok("check", slope)
    # From the release's edge at y = 122.5 m, whose points reach half a cell further.
    assert "warning: maps.path: path.geojson misses the release by 6" in printed
    write_line(slope / "path.geojson", [(150.0, MIDDLE), (150.0, MIDDLE)])
    for command in (("block", slope), ("run", slope, "--output", slope / "run", *sets(time__end=0.1))):
        assert "the path has no length; allowed: a line of at least two different points" in thawslide.error(*command)


def test_a_probe_without_terrain_is_reported(thawslide: Program, slope: Path) -> None:
    x, y = place(500.0, 100.0)
    probe = f"[probe.gate]\npoint = [{x}, {y}]\n"
    (slope / "case.toml").write_text(CASE + probe)
    note = "probe.gate: the DEM has no data there, and the probe reports zeros"
    assert note not in thawslide.ok("check", slope)
    hole = np.array([500.0, 100.0])
    write_case(slope, lambda x, y: np.where(np.hypot(x - hole[0], y - hole[1]) < 30.0, np.nan, 1000.0 - 0.5 * x))
    (slope / "case.toml").write_text(CASE + probe)
    assert note in thawslide.ok("check", slope)


def test_a_block_ends_with_its_profile(thawslide: Program, tmp_path: Path) -> None:
    (tmp_path / "profile.csv").write_text("distance_m,terrain_elevation_m\n-100,50\n400,-200\n")
    plane = 'type = "plane"\nelevation = 0.0\nslope = 26.565051177078'
    assert plane in PLANE_2D
    text = PLANE_2D.replace(plane, 'type = "profile"\nfile = "profile.csv"').replace("[900.0, 200.0]", "[400.0, 200.0]")
    (tmp_path / "case.toml").write_text(text)
    printed = thawslide.ok("block", tmp_path / "case.toml", "--output", tmp_path / "a.csv", *sets(time__end=20.0))
    assert "warning: the profile is known from -100 to 400 m; the front leaves it at" in printed
    rows = columns_of(tmp_path / "a.csv")
    assert rows["front_position_m"].max() <= 400.0
    assert rows["time_s"][-1] < 20.0
