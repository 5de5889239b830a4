"""`thawslide run --pair`: the error from three cells, the distance of outlines, and the command."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import Capture

from thawslide.maps import Grid, Map
from thawslide.pairs.command import main
from thawslide.pairs.errors import SAFETY, error_of
from thawslide.pairs.outlines import outline_distance
from thawslide.run_folder import Run


@pytest.mark.parametrize("order", [0.6, 1.0, 1.5, 1.9])
def test_power_law_is_extrapolated_to_its_limit(order: float) -> None:
    found = error_of(*(7.0 + 3.0 * h**order for h in (4.0, 2.0, 1.0)))
    assert found.order == pytest.approx(order, rel=1e-12)
    assert found.limit == pytest.approx(7.0, rel=1e-12)
    assert found.error == pytest.approx(SAFETY * 3.0, rel=1e-12), "the error on cells of 1 is 3"
    assert found.reason == ""


@pytest.mark.parametrize(
    ("values", "reason", "spread"),
    [
        ((1.0, 3.0, 2.0), "not monotonic", 2.0),
        ((1.0, 2.0, 2.9), "observed order 0.2, not 0.5 to 2", 1.9),
        ((1.0, 2.0, 2.01), "observed order 6.6, not 0.5 to 2", 1.01),
        ((1302.0, 1320.0, 1323.0), "observed order 2.6, not 0.5 to 2", 21.0),  # 1,336 on small cells
        ((1.0, 2.0, 3.01), "observed order 0.0, not 0.5 to 2", 2.01),
        ((math.nan, 2.0, 5.0), "a run has no such result", 3.0),
        ((1.0, 2.0, 2.0), "the results on 2h and h are equal", 1.0),
    ],
)
def test_without_an_order_nothing_is_inferred(values: tuple[float, float, float], reason: str, spread: float) -> None:
    found = error_of(*values)
    assert found.reason == reason
    assert math.isnan(found.limit) and math.isnan(found.order)
    assert found.error == pytest.approx(spread), "the error is the largest difference among the runs"


def cone(radius: float, x: float = 0.0, cell: float = 5.0) -> Map:
    """Return the map of a cone around (x, 0) that is 1 m thick at `radius` from its axis."""
    grid = Grid(-400.0, -400.0, cell, cell, round(800.0 / cell) + 1, round(800.0 / cell) + 1)
    distance = np.hypot(grid.x[None, :] - x, grid.y[:, None])
    return Map(grid, np.maximum(0.0, 1.0 + 0.02 * (radius - distance)), "m", "", "", "")


def test_distance_of_circles_is_the_difference_of_their_outlines() -> None:
    larger = outline_distance(cone(150.0), cone(120.0), 1.0)
    smaller = outline_distance(cone(120.0, cell=10.0), cone(150.0), 1.0)
    assert larger is not None and smaller is not None
    for found, mean in ((larger, 30.0), (smaller, -30.0)):
        assert found.mean == pytest.approx(mean, abs=0.2)
        assert found.rms == pytest.approx(30.0, abs=0.2)
        assert found.largest == pytest.approx(30.0, abs=0.4)
    shift, radius = 12.0, 150.0
    found = outline_distance(cone(radius, shift), cone(radius), 1.0)
    assert found is not None
    along = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)
    exact = np.hypot(radius * np.cos(along) + shift, radius * np.sin(along)) - radius
    assert found.mean == pytest.approx(exact.mean(), abs=0.1)
    assert found.rms == pytest.approx(np.sqrt(np.mean(exact**2)), rel=0.02)
    assert outline_distance(cone(150.0), cone(-200.0), 1.0) is None


GRAINS = """
terrain = { type = "flat", elevation = 0.0 }
basal = { friction = "constant", friction_angle = 20.0 }
heat = { enabled = false }
pressure = { enabled = false }
material.grains = { law = "mohr_coulomb", youngs_modulus = 1.0e7, poisson_ratio = 0.3, friction_angle = 30.0, \
cohesion = 0.0 }
"""
CASE = f"""{GRAINS}
case = {{ title = "column of 20 m", dimension = 2 }}
time = {{ end = 2.0, stepping = "adaptive", output_interval = 2.0, history_interval = 0.5 }}
grid = {{ cell = 2.5, min = [0.0, 0.0], max = [97.5, 27.5] }}
body.column = {{ material = "grains", shape = "box", min = [30.0, 0.0], max = [50.0, 20.0] }}
"""
# A cube of 8 m that collapses, on cells of 8, 4 and 2 m.
CASE_3D = f"""{GRAINS}
case = {{ title = "cube of 8 m", dimension = 3 }}
time = {{ end = 1.0, stepping = "adaptive" }}
grid = {{ cell = 2.0, min = [0.0, 0.0, 0.0], max = [42.0, 32.0, 16.0] }}
body.cube = {{ material = "grains", shape = "box", min = [16.0, 12.0, 0.0], max = [24.0, 20.0, 8.0] }}
"""


@pytest.mark.usefixtures("with_program")
def test_the_command_runs_three_cells_and_reports_errors(tmp_path: Path, capfd: Capture) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    output = tmp_path / "out"
    assert main([str(tmp_path / "case.toml"), "--threads", "1", "--output", str(output)]) == 0
    printed = capfd.readouterr().out
    assert "| result | cells of 10 m | cells of 5 m | cells of 2.5 m | error of the last | extrapolated |" in printed
    found = json.loads((output / "pair.json").read_text())
    assert found["cell_m"] == 2.5
    for factor, name in ((4, "4h"), (2, "2h"), (1, "h")):
        case = tomllib.loads((output / name / "case.toml").read_text())
        assert case["grid"]["cell"] == 2.5 * factor
        assert case["grid"]["max"] == [90.0, 30.0], "a whole number of 10 m"
    error = found["results"]["displacement_m"]
    moved = Run(output / "h").series["mean_displacement_m"][-1]
    assert error["value"] == moved > 0.0
    assert (output / "pair.md").read_text().startswith("# Errors of column of 20 m")


@pytest.mark.usefixtures("with_program")
def test_in_3d_all_runs_have_one_map_cell(tmp_path: Path, capfd: Capture) -> None:
    (tmp_path / "case.toml").write_text(CASE_3D)
    output = tmp_path / "out"
    command = [str(tmp_path / "case.toml"), "--threads", "1", "--output", str(output)]
    assert main(command) == 0, capfd.readouterr().err
    runs = [Run(output / name) for name in ("4h", "2h", "h")]
    cells = [run.maps["max_thickness"].grid.cell_x for run in runs]
    assert cells == [4.0, 4.0, 4.0], "that of the run on cells of 2h"
    found = json.loads((output / "pair.json").read_text())
    assert found["results"]["deposit_area_m2"]["value"] == runs[-1].facts["deposit_area_m2"] > 0.0
    assert found["outline_distance_m"], "of the outlines on the two finer cells"
    assert main(command) == 2, "runs exist"
    assert "has a run already. Add --overwrite" in capfd.readouterr().err


@pytest.mark.usefixtures("with_program")
def test_a_mistake_is_reported_before_any_run(tmp_path: Path, capfd: Capture) -> None:
    (tmp_path / "case.toml").write_text(CASE.replace("friction_angle = 30.0", "friction_angle = 95.0"))
    assert main([str(tmp_path / "case.toml"), "--output", str(tmp_path / "out")]) == 2
    assert "friction_angle" in capfd.readouterr().err
    assert not (tmp_path / "out").exists()
