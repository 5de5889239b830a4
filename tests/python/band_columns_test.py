"""Reports of runs with band columns or an erodible bed: stresses, temperatures, boiling, heat, water, entrainment."""

from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, column_history, edit, numbers, page_of, snapshot_file, write_history
from figure_parts import line, plotted, texts, titled
from scipy.integrate import simpson

from thawslide import NotInRunError, Run
from thawslide.boiling import boiling_temperature, saturation_pressure
from thawslide.figures import FIGURES
from thawslide.figures.energy import relative_residual
from thawslide.figures.entrainment import entrained_depth
from thawslide.figures.water import LOSSES, relative_water_residual
from thawslide.key_numbers import stop_time
from thawslide.report_page import figures_of, make_report

BOILING = "boiling temperature at mean N"


def add_base(folder: Path) -> None:
    """Add 20 basal segments in random order to each snapshot except the first."""
    x = 20.0 + np.random.default_rng(1).permutation(20)
    for number in range(1, 11):
        with h5py.File(snapshot_file(folder, number), "a") as file:
            for name, values in {
                "position_m": np.stack([x, 100.0 - 0.5 * x, 0.0 * x], axis=1), "area_m2": np.full(20, 1.0),
                "normal_pressure_Pa": 1.0e6 + 1e4 * x, "pore_pressure_Pa": 1.0e4 * x * (number - 1) / 10,
                "temperature_C": 2.0 * x, "max_temperature_C": 3.0 * x,
            }.items():  # fmt: skip
                file[f"basal_segments/{name}"] = values


@pytest.fixture
def columns_run(make_run: MakeRun) -> Path:
    folder = make_run(history=column_history(), tables="[heat]\nsteam = true\n")
    add_base(folder)
    return folder


# Values of the C++ function thawslide::physics::boiling_temperature(P).
@pytest.mark.parametrize(
    ("pressure", "temperature"),
    [(0.0, 100.0), (2.0e5, 134.381906373124), (1.0e6, 187.243587897609), (2.0e6, 220.820904072478),
     (-3.0e4, 90.341987651245)],
)  # fmt: skip
def test_boiling_temperature_is_that_of_the_simulator(pressure: float, temperature: float) -> None:
    assert boiling_temperature(pressure) == pytest.approx(temperature, abs=1e-8)
    assert saturation_pressure(temperature) == pytest.approx(101325.0 + pressure, rel=1e-9)


def test_boiling_follows_clausius_and_clapeyron() -> None:
    # d(ln P)/dT = L_v/(R_v T^2), integrated by Simpson's rule from 100 C.
    for end in (40.0, 130.0, 215.0):
        t = np.linspace(100.0, end, 401)
        log_of_pressure = simpson((2.5e6 - 2360.0 * t) / (461.5 * (t + 273.15) ** 2), x=t)
        assert boiling_temperature(101325.0 * np.expm1(log_of_pressure)) == pytest.approx(end, abs=1e-7)
    assert np.isnan(boiling_temperature([np.nan, 0.0])).tolist() == [True, False]


def test_stresses_temperatures_and_basal_segments_have_their_panels(columns_run: Path) -> None:
    run = Run(columns_run)
    figure = FIGURES["band"].plot(run)
    stresses = titled(figure, "(a)")
    assert stresses.get_ylabel() == "stress (MPa)"
    load, pressure = run.series["band_normal_pressure_Pa"], run.series["band_pore_pressure_Pa"]
    np.testing.assert_allclose(line(stresses, "normal pressure N")[1] * 1e6, load)
    np.testing.assert_allclose(line(stresses, "pore pressure P")[1] * 1e6, pressure)
    np.testing.assert_allclose(line(stresses, "effective stress N − P")[1] * 1e6, load - pressure)
    np.testing.assert_allclose(line(stresses, "shear traction")[1] * 1e6, run.series["band_shear_Pa"])
    assert 'or on N alone for substrates with the law "coefficient"' in FIGURES["band"].caption_of(run)
    heat = titled(figure, "(b)")
    np.testing.assert_allclose(line(heat, "mean")[1], run.series["band_temperature_C"])
    np.testing.assert_allclose(line(heat, "maximum of all columns")[1], run.series["band_max_temperature_C"])
    np.testing.assert_allclose(line(heat, f"{BOILING} (above the panel)")[1], 187.243587897609)
    assert not any("boiling point" in text for axes in figure.axes for text in texts(axes))
    np.testing.assert_allclose(line(titled(figure, "(c)"), "run")[1], run.series["band_saturation"])
    np.testing.assert_allclose(line(titled(figure, "(d)"), "run")[1], 0.55)
    np.testing.assert_allclose(line(titled(figure, "(e)"), "run")[1], run.series["band_max_pressure_ratio"])
    figure = FIGURES["base_along"].plot(run)
    stress, heat = figure.axes[-2], figure.axes[-1]
    x, load = line(stress, "normal pressure N")
    np.testing.assert_array_equal(x, np.arange(20.0, 40.0))
    np.testing.assert_allclose(load, 1.0 + 0.01 * x)
    np.testing.assert_allclose(line(heat, "mean T")[1], 2.0 * x)
    np.testing.assert_allclose(line(heat, "boiling T at N")[1], boiling_temperature(1.0e6 + 1e4 * x))
    assert figure.axes[0].get_title(loc="left") != "t = 0 s", "times before the first contact have no panel"
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "normal pressure N", "pore pressure P", "N − P", "maximum T", "mean T", "boiling T at N",
    ]  # fmt: skip


def test_legend_does_not_cover_the_stresses(columns_run: Path) -> None:
    targets = next(columns_run.glob("**/*targets*.csv"))
    for reported in ("", "band_pore_pressure,4,9e5,Pa,some laboratory\n"):
        targets.write_text("quantity,time_s,value,unit,source\n" + reported)
        figure = plotted("band", columns_run)
        figure.draw_without_rendering()
        stresses = titled(figure, "(a)")
        legend = stresses.get_legend()
        assert legend is not None and len(legend.get_texts()) == 4 + bool(reported)
        box, panel = legend.get_window_extent(), stresses.get_window_extent()
        assert box.y1 <= panel.y1 and panel.x0 <= box.x0 < box.x1 <= panel.x1
        highest = max(float(np.nanmax(curve.get_ydata())) for curve in stresses.lines)
        assert box.y0 > stresses.transData.transform((0.0, highest))[1]


def test_thermal_terms_include_band_columns(columns_run: Path) -> None:
    run = Run(columns_run)
    thermal = titled(FIGURES["energy"].plot(run), "(b)")
    t = run.series["time_s"]
    assert not {found.get_label() for found in thermal.lines} & {"gained from the body", "heat in band columns"}
    warming = line(thermal, "warming and melting of columns")[1]
    heat, joined = (run.series[name] - run.series[name][0] for name in ("column_heat_J", "column_intake_J"))
    np.testing.assert_allclose(warming, (heat - joined) / 1e12, atol=1e-9)
    np.testing.assert_allclose(line(thermal, "lost with steam")[1], 0.15 * t, atol=1e-9)
    columns = column_history()
    # Colder material, all of which joins: heat relative to the reference state changes, warming does not.
    columns |= {name: columns[name] - 5e13 * t for name in ("column_heat_J", "column_intake_J")}
    write_history(columns_run / "history.csv", columns)
    colder = titled(plotted("energy", columns_run), "(b)")
    np.testing.assert_allclose(line(colder, "warming and melting of columns")[1], warming, atol=1e-9)
    columns["column_heat_J"] = 1e14 * t + columns["column_intake_J"]
    write_history(columns_run / "history.csv", columns)
    np.testing.assert_allclose(relative_residual(Run(columns_run), "thermal_residual_J"), 2e2 * t / 1e15)


def test_water_terms_have_their_panels_also_if_they_are_zero(columns_run: Path, make_run: MakeRun) -> None:
    run = Run(columns_run)
    figure = FIGURES["water"].plot(run)
    t = run.series["time_s"]
    for letter, unit, label, values in (
        ("a", "mass (million t)", "gained from the body", 3.0 + 0.04 * t),
        ("b", "mass (thousand t)", "steam", 10.0 * t),
        ("c", "volume (thousand m³)", "openings along the base", 0.05 * t),
    ):
        axes = titled(figure, f"({letter})")
        assert axes.get_ylabel() == unit
        np.testing.assert_allclose(line(axes, label)[1], values)
    np.testing.assert_allclose(relative_water_residual(run), 1e-3 * t / 3.4e9)
    assert titled(figure, "(d)").get_yscale() == "log"
    nothing = column_history() | {name: np.zeros(101) for name in LOSSES}
    figure = plotted("water", make_run(name="nothing", history=nothing))
    losses = titled(figure, "(b)")
    assert "all terms are zero" in texts(losses) and not losses.lines
    assert "all terms are zero" not in texts(titled(figure, "(a)"))


def test_runs_without_columns_have_no_figures_of_columns_but_a_stop_time(make_run: MakeRun) -> None:
    run = Run(make_run())
    assert "water" not in figures_of(run)
    with pytest.raises(NotInRunError, match="found no band columns"):
        FIGURES["water"].plot(run)
    assert len(FIGURES["band"].plot(run).axes) == 4
    assert FIGURES["band"].caption_of(run) == FIGURES["band"].caption
    thermal = titled(FIGURES["energy"].plot(run), "(b)")
    assert not any("column" in str(found.get_label()) for found in thermal.lines)
    assert "Maximum temperature of all columns" not in numbers(run)
    assert not FIGURES["base_along"].suits(run) and not FIGURES["entrainment"].suits(run)
    with pytest.raises(NotInRunError, match="no basal segments in the snapshots"):
        FIGURES["base_along"].plot(run)
    with pytest.raises(NotInRunError, match=r"found no \[bed\] in the case"):
        FIGURES["entrainment"].plot(run)
    # 12 sin2(pi t/10) in rows of 0.1 s: below 0.1 m/s from 9.709 s on
    assert stop_time(run, 0.1) == pytest.approx(9.8) and stop_time(run, 20.0) is None


def test_report_of_columns_has_their_figures_and_numbers(columns_run: Path) -> None:
    expected = ["motion", "velocity", "plastic_strain", "force", "band", "base_along", "energy", "water"]
    assert figures_of(Run(columns_run)) == expected
    page = page_of(columns_run, "band", "energy", "water")
    assert "Water does not boil" not in page and "heat.steam is false" not in page
    assert "Area-weighted means over the base" in page and "particles next to the terrain" not in page
    assert numbers(Run(columns_run)).items() >= {
        "Maximum temperature of all columns": ("170 °C", "at 10 s"),
        "Maximum pore pressure ratio P/N": ("1", "at 10 s"), "Water lost as steam": ("100,000 t", "until the end"),
    }.items()  # fmt: skip
    edit(columns_run / "case.toml", "steam = true", "steam = false")
    page = page_of(columns_run, "band")
    assert "from 9.3 s on and attains 110 °C. Water does not boil because heat.steam is false." in page


def test_figures_of_columns_without_contact_are_written(columns_run: Path, tmp_path: Path) -> None:
    columns = column_history(1)
    columns |= {name: np.full(1, np.nan) for name in columns if name.startswith("band_") and not name.endswith("_J")}
    columns |= {name: np.zeros(1) for name in columns if name.startswith("column_")}
    write_history(columns_run / "history.csv", columns)
    run = Run(columns_run)
    for name in ("band", "energy", "water"):
        FIGURES[name].plot(run).savefig(tmp_path / "figure.png")
    assert texts(titled(FIGURES["band"].plot(run), "(d)")) == ["no contact"]
    assert texts(titled(FIGURES["water"].plot(run), "(d)")) == ["residual is zero"]


def test_reference_lines_do_not_widen_the_panels(make_run: MakeRun) -> None:
    history = {"band_temperature_C": np.linspace(-8.0, -6.0, 101), "band_max_temperature_C": np.full(101, -5.0)}
    folder = make_run(history=column_history() | history | {"band_max_pressure_ratio": np.full(101, 0.01)})
    add_base(folder)
    figure = FIGURES["band"].plot(Run(folder))
    heat, ratio = titled(figure, "(b)"), titled(figure, "(e)")
    assert -8.2 < heat.get_ylim()[0] <= -8.0 and heat.get_ylim()[1] < 0.0
    line(heat, f"{BOILING} (above the panel)")
    assert ratio.get_ylim()[1] == pytest.approx(0.0108)
    along = FIGURES["base_along"].plot(Run(folder)).axes[-1]
    assert along.get_ylim()[1] < 150.0 < line(along, "boiling T at N")[1].min()


BED_DENSITY, JOINED = 900.0, 8  # kg/m3; particles of the bed in the last snapshot


@pytest.fixture
def bed_run(make_run: MakeRun) -> Path:
    t = np.linspace(0.0, 10.0, 101)
    columns = {
        "entrained_mass_kg": 2e4 * t, "entrained_volume_m3": 2e4 * t / BED_DENSITY, "entrained_work_J": 1e6 * t,
        "entrained_heat_J": 4e5 * t, "loose_mass_kg": np.full(101, 1e3), "bed_mass_kg": 1e6 - 2e4 * t,
        "bed_residual_kg": np.zeros(101), "bed_residual_J": np.zeros(101),
    }  # fmt: skip
    tables = '[body.block]\nmaterial = "rock"\n[bed]\nlaw = "momentum"\ndepth = 1.0\n'
    folder = make_run(history=columns, tables=tables)
    with h5py.File(folder / "snapshots" / "000010.vtkhdf", "r+") as file:
        group = file["VTKHDF"]
        for owner, name in [(group, "Points"), *((group["PointData"], name) for name in list(group["PointData"]))]:
            values = owner[name][:]
            joined = values[:JOINED].copy()
            if name in ("body", "mass"):
                joined[:] = 1 if name == "body" else 900.0
            if name == "id":
                joined += len(values)
            if name == "displacement":
                joined[:, 0] = group["Points"][:JOINED, 0] - 60.5  # all of one cell, from 59 to 61 m
            attributes = dict(owner[name].attrs)
            del owner[name]
            owner.create_dataset(name, data=np.concatenate([values, joined])).attrs.update(attributes)
    return folder


def test_entrainment_has_a_depth_a_figure_and_a_key_number(bed_run: Path) -> None:
    run = Run(bed_run)
    edges, depth = entrained_depth(run)
    cell = int(np.searchsorted(edges, 60.5)) - 1
    assert edges[cell + 1] - edges[cell] == 8.0
    assert depth[cell] == pytest.approx(JOINED * 1.0 / 8.0)  # 1 m3 each per metre of width, in four cells 2 m wide
    assert np.count_nonzero(depth) == 1
    assert "entrainment" in figures_of(run)
    figure = FIGURES["entrainment"].plot(run)
    np.testing.assert_allclose(line(titled(figure, "(b)"), "work of entrainment")[1][-1], 10.0)  # MJ
    assert numbers(run)["Entrained bed volume"][0] == "222 m³"
    report = make_report(Run(bed_run), names=["velocity", "entrainment", "energy"], dpi=40)
    assert set(report.figures) == {"velocity", "entrainment", "energy"}
    for name in ("entrained_mass_kg", "entrained_volume_m3", "entrained_work_J", "entrained_heat_J"):
        run.series[name][:] = 0.0
    figure = FIGURES["entrainment"].plot(run)
    for panel in ("(b)", "(c)"):
        assert "no entrainment" in texts(titled(figure, panel)) and not titled(figure, panel).lines
