"""Times of snapshots and of reported values in figures, and velocities from displacement."""

from pathlib import Path

import numpy as np
import pytest
from conftest import MakeRun, change_snapshot, column_history, history_columns, numbers, write_history
from figure_parts import labels, line, maps_of, plotted, titled
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from thawslide import Run
from thawslide.figures import FIGURES
from thawslide.figures.colours import THIN, painted_values
from thawslide.figures.moments import chosen_snapshots, moments, shown_snapshot
from thawslide.figures.style import TIME_LABEL


def times_of(run: Run, most: int | None = None) -> list[float]:
    return [shot.time for shot in (chosen_snapshots(run) if most is None else chosen_snapshots(run, most=most))]


def test_moments_are_fractions_of_the_displacement_without_times(make_run: MakeRun) -> None:
    folder, columns = make_run(times="[]"), history_columns(101, 2)
    displacement = np.minimum(columns["time_s"] ** 2, 36.0)  # stop at 6 s
    write_history(folder / "history.csv", columns | {"mean_displacement_m": displacement})
    run = Run(folder)
    assert moments(run) == pytest.approx([0.0, *(np.ceil(60.0 * np.sqrt(0.2 * n)) / 10.0 for n in range(1, 6))])
    assert times_of(run) == [0.0, 3.0, 4.0, 5.0, 6.0]  # 2.7, 3.8, 4.7, 5.4, 6
    for still in (0.0, np.nan):
        write_history(folder / "history.csv", columns | {"mean_displacement_m": np.full(101, still)})
        assert moments(Run(folder)) == [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
    assert times_of(Run(make_run(name="given", times="[1.0, 9.0]"))) == [1.0, 9.0]
    # Times with a common snapshot have one panel.
    assert times_of(Run(make_run(name="common", times="[0.0, 8.9, 9.1, 500.0]"))) == [0.0, 9.0, 10.0]


def test_few_moments_begin_at_the_peak_of_the_mean_velocity(make_run: MakeRun) -> None:
    run = Run(make_run(times="[0.0, 1.0, 4.0, 6.0, 8.0, 9.0, 10.0]"))  # peak at 5 s
    assert times_of(run, most=3) == [4.0, 8.0, 10.0]
    rising = {"mean_velocity_m_s": np.arange(101.0)}
    late = Run(make_run(name="late", times="[0.0, 1.0, 4.0, 9.0]", history=rising))
    assert times_of(late, most=3) == [1.0, 4.0, 9.0]
    assert panels_of(FIGURES["velocity"].plot(run)) == ["(a) t = 4 s", "(b) t = 8 s", "(c) t = 10 s"]


def test_velocities_are_those_of_displacement(make_run: MakeRun) -> None:
    """The velocities of the file increase with time; its points move at (12, -6) m/s."""
    run = Run(make_run())
    for index in (1, 5, 9):
        np.testing.assert_allclose(shown_snapshot(run, index)["velocity"], [[12.0, -6.0, 0.0]] * 80, atol=1e-9)
    np.testing.assert_array_equal(shown_snapshot(run, 0)["velocity"], run.snapshot(0)["velocity"])
    panel = titled(FIGURES["velocity"].plot(run), "(b)")
    values = [c.get_array() for c in panel.collections if c.get_array() is not None]
    np.testing.assert_allclose(values[0], 6.0 * np.sqrt(5.0))
    assert panel.get_title(loc="right") == "max 13.4 m/s"


def velocity_label(run: Run) -> str:
    return next(label for label in labels(FIGURES["velocity"].plot(run)) if label.startswith("speed"))


@pytest.mark.parametrize("facts", [{"at_rest": False}, {}])
def test_last_velocities_of_a_moving_mass_are_those_of_the_last_time(make_run: MakeRun, facts: dict[str, bool]) -> None:
    run = Run(make_run(times="[0.0, 5.0, 10.0]", facts=facts))
    np.testing.assert_array_equal(shown_snapshot(run, 10)["velocity"], run.snapshot(10)["velocity"])
    assert velocity_label(run) == "speed (m/s), 2 s mean; at 0 and 10 s: instantaneous"


def test_last_velocities_at_rest_are_means_of_the_last_interval_without_vibration(make_run: MakeRun) -> None:
    for since, words in ((9.5, "; at 10 s: mean of the last 1 s"), (8.0, "")):
        facts = {"at_rest": True, "rest_since_s": since}
        run = Run(make_run(name=f"{since}", times="[5.0, 10.0]", facts=facts))
        assert velocity_label(run) == f"speed (m/s), 2 s mean{words}"
    folder = make_run(times="[10.0]", facts={"at_rest": True, "rest_since_s": 8.0})
    points = Run(folder).snapshot(8).points
    for number in (9, 10):
        change_snapshot(folder, number, points=points, velocity=1.2)
    assert titled(plotted("velocity", folder), "(a)").get_title(loc="right") == "max 0 m/s"


def test_velocities_of_particles_in_one_neighbouring_snapshot(make_run: MakeRun) -> None:
    folder, ids = make_run(), np.arange(80)
    change_snapshot(folder, 4, id=np.where(ids == 79, 500, ids))  # without 79
    change_snapshot(folder, 6, id=np.where(ids == 79, 500, np.where(ids == 78, 400, ids)))  # without 78 and 79
    run = Run(folder)
    found = shown_snapshot(run, 5)["velocity"]
    np.testing.assert_allclose(found[:79], [[12.0, -6.0, 0.0]] * 79, atol=1e-9)
    np.testing.assert_array_equal(found[79], run.snapshot(5)["velocity"][79])


def test_maps_have_a_colour_of_thin_margins_and_velocities_of_displacement(map_run: Path) -> None:
    figure = FIGURES["slide_thickness"].plot(Run(map_run))
    image = next(axes.images[-1] for axes in figure.axes if len(axes.images) > 1)
    norm, colours = image.norm, image.get_cmap()
    assert (norm.vmin, norm.vmax) == (0.1, pytest.approx(6.0))
    np.testing.assert_array_equal(colours(norm(0.05)), to_rgba(THIN))
    for thickness in (0.5, 1.5, 6.0):
        assert norm(thickness) == pytest.approx(np.sqrt((thickness - 0.1) / 5.9)), "thin margins have a sufficient part"
    (bar,) = [axes for axes in figure.axes if axes.get_xlabel().startswith("flow thickness")]
    assert [label.get_text() for label in bar.get_xticklabels()] == ["0.1", "0.2", "0.5", "1", "2", "5"]
    run = Run(map_run)
    shot = shown_snapshot(run, 3)
    before, after = run.snapshot(2), run.snapshot(4)
    expected = np.linalg.norm(after.points - before.points, axis=1) / (after.time - before.time)
    np.testing.assert_allclose(painted_values(shot, "velocity"), expected)


START = 10.0 / np.pi * np.arcsin(np.sqrt(8.0 / 12.0))  # s: 12 sin2(pi t/10) = 8


@pytest.fixture
def folder(make_run: MakeRun) -> Path:
    rows = "start_velocity,40,8,m/s,x\nmean_velocity,42,9,m/s,x\n"
    return make_run(targets="quantity,time_s,value,unit,source\n" + rows)


def labels_of_time(figure: Figure) -> set[str]:
    return {label for label in labels(figure) if label.startswith("time")}


def panels_of(figure: Figure) -> list[str]:
    return [axes.get_title(loc="left") for axes in maps_of(figure)]


@pytest.mark.parametrize("name", ["motion", "force", "band", "energy"])
def test_curves_have_the_times_of_the_run(folder: Path, name: str) -> None:
    run = Run(folder)
    figure = FIGURES[name].plot(run)
    assert labels_of_time(figure) == {TIME_LABEL}
    curves = [each for axes in figure.axes for each in axes.lines if len(each.get_xdata()) == run.series.rows]
    assert curves
    for curve in curves:
        np.testing.assert_array_equal(curve.get_xdata(), run.series["time_s"])


def test_reported_values_snapshots_and_columns_have_the_times_of_the_run(folder: Path) -> None:
    run = Run(folder)
    assert [target.time for target in run.targets] == pytest.approx([START, START + 2.0], abs=2e-3)
    speed = FIGURES["motion"].plot(run).axes[0]
    np.testing.assert_allclose(line(speed, "reported: x"), [[START + 2.0], [9.0]], atol=2e-3)
    assert np.interp(run.targets[0].time, *line(speed, "mean (mass-weighted)")) == pytest.approx(8.0, abs=0.01)
    assert panels_of(plotted("velocity", folder)) == ["(a) t = 0 s", "(b) t = 4 s", "(c) t = 7 s"]
    assert numbers(Run(folder))["Peak mean velocity"][1] == "at 5 s"
    write_history(folder / "history.csv", column_history())
    run = Run(folder)
    for name in ("band", "water"):
        assert labels_of_time(FIGURES[name].plot(run)) == {TIME_LABEL}


def test_reported_values_keep_their_times_without_a_start_velocity_that_is_attained(make_run: MakeRun) -> None:
    for value in ("mean_velocity,42,9", "start_velocity,40,99"):
        run = Run(make_run(name=value[:5], targets=f"quantity,time_s,value,unit\n{value},m/s\n"))
        assert run.targets[0].time == float(value.split(",")[1])
        assert labels_of_time(FIGURES["motion"].plot(run)) == {TIME_LABEL}


def test_two_reported_forces_of_one_value_can_be_distinguished(make_run: MakeRun) -> None:
    rows = "max_seismic_force,5,280,GN,One\nmax_seismic_force_2_8_s,5,280,GN,Two\n"
    size = FIGURES["force"].plot(Run(make_run(targets="quantity,time_s,value,unit,source\n" + rows))).axes[0]
    one, two = (found for found in size.lines if "maximum" in str(found.get_label()))
    np.testing.assert_array_equal(one.get_ydata(), two.get_ydata())
    (passed,) = (found for found in size.lines if "band-pass" in str(found.get_label()))
    assert one.get_color() != two.get_color() == passed.get_color()
    assert one._unscaled_dash_pattern == (0.0, (4.0, 4.0)) and two._unscaled_dash_pattern == (4.0, (4.0, 4.0))
