"""Warnings inside figures: panels and numbers."""

import numpy as np
import pytest
from conftest import MakeRun, change_snapshot, column_history, history_columns, write_history
from figure_parts import line, titled
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from reproduction.lamplugh_figures import figure_20
from thawslide import Run
from thawslide.boiling import boiling_temperature
from thawslide.figures import FIGURES
from thawslide.figures.load import load_on_band, overburden
from thawslide.number_text import number_text


def warnings(figure: Figure) -> dict[str, str]:
    """Return the warnings of a figure, by the first letters of their panels' titles."""

    def of(axes: Axes) -> str:
        return " ".join(text.get_text().replace("\n", " ") for text in axes.texts if text.get_gid() == "warning")

    return {axes.get_title(loc="left")[:3]: of(axes) for axes in figure.axes if of(axes)}


def test_physical_values_have_no_warning(make_run: MakeRun) -> None:
    columns = history_columns(101, 2)
    columns["band_pore_pressure_Pa"] *= 0.01
    columns["band_temperature_C"] = np.minimum(columns["band_temperature_C"], 99.0)
    run = Run(make_run(history=columns))
    for name in ("band", "temperature"):
        assert warnings(FIGURES[name].plot(run)) == {}


def test_band_above_the_boiling_point_has_a_warning(make_run: MakeRun) -> None:
    columns = history_columns(101, 2)
    columns["band_temperature_C"][-1] = 1262.0
    folder = make_run(history=columns)
    words = "⚠ unphysical: 1,260 °C exceeds the boiling point of water; boiling is not modelled"
    found = warnings(FIGURES["band"].plot(Run(folder)))
    time, load = load_on_band(Run(folder))
    ratio = np.interp(time, columns["time_s"], columns["band_pore_pressure_Pa"]) / load
    assert found == {"(a)": words, "(b)": f"⚠ unphysical: P/overburden up to {number_text(np.nanmax(ratio))}"}
    # Higher pressure raises the boiling point.
    hot = 1.002 * float(boiling_temperature(columns["band_pore_pressure_Pa"][50]))
    for temperature, warned in ((hot, True), (0.999 * hot, False)):
        columns["band_temperature_C"][:] = np.nan
        columns["band_temperature_C"][50] = temperature
        write_history(folder / "history.csv", columns)
        assert ("(a)" in warnings(FIGURES["band"].plot(Run(folder)))) is warned


def test_limit_of_boiling_columns_is_the_melting_point_of_rock(make_run: MakeRun) -> None:
    columns = column_history()
    folder = make_run(history=columns)
    assert warnings(FIGURES["band"].plot(Run(folder))) == {}
    columns["band_max_temperature_C"][-1] = 1262.0
    columns["band_max_pressure_ratio"][-1] = 1.25
    write_history(folder / "history.csv", columns)
    assert warnings(FIGURES["band"].plot(Run(folder))) == {
        "(b)": "⚠ unphysical: 1,260 °C exceeds the melting point of rock (1,000 °C); rock melting is not modelled",
        "(e)": "⚠ unphysical: P/N up to 1.25",
    }


def test_warnings_are_above_curves_and_unapplied_pressure_is_marked(make_run: MakeRun) -> None:
    figure = FIGURES["band"].plot(Run(make_run(history={"band_temperature_C": np.full(101, 400.0)})))
    figure.draw_without_rendering()
    (box,) = [text for text in figure.findobj(Text) if text.get_text().startswith("⚠ unphysical: 400 °C")]
    assert box.axes.transData.inverted().transform(box.get_window_extent().corners())[:, 1].min() > 400.0
    folder = make_run(name="dry", tables="[mechanisms]\npressurization = false\n")
    labels = [text.get_text() for text in FIGURES["band"].plot(Run(folder)).findobj(Text)]
    assert "pore pressure P, computed but not applied\n(mechanisms.pressurization = false)" in labels


def test_panel_of_hot_particles_has_a_warning(make_run: MakeRun) -> None:
    folder = make_run()
    change_snapshot(folder, 4, slice(3), temperature=4321.0)
    found = warnings(FIGURES["temperature"].plot(Run(folder)))
    assert list(found) == ["(b)"] and "4,320 °C exceeds" in found["(b)"]
    change_snapshot(folder, 4, slice(3), liquid_saturation=0.0)
    assert warnings(FIGURES["temperature"].plot(Run(folder))) == {}, "dry"


def test_pore_pressure_is_compared_with_the_overburden_of_the_width(make_run: MakeRun) -> None:
    folder = make_run()
    run = Run(folder)
    shot = run.snapshot(4)
    # Columns of two particles of 2,000 kg/m over a cell of 2 m, in up to four rows of stairs on the slope.
    weight, cell = overburden(run, shot), np.floor(shot.points[:, 0] / 2.0)
    for number in np.flatnonzero(cell == cell[25]):
        higher = (cell == cell[number]) & (shot.points[:, 1] > shot.points[number, 1])
        assert weight[number] == pytest.approx(9.81 / 2.0 * (shot["mass"][higher].sum() + 0.5 * 2000.0))
    for factor, words in ((1.9, {}), (6.0, {"(c)": "⚠ unphysical: P/overburden at least 6 in 5 % of particles"})):
        for number in range(11):
            pressure = 0.5 * overburden(run, run.snapshot(number))
            pressure[-8:] *= 2.0 * factor if number == 7 else 1.0
            change_snapshot(folder, number, pore_pressure=pressure)
        assert warnings(FIGURES["pore_pressure"].plot(Run(folder))) == words
    widening = "{ x = [0.0, 1.0], value = [10.0, 20.0] }"
    before, wide = (Run(make_run(name=f"width {width}"[:9], width=width)) for width in (10.0, widening))
    np.testing.assert_allclose(overburden(wide, wide.snapshot(4)), 0.5 * overburden(before, before.snapshot(4)))


def test_normal_pressure_is_next_to_pore_pressure_with_the_same_warnings_in_figure_20(make_run: MakeRun) -> None:
    run = Run(make_run())
    columns = run.series
    figure = figure_20({"lamplugh": run})
    (words,) = (text.get_text().replace("\n", " ") for text in figure.findobj(Text) if text.get_gid() == "warning")
    hottest = float(np.nanmax(columns["band_temperature_C"]))
    time, load = load_on_band(run)
    ratio = np.nanmax(np.interp(time, columns["time_s"], columns["band_pore_pressure_Pa"]) / load)
    assert f"{number_text(hottest)} °C exceeds the boiling point" in words
    assert f"P/overburden up to {number_text(ratio)}" in words
    np.testing.assert_array_equal(time, run.times)
    pressure = titled(FIGURES["band"].plot(run), "(b)")
    np.testing.assert_allclose(1e6 * line(pressure, "static normal pressure N")[1], load)
    for index in (0, 5, 10):
        shot = run.snapshot(index)
        expected = 0.8 * overburden(run, shot)[shot["in_band"] == 1].mean()  # cos2 of a slope of 1/2
        assert load[index] == pytest.approx(expected)
    assert not len(load_on_band(Run(make_run(name="space", dimension=3)))[0])
