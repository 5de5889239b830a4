"""Basal laws written in Python, and erodible beds in polygons from Python."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import CommandLine, assert_identical, history_of, silent
from terrain_files import SOUTH, THICKNESS, WEST, write_rectangle, write_slope

from thawslide import Case, ContactNodes, Simulation, UserError, new_case
from thawslide.basal_law import BasalLaw


def simulated(case: Case | Path, law: BasalLaw | None = None, threads: int = 1) -> Simulation:
    simulation = Simulation(case, threads=threads, on_message=silent, basal_law=law)
    simulation.run()
    return simulation


def coulomb(nodes: ContactNodes) -> np.ndarray:
    """Return the strength by Coulomb's law with 10 degrees, as the case `slope`."""
    return math.tan(10.0 * math.pi / 180.0) * np.maximum(nodes.normal_pressure - nodes.pore_pressure, 0.0)


@pytest.mark.parametrize("threads", [1, 2])
def test_a_law_like_that_of_the_case_gives_bitwise_the_same_run(slope: Path, threads: int) -> None:
    assert_identical(simulated(slope, coulomb, threads).history, simulated(slope).history)


def test_the_strength_of_the_case_gives_bitwise_the_same_run_with_particles_in_the_band(slope: Path) -> None:
    case = Case(slope, {"band.model": "scaled", "basal.cohesion": 1.0e3, "basal.slip_distance": 5.0})
    assert_identical(simulated(case, lambda nodes: nodes.strength).history, simulated(case).history)


def test_contact_nodes_have_the_state_of_the_base(slope: Path) -> None:
    seen: list[ContactNodes] = []

    def law(nodes: ContactNodes) -> np.ndarray:
        seen.append(nodes)
        return nodes.strength

    simulation = Simulation(slope, threads=1, on_message=silent, basal_law=law)
    simulation.run()
    assert 150 < len(seen) <= simulation.step_number  # none without loaded nodes
    first, last = seen[0], seen[-1]
    count = len(last.strength)
    assert last.position.shape == (count, 2) and last.substrate.dtype == np.int32
    assert last.time <= simulation.time and last.dt == pytest.approx(0.005)
    for values in vars(last).values():
        assert isinstance(values, float) or len(values) == count
    assert (first.slip == 0.0).all() and (last.slip >= 0.0).all() and last.slip.max() > 0.0
    heights = 100.0 - 0.5 * last.position[:, 0]
    assert np.abs(last.position[:, 1] - heights).max() < 10.0  # within reach of the slope
    weight = np.sum(simulation.field("mass")) * 9.81 * math.cos(math.atan(0.5))
    assert np.mean([np.sum(each.normal_pressure * each.area) for each in seen]) == pytest.approx(weight, rel=0.25)
    np.testing.assert_array_equal(last.strength, coulomb(last))


def test_one_number_is_the_strength_of_all_nodes(slope: Path) -> None:
    stuck, free = simulated(slope, lambda nodes: 1.0e9), simulated(slope, lambda nodes: 0)
    slow, fast, of_case = (each.history["mean_velocity_m_s"].iloc[-1] for each in (stuck, free, simulated(slope)))
    assert slow < 0.25 * fast and of_case < fast


def test_a_law_remains_after_a_change(slope: Path) -> None:
    simulation = Simulation(slope, threads=1, on_message=silent, basal_law=lambda nodes: 0.0)
    simulation.run(until=0.5)
    simulation.change({"basal.friction_angle": 45.0})
    simulation.run()
    of_law = "band_friction_coefficient"  # that of the case, whose law does not act
    expected = simulated(slope, lambda nodes: 0.0).history
    assert_identical(simulation.history.drop(columns=of_law), expected.drop(columns=of_law))


def test_an_exception_of_a_law_leaves_the_simulation_before_the_step(slope: Path) -> None:
    times: list[float] = []

    def law(nodes: ContactNodes) -> np.ndarray:
        if not times and nodes.time > 0.25:
            times.append(nodes.time)
            raise RuntimeError("no strength")
        return coulomb(nodes)

    simulation = Simulation(slope, threads=1, on_message=silent, basal_law=law)
    with pytest.raises(RuntimeError, match="no strength"):
        simulation.run()
    assert simulation.time == times[0]
    simulation.run()
    assert_identical(simulation.history, simulated(slope).history)


@pytest.mark.parametrize(
    ("strength", "words"),
    [
        (np.nan, r"invalid strength \(found nan Pa; allowed: finite, at least 0\)"),
        (-5.0, "found -5 Pa"), (np.zeros(3000), r"found an array of shape \(3000,\)"), (None, "found a NoneType"),
        ("much", "found a str"),
    ],
)  # fmt: skip
def test_invalid_strengths_are_refused(slope: Path, strength: Any, words: str) -> None:
    simulation = Simulation(slope, threads=1, on_message=silent, basal_law=lambda nodes: strength)
    with pytest.raises(UserError, match=words):
        simulation.step()


def test_a_case_without_basal_friction_is_refused(slope: Path) -> None:
    with pytest.raises(UserError, match="the case has no basal friction"):
        Simulation(Case(slope, {"mechanics.enabled": False}), on_message=silent, basal_law=lambda nodes: 0.0)


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
    command_line("run", tmp_path / "slide", "--output", tmp_path / "run", "--threads", 1, *sets)
    assert_identical(rows, history_of(tmp_path / "run"))

    with pytest.raises(UserError, match="there is no attribute 'deep', which "):
        Simulation(Case(tmp_path / "slide", changes | {"bed.depth": {"attribute": "deep"}}), on_message=silent)
    with pytest.raises(UserError, match="there are no polygons to have it"):
        Case(tmp_path / "slide", {key: value for key, value in changes.items() if key != "bed.outline"})
