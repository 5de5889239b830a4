"""Members with initial noise: results, met rows, variants, aligned times; influence of numerical parameters."""

import tomllib

import numpy as np
import pytest
from conftest import MakeRun, column_history, write_history
from force_record_test import pulse, write_record

from reproduction import members, numerics
from reproduction.lamplugh import INVERSION
from reproduction.member_figures import MEMBER, members_over_time, on_common_times
from reproduction.members import Observed, is_met, verdict
from reproduction.study import ROOT
from thawslide import Run
from thawslide.figures.force import force_in_band
from thawslide.figures.force_record import compared

START = 10.0 / np.pi * np.arcsin(np.sqrt(8.0 / 12.0))  # s: 12 sin2(pi t/10) = 8
GOOD = Observed(
    start=20.0, end=220.0, peak=80.0, rise=35.0, displacement=5.7, runout=10.0, stop=180.0, force=0.28, reversal=10.0,
    dilation=5.0, hottest=190.0, ratio=1.0,
)  # fmt: skip
ACCEPTED = {each.name: each for each in members.QUANTITIES}
CASE = {
    "material": {"rock_ice": {"hydraulic_conductivity": 1e-7}}, "substrate": {"glacier": {"friction_coefficient": 0.1}},
    "basal": {"slip_distance": 20.0}, "band": {"thickness": 0.55, "load_time": 1.0, "growth": "none"},
    "pressure": {"frozen_rows": "vented", "skeleton_compressibility": 2e-9}, "heat": {"steam": True},
}  # fmt: skip


def changed(**values: float | str) -> Observed:
    return Observed(**(vars(GOOD) | values))  # type: ignore[arg-type]


def test_observed_has_the_results_of_a_run_and_no_stop_in_motion(make_run: MakeRun) -> None:
    folder = make_run(history=column_history())
    found = members.observed(folder)
    # Below 0.1 m/s from 9.709 s on.
    times = [START, 5.0 - START, 9.8 + 40.0 - START, 50.0 - START]
    assert [found.start, found.rise, found.stop, found.end] == pytest.approx(times, abs=2e-3)
    values = [found.peak, found.displacement, found.runout, found.hottest, found.ratio, found.dilation]
    assert values == pytest.approx([12.0, 0.08, 0.16, 170.0, 1.0, 3.0])
    assert found.force == pytest.approx(np.nanmax(force_in_band(Run(folder), INVERSION)) / 1e12)
    assert found.failure == "" and np.isnan(found.reversal), "no record in the case"
    columns = column_history() | {"mean_velocity_m_s": np.linspace(0.0, 10.0, 101)}
    folder = make_run(name="moving", history=columns, facts={"status": "failed", "message": "it left"})
    found = members.observed(folder)
    assert (found.stop, found.failure) == (float("inf"), "it left")
    assert members.observed(folder.parent / "none").failure == "not run"


def test_reversal_is_that_of_the_force_figure(make_run: MakeRun) -> None:
    time = np.linspace(0.0, 200.0, 2001)
    force = {"seismic_force_x_N": -1e11 * pulse(time, 52.0), "seismic_force_y_N": 1e11 * pulse(time, 60.0)}
    folder = make_run(rows=2001, history=column_history(2001) | {"time_s": time} | force)
    write_record(folder)
    found = compared(Run(folder)).run.reversal
    assert found is not None and 8.0 < found.duration < 20.0
    assert members.observed(folder).reversal == found.duration


def test_rows_are_met_by_the_median_and_pressure_by_every_member() -> None:
    found = [changed(peak=peak) for peak in (60.0, 75.0, 80.0, 87.0, 120.0)]
    assert members.median(found, ACCEPTED["peak"]) == 80.0
    assert all(is_met(found, each) for each in members.QUANTITIES)
    assert is_met([changed(ratio=1.0 + 1e-12)], ACCEPTED["ratio"])
    assert not is_met([*found[:4], changed(ratio=1.01)], ACCEPTED["ratio"])
    assert not is_met([changed(failure="bad"), GOOD], ACCEPTED["ratio"])
    assert "- maximum P over averaged N: not every member ended" in verdict([changed(failure="bad"), GOOD])
    table = members.members_table(found).splitlines()
    peak = "| model | peak of the mean velocity [m/s] | 80 | 72 to 88 | 80.0 | 60.0 to 120.0 | 3 of 5 | yes |"
    assert peak in table
    assert "| bound | maximum P over averaged N |  | at most 1 | 1.000 | 1.000 | 5 of 5 | yes |" in table
    assert table[0].count("|") == table[2].count("|") == 9


def test_verdict_lists_rows_that_are_met_and_not_met() -> None:
    assert verdict([GOOD, GOOD]).endswith("Not met: none.")
    assert verdict([GOOD, GOOD]).startswith(
        "Met:\n\n- observations: 3 of 3 (runout; force, band-passed 35 to 150 s (the band is assumed); vertical force, "
        "10 to 200 s)\n- results of other models: 4 of 4 (peak "
    )
    words = verdict([changed(peak=60.0, ratio=1.2), GOOD, changed(peak=70.0, failure="it\nleft")])
    for line in (
        "results of other models: 3 of 4 (from 8 m/s to the peak; ",
        "physical bounds: 1 of 2 (hottest of any column)\n",
        "peak of the mean velocity: the median is 70.0 m/s (accepted: 72 to 88)",
        "maximum P over averaged N: the maximum is 1.200 (accepted: at most 1)",
    ):
        assert f"- {line}" in words
    assert words.endswith("Excluded from median and range, because they failed: seed 3 (it left).")
    going = [changed(stop=float("inf")), changed(stop=float("inf")), GOOD]
    assert "- stop: at least half of the members have none (accepted: before 200)" in verdict(going)
    assert "| before 200 | not by 220 | 180 to not by 220 | 1 of 3 | **no** |" in members.members_table(going)
    assert "- runout: no member has it (accepted: 9 to 11.5)" in verdict([Observed("not run")])


def test_variants_differ_from_the_case() -> None:
    sets = [row.sets[0] for row in members.variant_rows(CASE)]
    assert len(sets) == 16 and "band.growth_per_slip=1e-12" not in sets
    assert "substrate.glacier.friction_coefficient=0.10" not in sets  # value of this case
    assert {"pressure.frozen_rows=sealed", "band.load_time=2", "heat.steam=false", "band.growth=inertial"} < set(sets)
    grown = [row.sets[0] for row in members.variant_rows(CASE | {"band": CASE["band"] | {"growth": "slip"}})]
    assert "band.growth_per_slip=1e-12" in grown and "band.growth=inertial" not in grown
    other = CASE | {"pressure": {"frozen_rows": "sealed", "skeleton_compressibility": 1e-8}, "heat": {"steam": False}}
    found = [row.sets[0] for row in members.variant_rows(other)]
    assert "pressure.frozen_rows=vented" in found
    assert not {"heat.steam=false", "pressure.skeleton_compressibility=1e-8"} & set(found)


def test_members_differ_in_their_seed_and_have_medians_and_a_middle() -> None:
    named = members.numbers([GOOD, changed(peak=70.0)], {"e-0.35": changed(runout=8.0)})
    assert (named["median_peak"], named["least_peak"], named["most_peak"]) == (75.0, 70.0, 80.0)
    assert named["e_0_35_runout"] == 8.0
    rows = members.member_rows()
    assert [row.sets for row in rows] == [("initial.noise=0.1", f"initial.seed={seed}") for seed in range(1, 21)]
    assert len({row.key for row in rows}) == 20
    found = [changed(peak=78.0), changed(peak=79.0, failure="bad"), changed(peak=81.0, runout=11.0), changed(peak=80.0)]
    assert members.middle_member(found) == 3


def test_members_have_the_times_of_their_runs(make_run: MakeRun) -> None:
    folders = [make_run(name=name) for name in ("one", "two")]
    columns = column_history()
    for folder, late in zip(folders, (0.0, 1.0), strict=True):
        moved = np.interp(columns["time_s"] - late, columns["time_s"], columns["mean_velocity_m_s"])
        write_history(folder / "history.csv", columns | {"mean_velocity_m_s": moved})
        (folder / "inputs" / "targets.csv").write_text(
            "quantity,time_s,value,unit,source\nstart_velocity,40,8,m/s,x\nmean_velocity,40,8,m/s,x\n"
            "mean_velocity,42,11,m/s,x\n"
        )
    runs = [Run(folder) for folder in folders]
    time, values = on_common_times(runs, "mean_velocity_m_s")
    assert (time[0], time[-1]) == (0.0, pytest.approx(runs[0].last_time, abs=0.11))
    np.testing.assert_allclose(values[0][:-10], values[1][10:], atol=0.05)
    np.testing.assert_allclose(np.interp(START, time, values[0]), 8.0, atol=0.05)
    speed, distance = members_over_time(runs).axes
    middle = next(line for line in speed.lines if line.get_label() == "median")
    wide = [line for line in speed.lines if line.get_color() == MEMBER]
    np.testing.assert_allclose([line.get_ydata() for line in wide], values)
    assert all(middle.get_zorder() > line.get_zorder() for line in wide)
    assert all(middle.get_linewidth() < line.get_linewidth() for line in wide)
    assert speed.get_xlabel() == distance.get_xlabel() == "time since the start (s)"
    np.testing.assert_allclose(middle.get_ydata(), np.median(values, axis=0))
    assert distance.get_ylabel() == "mean displacement (km)"
    (marks,) = [line for line in speed.lines if line.get_label() == "reported: x"]
    np.testing.assert_allclose(marks.get_data(), [[START, START + 2.0], [8.0, 11.0]], atol=2e-3)


def test_rows_have_the_multiples_in_their_names() -> None:
    rows = {row.key: row.sets for row in numerics.cell_rows()}
    assert len(rows) == 9
    assert rows["e-0.21-cell-5"] == (
        "band.thickness=0.21", "grid.cell=5", "time.step=0.005", "material.rock_ice.viscosity_time=0.00125",
    )  # fmt: skip
    assert next(iter(rows)).endswith("cell-5"), "the long runs first"
    shifted = {row.key: row.sets for row in numerics.numerics_rows()}
    assert shifted["quarter-shift"] == ("grid.min=[-202.5,197.5]", "grid.max=[13997.5,2397.5]")
    case = tomllib.loads((ROOT / "cases" / "lamplugh-columns" / "case.toml").read_text(encoding="utf-8"))
    rock = case["material"]["rock_ice"]
    assert (case["grid"]["cell"], case["time"]["step"]) == (numerics.CELL, numerics.STEP_PER_CELL * numerics.CELL)
    assert rock["viscosity_time"] == numerics.VISCOSITY_PER_CELL * numerics.CELL
    assert (*case["grid"]["min"], *case["grid"]["max"]) == tuple(numerics.DOMAIN[k] for k in (0, 2, 1, 3))
    rows = {row.key: dict(each.split("=") for each in row.sets) for row in numerics.numerics_rows()}
    factors = {
        "half-modulus": (0.5, 1.0, 1.0), "twice-modulus": (2.0, 1.0, 1.0), "soft": (0.5, 2.0, 1.0),
        "softest": (0.25, 4.0, 1.0), "stiff": (2.0, 0.5, 1.0), "half-viscosity": (1.0, 0.5, 1.0),
        "twice-viscosity": (1.0, 2.0, 1.0), "half-slip": (1.0, 1.0, 0.5), "twice-slip": (1.0, 1.0, 2.0),
        "fine-same-viscosity": (1.0, 1.0, 1.0),
    }  # fmt: skip
    for key, of_row in factors.items():
        for name, factor in zip(("youngs_modulus", "viscosity_time", "softening_slip"), of_row, strict=True):
            value = float(rows[key].get(f"material.rock_ice.{name}", rock[name]))
            assert abs(value / rock[name] - factor) < 1e-9, (key, name)
