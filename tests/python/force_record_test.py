"""Force of a run compared with one inverted from seismic waves and with reported values; the band-pass filter."""

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import TARGETS, MakeRun, history_columns, numbers, page_of, write_history
from figure_parts import line
from matplotlib.collections import FillBetweenPolyCollection
from wrong_tables import FORCE_RANGE, FORCES, HEADER, WRONG_FORCES

from thawslide import NotInRunError, ReportError, Run
from thawslide.band_pass import band_passed, response
from thawslide.figures import FIGURES
from thawslide.figures.force import force_in_band, reported_bands, seismic_force
from thawslide.figures.force_record import compared, filtered
from thawslide.force_record import ForceRecord, projected, projected_ends, read_force_record, reversal, travel_azimuth
from thawslide.key_numbers import found_for, quantity_text
from thawslide.report_page import make_report
from thawslide.targets import Band, Target, band_of

BAND = Band(10.0, 200.0)
AZIMUTH = 30.0  # of the records made here


def pulse(time: np.ndarray, middle: float) -> np.ndarray:
    """Return a vertical force on the Earth that is first upward, then downward, and 0 in the middle."""
    s = (time - middle) / 6.0
    return np.asarray(-s * np.exp(-0.5 * s * s))


def push(time: np.ndarray) -> np.ndarray:
    """Return a horizontal force on the Earth of a mass that is accelerated and then braked: backward first."""
    return -pulse(time, 52.0)


def write_record(folder: Path) -> None:
    """Add a record to a run: half of its force, 7 s earlier, towards AZIMUTH."""
    time = np.arange(-20.0, 121.0)
    up, along = 5e10 * pulse(time + 7.0, 60.0), 5e10 * push(time + 7.0)
    angle = np.radians(AZIMUTH)
    rows = zip(time, up, along * np.cos(angle), along * np.sin(angle), strict=True)
    text = "".join(",".join(repr(float(each)) for each in row) + "\n" for row in rows)
    (folder / "inputs" / "force.csv").write_text(FORCES + text)
    keys = 'force_record = "inputs/force.csv"\nforce_periods = [10.0, 200.0]\nforce_source = "A survey"\n'
    with (folder / "case.toml").open("a") as case:
        case.write(keys)


@pytest.fixture
def folder(make_run: MakeRun) -> Path:
    """Return a run of 200 s whose vertical force passes 0 at 60 s, with a record."""
    made = make_run()
    write_long_run(made)
    write_record(made)
    return made


def write_long_run(folder: Path, towards: float = 1.0) -> None:
    columns, time = history_columns(2001, 2), np.linspace(0.0, 200.0, 2001)
    columns |= {
        "time_s": time, "front_position_m": 40.0 + towards * time, "seismic_force_x_N": towards * 1e11 * push(time),
        "seismic_force_y_N": 1e11 * pulse(time, 60.0),
    }  # fmt: skip
    write_history(folder / "history.csv", columns)


def test_curves_are_the_filtered_history_and_of_equal_forces_coincide(folder: Path) -> None:
    run = Run(folder)
    figure = FIGURES["force_record"].plot(run)
    for axes in figure.axes[:2]:
        time, values = line(axes, "run")
        record_time, reference = line(axes, "A survey, time shifted by +7.0 s")
        assert record_time[0] == pytest.approx(-13.0, abs=0.01) and record_time[-1] == pytest.approx(127.0, abs=0.26)
        inside = time <= record_time[-1]
        difference = np.interp(time[inside], record_time, reference) - 0.5 * values[inside]
        assert np.abs(difference).max() < 0.005 * values.max(), "linear between rows one second apart"
        assert np.abs(values).max() > 20.0, "GN"
    vertical, along = figure.axes
    assert (vertical.get_ylabel(), along.get_xlabel()) == ("force (GN)", "time since the start (s)")
    assert along.get_title(loc="left").endswith("(record: azimuth 30°)")
    of_run, of_record = (each.reversal for each in (compared(run).run, compared(run).record))
    assert of_run is not None and of_record is not None
    assert of_run.zero == pytest.approx(60.0, abs=0.02) == of_record.zero
    assert of_run.duration == pytest.approx(of_record.duration, abs=0.05)
    times = f"inversion {of_record.duration:.1f} s, run {of_run.duration:.1f} s."
    words = f"From maximum upward to maximum downward force: {times}"
    assert figure.get_supxlabel().replace("\n", " ") == words, "below the panels, away from the curves"
    assert not figure.axes[0].texts
    time = run.series["time_s"]
    for panel, axis in ((0, "y"), (1, "x")):
        curve_time, curve = line(figure.axes[panel], "run")
        expected = filtered(time, run.series[f"seismic_force_{axis}_N"], curve_time, BAND)
        np.testing.assert_allclose(1e9 * curve, expected, atol=1e-6 * np.abs(expected).max())
        assert curve_time[0] >= 0.0 > line(figure.axes[panel], "filter response before the run")[0].max()
    forward = compared(Run(folder)).run.along
    write_long_run(folder, towards=-1.0)
    np.testing.assert_allclose(compared(Run(folder)).run.along, forward)


def test_range_surrounds_the_record(folder: Path) -> None:
    time = np.arange(-20.0, 121.0)
    up = 1e11 * pulse(time, 50.0)
    columns = (time, up, -up, 0 * up, up - 1e9, up + 2e9, -up - 3e9, -up + 4e9, 0 * up - 5e9, 0 * up + 6e9)
    rows = (",".join(map(str, row)) + "\n" for row in zip(*columns, strict=True))
    (folder / "inputs" / "force.csv").write_text(FORCE_RANGE + "".join(rows))
    run = Run(folder)
    figure = FIGURES["force_record"].plot(run)
    assert np.radians(compared(run).azimuth) == pytest.approx(0.0)
    for axes, low, high in zip(figure.axes, (1.0, 3.0), (2.0, 4.0), strict=False):
        (band,) = [found for found in axes.collections if isinstance(found, FillBetweenPolyCollection)]
        (curve,) = [found for found in axes.lines if "A survey" in str(found.get_label())]
        at, best = curve.get_data()
        corners = band.get_paths()[0].vertices
        for middle in (10, len(at) // 2, len(at) - 10):
            heights = corners[np.abs(corners[:, 0] - at[middle]) < 1e-6, 1]
            ends = (best[middle] - low, best[middle] + high)
            assert (heights.min(), heights.max()) == pytest.approx(ends, abs=1e-6)


def test_projection_is_a_component_and_its_range_bounds_all() -> None:
    north, east = np.array([3.0, -1.0, 0.0]), np.array([4.0, 2.0, 5.0])
    np.testing.assert_allclose(projected(north, east, 0.0), north)
    np.testing.assert_allclose(projected(north, east, 90.0), east, atol=1e-15)
    np.testing.assert_allclose(projected(north, east, -180.0), -north, atol=1e-15)
    for azimuth in np.arange(-180.0, 180.0, 17.0):
        across = projected(north, east, azimuth + 90.0)
        np.testing.assert_allclose(projected(north, east, azimuth) ** 2 + across**2, north**2 + east**2)
        assert projected(north, east, float(np.degrees(np.arctan2(east[0], north[0]))))[0] == pytest.approx(5.0)
    low = {"north": np.array([-2.0]), "east": np.array([1.0])}
    high = {"north": np.array([1.0]), "east": np.array([3.0])}
    inside = [each.ravel() for each in np.meshgrid(np.linspace(-2.0, 1.0, 7), np.linspace(1.0, 3.0, 7))]
    for azimuth in np.arange(-180.0, 180.0, 15.0):
        values = projected(*inside, azimuth)
        assert np.ravel(projected_ends(low, high, azimuth)) == pytest.approx([values.min(), values.max()])


@pytest.mark.parametrize("azimuth", [-170.0, -45.0, 0.0, 5.0, 90.0, 135.0])
def test_direction_of_travel_is_that_of_the_momentum(azimuth: float) -> None:
    """The reaction of a mass that is accelerated and then braked is first backward, then forward."""
    time = np.linspace(0.0, 100.0, 401)
    force = -np.sin(2.0 * np.pi * time / 100.0)
    angle = np.radians(azimuth)
    best = {"up": 0.0 * time, "north": force * np.cos(angle), "east": force * np.sin(angle)}
    assert travel_azimuth(ForceRecord(time, best, {}, {}, BAND, "")) == pytest.approx(azimuth)


def test_reversal_is_interpolated_between_rows() -> None:
    for start in (0.0, 0.1, 0.37):
        time = start + np.arange(0.0, 100.0, 0.5)
        found = reversal(time, np.where((time > 10.0) & (time < 50.0), np.sin(2.0 * np.pi * (time - 10.0) / 40.0), 0.0))
        assert found is not None and (found.upward, found.downward) == pytest.approx((20.0, 40.0), abs=2e-3)
        assert found.zero == pytest.approx(30.0, abs=1e-3) and found.duration == pytest.approx(20.0, abs=4e-3)
    assert reversal(time, np.ones_like(time)) is None and reversal(time, -np.ones_like(time)) is None
    assert reversal(time, time - 50.0) is None, "downward first"


def test_history_is_extended_by_its_end_values() -> None:
    time, at = np.array([0.0, 1.0, 2.0]), np.arange(-100.0, 100.0, 1.0)
    np.testing.assert_allclose(filtered(time, np.full(3, 7.0), at, BAND), 0.0, atol=1e-12)
    rises = filtered(time, np.array([np.nan, 0.0, 1.0]), at, BAND)
    assert rises[at == 3.0][0] > 0.2 > abs(rises[at == -60.0][0]), "a row without a number counts as 0"
    # Without padding, the jump to 0 at the end would change the result by 0.5.
    short, long = np.arange(0.0, 100.0, 0.1), np.arange(-3000.0, 3000.0, 0.1)
    step = [np.where(time < 40.0, 0.0, 1.0) for time in (short, long)]
    at = np.arange(-50.0, 150.0, 0.5)
    padded, whole = (filtered(time, values, at, BAND) for time, values in zip((short, long), step, strict=True))
    assert np.abs(whole).max() > 0.5
    np.testing.assert_allclose(padded, whole, atol=0.02)
    # Exact value at 45 s, from the response of the filter to a step.
    exact = np.trapezoid(response(f := np.linspace(1e-6, 2.0, 400001), 10.0, 200.0) * np.sin(2.0 * np.pi * f * 5.0)
                         / (np.pi * f), f)  # fmt: skip
    assert np.interp(45.0, at, padded) == pytest.approx(float(exact), abs=0.02)


def test_runs_without_a_reversal_or_before_the_record_are_plotted(folder: Path) -> None:
    columns = history_columns(2001, 2) | {f"seismic_force_{axis}_N": np.zeros(2001) for axis in "xy"}
    write_history(folder / "history.csv", columns | {"time_s": np.linspace(0.0, 200.0, 2001)})
    run = Run(folder)
    found = compared(run)
    assert (found.is_aligned, found.shift) == (False, 0.0)
    words = "Times are not aligned, because one of the vertical forces does not reverse."
    assert words in FIGURES["force_record"].caption_of(run)
    assert line(FIGURES["force_record"].plot(run).axes[0], "A survey, times not aligned")[0][0] == -20.0
    columns = {name: values[:3] for name, values in history_columns(2001, 2).items()}
    write_history(folder / "history.csv", columns | {"time_s": np.array([-90.0, -80.0, -70.0])})
    assert not line(FIGURES["force_record"].plot(Run(folder)).axes[0], "filter response before the run").size


def test_caption_has_the_difference_of_two_inversions(folder: Path) -> None:
    (folder / "inputs" / "targets.csv").write_text(
        HEADER + "max_seismic_force_35_150_s,5,280,GN,Others\nmax_seismic_force,5,70,GN,Them\n"
        "max_seismic_force_2_8_s,5,1,GN,Third\n"
    )
    run = Run(folder)
    record = run.force_record
    assert record is not None
    parts = [filtered(record.time, record.best[part], record.time, Band(35.0, 150.0)) for part in record.best]
    of_record = float(np.sqrt(sum(part**2 for part in parts)).max()) / 1e9
    words = FIGURES["force_record"].caption_of(run)
    for text in (
        "(A survey). Both are filtered to periods of 10 to 200 s by the same filter",
        "Times of the record are shifted by +7.0 s to align the sign reversals",
        "for the record, the azimuth of the maximum horizontal momentum, 30°;",
        "Maximum force without a specified band, compared in 10 to 200 s (Them): 70 GN reported. ",
    ):
        assert text in words
    (of_others,) = re.findall(
        r"Maximum force in 35 to 150 s \(Others\): 280 GN reported\. The record has ([\d.]+) GN, "
        r"the run ([\d.]+) GN\. The two inversions differ by a factor of ([\d.]+)\.",
        words,
    )
    record_force, run_force, factor = map(float, of_others)
    assert record_force == pytest.approx(of_record, rel=0.01)
    assert (run_force, factor) == pytest.approx((2.0 * of_record, 280.0 / of_record), rel=0.03)
    assert re.search(r"in 2 to 8 s \(Third\): 1 GN reported\. The run has [\d.]+ GN\.", words), "not in the record"
    page = page_of(folder, "force_record")
    assert '<h2 id="figure-force_record">' in page and "The two inversions differ by a factor of" in page


def test_x_is_east_in_three_dimensions(make_run: MakeRun) -> None:
    time, angle = np.linspace(0.0, 200.0, 2001), np.radians(AZIMUTH)
    along, up = 1e11 * push(time), 1e11 * pulse(time, 60.0)
    force = {
        "seismic_force_x_N": along * np.sin(angle), "seismic_force_y_N": along * np.cos(angle), "seismic_force_z_N": up,
    }  # fmt: skip
    made = make_run(dimension=3, rows=2001, history={"time_s": time} | force)
    write_record(made)
    found = compared(Run(made))
    np.testing.assert_allclose(found.run.along, filtered(time, along, found.run.time, BAND), atol=2e7)
    assert "with x as east and y as north" in FIGURES["force_record"].caption_of(Run(made))


def test_figure_requires_a_record_and_a_width(make_run: MakeRun) -> None:
    run = Run(make_run())
    assert not FIGURES["force_record"].suits(run)
    with pytest.raises(NotInRunError, match=r"^case\.toml: no force record\. "):
        compared(run)
    made = make_run(name="thin", width=0.0)
    write_record(made)
    report = make_report(Run(made), names=None, dpi=40)
    reason = "case.toml: the force record cannot be compared without a width. Specify case.width."
    assert report.missing["force_record"] == reason and not report.faults


@pytest.mark.parametrize(("text", "message"), WRONG_FORCES)
def test_invalid_record_is_an_error(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "force.csv").write_text(text)
    with pytest.raises(ReportError) as error:
        read_force_record(tmp_path / "force.csv", BAND, "")
    assert str(error.value) == f"{tmp_path}/force.csv{message}"


def test_keys_of_the_case_are_checked(make_run: MakeRun) -> None:
    made = make_run()
    case = made / "case.toml"
    text = case.read_text()
    (made / "inputs" / "force.csv").write_text(FORCES + "0,0,0,0\n1,0,0,0\n")
    periods = f"{case}: report.force_periods: "
    invalid = f"{periods}invalid value (found {{}}; allowed two numbers above 0, the smaller one first)"
    for name, keys, message in (
        ("force", "", f"{periods}missing for report.force_record. Add the periods of its waves [s]."),
        ("force", "force_periods = [9.0]\n", invalid.format([9.0])),
        ("force", "force_periods = [9.0, 3.0]\n", invalid.format([9.0, 3.0])),
        ("none", "force_periods = [3.0, 9.0]\n", "none.csv: no such file. Correct report.force_record in"),
    ):
        case.write_text(f'{text}force_record = "inputs/{name}.csv"\n{keys}')
        with pytest.raises(ReportError, match=re.escape(message)):
            _ = Run(made).force_record


TIME = np.arange(0.0, 2000.0, 0.1)
INNER = (TIME > 600.0) & (TIME < 1400.0)  # four of the longest periods from either end


def sine(period: float, time: np.ndarray = TIME) -> np.ndarray:
    return np.asarray(np.sin(2.0 * np.pi * time / period + 0.3))


@pytest.mark.parametrize("period", [50.0, 60.0, 72.0, 90.0, 100.0])
def test_sine_in_the_band_is_unchanged(period: float) -> None:
    passed = band_passed(TIME, sine(period), 35.0, 150.0)
    # 1/(1 + (T/150)^8) and 1/(1 + (35/T)^8) are the response: at least 0.946 from 50 to 100 s.
    assert np.abs(passed - sine(period))[INNER].max() < 0.06
    exact = response(np.array([1.0 / period]), 35.0, 150.0)[0]
    assert np.abs(passed - exact * sine(period))[INNER].max() < 1e-3, "no phase, and the amplitude of the response"


def test_band_passes_its_middle_half_of_its_ends_and_nothing_else() -> None:
    middle = np.sqrt(35.0 * 150.0)
    assert np.abs(band_passed(TIME, sine(middle), 35.0, 150.0))[INNER].max() == pytest.approx(1.0, abs=0.01)
    for period in (35.0, 150.0):
        assert np.abs(band_passed(TIME, sine(period), 35.0, 150.0))[INNER].max() == pytest.approx(0.5, abs=0.005)
    for period in (1.0, 5.0, 15.0, 20.0, 300.0, 500.0):
        assert np.abs(band_passed(TIME, sine(period), 35.0, 150.0))[INNER].max() < 0.013
    for end in (3.0, 60.0, 200.0, 1000.0):
        time = np.arange(0.0, end, 0.1)
        assert np.abs(band_passed(time, np.full_like(time, 7.0), 35.0, 150.0)).max() < 1e-12


def at_rest_pulse(time: np.ndarray) -> np.ndarray:
    """Return a force that begins and ends at rest and changes its sign between."""
    s = np.clip((time - 20.0) / 80.0, 0.0, 1.0)
    return np.asarray(np.sin(2.0 * np.pi * s) * np.sin(np.pi * s) ** 2)


def test_short_and_uneven_records_are_filtered_as_parts_of_long_ones() -> None:
    # The force is zero before and after: the extension of the record is exact.
    short, long = np.arange(0.0, 120.0, 0.1), np.arange(-600.0, 800.0, 0.1)
    passed = band_passed(short, at_rest_pulse(short), 35.0, 150.0)
    whole = np.interp(short, long, band_passed(long, at_rest_pulse(long), 35.0, 150.0))
    assert np.abs(passed).max() > 0.5 and np.abs(passed - whole).max() < 2e-3
    time = np.concatenate((np.arange(0.0, 120.0, 0.1), [120.03, 120.3]))
    values = at_rest_pulse(time)
    values[0] = np.nan  # no step yet
    found = np.interp(short, time, band_passed(time, values, 35.0, 150.0))
    assert np.abs(found - passed).max() < 1e-3
    coarse = np.arange(0.0, 121.0, 1.0)
    largest = np.abs(band_passed(coarse, at_rest_pulse(coarse), 35.0, 150.0)).max()
    assert largest == pytest.approx(np.abs(found).max(), rel=0.01)
    assert band_passed(np.zeros(1), np.ones(1), 35.0, 150.0).tolist() == [0.0]
    with pytest.raises(ValueError, match="the first period must be the shorter one"):
        band_passed(short, at_rest_pulse(short), 150.0, 35.0)


def target(quantity: str, time: float = 5.0, value: float = 1e11, unit: str = "N") -> Target:
    return Target(quantity, time, value, unit, "somebody")


def test_name_of_a_reported_force_has_a_valid_band(make_run: MakeRun, tmp_path: Path) -> None:
    bands = {"35_150_s": Band(35.0, 150.0), "0.5_2.5_s": Band(0.5, 2.5)}
    assert {name: band_of(target(f"max_seismic_force_{name}")) for name in bands} == bands
    assert band_of(target("max_seismic_force")) is band_of(target("mean_velocity")) is None
    folder = make_run(targets=TARGETS.replace("_2_8_s", "_8_2_s"))
    words = r"targets\.csv:9: max_seismic_force_8_2_s: give the shorter period first, both"
    with pytest.raises(ReportError, match=words):
        make_report(Run(folder), tmp_path / "out", dpi=50)


def test_report_has_a_value_of_the_run_for_each_reported_one(make_run: MakeRun) -> None:
    run = Run(make_run())
    assert reported_bands(run) == [Band(2.0, 8.0)]
    largest = quantity_text(float(np.nanmax(force_in_band(run, Band(2.0, 8.0)))), "N")
    found = numbers(run)
    assert found["Maximum seismic force, band-pass 2 to 8 s"][0] == largest
    assert found["Maximum seismic force"][0] == quantity_text(float(np.nanmax(seismic_force(run)[1])), "N") != largest
    outside = "not compared: time outside the run (0 to 10 s)"
    for reported, text in (
        (target("mean_velocity", 5.0, 11.0, "m/s"), "12 m/s"), (target("band_SL", 5.0, 0.4, "-"), "0.5"),
        (target("mean_velocity", 11.0, 11.0, "m/s"), outside), (target("mean_velocity", -100.0, 11.0, "m/s"), outside),
        (target("source_volume", 0.0, 1.0, "m3"), "800 m³"),  # 80 particles of 1 m2 on 10 m of width
    ):  # fmt: skip
        assert found_for(run, reported) == text, reported
    page = re.sub(r'<td data-column="[^"]*">', "<td>", page_of(run.folder, "force"))
    cells = f"maximum seismic force, band-pass 2 to 8 s</th><td>5 s</td><td>110 GN</td><td>{largest}</td><td>waves</td>"
    assert cells in page and '<th scope="col">this run</th>' in page
    per_metre = Run(make_run(name="thin", width=0.0))
    assert found_for(per_metre, target("max_seismic_force_2_8_s")) == "not available: no case.width"
