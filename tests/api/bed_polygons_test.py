"""Erodible beds in polygons from Python."""

from pathlib import Path

import pytest
from conftest import CommandLine
from simulation_test import assert_identical, history_of, silent
from terrain_files import SOUTH, THICKNESS, WEST, write_rectangle, write_slope

from thawslide import Case, Simulation, UserError, new_case

LENGTH, WIDTH = 230.0, 121.0  # m, of the bed


def test_a_bed_in_polygons_is_that_of_the_command(tmp_path: Path, command_line: CommandLine) -> None:
    dem = write_slope(tmp_path / "dem.tif")
    release = write_rectangle(tmp_path / "release.geojson", WEST + 200.0, SOUTH + 250.0)
    bed = write_rectangle(tmp_path / "bed.geojson", WEST + 190.0, SOUTH + 240.0, LENGTH, WIDTH, metres=1.5)
    new_case(dem, release, tmp_path / "slide", thickness=THICKNESS, valley_floor=bed, on_message=silent)
    outline = tmp_path / "slide" / bed.name  # the copy, which is also that of the substrate
    changes = {
        "bed.law": "strength", "bed.outline": str(outline), "bed.depth": {"attribute": "metres"}, "bed.strength": 0.0,
        "bed.depth_per_slip": 0.2, "bed.material": "rock_ice", "body.slide.velocity": [15.0, 0.0, -8.0],
        "time.end": 0.3,
    }  # fmt: skip
    simulation = Simulation(Case(tmp_path / "slide", changes), threads=1, on_message=silent)
    assert simulation.case["bed.outline"] == str(outline)
    simulation.run()
    rows = simulation.history
    density = rows["entrained_mass_kg"].iloc[-1] / rows["entrained_volume_m3"].iloc[-1]
    assert rows["bed_mass_kg"].iloc[0] == pytest.approx(density * 1.5 * LENGTH * WIDTH, rel=1e-11)

    sets = [f"--set={key}={value}" for key, value in changes.items() if not isinstance(value, dict)]
    sets.append('--set=bed.depth={ attribute = "metres" }')
    done = command_line("run", tmp_path / "slide", "--output", tmp_path / "run", "--threads", 1, *sets)
    assert done.returncode == 0, done.stderr
    assert_identical(rows, history_of(tmp_path / "run"))

    with pytest.raises(UserError, match="there is no attribute 'deep', which "):
        Simulation(Case(tmp_path / "slide", changes | {"bed.depth": {"attribute": "deep"}}), on_message=silent)
    with pytest.raises(UserError, match="there are no polygons to have it"):
        Case(tmp_path / "slide", {key: value for key, value in changes.items() if key != "bed.outline"})
