"""Warnings inside figures: where they stand, and that their numbers are those of the run."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
from band_columns_test import column_history
from conftest import MakeRun, history_columns, write_history
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from reproduction.lamplugh_figures import figure_20
from thawslide import Run
from thawslide.boiling import boiling_temperature
from thawslide.figures import FIGURES
from thawslide.figures.load import load_on_band, overburden


def warnings(figure: Figure) -> dict[str, str]:
    """Return the warnings of a figure, by the first letters of their panels' titles."""

    def of(axes: Axes) -> str:
        return " ".join(text.get_text().replace("\n", " ") for text in axes.texts if text.get_gid() == "warning")

    return {axes.get_title(loc="left")[:3]: of(axes) for axes in figure.axes if of(axes)}


def change_snapshot(folder: Path, number: int, **fields: float) -> None:
    with h5py.File(folder / "snapshots" / f"{number:06d}.vtkhdf", "r+") as file:
        for name, value in fields.items():
            file[f"VTKHDF/PointData/{name}"][:3] = value


def test_values_that_can_be_have_no_warning(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(101, 2)
    columns["band_pore_pressure_Pa"] *= 0.01
    columns["band_temperature_C"] = np.minimum(columns["band_temperature_C"], 99.0)
    write_history(folder / "history.csv", columns)
    for name in ("band", "temperature"):
        assert warnings(FIGURES[name].draw(Run(folder))) == {}


def test_a_band_hotter_than_its_water_boils_has_one(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(101, 2)
    columns["band_temperature_C"][-1] = 1262.0
    write_history(folder / "history.csv", columns)
    words = "⚠ unphysical: up to 1,262 °C, where water boils at its pressure; the model has no boiling here"
    found = warnings(FIGURES["band"].draw(Run(folder)))
    time, load = load_on_band(Run(folder))
    ratio = np.interp(time, columns["time_s"], columns["band_pore_pressure_Pa"]) / load
    over = f"⚠ unphysical: P is up to {np.nanmax(ratio):.3g} times the weight above"
    assert found == {"(a)": words, "(b)": over}
    # Pressure that holds the water down takes the warning away.
    hot = 1.002 * float(boiling_temperature(columns["band_pore_pressure_Pa"][50]))
    for temperature, warned in ((hot, True), (0.999 * hot, False)):
        columns["band_temperature_C"][:] = np.nan
        columns["band_temperature_C"][50] = temperature
        write_history(folder / "history.csv", columns)
        assert ("(a)" in warnings(FIGURES["band"].draw(Run(folder)))) is warned


def test_columns_that_boil_may_be_as_hot_as_rock_bears(make_run: MakeRun) -> None:
    folder = make_run()
    columns = column_history()
    write_history(folder / "history.csv", columns)
    assert warnings(FIGURES["band"].draw(Run(folder))) == {}
    columns["band_hottest_C"][-1] = 1262.0
    columns["band_largest_pressure_ratio"][-1] = 1.25
    write_history(folder / "history.csv", columns)
    assert warnings(FIGURES["band"].draw(Run(folder))) == {
        "(b)": "⚠ unphysical: up to 1,262 °C, where rock melts (1,000 °C); the model has no melting of rock",
        "(e)": "⚠ unphysical: P exceeds N, by up to a factor of 1.25",
    }


def test_a_panel_of_hot_particles_has_one(make_run: MakeRun) -> None:
    folder = make_run()
    change_snapshot(folder, 4, temperature=4321.0)
    found = warnings(FIGURES["temperature"].draw(Run(folder)))
    assert list(found) == ["(b)"]
    assert "up to 4,321 °C" in found["(b)"]
    change_snapshot(folder, 4, liquid_saturation=0.0)
    assert warnings(FIGURES["temperature"].draw(Run(folder))) == {}, "dry"


def test_pore_pressure_is_compared_with_the_weight_above(make_run: MakeRun) -> None:
    folder = make_run()
    run = Run(folder)
    shot = run.snapshot(4)
    # Columns of two particles of 2,000 kg/m over a cell of 2 m, in up to four rows of stairs on the slope.
    weight = overburden(run, shot)
    cell = np.floor(shot.points[:, 0] / 2.0)
    for number in np.flatnonzero(cell == cell[25]):
        higher = (cell == cell[number]) & (shot.points[:, 1] > shot.points[number, 1])
        assert weight[number] == pytest.approx(9.81 / 2.0 * (shot["mass"][higher].sum() + 0.5 * 2000.0))
    for factor, words in (
        (1.9, {}),
        (6.0, "⚠ unphysical: in 5 % of particles P is at least 6 times the weight above"),
    ):
        for path in run.snapshot_files:
            with h5py.File(path, "r+") as file:
                pressure = 0.5 * overburden(run, run.snapshot(int(path.stem)))
                pressure[-8:] *= 2.0 * factor if path.stem.endswith("7") else 1.0
                file["VTKHDF/PointData/pore_pressure"][:] = pressure
        assert warnings(FIGURES["pore_pressure"].draw(Run(folder))) == ({"(c)": words} if words else {})


def test_normal_pressure_stands_next_to_pore_pressure(make_run: MakeRun) -> None:
    run = Run(make_run())
    pressure = next(axes for axes in FIGURES["band"].draw(run).axes if axes.get_title(loc="left").startswith("(b)"))
    lines = {str(line.get_label()): line for line in pressure.lines}
    assert pressure.get_ylabel() == "pore pressure (MPa)"
    np.testing.assert_allclose(
        1e6 * lines["pore pressure P"].get_ydata(), run.history["band_pore_pressure_Pa"], equal_nan=True
    )
    time, load = load_on_band(run)
    np.testing.assert_array_equal(time, run.times)
    np.testing.assert_allclose(1e6 * lines["normal pressure N, weight above"].get_ydata(), load)
    for index in (0, 5, 10):
        shot = run.snapshot(index)
        expected = 0.8 * overburden(run, shot)[shot["in_band"] == 1].mean()  # cos2 of a slope of 1/2
        assert load[index] == pytest.approx(expected)
    assert not len(load_on_band(Run(make_run(name="space", dimension=3)))[0])


def test_the_band_of_the_paper_has_the_same_warnings(make_run: MakeRun) -> None:
    run = Run(make_run())
    columns = run.history
    figure = figure_20({"lamplugh": run})
    (words,) = (text.get_text().replace("\n", " ") for text in figure.findobj(Text) if text.get_gid() == "warning")
    hottest = float(np.nanmax(columns["band_temperature_C"]))
    time, load = load_on_band(run)
    ratio = np.nanmax(np.interp(time, columns["time_s"], columns["band_pore_pressure_Pa"]) / load)
    assert f"up to {hottest:,.0f} °C, where water boils" in words
    assert f"P is up to {ratio:.3g} times the weight above" in words


def test_the_weight_above_is_that_over_the_width_of_the_section(make_run: MakeRun) -> None:
    folder = make_run()
    before = overburden(Run(folder), Run(folder).snapshot(4))
    case = folder / "case.toml"
    case.write_text(case.read_text().replace("width = 10.0", "width = { x = [0.0, 1.0], value = [10.0, 20.0] }"))
    np.testing.assert_allclose(overburden(Run(folder), Run(folder).snapshot(4)), 0.5 * before)
