"""Measures of Sec. 4, and rows of the one-at-a-time table, on constructed run folders."""

import math
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun

from reproduction.engine import at_rest
from reproduction.lamplugh import FRONT, base_traction, block_measures, near_ground, read_block, zone_fractions, zones
from reproduction.one_at_a_time import Outcome, end_of, outcome, table, table_row
from reproduction.runs import LAMPLUGH_BLOCKS
from reproduction.study import Job
from thawslide.run_folder import Run


def write_ground(folder: Path) -> None:
    """Write a slope of 48 degrees to 1 km, a ramp of 8 to 2 km, a floor of 1.3 beyond."""
    x = np.arange(0.0, 12000.0, 10.0)
    slope = np.where(x < 1000.0, 48.0, np.where(x < 2000.0, 8.0, 1.3))
    z = 2150.0 - np.concatenate(([0.0], np.cumsum(10.0 * np.tan(np.radians(slope[:-1])))))
    rows = "".join(f"{a!r},{b!r}\n" for a, b in zip(x.tolist(), z.tolist(), strict=True))
    (folder / "terrain.csv").write_text("distance_m,terrain_elevation_m\n" + rows)


def test_zones_adjoin_and_contain_their_fraction_of_the_volume(make_run: MakeRun) -> None:
    folder = make_run()
    write_ground(folder)
    found = zones(Run(folder))
    assert "".join(zone.letter for zone in found) == "BCDEF"
    assert [zone.end for zone in found[:-1]] == [zone.start for zone in found[1:]]
    assert found[0].start == pytest.approx(1000.0, abs=20.0)
    assert (found[0].end, found[-1].end) == (pytest.approx(2000.0, abs=20.0), FRONT)
    # A quarter of the particles into each of B, D and F, another beyond the front.
    with h5py.File(folder / "snapshots" / "000010.vtkhdf", "r+") as file:
        points = file["VTKHDF/Points"]
        x = np.repeat([1500.0, 0.5 * (found[2].start + found[2].end), 10000.0, 11000.0], len(points) // 4)
        points[:, 0] = x
        volume = float(np.sum(file["VTKHDF/PointData/volume"]))
    fractions = zone_fractions(Run(folder))
    assert {letter: fraction for letter, (fraction, _) in fractions.items()} == dict(B=25, C=0, D=25, E=0, F=25)
    assert fractions["F"][1] == pytest.approx(0.25 * volume / 1000.0)


def test_base_traction_and_particles_near_the_terrain(make_run: MakeRun) -> None:
    folder = make_run(rows=201, history={"mean_velocity_m_s": 50.0 - 0.8 * np.linspace(0.0, 10.0, 201)})
    (folder / "terrain.csv").write_text("distance_m,terrain_elevation_m\n-1e4,0.0\n1e4,0.0\n")
    run = Run(folder)
    x = np.sort(run.snapshot(0).points[:, 0])
    # 80 particles of 2,000 kg on 20 m in rows of 4: 0.5 % and 99.5 % of the mass are the first and the last of them.
    assert base_traction(run, 2.0, 8.0) == pytest.approx(80 * 2000.0 * 0.8 / (x[-1] - x[0]) / 1e3)
    assert math.isnan(base_traction(run))
    # Rows 0.5, 1.5, 2.5 and 3.5 m up a slope of one half: 0.447, 1.342, 2.236, 3.130 m normal to it, two per 2 m.
    run = Run(make_run(name="near"))
    assert near_ground(run, 0.0, height=1.3, column=2.0) == 2.0
    assert near_ground(run, 0.0, height=1.4, column=2.0) == 4.0


def test_measures_of_blocks_are_those_of_their_histories(make_run: MakeRun) -> None:
    folder = make_run()
    header = "time_s,velocity_m_s,displacement_m,sliding_strength_Pa,driving_traction_Pa\n"
    for block in LAMPLUGH_BLOCKS:
        rows = "0,0,0,90,100\n1,4,2,50,100\n2,0,4,50,100\n3,0,4,50,9\n"
        (folder.parent / f"{block.key}.csv").write_text(header + rows)
    found = block_measures(Run(folder))
    assert (found["lamplugh_block_561_peak"], found["lamplugh_block_561_stop"]) == (4.0, 2.0)
    assert (found["lamplugh_block_561_safety"], found["lamplugh_block_displacement"]) == (0.9, 4.0)
    assert read_block(folder.parent / "lamplugh-block.csv")["time_s"].tolist() == [0, 1, 2, 3]


def test_rest_differs_from_a_pause_at_the_start() -> None:
    times = [float(t) for t in range(121)]
    moving = [max(0.0, 10.0 - abs(t - 50.0)) for t in times]
    assert not at_rest(times[:30], moving[:30]) and not at_rest(times[:66], moving[:66])
    assert at_rest(times[:72], moving[:72]) and at_rest(times, [0.3] * 121)
    assert not at_rest([], [])


def test_outcome_has_the_results_of_a_run(make_run: MakeRun) -> None:
    found = outcome(make_run())
    assert (found.failure, found.peak) == ("", pytest.approx(12.0))
    assert found.peak_time == pytest.approx(5.0)
    assert found.start_time == pytest.approx(3.0409, abs=2e-3)  # 12 sin2 = 8
    assert (found.stop_time, found.displacement) == (pytest.approx(9.7, abs=0.1), pytest.approx(80.0))
    assert (found.runout, found.front) == (pytest.approx(160.0), pytest.approx(120.0))
    assert (end_of(found), found.length) == ("stopped", pytest.approx(19.0))


def test_rows_state_failures() -> None:
    row = Job("x", "x", ("a=1", "b=2"), "other.toml")
    empty = "| x | not run | | | | | | | | | [other.toml](other.toml) `a=1` `b=2` |"
    assert table_row(row, Outcome("not run")) == empty
    still = Outcome(peak=0.4, peak_time=1.0, displacement=0.0, runout=1000.0, length=1000.0, end_time=100.0)
    assert "| never | does not start |" in table_row(row, still)
    broken = Outcome("bad\nnews", 9.0, 1.0, 1.0, math.nan, 5.0, 6.0, 4.0, 7.0, 8.0, 33.0, 9.0)
    assert "failed at 33" in table_row(row, broken)
    assert table([row], {"x": broken}, ["a=1"]).endswith("[other.toml](other.toml) `b=2` |\n\n- x: `bad news`\n")
    going = Outcome("", 9.0, 1.0, 1.0, math.nan, 5.0, 6.0, 4.0, 7.0, 8.0, 200.0, 9.0)
    assert "not: 9 m/s at 200" in table_row(row, going)
    assert [end_of(each) for each in (Outcome(), still, broken, going)] == ["missing", "never", "broken", "going"]
