"""Measures of Sec. 4, and point masses on a profile."""

import math
from pathlib import Path

import numpy as np
import pytest
from conftest import MakeRun, change_snapshot, write_history
from figure_parts import texts, titled

from reproduction import lamplugh
from reproduction.engine import at_rest
from reproduction.lamplugh import FRONT, base_traction, block_measures, near_ground, read_block, zone_fractions, zones
from reproduction.one_at_a_time import end_of, outcome
from reproduction.point_masses import GRAVITY, Friction, move, smooth_profile
from reproduction.runs import LAMPLUGH_BLOCKS
from thawslide import Run
from thawslide.figures.snapshots import Zone, velocity


def write_ground(folder: Path) -> None:
    """Write a slope of 48 degrees to 1 km, a ramp of 8 to 2 km, a floor of 1.3 beyond."""
    x = np.arange(0.0, 12000.0, 10.0)
    slope = np.where(x < 1000.0, 48.0, np.where(x < 2000.0, 8.0, 1.3))
    z = 2150.0 - np.concatenate(([0.0], np.cumsum(10.0 * np.tan(np.radians(slope[:-1])))))
    write_history(folder / "terrain.csv", {"distance_m": x, "terrain_elevation_m": z})


def test_zones_adjoin_and_contain_their_fraction_of_the_volume(make_run: MakeRun) -> None:
    folder = make_run()
    write_ground(folder)
    found = zones(Run(folder))
    assert "".join(zone.letter for zone in found) == "BCDEF"
    assert [zone.end for zone in found[:-1]] == [zone.start for zone in found[1:]]
    assert found[0].start == pytest.approx(1000.0, abs=20.0)
    assert (found[0].end, found[-1].end) == (pytest.approx(2000.0, abs=20.0), FRONT)
    # A quarter of the particles into each of B, D and F, another beyond the front.
    points = Run(folder).snapshot(10).points.copy()
    points[:, 0] = np.repeat([1500.0, 0.5 * (found[2].start + found[2].end), 10000.0, 11000.0], 20)
    change_snapshot(folder, 10, points=points)
    fractions = zone_fractions(Run(folder))
    assert {letter: fraction for letter, (fraction, _) in fractions.items()} == dict(B=25, C=0, D=25, E=0, F=25)
    assert fractions["F"][1] == pytest.approx(0.25 * 80.0 / 1000.0)  # 80 particles of 1 m3


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


def test_outcome_has_the_results_of_a_run_and_rest_differs_from_a_pause(make_run: MakeRun) -> None:
    found = outcome(make_run())
    values = [found.peak, found.peak_time, found.displacement, found.runout, found.front, found.length]
    assert values == pytest.approx([12.0, 5.0, 80.0, 160.0, 120.0, 19.0])
    assert found.start_time == pytest.approx(3.0409, abs=2e-3)  # 12 sin2 = 8
    assert found.stop_time == pytest.approx(9.7, abs=0.1) and (found.failure, end_of(found)) == ("", "stopped")
    times = [float(t) for t in range(121)]
    moving = [max(0.0, 10.0 - abs(t - 50.0)) for t in times]
    assert not at_rest(times[:30], moving[:30]) and not at_rest(times[:66], moving[:66])
    assert at_rest(times[:72], moving[:72]) and at_rest(times, [0.3] * 121)
    assert not at_rest([], [])


X = np.arange(0.0, 4000.0, 10.0)
PLANE, BENT = (smooth_profile(X, z) for z in (2000.0 - 0.5 * X, np.where(X < 1000.0, 1500.0 - 0.5 * X, 1000.0)))
ANGLE = np.arctan(0.5)


def friction(*coefficients: float) -> Friction:
    """Return one coefficient for each sample, everywhere."""
    values = np.array(coefficients)[:, None]
    return Friction(values, values, np.full_like(values, 50.0), values, 1e9)


def test_a_point_on_a_plane_has_the_closed_form() -> None:
    found = move(PLANE, np.array([500.0]), np.zeros((2, 1)), friction(0.1, 0.3), 10.0, 0.01, chained=False)
    for sample, coefficient in enumerate((0.1, 0.3)):
        down = GRAVITY * (np.sin(ANGLE) - coefficient * np.cos(ANGLE))
        inner = slice(5, -5)
        assert found.up[sample, inner] == pytest.approx(down * np.sin(ANGLE), rel=1e-3)
        assert found.along[sample, inner] == pytest.approx(-down * np.cos(ANGLE), rel=1e-3)

    held = move(PLANE, np.array([500.0]), np.zeros((1, 1)), friction(0.6), 2.0, 0.01, chained=False)
    assert np.all(held.up == 0.0) and np.all(held.along == 0.0)


def test_momentum_is_the_integral_of_the_force_past_a_bend() -> None:
    found = move(BENT, np.array([700.0]), np.zeros((1, 1)), friction(0.0), 20.0, 0.005, chained=False)
    speed = -np.cumsum(found.along[0]) * 0.005
    drop = np.interp(700.0, BENT.x, BENT.z) - BENT.z[-1]
    assert speed[-10] == pytest.approx(np.sqrt(2.0 * GRAVITY * drop), rel=5e-3)
    assert np.sum(found.up[0]) * 0.005 == pytest.approx(0.0, abs=0.2)


@pytest.mark.parametrize("chained", [False, True])
def test_a_part_that_is_held_leaves_later(chained: bool) -> None:
    starts = np.array([[0.0, 0.0, 3.0, 3.0]])
    found = move(PLANE, np.array([600.0, 580.0, 560.0, 540.0]), starts, friction(0.2), 6.0, 0.01, chained)
    before, after = found.up[0, 200], found.up[0, 500]
    assert after == pytest.approx(2.0 * before, rel=1e-2)


def test_a_chain_has_one_acceleration() -> None:
    places = np.array([1100.0, 700.0])  # on the flat, and on the slope
    found = move(BENT, places, np.zeros((1, 2)), friction(0.0), 2.0, 0.01, chained=True)
    common = 0.5 * GRAVITY * np.sin(ANGLE)
    inner = slice(5, -5)
    assert found.along[0, inner] == pytest.approx(-0.5 * common * (1.0 + np.cos(ANGLE)), rel=1e-3)
    assert found.up[0, inner] == pytest.approx(0.5 * common * np.sin(ANGLE), rel=1e-3)


def test_zones_are_between_dotted_lines(make_run: MakeRun) -> None:
    run = Run(make_run())
    left, right = titled(velocity(run), "whole profile").get_xlim()
    ends = np.linspace(left, right, 5)
    names = [Zone("B", ends[1], ends[2]), Zone("C", ends[2], ends[3]), Zone("far", right, right + 10.0)]
    profile = titled(velocity(run, names), "whole profile")
    dotted = [line.get_xdata()[0] for line in profile.lines if line.get_linestyle() == ":"]
    assert dotted == pytest.approx(ends[1:4])
    assert texts(profile) == ["B", "C"]


def test_profile_of_a_deposit_states_its_exaggeration(make_run: MakeRun, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lamplugh, "deposit", lambda run: (np.array([50.0, 150.0]), np.array([3.0, 4.0])))
    monkeypatch.setattr(lamplugh, "zones", lambda run: [])
    figure = lamplugh.figure_deposit({"lamplugh": Run(make_run())})
    section = figure.axes[0]
    width, height = figure.get_size_inches() * section.get_position().size
    (left, right), (low, top) = section.get_xlim(), section.get_ylim()
    times = 1e3 * (right - left) / width * height / (top - low)
    assert section.get_title(loc="left") == f"(a) profile, vertical exaggeration {times:.2g}×"
