"""Force of a run compared with one inverted from seismic waves: file, projection, filter, alignment, figure."""

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import MakeRun, history_columns, page_of, write_history
from figures_test import line
from matplotlib.collections import FillBetweenPolyCollection
from wrong_tables import FORCE_RANGE, FORCES, WRONG_FORCES

from thawslide import NotInRunError, ReportError, Run
from thawslide.band_pass import response
from thawslide.figures import FIGURES
from thawslide.figures.force_record import compared, filtered
from thawslide.force_record import ForceRecord, projected, projected_ends, read_force_record, reversal, travel_azimuth
from thawslide.report_page import make_report
from thawslide.targets import Band

ROOT = Path(__file__).resolve().parents[2]
BAND = Band(10.0, 200.0)
AZIMUTH = 30.0  # of the records made here


def pulse(time: np.ndarray, middle: float) -> np.ndarray:
    """Return a vertical force on the Earth that is first upward, then downward, and 0 in the middle."""
    s = (time - middle) / 6.0
    return np.asarray(-s * np.exp(-0.5 * s * s))


def push(time: np.ndarray) -> np.ndarray:
    """Return a horizontal force on the Earth of a mass that is accelerated and then braked: backward first."""
    return -pulse(time, 52.0)


def write_record(folder: Path, *, lag: float = 7.0, size: float = 0.5, keys: str = "") -> None:
    """Add a record to a run: its force times `size`, `lag` seconds earlier, towards AZIMUTH."""
    time = np.arange(-20.0, 121.0)
    up, along = size * 1e11 * pulse(time + lag, 60.0), size * 1e11 * push(time + lag)
    angle = np.radians(AZIMUTH)
    rows = zip(time, up, along * np.cos(angle), along * np.sin(angle), strict=True)
    (folder / "inputs" / "force.csv").write_text(
        FORCES + "".join(",".join(repr(float(each)) for each in row) + "\n" for row in rows)
    )
    case = folder / "case.toml"
    case.write_text(
        case.read_text() + f'force_record = "inputs/force.csv"\nforce_periods = [10.0, 200.0]\n'
        f'force_source = "A survey"\n{keys}'
    )


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


def test_curves_of_equal_forces_coincide(folder: Path) -> None:
    run = Run(folder)
    figure = FIGURES["force_record"].plot(run)
    for panel in (0, 1):
        time, values = line(figure.axes[panel], "run")
        record_time, reference = line(figure.axes[panel], "A survey, time shifted by +7.0 s")
        assert record_time[0] == pytest.approx(-13.0, abs=0.01) and record_time[-1] == pytest.approx(127.0, abs=0.26)
        inside = time <= record_time[-1]
        difference = np.interp(time[inside], record_time, reference) - 0.5 * values[inside]
        assert np.abs(difference).max() < 0.005 * values.max(), "linear between rows one second apart"
        assert np.abs(values).max() > 20.0, "GN"
    assert figure.axes[0].get_ylabel() == "force (GN)"
    assert figure.axes[1].get_xlabel() == "time since the start (s)"
    assert figure.axes[1].get_title(loc="left").endswith("(record: azimuth 30°)")
    found = compared(run)
    assert found.run.reversal is not None and found.record.reversal is not None
    assert found.run.reversal.zero == pytest.approx(60.0, abs=0.02) == found.record.reversal.zero
    assert found.run.reversal.duration == pytest.approx(found.record.reversal.duration, abs=0.05)
    times = [f"{each.duration:.1f} s" for each in (found.record.reversal, found.run.reversal)]
    words = f"From maximum upward to maximum downward force: inversion {times[0]}, run {times[1]}."
    assert figure.get_supxlabel().replace("\n", " ") == words, "below the panels, away from the curves"
    assert not figure.axes[0].texts


def test_curves_are_the_filtered_history(folder: Path) -> None:
    run = Run(folder)
    figure = FIGURES["force_record"].plot(run)
    time = run.series["time_s"]
    for panel, axis in ((0, "y"), (1, "x")):
        curve_time, curve = line(figure.axes[panel], "run")
        expected = filtered(time, run.series[f"seismic_force_{axis}_N"], curve_time, BAND)
        np.testing.assert_allclose(1e9 * curve, expected, atol=1e-6 * np.abs(expected).max())
        assert curve_time[0] >= 0.0 > line(figure.axes[panel], "filter response before the run")[0].max()


def test_motion_towards_minus_x_is_forward(folder: Path) -> None:
    forward = compared(Run(folder)).run.along
    write_long_run(folder, towards=-1.0)
    np.testing.assert_allclose(compared(Run(folder)).run.along, forward)


def test_range_surrounds_the_record(folder: Path) -> None:
    time = np.arange(-20.0, 121.0)
    up = 1e11 * pulse(time, 50.0)
    rows = (
        f"{t},{u},{-u},0,{u - 1e9},{u + 2e9},{-u - 3e9},{-u + 4e9},-5e9,6e9\n" for t, u in zip(time, up, strict=True)
    )
    (folder / "inputs" / "force.csv").write_text(FORCE_RANGE + "".join(rows))
    run = Run(folder)
    figure = FIGURES["force_record"].plot(run)
    assert np.radians(compared(run).azimuth) == pytest.approx(0.0)
    for panel, low, high in ((0, 1e9, 2e9), (1, 3e9, 4e9)):
        axes = figure.axes[panel]
        (band,) = [found for found in axes.collections if isinstance(found, FillBetweenPolyCollection)]
        (label,) = [label for found in axes.lines if "A survey" in (label := str(found.get_label()))]
        at, best = line(figure.axes[panel], label)
        corners = band.get_paths()[0].vertices
        for middle in (10, len(at) // 2, len(at) - 10):
            heights = corners[np.abs(corners[:, 0] - at[middle]) < 1e-6, 1]
            assert heights.min() == pytest.approx(best[middle] - low / 1e9, abs=1e-6)
            assert heights.max() == pytest.approx(best[middle] + high / 1e9, abs=1e-6)


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
    inside = [(n, e) for n in np.linspace(-2.0, 1.0, 7) for e in np.linspace(1.0, 3.0, 7)]
    for azimuth in np.arange(-180.0, 180.0, 15.0):
        values = [float(projected(np.array([n]), np.array([e]), azimuth)[0]) for n, e in inside]
        least, largest = projected_ends(low, high, azimuth)
        assert (least[0], largest[0]) == (pytest.approx(min(values)), pytest.approx(max(values)))


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
        assert found is not None
        assert (found.upward, found.zero, found.downward) == (
            pytest.approx(20.0, abs=2e-3), pytest.approx(30.0, abs=1e-3), pytest.approx(40.0, abs=2e-3),
        )  # fmt: skip
        assert found.duration == pytest.approx(20.0, abs=4e-3)
    assert reversal(time, np.ones_like(time)) is None and reversal(time, -np.ones_like(time)) is None
    assert reversal(time, time - 50.0) is None, "downward first"


@pytest.mark.parametrize("period", [6.0, 12.0, 30.0, 60.0, 120.0, 300.0])
def test_long_sinusoid_is_filtered_exactly(period: float) -> None:
    time, at = np.arange(0.0, 4000.0, 0.25), np.arange(1500.0, 2500.0, 0.25)
    wave = np.sin(2.0 * np.pi * time / period + 0.3)
    factor = response(np.array([1.0 / period]), BAND.shortest, BAND.longest)[0]
    expected = factor * np.sin(2.0 * np.pi * at / period + 0.3)
    np.testing.assert_allclose(filtered(time, wave, at, BAND), expected, atol=2e-3)


def test_history_is_extended_by_its_end_values() -> None:
    time, at = np.array([0.0, 1.0, 2.0]), np.arange(-100.0, 100.0, 1.0)
    np.testing.assert_allclose(filtered(time, np.full(3, 7.0), at, BAND), 0.0, atol=1e-12)
    rises = filtered(time, np.array([np.nan, 0.0, 1.0]), at, BAND)
    assert rises[at == 3.0][0] > 0.2 > abs(rises[at == -60.0][0]), "a row without a number counts as 0"
    """Without padding, the jump to 0 at the end would change the result by 0.5."""
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


def test_times_without_a_reversal_are_not_aligned(folder: Path) -> None:
    columns = history_columns(2001, 2) | {f"seismic_force_{axis}_N": np.zeros(2001) for axis in "xy"}
    write_history(folder / "history.csv", columns | {"time_s": np.linspace(0.0, 200.0, 2001)})
    run = Run(folder)
    found = compared(run)
    assert (found.is_aligned, found.shift) == (False, 0.0)
    words = "Times are not aligned, because one of the vertical forces does not reverse."
    assert words in FIGURES["force_record"].caption_of(run)
    assert line(FIGURES["force_record"].plot(run).axes[0], "A survey, times not aligned")[0][0] == -20.0


def test_run_before_the_record_is_plotted(folder: Path) -> None:
    columns = {name: values[:3] for name, values in history_columns(2001, 2).items()}
    write_history(folder / "history.csv", columns | {"time_s": np.array([-90.0, -80.0, -70.0])})
    assert not line(FIGURES["force_record"].plot(Run(folder)).axes[0], "filter response before the run").size


def test_caption_has_the_difference_of_two_inversions(folder: Path) -> None:
    header = "quantity,time_s,value,unit,source,kind\n"
    (folder / "inputs" / "targets.csv").write_text(
        header + "max_seismic_force_35_150_s,5,280,GN,Others,observation\nmax_seismic_force,5,70,GN,Them,observation\n"
        "max_seismic_force_2_8_s,5,1,GN,Third,model\n"
    )
    run = Run(folder)
    record = run.force_record
    assert record is not None
    parts = [filtered(record.time, record.best[part], record.time, Band(35.0, 150.0)) for part in record.best]
    of_record = float(np.sqrt(sum(part**2 for part in parts)).max()) / 1e9
    words = FIGURES["force_record"].caption_of(run)
    assert "(A survey). Both are filtered to periods of 10 to 200 s by the same filter" in words
    assert "Times of the record are shifted by +7.0 s to align the sign reversals" in words
    assert "for the record, the azimuth of the maximum horizontal momentum, 30°;" in words
    of_others = re.search(
        r"Maximum force in 35 to 150 s \(Others\): 280 GN reported\. The record has ([\d.]+) GN, "
        r"the run ([\d.]+) GN\. The two inversions differ by a factor of ([\d.]+)\.",
        words,
    )
    assert of_others
    assert [float(of_others[number]) for number in (1, 2, 3)] == [
        pytest.approx(of_record, rel=0.01), pytest.approx(2.0 * of_record, rel=0.03),
        pytest.approx(280.0 / of_record, rel=0.03),
    ]  # fmt: skip
    assert "Maximum force without a specified band, compared in 10 to 200 s (Them): 70 GN reported. " in words
    assert re.search(r"in 2 to 8 s \(Third\): 1 GN reported\. The run has [\d.]+ GN\.", words), "not in the record"
    page = page_of(folder, "force_record")
    assert '<h2 id="figure-force_record">' in page and "The two inversions differ by a factor of" in page


def test_x_is_east_in_three_dimensions(make_run: MakeRun) -> None:
    time = np.linspace(0.0, 200.0, 2001)
    along, angle = 1e11 * push(time), np.radians(AZIMUTH)
    force = (along * np.sin(angle), along * np.cos(angle), 1e11 * pulse(time, 60.0))
    of_axes = {f"seismic_force_{axis}_N": part for axis, part in zip("xyz", force, strict=True)}
    made = make_run(dimension=3, rows=2001, history={"time_s": time} | of_axes)
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
    text = case.read_text() + 'force_record = "inputs/force.csv"\n'
    (made / "inputs" / "force.csv").write_text(FORCES + "0,0,0,0\n1,0,0,0\n")
    invalid = "invalid value (found {}; allowed two numbers above 0, the smaller one first)"
    for keys, message in (
        ("", "missing for report.force_record. Add the periods of its waves [s]."),
        ("force_periods = [9.0]\n", invalid.format([9.0])),
        ("force_periods = [9.0, 3.0]\n", invalid.format([9.0, 3.0])),
    ):
        case.write_text(text + keys)
        with pytest.raises(ReportError, match=re.escape(f"{case}: report.force_periods: {message}")):
            _ = Run(made).force_record
    case.write_text(text.replace("inputs/force.csv", "inputs/none.csv") + "force_periods = [3.0, 9.0]\n")
    with pytest.raises(ReportError, match=re.escape("none.csv: no such file. Correct report.force_record in")):
        _ = Run(made).force_record


def test_record_of_lamplugh_has_the_values_of_its_source() -> None:
    """Values from the figures of the notebook: peaks of the components, and the end of the force."""
    texts = [(ROOT / "cases" / name / "lamplugh_force.csv").read_bytes() for name in ("lamplugh", "lamplugh-columns")]
    assert texts[0] == texts[1]
    record = read_force_record(ROOT / "cases" / "lamplugh" / "lamplugh_force.csv", BAND, "")
    time, best = record.time, record.best
    size = np.sqrt(sum(part**2 for part in best.values()))
    assert (size.max() / 1e11, time[size.argmax()]) == (pytest.approx(2.04, abs=0.03), 31.0)
    assert (best["up"].max() / 1e11, time[best["up"].argmax()]) == (pytest.approx(1.46, abs=0.02), 21.0)
    assert best["north"].min() / 1e11 == pytest.approx(-1.55, abs=0.02)
    assert size[time > 90.0].max() < 0.1e11
    assert record.low["north"].min() / 1e11 == pytest.approx(-1.86, abs=0.03), "of the jackknife solutions"
    assert travel_azimuth(record) == pytest.approx(5.0, abs=1.0)
