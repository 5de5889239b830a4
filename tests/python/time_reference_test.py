"""One clock for all figures: time 0 is the start of the run, and start_velocity shifts reported values to it."""

import re
from pathlib import Path

import numpy as np
import pytest
from band_columns_test import column_history
from conftest import MakeRun, write_history
from matplotlib.figure import Figure

from thawslide import Run
from thawslide.figures import FIGURES
from thawslide.figures.style import TIME_LABEL
from thawslide.key_numbers import key_numbers
from thawslide.targets import read_targets

ROOT = Path(__file__).resolve().parents[2]
OVER_TIME = ("motion", "force", "band", "energy")
START = 10.0 / np.pi * np.arcsin(np.sqrt(8.0 / 12.0))  # s: 12 sin2(pi t/10) = 8


@pytest.fixture
def folder(make_run: MakeRun) -> Path:
    rows = "start_velocity,40,8,m/s,x\nmean_velocity,42,9,m/s,x\n"
    return make_run(targets="quantity,time_s,value,unit,source\n" + rows)


def labels_of_time(figure: Figure) -> set[str]:
    return {axes.get_xlabel() for axes in figure.axes if axes.get_xlabel().startswith("time")}


@pytest.mark.parametrize("name", OVER_TIME)
def test_curves_have_the_times_of_the_run(folder: Path, name: str) -> None:
    run = Run(folder)
    figure = FIGURES[name].plot(run)
    assert labels_of_time(figure) == {TIME_LABEL}
    curves = [line for axes in figure.axes for line in axes.lines if len(line.get_xdata()) == run.series.rows]
    assert curves
    for line in curves:
        np.testing.assert_array_equal(line.get_xdata(), run.series["time_s"])


def test_reported_values_are_shifted_to_the_times_of_the_run(folder: Path) -> None:
    run = Run(folder)
    assert [target.time for target in run.targets] == pytest.approx([START, START + 2.0], abs=2e-3)
    speed = FIGURES["motion"].plot(run).axes[0]
    (marks,) = [line for line in speed.lines if str(line.get_label()).startswith("reported")]
    np.testing.assert_allclose(marks.get_data(), [[START + 2.0], [9.0]], atol=2e-3)
    (curve,) = [line for line in speed.lines if line.get_label() == "mean (mass-weighted)"]
    assert np.interp(run.targets[0].time, *curve.get_data()) == pytest.approx(8.0, abs=0.01)


def test_snapshots_are_those_of_the_times_of_the_run(folder: Path) -> None:
    titles = [axes.get_title(loc="left") for axes in FIGURES["velocity"].plot(Run(folder)).axes]
    found = [float(match[1]) for title in titles if (match := re.match(r"\(.\) t = ([\d.]+) s", title))]
    assert found == [0.0, 4.0, 7.0]


def test_page_and_figures_of_band_columns_have_the_times_of_the_run(folder: Path) -> None:
    (peak,) = [row for row in key_numbers(Run(folder)) if row.words == "Peak mean velocity"]
    assert float(peak.remark.split()[1]) == pytest.approx(5.0, abs=0.06)
    write_history(folder / "history.csv", column_history())
    run = Run(folder)
    for name in ("band", "water"):
        assert labels_of_time(FIGURES[name].plot(run)) == {TIME_LABEL}


def test_reported_values_keep_their_times_without_a_start_velocity_that_is_attained(make_run: MakeRun) -> None:
    for value in ("mean_velocity,42,9", "start_velocity,40,99"):
        run = Run(make_run(name=value[:5], targets=f"quantity,time_s,value,unit\n{value},m/s\n"))
        assert run.targets[0].time == float(value.split(",")[1])
        assert labels_of_time(FIGURES["motion"].plot(run)) == {TIME_LABEL}


TARGETS = sorted((ROOT / "cases").glob("**/*targets*.csv"))


@pytest.mark.parametrize("path", TARGETS, ids=lambda path: path.parent.name)
def test_sources_of_cases_are_publications_in_legends(make_run: MakeRun, path: Path) -> None:
    targets = read_targets(path)
    assert targets
    for target in targets:
        assert re.match(r"[A-Z][\w-]+( et al\.,| et al\. \(\d{4}\)| \(\d{4}\))", target.source), target.source
    history = {"time_s": np.linspace(0.0, 250.0, 101), "mean_velocity_m_s": np.linspace(0.0, 20.0, 101)}
    folder = make_run(history=history, targets=path.read_text(encoding="utf-8"))
    speed, _ = FIGURES["motion"].plot(Run(folder)).axes
    of_speed = {target.source for target in targets if target.quantity == "mean_velocity"}
    marks = {str(line.get_label()) for line in speed.lines if str(line.get_label()).startswith("modelled: ")}
    assert marks == {f"modelled: {source}" for source in of_speed}


def test_two_reported_forces_of_one_value_can_be_distinguished(make_run: MakeRun) -> None:
    rows = "max_seismic_force,5,280,GN,One\nmax_seismic_force_2_8_s,5,280,GN,Two\n"
    size = FIGURES["force"].plot(Run(make_run(targets="quantity,time_s,value,unit,source\n" + rows))).axes[0]
    one, two = (found for found in size.lines if "maximum" in str(found.get_label()))
    np.testing.assert_array_equal(one.get_ydata(), two.get_ydata())
    (passed,) = (found for found in size.lines if "band-pass" in str(found.get_label()))
    assert one.get_color() != two.get_color() == passed.get_color()
    assert one._unscaled_dash_pattern == (0.0, (4.0, 4.0)) and two._unscaled_dash_pattern == (4.0, (4.0, 4.0))
