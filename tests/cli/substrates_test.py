"""Substrates of a case and sections of varying width: facts of check, gaps, overlaps, and what a run uses."""

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program, Ran, datasets, history, sets, snapshot_files
from terrain_files import EAST, place, toml, write_dem, write_release

GLACIER = toml("""
[substrate.glacier] x_min = 12.0 | friction = "coefficient" | friction_coefficient = 0.12
""")
MORAINE = toml("""
[substrate.moraine] x_max = 5.0 | friction = "constant" | friction_angle = 30.0 | cohesion = 1000.0
  cohesion_law = "bonds" | slip_distance = 5.0
""")


def test_areas_of_the_ground_and_gaps_are_reported(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    case = small_case / "case.toml"
    assert "substrate" not in thawslide.ok("check", small_case)
    case.write_text(case.read_text() + GLACIER + MORAINE)
    printed = thawslide.ok("check", small_case)
    assert (
        '  substrate   glacier: from x = 12 m on, 8 m or 40 % of the domain; friction "coefficient", no cohesion\n'
        "  substrate   moraine: up to x = 5 m, 5 m or 25 % of the domain; "
        'friction "constant", cohesion 1,000 Pa, "bonds"\n'
        '              elsewhere [basal], 35 % of the domain; friction "lubricated", no cohesion\n'
    ) in printed
    for words in (["check", case], ["run", case, "--output", tmp_path / "run"], ["block", case]):
        printed = thawslide.ok(*words)
        place = "between the substrates moraine and glacier, from x = 5 to 12 m"
        note = f"{place}, there is no substrate: [basal] applies there\n"
        assert printed.count(f"warning: {note}") == 1, words


WIDE = ROOT / "cases" / "lamplugh-columns" / "wide-valley.toml"


def test_check_states_the_reference_width_of_values_per_metre(thawslide: Program) -> None:
    printed = thawslide.ok("check", WIDE)
    assert "slide: 84,300 m3 and 174,000 t per metre of the width at x = 2190 m, along 1,050 m; " in printed
    assert "case.width" not in printed, "1,883 m over 2 km is no reason to warn"
    printed = thawslide.ok("check", WIDE, "--set", "case.width={ x = [2190.0, 3190.0], value = [617.0, 2500.0] }")
    lateral = "The neglected lateral motion would have 0.3 of the kinetic energy there."
    assert f"it changes by 1.9 m per m. {lateral}" in printed


def test_resolved_case_of_a_run_has_the_width_and_resume_keeps_it(ran: Ran, thawslide: Program, tmp_path: Path) -> None:
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
    found = distance_beyond(EAST + border, thawslide, tmp_path, slope, 300.0 + np.tan(slope) * EAST, **keys)
    assert abs(found) < 0.5 * BLOCK_CELL
