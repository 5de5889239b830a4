"""Memory of a worker: the estimate covers all members."""

from pathlib import Path

import pytest

from thawslide.program import find_program
from thawslide.sweeps import resources
from thawslide.sweeps.design import Design
from thawslide.sweeps.resources import bytes_of_worker, workers_that_fit
from thawslide.sweeps.variables import Uniform


def test_the_estimate_combines_the_extremes_of_all_keys(slope: Path, with_program: None) -> None:
    sizes = (Uniform("grid.cell", 1.0, 4.0), Uniform("body.block.particles_per_axis", 1.0, 4.0))

    def need(cell: float, particles: float) -> float:
        program = find_program()
        assert program
        changes = {"grid.cell": cell, "body.block.particles_per_axis": round(particles)}
        found = resources._need(program, str(slope), changes)
        assert found
        return found

    members = Design((str(slope),), sizes, "lhs", 4, 1).members()
    for member in members:
        member.changes["body.block.particles_per_axis"] = round(member.changes["body.block.particles_per_axis"])
    cells, particles = ([member.changes[key] for member in members] for key in members[0].changes)
    found = bytes_of_worker(members)
    assert found == pytest.approx(0.4e9 + 1.2 * need(min(cells), max(particles)))
    assert found >= max(0.4e9 + 1.2 * need(*member.changes.values()) for member in members)


def test_at_least_one_worker_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(resources, "available_bytes", lambda: 10e9)
    assert [workers_that_fit(8, need) for need in (None, 1e9, 4e9, 20e9)] == [8, 8, 2, 1]
