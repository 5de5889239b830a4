"""Contents of figures: data of the run, units and terrain; and figures of runs with little data."""

import re
import struct
from pathlib import Path

import numpy as np
import pytest
from conftest import MakeRun, change_snapshot, column_history, edit, ground, history_columns, numbers, write_history
from figure_parts import line, plotted, texts, titled
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import FillBetweenPolyCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.text import Text

from thawslide import NotInRunError, Run
from thawslide.band_pass import band_passed
from thawslide.figures import FIGURES
from thawslide.figures.colours import TEMPERATURE, colour_range, label_bar, normalization
from thawslide.figures.energy import relative_residual
from thawslide.figures.moments import chosen_snapshots
from thawslide.figures.style import COLUMN_WIDTH, TIME_LABEL, without_title
from thawslide.figures.window import fit
from thawslide.report_page import make_report

SCALE = re.compile("true scale|vertical exaggeration|particles outside")
SNAPSHOT_FIGURES = ("velocity", "plastic_strain", "temperature", "pore_pressure")


def legend_notes(axes: Axes) -> list[str]:
    legend = axes.get_legend()
    assert legend is not None
    found = [text.get_text().replace("\n", " ") for text in legend.get_texts()]
    return [text for text in found if text.endswith(" of the run") or " of the run, " in text]


def particles(axes: Axes) -> PolyCollection:
    polygons = [each for each in axes.collections if isinstance(each, PolyCollection)]
    (found,) = [each for each in polygons if not isinstance(each, FillBetweenPolyCollection)]
    return found


def centres_and_sizes(axes: Axes) -> tuple[np.ndarray, np.ndarray]:
    """Return centres and sizes of the particles of a panel, shape (n, 2)."""
    low, high = np.array([path.get_extents().get_points() for path in particles(axes).get_paths()]).swapaxes(0, 1)
    return 0.5 * (low + high), high - low


@pytest.mark.parametrize(
    ("name", "label", "low", "high"),
    [
        ("velocity", "speed (m/s), 2 s mean; at 0 s: instantaneous", 0.0, 6.0 * np.sqrt(5.0)),
        ("plastic_strain", "equivalent plastic strain (–)", 0.0, 0.7 * np.exp(-0.5)),
        ("temperature", "temperature (°C)", -10.0, -10.0 + 14.0 * np.exp(-0.5)),
        ("pore_pressure", "pore pressure (kPa)", 0.0, 1400.0 * np.exp(-0.5)),
    ],
)
def test_snapshot_panels_have_a_common_scale(make_run: MakeRun, name: str, label: str, low: float, high: float) -> None:
    figure = FIGURES[name].plot(Run(make_run()))
    (bar,) = [axes for axes in figure.axes if axes.get_xlabel() == label]
    assert bar.get_xlim() == pytest.approx((low, high))
    panels = [axes for axes in figure.axes if axes.get_title(loc="left").startswith("(")]
    assert [axes.get_title(loc="left") for axes in panels] == ["(a) t = 0 s", "(b) t = 4 s", "(c) t = 7 s"]
    assert all(texts(axes)[0] == "true scale" for axes in panels)
    values = particles(panels[2]).get_array()
    assert values is not None and np.max(values) == pytest.approx(high)
    assert panels[0].get_ylabel() == "elevation (m)"


def test_snapshot_panels_have_particles_of_their_size_on_the_terrain(make_run: MakeRun) -> None:
    run = Run(make_run())
    figure = FIGURES["velocity"].plot(run)
    panel, shot = titled(figure, "(b)"), run.snapshot(4)
    centres, sizes = centres_and_sizes(panel)
    np.testing.assert_allclose(centres, shot.points[:, :2])
    # Cubes of 1 m on cells of 2 m: gaps narrower than a cell are closed.
    np.testing.assert_allclose(sizes, [(2.0, 1.0)] * len(shot.points))
    (ground_line,) = [found for found in panel.lines if len(found.get_xdata()) == 21]
    np.testing.assert_allclose(ground_line.get_ydata(), ground(np.asarray(ground_line.get_xdata(), dtype=float)))
    assert any(isinstance(c, FillBetweenPolyCollection) for c in panel.collections)
    (left, right), (bottom, top) = panel.get_xlim(), panel.get_ylim()
    assert left < shot.points[:, 0].min() and right > shot.points[:, 0].max()
    assert bottom < shot.points[:, 1].min() and top > shot.points[:, 1].max()
    width, height = figure.get_size_inches() * panel.get_position().size
    assert (right - left) / width == pytest.approx((top - bottom) / height), "true scale"


def test_block_on_a_tilted_plane_is_drawn_once(make_run: MakeRun) -> None:
    """The strip would have the scale of the panel; its height is not an elevation."""
    folder = make_run(times="[0.0, 4.0]", case_keys="gravity_tilt = 30.0\n")
    (folder / "terrain.csv").write_text("distance_m,terrain_elevation_m\n0.0,0.0\n200.0,0.0\n")
    for number in (0, 4):
        x, y, z = Run(folder).snapshot(number).points.T
        change_snapshot(folder, number, points=np.stack([x, 1.55 * (y - ground(x) - 0.5), z], axis=1))
    found = {axes.get_ylabel() for axes in FIGURES["velocity"].plot(Run(folder)).axes}
    assert "height above\nslope (m)" in found and not found & {"height above\nterrain (m)", "elevation (m)"}


def test_strips_have_heights_and_exaggeration_and_the_overview_the_range_of_each_panel(make_run: MakeRun) -> None:
    figure = plotted("velocity", make_run())
    strips = [axes for axes in figure.axes if axes.get_ylabel() == "height above\nterrain (m)"]
    assert len(strips) == 3
    np.testing.assert_allclose(np.unique(np.round(centres_and_sizes(strips[1])[0][:, 1], 9)), [0.5, 1.5, 2.5, 3.5])
    for axes in strips:
        width, height = figure.get_size_inches() * axes.get_position().size
        (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
        times = (right - left) / width / ((high - low) / height)
        assert texts(axes) == [f"vertical exaggeration {times:.2g}×"]
    assert titled(figure, "whole profile, true scale; grey: t = 0 s, red: t = 7 s")
    (bars,) = [axes for axes in figure.axes if "range of each panel" in axes.get_xlabel()]
    assert bars.get_xlabel().startswith("distance (m)")
    assert bars.lines[2].get_xdata() == pytest.approx(titled(figure, "(b)").get_xlim())
    assert bars.lines[3].get_xdata() == pytest.approx((68.5, 87.5))


def test_notes_on_scale_and_particles_are_between_panels_and_titles(make_run: MakeRun, map_run: Path) -> None:
    """Inside a panel, they would cover the sliding mass."""
    folder = make_run()
    edit(folder / "case.toml", "max = [200.0, ", "max = [60.0, ")  # panels end there
    for path, names in ((folder, SNAPSHOT_FIGURES), (map_run, ("cross_sections",))):
        for name in names:
            figure = plotted(name, path)
            figure.draw_without_rendering()
            notes = [(axes, text) for axes in figure.axes for text in axes.texts if SCALE.search(text.get_text())]
            assert len(notes) > 3
            assert any("of 80 particles outside" in text.get_text() for _, text in notes) == (path == folder)
            for axes, text in notes:
                note, titles = text.get_window_extent(), {axes.get_title(loc="left"), axes.get_title(loc="right")}
                assert note.y0 >= axes.get_window_extent().y1, (name, text)
                shown = [each for each in axes.findobj(Text) if each.get_text() in titles - {""}]
                assert all(each.get_window_extent().y0 >= note.y1 for each in shown), (name, text)


def test_three_dimensions_are_projected_and_without_terrain_there_is_no_fill(make_run: MakeRun) -> None:
    for axes in plotted("temperature", make_run(terrain=False)).axes:
        assert "above" not in axes.get_ylabel()
        assert not any(isinstance(c, FillBetweenPolyCollection) for c in axes.collections)
    run = Run(make_run(name="space", dimension=3))
    panel, points = titled(FIGURES["velocity"].plot(run), "(b)"), run.snapshot(4).points
    order = np.argsort(-points[:, 1], kind="stable")  # distant ones first
    np.testing.assert_allclose(centres_and_sizes(panel)[0][:, 1], points[order, 2])


def test_ticks_are_round() -> None:
    figure = Figure()
    norm, _ = normalization(np.linspace(-9.45, 35.8, 1000), TEMPERATURE)
    bar = figure.colorbar(ScalarMappable(norm), cax=figure.add_subplot(), orientation="horizontal")
    label_bar(bar, norm)
    assert [label.get_text() for label in bar.ax.get_xticklabels()] == ["−5", "0", "10", "20", "30"]


def test_window_exaggerates_only_long_flat_sections() -> None:
    for length, height, exaggeration in (1000.0, 1000.0, 1), (8000.0, 200.0, 10):
        found = fit((0.0, length), (0.0, height), 2.0, None)  # 17.8 times would fill the box
        assert found.exaggeration == exaggeration
        assert found.right - found.left == pytest.approx(2.0 * exaggeration * (found.top - found.bottom))
    assert found.note() == "vertical exaggeration 10×"
    shifted = fit((0.0, 100.0), (0.0, 100.0), 4.0, (-10.0, 1000.0))
    assert (shifted.left, shifted.right - shifted.left) == (-10.0, pytest.approx(4.0 * 130.0))


def test_colour_range_excludes_outliers() -> None:
    low, high, extend = colour_range(np.concatenate([np.linspace(0.0, 1.0, 1000), [50.0]]), from_zero=True)
    assert (low, extend) == (0.0, "max") and 0.99 < high <= 1.0
    low, high, extend = colour_range(np.full(5, -10.0), from_zero=False)
    assert low < -10.0 < high and extend == "neither"
    assert colour_range(np.zeros(5), from_zero=True) == (0.0, 0.5, "neither")
    assert colour_range(np.full(3, np.nan), from_zero=False) == (0.0, 1.0, "neither")


def test_motion_has_reported_values_only_with_targets(make_run: MakeRun) -> None:
    run = Run(make_run())
    speed, distance = FIGURES["motion"].plot(run).axes
    time, front = run.series["time_s"], run.series["front_position_m"]
    for axes, label, expected in (
        (speed, "mean (mass-weighted)", [time, run.series["mean_velocity_m_s"]]),
        (speed, "reported: seismic", [[4.0, 6.0], [9.0, 11.0]]),
        (distance, "mean path length (mass-weighted)", [time, run.series["mean_displacement_m"]]),
        (distance, "front travel distance", [time, front - front[0]]),
        (distance, "reported mean displacement: model", [[10.0], [80.0]]),
        (distance, "reported runout distance: field", [[10.0], [160.0]]),
    ):
        np.testing.assert_array_equal(line(axes, label), expected)
    assert [axes.get_title(loc="left")[:7] for axes in (speed, distance)] == ["(a) spe", "(b) dis"]
    assert (speed.get_ylabel(), distance.get_ylabel()) == ("speed (m/s)", "distance (m)")
    assert (speed.get_xlabel(), distance.get_xlabel()) == (TIME_LABEL, TIME_LABEL)
    figure = plotted("motion", make_run(name="bare", targets=False))
    labels = [str(found.get_label()) for axes in figure.axes for found in axes.lines]
    assert len(labels) == 5 and not any("reported" in label for label in labels)


def test_maximum_velocity_ends_at_rest(make_run: MakeRun) -> None:
    run = Run(make_run(facts={"status": "done", "at_rest": True, "rest_since_s": 6.0}))
    moving = titled(plotted("motion", make_run(name="moving")), "(a) speed")
    assert len(line(moving, "maximum")[0]) == run.series.rows
    before = run.series["time_s"] <= 6.0
    assert 0 < before.sum() < len(before)
    maximum = line(titled(FIGURES["motion"].plot(run), "(a) speed"), "maximum, until rest")
    np.testing.assert_array_equal(maximum, [run.series["time_s"][before], run.series["max_velocity_m_s"][before]])


def test_front_travel_distance_begins_at_the_first_known_front(make_run: MakeRun) -> None:
    known = history_columns(11, 2)["runout_m"]
    known[:2] = np.nan
    run = Run(make_run(rows=11, history={"front_position_m": known, "runout_m": known}))
    front = line(titled(FIGURES["motion"].plot(run), "(b) distance"), "front travel distance")[1]
    np.testing.assert_allclose(front, [np.nan, np.nan, *(12.0 * np.arange(9.0))], atol=1e-12)
    assert numbers(run)["Runout distance L"] == ("160 m", "front at 10 s minus initial rear")
    assert numbers(run)["Front travel distance"] == ("96 m", "front at 10 s minus front at 2 s, the first known")


def test_reported_values_outside_the_run_are_counted_in_the_legend(make_run: MakeRun) -> None:
    until_5_s = {name: values[:51] for name, values in history_columns(101, 2).items()}
    speed, distance = plotted("motion", make_run(history=until_5_s)).axes
    np.testing.assert_array_equal(line(speed, "reported: seismic"), [[4.0], [9.0]])
    assert legend_notes(speed) == ["1 reported value after the end of the run"]
    assert legend_notes(distance) == [
        "1 reported value of mean displacement after the end of the run",
        "1 reported value of runout distance after the end of the run",
    ]
    targets = "quantity,time_s,value,unit\nmean_velocity,-100,9,m/s\nmean_velocity,99,9,m/s\n"
    speed, _ = plotted("motion", make_run(name="outside", targets=targets)).axes
    assert not [marks for marks in speed.lines if str(marks.get_label()).startswith("reported")]
    assert legend_notes(speed) == [
        "1 reported value before the start of the run, 1 reported value after the end of the run"
    ]


def test_seismic_force_has_components_and_reported_maxima_per_width(make_run: MakeRun) -> None:
    run = Run(make_run())
    figure = FIGURES["force"].plot(run)
    size, parts = titled(figure, "(a)"), titled(figure, "(b)")
    x, y = run.series["seismic_force_x_N"], run.series["seismic_force_y_N"]
    passed = [band_passed(run.series["time_s"], part, 2.0, 8.0) for part in (x, y)]
    for axes, label, expected in (
        (size, "run", np.hypot(x, y)), (size, "run, band-pass 2 to 8 s", np.hypot(*passed)), (parts, "x (along)", x),
        (parts, "y (up)", y),
    ):  # fmt: skip
        np.testing.assert_allclose(line(axes, label)[1] * 1e9, expected)
    for maximum, source in (280.0, "280 GN: seismic"), (110.0, "110 GN (2 to 8 s): waves"):
        np.testing.assert_array_equal(line(size, f"reported maximum {source}")[1], [maximum, maximum])
    assert size.get_ylabel() == "force (GN)"
    (strain,) = titled(figure, "(c)").lines
    np.testing.assert_array_equal(strain.get_ydata(), run.series["mean_plastic_strain"])
    space = titled(plotted("force", make_run(name="space", dimension=3)), "(b)")
    assert [found.get_label() for found in space.lines] == ["x (along)", "y (across)", "z (up)"]
    bare = titled(plotted("force", make_run(name="bare", targets=False)), "(a)")
    assert [found.get_label() for found in bare.lines] == ["run"]
    thin = titled(plotted("force", make_run(name="thin", width=0.0)), "(a)")
    assert thin.get_ylabel() == "force (GN/m of width)"
    assert [found.get_label() for found in thin.lines] == ["run", "run, band-pass 2 to 8 s"]
    assert texts(thin) == ["reported force not shown: no case.width"]


def test_band_has_the_history_with_gaps_or_a_reason(make_run: MakeRun) -> None:
    run = Run(make_run())
    figure = FIGURES["band"].plot(run)
    for start, label, column, divisor, axis_label in (
        ("(a)", "run", "band_temperature_C", 1.0, "temperature (°C)"),
        ("(b)", "pore pressure P", "band_pore_pressure_Pa", 1e6, "pore pressure (MPa)"),
        ("(c)", "run", "band_saturation", 1.0, "liquid saturation (–)"),
        ("(d)", "run", "band_friction_coefficient", 1.0, "friction coefficient (–)"),
    ):
        axes = titled(figure, start)
        np.testing.assert_allclose(line(axes, label)[1] * divisor, run.series[column])
        assert axes.get_ylabel() == axis_label
    np.testing.assert_array_equal(line(titled(figure, "(c)"), "reported: model"), [[4.0], [0.3]])
    assert texts(titled(figure, "(a)"))[:2] == ["melting point", "boiling point"]
    unknown = {name: np.full(101, np.nan) for name in ("band_temperature_C", "band_friction_coefficient")}
    folder = make_run(name="unknown", history=unknown)
    edit(folder / "history.csv", "band_saturation", "band_other")
    figure = plotted("band", folder)
    found = {letter: texts(titled(figure, f"({letter})")) for letter in "acd"}
    no_column = ["no column band_saturation in history.csv"]
    assert found == {"a": ["no particles in the band"], "c": no_column, "d": ["no contact"]}


def test_energy_terms_are_changes_residuals_relative_and_small_terms_below(make_run: MakeRun) -> None:
    run = Run(make_run())
    figure = FIGURES["energy"].plot(run)
    mechanical, thermal, residual = (titled(figure, f"({letter})") for letter in "abc")
    t = run.series["time_s"]
    np.testing.assert_allclose(line(mechanical, "potential")[1], -t, atol=1e-12)
    np.testing.assert_allclose(line(mechanical, "kinetic")[1], 0.4 * t)
    np.testing.assert_allclose(line(thermal, "sensible heat")[1] * 1e12, 0.15e12 * t, atol=1.0)
    assert mechanical.get_ylabel() == "energy change (TJ)"
    omitted = "below 0.5 % of the largest of their budget: viscous work, damping, impact on the terrain, work of frames"
    assert omitted in figure.get_supxlabel().replace("\n", " ")
    assert residual.get_yscale() == "log"
    np.testing.assert_allclose(line(residual, "mechanical")[1][1:], 1e3 * t[1:] / 1e13)
    np.testing.assert_allclose(line(residual, "thermal")[1][1:], 2e2 * t[1:] / 2e12)
    for size, is_shown in ((0.0049, False), (0.0051, True)):  # of the potential energy
        damping = {"damping_J": np.linspace(0.0, size * 1e13, 101)}
        figure = plotted("energy", make_run(name=f"run {is_shown}", history=damping))
        assert ("damping" not in figure.get_supxlabel()) == is_shown
        assert ("damping" in {found.get_label() for found in titled(figure, "(a)").lines}) == is_shown


def test_one_row_is_a_marker_without_a_residual(make_run: MakeRun) -> None:
    folder = make_run(rows=1, targets=False)
    assert relative_residual(Run(folder), "mechanical_residual_J") is None
    assert texts(titled(plotted("energy", folder), "(a)")) == ["no change of any term"]
    assert [found.get_marker() for found in titled(plotted("motion", folder), "(a)").lines] == ["o", "o"]


@pytest.mark.parametrize("name", ["motion", *SNAPSHOT_FIGURES, "force", "band", "energy"])
def test_figures_of_one_row_and_one_snapshot_are_written(make_run: MakeRun, tmp_path: Path, name: str) -> None:
    FIGURES[name].plot(Run(make_run(rows=1, snapshots=1, targets=False))).savefig(tmp_path / "figure.png")
    assert (tmp_path / "figure.png").stat().st_size > 5000


def test_figures_require_snapshots_budget_and_force(make_run: MakeRun) -> None:
    folder = make_run(snapshots=0)
    write_history(folder / "history.csv", {"time_s": np.arange(3.0)})
    for name, text in (
        *((name, r"no snapshots\. Set") for name in SNAPSHOT_FIGURES),
        ("energy", "no columns of the energy budget"),
        ("force", "no column seismic_force_x_N"),
    ):
        with pytest.raises(NotInRunError, match=text):
            FIGURES[name].plot(Run(folder))


def test_scale_of_high_temperatures_is_logarithmic_up_to_the_maximum(make_run: MakeRun) -> None:
    values = np.concatenate([np.full(600, -10.0), np.linspace(0.0, 900.0, 400), [5000.0]])
    norm, extend = normalization(values, TEMPERATURE)
    assert (norm.vmin, norm.vmax, extend) == (-10.0, 5000.0, "neither")
    # Decades have equal and sufficient lengths.
    first, second = np.diff(norm(np.array([10.0, 100.0, 1000.0])))
    assert second == pytest.approx(first) and first > 0.15
    folder = make_run()
    for number in range(11):
        change_snapshot(folder, number, slice(3), temperature=4321.0)
    figure = FIGURES["temperature"].plot(Run(folder))
    figure.canvas.draw()
    (bar,) = [axes for axes in figure.axes if axes.get_xlabel().startswith("temperature (°C)")]
    assert bar.get_xlabel() == "temperature (°C), logarithmic scale above 10 °C"
    assert [label.get_text() for label in bar.get_xticklabels()][-2:] == ["100", "4,320"]


def test_runs_that_split_particles_show_the_velocities_of_the_file(make_run: MakeRun) -> None:
    folder = make_run()
    shown = chosen_snapshots(Run(folder))[1]["velocity"]
    edit(folder / "case.toml", "[grid]\n", "[mechanics]\nsplit_stretched = true\n[grid]\n")
    run = Run(folder)
    shot = chosen_snapshots(run)[1]
    np.testing.assert_array_equal(shot["velocity"], run.snapshot(time=shot.time)["velocity"])
    assert not np.array_equal(shown, shot["velocity"]), "otherwise those of displacement"


def check(figure: Figure) -> None:
    assert 4.0 <= figure.get_size_inches()[0] <= COLUMN_WIDTH
    figure.draw_without_rendering()
    visible = [text for text in figure.findobj(Text) if text.get_text() and text.get_visible()]
    assert [text.get_text() for text in visible if text.get_fontsize() < 6.0] == []  # points
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    letters = [found[1] for title in titles if (found := re.match(r"\((.)\) ", title))]
    assert letters == list("abcdefghijklmnopqrstuvwxyz"[: len(letters)])


def test_figures_have_the_width_of_two_columns(make_run: MakeRun, map_run: Path) -> None:
    folder = make_run()
    names = [name for name, kind in FIGURES.items() if kind.suits(Run(folder))]
    assert len(names) > 5
    for name in names:
        check(plotted(name, folder))
    columns = make_run(name="columns", history=column_history())
    for name in ("band", "water"):
        check(plotted(name, columns))
    for name in ("extent_maps", "slide_speed", "cross_sections", "impact_maps"):
        check(plotted(name, map_run))


def test_figures_without_title_have_larger_panels(make_run: MakeRun) -> None:
    figure = FIGURES["band"].plot(Run(make_run()))
    assert figure.get_suptitle()
    figure.draw_without_rendering()
    high = figure.axes[0].get_position().y1
    assert without_title(figure).get_suptitle() == ""
    figure.draw_without_rendering()
    assert figure.axes[0].get_position().y1 > high, "the panels use the space of the title"


@pytest.mark.parametrize("name", ["motion", "velocity"])
def test_images_have_150_dots_per_inch(make_run: MakeRun, name: str) -> None:
    image = make_report(Run(make_run()), names=[name]).figures[name].read_bytes()
    width = struct.unpack(">I", image[16:20])[0]  # of a PNG's first block
    assert width == int(150 * COLUMN_WIDTH)
