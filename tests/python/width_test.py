"""Section with a variable width: extensive columns, and sizes of particles."""

import numpy as np
import pytest
from conftest import MakeRun

from reproduction.lamplugh import deposit
from thawslide.figures.snapshots import particle_size
from thawslide.key_numbers import found_for
from thawslide.run_folder import Run
from thawslide.targets import Target

WIDENING = "{ x = [20.0, 40.0], value = [10.0, 40.0] }"


def test_relative_width_is_one_at_the_first_place(make_run: MakeRun) -> None:
    run = Run(make_run(width=WIDENING))
    assert (run.width, run.per_metre) == (10.0, False)
    assert run.relative_width(np.array([0.0, 20.0, 30.0, 40.0, 900.0])).tolist() == [1.0, 1.0, 2.5, 4.0, 4.0]
    run = Run(make_run(name="one", width=10.0))
    assert run.width == 10.0 and run.relative_width(np.array([0.0, 900.0])).tolist() == [1.0, 1.0]
    assert Run(make_run(name="none", width=0.0)).per_metre


def test_volume_and_size_of_particles_include_the_width(make_run: MakeRun) -> None:
    volume = Target("source_volume", 0.0, 1.0, "m3", "survey")
    assert found_for(Run(make_run(width=WIDENING)), volume) == "800 m³", "80 particles of 1 m3 per metre of 10 m"
    run = Run(make_run(name="wide", width=WIDENING))
    shot, one = run.snapshot(0), Run(make_run(name="one"))
    expected = particle_size(one, one.snapshot(0)) / np.sqrt(run.relative_width(shot.points[:, 0]))
    assert particle_size(run, shot) == pytest.approx(expected, rel=1e-15)
    assert expected.min() < 0.6 * expected.max(), "the body is across the widening"


def test_thickness_of_the_deposit_is_area_over_length(make_run: MakeRun) -> None:
    run = Run(make_run(width=WIDENING, snapshots=1))  # a block 4 m high and 20 m long at its start
    x, thickness = deposit(run)
    assert x[0] == 50.0
    shot = run.snapshot(0)
    areas = run.section_areas(shot)
    assert areas == pytest.approx(np.asarray(shot["volume"]) / run.relative_width(shot.points[:, 0]))
    assert thickness[0] == pytest.approx(areas.sum() / 100.0)
