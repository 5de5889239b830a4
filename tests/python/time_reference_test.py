"""Common time reference of all figures of a run: a target start_velocity, or the start of the run."""

import re
from pathlib import Path

import numpy as np
import pytest
from band_columns_test import column_history
from conftest import MakeRun, edit, write_history
from matplotlib.figure import Figure

from thawslide import Run
from thawslide.figures import FIGURES
from thawslide.key_numbers import key_numbers
from thawslide.targets import read_targets

ROOT = Path(__file__).resolve().parents[2]
ALIGNED = "time (s), mean velocity 8 m/s at 40 s"
OVER_TIME = ("motion", "force", "band", "energy")
SHIFT = 40.0 - 10.0 / np.pi * np.arcsin(np.sqrt(8.0 / 12.0))  # s: 12 sin2(pi t/10) = 8


@pytest.fixture
def folder(make_run: MakeRun) -> Path:
    rows = "start_velocity,40,8,m/s,x\nmean_velocity,42,9,m/s,x\n"
    return make_run(targets="quantity,time_s,value,unit,source\n" + rows)


def labels_of_time(figure: Figure) -> set[str]:
    return {axes.get_xlabel() for axes in figure.axes if axes.get_xlabel().startswith("time")}


@pytest.mark.parametrize("name", OVER_TIME)
def test_all_curves_have_aligned_times(folder: Path, name: str) -> None:
    run = Run(folder)
    figure = FIGURES[name].plot(run)
    assert labels_of_time(figure) == {ALIGNED}
    curves = [line for axes in figure.axes for line in axes.lines if len(line.get_xdata()) == run.history.rows]
    assert curves
    for line in curves:
        np.testing.assert_allclose(line.get_xdata(), run.history["time_s"] + SHIFT, atol=2e-3)


def test_reported_values_have_their_own_times(folder: Path) -> None:
    speed = FIGURES["motion"].plot(Run(folder)).axes[0]
    (marks,) = [line for line in speed.lines if str(line.get_label()).startswith("reported")]
    np.testing.assert_array_equal(marks.get_data(), [[42.0], [9.0]])
    (curve,) = [line for line in speed.lines if line.get_label() == "mean (mass-weighted)"]
    assert np.interp(40.0, *curve.get_data()) == pytest.approx(8.0, abs=0.01)


def test_snapshots_have_aligned_times(folder: Path) -> None:
    edit(folder / "case.toml", "times = [0.0, 4.0, 7.4]", "times = [0.0, 41.0, 44.4]")
    run = Run(folder)
    titles = [axes.get_title(loc="left") for axes in FIGURES["velocity"].plot(run).axes]
    assert any(title.endswith("; time: mean velocity 8 m/s at 40 s") for title in titles)
    found = [float(match[1]) for title in titles if (match := re.match(r"\(.\) t = ([\d.]+) s", title))]
    assert found == pytest.approx([SHIFT, SHIFT + 4.0, SHIFT + 7.0], abs=0.05)


def test_page_and_figures_of_band_columns_have_aligned_times(folder: Path) -> None:
    (peak,) = [row for row in key_numbers(Run(folder)) if row.words == "Peak mean velocity"]
    assert float(peak.remark.split()[1]) == pytest.approx(5.0 + SHIFT, abs=0.06)
    write_history(folder / "history.csv", column_history())
    run = Run(folder)
    for name in ("band", "water"):
        assert labels_of_time(FIGURES[name].plot(run)) == {run.time_reference.label} == {ALIGNED}


def test_times_begin_at_the_start_without_a_target_or_its_velocity(make_run: MakeRun) -> None:
    for value in ("mean_velocity,42,9", "start_velocity,40,99"):
        run = Run(make_run(name=value[:5], targets=f"quantity,time_s,value,unit\n{value},m/s\n"))
        np.testing.assert_array_equal(run.shown_time, run.history["time_s"])
        assert labels_of_time(FIGURES["motion"].plot(run)) == {"time (s), 0 at the start of the run"}


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
