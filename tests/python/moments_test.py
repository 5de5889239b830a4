"""Times of snapshots in figures, and velocities from displacement."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, history_columns, write_facts, write_history
from matplotlib.colors import PowerNorm, to_rgba

from thawslide import Run
from thawslide.figures import FIGURES
from thawslide.figures.colours import THIN, painted_values
from thawslide.figures.maximum_maps import _EXTENT, _norm
from thawslide.figures.moments import chosen_snapshots, moments, shown_snapshot
from thawslide.maps import Maps


def move(folder: Path, number: int, points: np.ndarray | None = None, **fields: np.ndarray | float) -> None:
    with h5py.File(folder / "snapshots" / f"{number:06d}.vtkhdf", "r+") as file:
        if points is not None:
            file["VTKHDF/Points"][:] = points
        for name, values in fields.items():
            file[f"VTKHDF/PointData/{name}"][:] = values


def test_moments_are_fractions_of_the_displacement_without_times(make_run: MakeRun) -> None:
    folder, columns = make_run(times="[]"), history_columns(101, 2)
    displacement = np.minimum(columns["time_s"] ** 2, 36.0)  # stop at 6 s
    write_history(folder / "history.csv", columns | {"mean_displacement_m": displacement})
    run = Run(folder)
    assert moments(run) == pytest.approx([0.0, *(np.ceil(60.0 * np.sqrt(0.2 * n)) / 10.0 for n in range(1, 6))])
    assert [shot.time for shot in chosen_snapshots(run)] == [0.0, 3.0, 4.0, 5.0, 6.0]  # 2.7, 3.8, 4.7, 5.4, 6
    for still in (0.0, np.nan):
        write_history(folder / "history.csv", columns | {"mean_displacement_m": np.full(101, still)})
        assert moments(Run(folder)) == [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]
    assert [shot.time for shot in chosen_snapshots(Run(make_run(name="given", times="[1.0, 9.0]")))] == [1.0, 9.0]


def test_few_moments_begin_at_the_peak_of_the_mean_velocity(make_run: MakeRun) -> None:
    run = Run(make_run(times="[0.0, 1.0, 4.0, 6.0, 8.0, 9.0, 10.0]"))  # peak at 5 s
    assert [shot.time for shot in chosen_snapshots(run, most=3)] == [4.0, 8.0, 10.0]
    rising = {"mean_velocity_m_s": np.arange(101.0)}
    late = Run(make_run(name="late", times="[0.0, 1.0, 4.0, 9.0]", history=rising))
    assert [shot.time for shot in chosen_snapshots(late, most=3)] == [1.0, 4.0, 9.0]
    panels = [title for axes in FIGURES["velocity"].plot(run).axes if (title := axes.get_title(loc="left"))[:1] == "("]
    assert panels == ["(a) t = 4 s", "(b) t = 8 s", "(c) t = 10 s"]


def test_velocities_are_those_of_displacement(make_run: MakeRun) -> None:
    """The velocities of the file increase with time; its points move at (12, -6) m/s."""
    run = Run(make_run())
    for index in (1, 5, 9):
        np.testing.assert_allclose(shown_snapshot(run, index)["velocity"], [[12.0, -6.0, 0.0]] * 80, atol=1e-9)
    np.testing.assert_array_equal(shown_snapshot(run, 0)["velocity"], run.snapshot(0)["velocity"])
    figure = FIGURES["velocity"].plot(run)
    panel = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("(b)"))
    values = [c.get_array() for c in panel.collections if c.get_array() is not None]
    np.testing.assert_allclose(values[0], 6.0 * np.sqrt(5.0))
    assert panel.get_title(loc="right") == "max 13.4 m/s"


def velocity_label(run: Run) -> str:
    labels = [axes.get_xlabel() for axes in FIGURES["velocity"].plot(run).axes]
    return next(label for label in labels if label.startswith("speed"))


@pytest.mark.parametrize("facts", [{"at_rest": False}, {}])
def test_last_velocities_of_a_moving_mass_are_those_of_the_last_time(make_run: MakeRun, facts: dict[str, bool]) -> None:
    folder = make_run(times="[0.0, 5.0, 10.0]")
    write_facts(folder, **facts)
    run = Run(folder)
    np.testing.assert_array_equal(shown_snapshot(run, 10)["velocity"], run.snapshot(10)["velocity"])
    assert velocity_label(run) == "speed (m/s), 2 s mean; at 0 and 10 s: instantaneous"


def test_last_velocities_at_rest_are_means_of_the_last_interval(make_run: MakeRun) -> None:
    folder = make_run(times="[5.0, 10.0]")
    for since, words in ((9.5, "; at 10 s: mean of the last 1 s"), (8.0, "")):
        write_facts(folder, at_rest=True, rest_since_s=since)
        assert velocity_label(Run(folder)) == f"speed (m/s), 2 s mean{words}"


def test_vibration_at_rest_has_no_velocity(make_run: MakeRun) -> None:
    folder = make_run(times="[10.0]", facts={"at_rest": True, "rest_since_s": 8.0})
    points = Run(folder).snapshot(8).points
    for number in (9, 10):
        move(folder, number, points=points, velocity=1.2)
    figure = FIGURES["velocity"].plot(Run(folder))
    (title,) = [axes.get_title(loc="right") for axes in figure.axes if axes.get_title(loc="left").startswith("(a)")]
    assert title == "max 0 m/s"


def test_velocities_of_particles_in_one_neighbouring_snapshot(make_run: MakeRun) -> None:
    folder, ids = make_run(), np.arange(80)
    move(folder, 4, id=np.where(ids == 79, 500, ids))  # without 79
    move(folder, 6, id=np.where(ids == 79, 500, np.where(ids == 78, 400, ids)))  # without 78 and 79
    run = Run(folder)
    found = shown_snapshot(run, 5)["velocity"]
    np.testing.assert_allclose(found[:79], [[12.0, -6.0, 0.0]] * 79, atol=1e-9)
    np.testing.assert_array_equal(found[79], run.snapshot(5)["velocity"][79])


def test_maps_have_velocities_of_displacement(map_run: Path) -> None:
    run = Run(map_run)
    shot = shown_snapshot(run, 3)
    before, after = run.snapshot(2), run.snapshot(4)
    expected = np.linalg.norm(after.points - before.points, axis=1) / (after.time - before.time)
    np.testing.assert_allclose(painted_values(shot, "velocity"), expected)


def test_thin_margins_have_a_separate_colour(map_run: Path) -> None:
    figure = FIGURES["slide_thickness"].plot(Run(map_run))
    image = next(axes.images[-1] for axes in figure.axes if len(axes.images) > 1)
    norm, colours = image.norm, image.get_cmap()
    assert (norm.vmin, norm.vmax) == (0.1, pytest.approx(6.0))
    np.testing.assert_array_equal(colours(norm(0.05)), to_rgba(THIN))
    for thickness in (0.5, 1.5, 6.0):
        assert norm(thickness) == pytest.approx(np.sqrt((thickness - 0.1) / 5.9)), "thin margins have a sufficient part"
    (bar,) = [axes for axes in figure.axes if axes.get_xlabel().startswith("flow thickness")]
    assert [label.get_text() for label in bar.get_xticklabels()] == ["0.1", "0.2", "0.5", "1", "2", "5"]
    for name in ("max_thickness", "final_thickness"):
        values = Maps(Run(map_run))[name].values
        shown = _norm(values[values > 0.1], next(kind for kind in _EXTENT if kind.name == name))[0]
        assert shown.vmax == pytest.approx(values.max()) and isinstance(shown, PowerNorm)
