"""Reports of runs with an erodible bed, in which the number of particles changes."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun
from figures_test import line, texts, titled

from thawslide import NotInRunError, Run
from thawslide.figures import FIGURES
from thawslide.figures.entrainment import entrained_depth
from thawslide.key_numbers import key_numbers
from thawslide.report_page import figures_of, make_report

BED_DENSITY, JOINED = 900.0, 8  # kg/m3; particles of the bed in the last snapshot


@pytest.fixture
def bed_run(make_run: MakeRun) -> Path:
    t = np.linspace(0.0, 10.0, 101)
    columns = {
        "entrained_mass_kg": 2e4 * t, "entrained_volume_m3": 2e4 * t / BED_DENSITY, "entrained_work_J": 1e6 * t,
        "entrained_heat_J": 4e5 * t, "loose_mass_kg": np.full(101, 1e3), "bed_mass_kg": 1e6 - 2e4 * t,
        "bed_residual_kg": np.zeros(101), "bed_residual_J": np.zeros(101),
    }  # fmt: skip
    tables = '[body.block]\nmaterial = "rock"\n[bed]\nlaw = "momentum"\ndepth = 1.0\n'
    folder = make_run(history=columns, tables=tables)
    with h5py.File(folder / "snapshots" / "000010.vtkhdf", "r+") as file:
        group = file["VTKHDF"]
        for owner, name in [(group, "Points"), *((group["PointData"], name) for name in list(group["PointData"]))]:
            values = owner[name][:]
            joined = values[:JOINED].copy()
            if name == "id":
                joined += len(values)
            if name == "body":
                joined[:] = 1
            if name == "mass":
                joined[:] = 900.0
            if name == "displacement":
                joined[:, 0] = group["Points"][:JOINED, 0] - 60.5  # all of one cell, from 59 to 61 m
            unit = owner[name].attrs.get("unit")
            del owner[name]
            owner.create_dataset(name, data=np.concatenate([values, joined]))
            if unit is not None:
                owner[name].attrs["unit"] = unit
    return folder


def test_entrained_depth_is_at_the_place_of_joining(bed_run: Path) -> None:
    edges, depth = entrained_depth(Run(bed_run))
    cell = int(np.searchsorted(edges, 60.5)) - 1
    assert edges[cell + 1] - edges[cell] == 8.0
    assert depth[cell] == pytest.approx(JOINED * 1.0 / 8.0)  # 1 m3 each per metre of width, in four cells 2 m wide
    assert np.count_nonzero(depth) == 1


def test_entrainment_has_a_figure_and_a_key_number(bed_run: Path) -> None:
    run = Run(bed_run)
    assert "entrainment" in figures_of(run)
    figure = FIGURES["entrainment"].plot(run)
    np.testing.assert_allclose(line(titled(figure, "(b)"), "work of entrainment")[1][-1], 10.0)  # MJ
    assert {row.words: row.value for row in key_numbers(run)}["Entrained bed volume"] == "222 m³"


def test_panels_without_entrainment_say_so(bed_run: Path) -> None:
    run = Run(bed_run)
    for name in ("entrained_mass_kg", "entrained_volume_m3", "entrained_work_J", "entrained_heat_J"):
        run.series[name][:] = 0.0
    figure = FIGURES["entrainment"].plot(run)
    for panel in ("(b)", "(c)"):
        assert "no entrainment" in texts(titled(figure, panel)) and not titled(figure, panel).lines


def test_report_accepts_more_particles_at_the_end(bed_run: Path) -> None:
    report = make_report(Run(bed_run), names=["velocity", "entrainment", "energy"], dpi=40)
    assert set(report.figures) == {"velocity", "entrainment", "energy"}


def test_run_without_a_bed_has_no_such_figure(make_run: MakeRun) -> None:
    run = Run(make_run())
    assert "entrainment" not in figures_of(run)
    with pytest.raises(NotInRunError, match=r"found no \[bed\] in the case"):
        FIGURES["entrainment"].plot(run)
