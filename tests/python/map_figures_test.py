"""Figures of a 3D run on a DEM: values of the files, units, coordinates, terrain, and the 3D view."""

import re
import struct
import sys
from pathlib import Path

import imageio_ffmpeg
import map_runs
import numpy as np
import pytest
from conftest import Fails, edit, numbers, page_of, update_facts
from figure_parts import field, labels, maps_of, notes, plotted, titled
from map_runs import SOUTH, SPEED, THICKNESS, WEST, centres, write_map
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

import thawslide.figures  # noqa: F401
from thawslide import NotInRunError, ReportError, Run
from thawslide.figures import FIGURES, map_panel
from thawslide.figures.animation import MOST_FRAMES, Animation
from thawslide.figures.map_page import HIGHEST, WIDTH, layout
from thawslide.figures.site import make_site
from thawslide.maps import Grid, Map
from thawslide.number_text import number_text
from thawslide.report_page import figures_of, make_report

ON_MAP = [
    "extent_maps", "view", "animation", "slide_speed", "slide_thickness", "slide_temperature", "cross_sections",
    "impact_maps", "probes", "motion", "force", "band", "energy",
]  # fmt: skip
SPEED_LABEL = "depth-averaged speed (m/s), 4 s mean; at 0 s: instantaneous; at 10 s: mean of the last 2 s"


@pytest.mark.parametrize(
    ("name", "label", "value"),
    [
        ("slide_speed", SPEED_LABEL, SPEED * np.hypot(1.0, 0.4)),
        ("slide_thickness", "flow thickness (m), square-root scale; blue: below 0.1 m", THICKNESS),
        ("slide_temperature", "basal temperature (°C)", 10.0),
    ],
)
def test_maps_at_report_times_have_values_of_particles(map_run: Path, name: str, label: str, value: float) -> None:
    figure = plotted(name, map_run)
    panels = maps_of(figure)
    assert [axes.get_title(loc="left") for axes in panels] == [f"({c}) t = {2 * k} s" for k, c in enumerate("abcdef")]
    assert {label, "easting (km)", "northing (km)"} <= labels(figure)
    values = field(panels[-1]).get_array()
    assert values is not None and np.ma.max(values) == pytest.approx(value)
    west, east, south, _ = field(panels[-1]).get_extent()
    shown = np.argwhere(~np.ma.getmaskarray(values).all(axis=0)).ravel()
    start = west + (east - west) * shown[0] / values.shape[1]
    assert start == pytest.approx(WEST + 60.0 + SPEED * 10.0, abs=10.0) and south >= SOUTH
    assert "Coordinates: MGI / Austria Lambert (EPSG:31287)." in notes(figure)
    assert "Hillshade from the north-west" in notes(figure)


def test_extent_maps_have_titles_units_and_legend(map_run: Path) -> None:
    figure = plotted("extent_maps", map_run)
    panels = maps_of(figure)
    assert [axes.get_title(loc="left").replace("\n", " ") for axes in panels] == [
        "(a) maximum flow thickness", "(b) maximum speed", "(c) arrival time", "(d) flow thickness at 10 s",
    ]  # fmt: skip
    remarks = ({text.get_text() for text in axes.texts} | {axes.get_title(loc="right")} for axes in panels)
    for found, words in zip(remarks, ("max 6 m", "max 20 m/s", "0 to 9.8 s", "max 6 m"), strict=True):
        assert words in found
    first, *others = (axes.get_position() for axes in panels)
    assert all(other.y1 < first.y0 and other.width < 0.5 * first.width for other in others)
    assert field(panels[3]).norm.vmax == field(panels[0]).norm.vmax, "one scale of thicknesses"
    assert len(figure.axes) == len(panels) + 3, "no second colour bar of thicknesses"
    assert {"m, square-root scale\nblue: below 0.1 m", "m/s", "s"} <= labels(figure)
    assert " Outline: thickness > 0.1 m. " in notes(figure)
    assert np.ma.count(field(panels[3]).get_array()) == 8 * 6
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["release", "flow path", "probe"]
    assert "gate" in {text.get_text() for text in panels[0].texts}


def test_impact_maps_have_values_and_a_symmetric_elevation_change(map_run: Path) -> None:
    titles = [axes.get_title(loc="left")[4:] for axes in maps_of(plotted("impact_maps", map_run))]
    assert titles == [
        "maximum dynamic pressure", "maximum momentum flux", "maximum pore pressure", "maximum basal temperature",
        "elevation change at 10 s",
    ]  # fmt: skip
    components = FIGURES["force"].plot(Run(map_run)).axes[1]
    assert [text.get_text() for text in components.get_legend().get_texts()] == ["x (east)", "y (north)", "z (up)"]
    x, _ = centres()
    write_map(map_run / "maps" / "elevation_change.tif", np.where(x < WEST + 200.0, -19.3, 45.8), "m")
    figure = plotted("impact_maps", map_run)
    norm = field(maps_of(figure)[-1]).norm
    assert (norm.vmin, norm.vmax) == pytest.approx((-45.8, 45.8))
    assert norm(-10.0) + norm(10.0) == pytest.approx(1.0)
    assert {"−50", "−25", "0", "25", "50"} <= {label.get_text() for label in figure.axes[-1].get_yticklabels()}


@pytest.mark.parametrize("largest", [THICKNESS, 1.2e27])
def test_remarks_are_next_to_all_titles_or_in_all_maps(map_run: Path, largest: float) -> None:
    x, _ = centres()
    write_map(map_run / "maps" / "max_momentum_flux.tif", np.full(x.shape, largest), "m3/s2")
    panels = maps_of(plotted("impact_maps", map_run))
    titles = [axes.get_title(loc="right") for axes in panels]
    inside = [[text.get_text() for text in axes.texts if "max" in text.get_text()] for axes in panels]
    assert all(titles) == any(titles) and any(titles) != any(inside)
    assert number_text(largest) in (titles[1] or inside[1][0])


def test_probes_have_one_panel_per_quantity(map_run: Path) -> None:
    figure = plotted("probes", map_run)
    assert {"flow thickness (m)", "speed (m/s)", "flow area (m²)", "discharge (m³/s)"} <= labels(figure)
    thickness, speed, _, discharge = maps_of(figure)
    assert thickness.get_title(loc="left") == "(a) flow thickness"
    curves = [[str(line.get_label()) for line in panel.lines] for panel in (thickness, speed, discharge)]
    assert curves == [["gate", "weir (maximum)"], ["gate", "weir (mean)"], ["weir"]]
    assert speed.lines[1].get_color() == thickness.lines[1].get_color()
    assert list(speed.lines[1].get_ydata()) == [0.0, 18.0, 0.0]
    assert list(discharge.lines[0].get_ydata()) == [0.0, -6480.0, 0.0]
    assert discharge.get_ylim()[0] < -6480.0 and discharge.get_ylim()[1] == 0.0


def test_animation_has_different_frames_with_even_sides_up_to_a_limit(
    map_run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    video = FIGURES["animation"].plot(Run(map_run))
    assert isinstance(video, Animation)
    video.write(tmp_path / "video.mp4", 40)
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(tmp_path / "video.mp4"))
    assert frames == 6 and seconds == pytest.approx(6 / video.frames_per_second, abs=0.1)
    assert [path.name for path in tmp_path.glob("*.mp4")] == ["video.mp4"]
    first, *_, last = list(video.frames(41))
    assert first.shape == last.shape and not any(side % 2 for side in first.shape[:2])
    assert np.any(first != last)
    video = Animation(Run(map_run))
    with pytest.raises(ReportError, match=r"video\.mp4: cannot be written \("):
        video.write(tmp_path / "no such folder" / "video.mp4", 40)
    run = Run(map_run)
    monkeypatch.setitem(run.__dict__, "times", np.arange(1000.0))
    indices = Animation(run).indices
    assert (len(indices), indices[0], indices[-1]) == (MOST_FRAMES, 0, 999)


def test_report_has_figures_animation_and_maps(map_run: Path) -> None:
    run = Run(map_run)
    assert figures_of(run) == ON_MAP
    lines: list[str] = []
    report = make_report(run, dpi=40, progress=lines.append)
    assert list(report.figures) == ON_MAP
    assert lines[0] == f"[1/13] extent_maps: {map_run / 'figures' / 'extent_maps.png'}"
    page = report.page.read_text(encoding="utf-8")
    assert '<video controls loop muted src="data:video/mp4;base64,' in page
    assert '<th scope="row">max_pressure.tif</th><td>max pressure</td><td>Pa</td>' in page
    assert '<p>Folder: <a href="maps">maps</a></p>' in page and "Missing figures" not in page
    names = re.findall(r'<\w+ id="([^"]+)"', page)
    assert len(names) == len(set(names)), "a link leads to one place"
    assert {f"figure-{name}" for name in ON_MAP} <= set(re.findall(r'href="#([^"]+)"', page)) <= set(names)


def test_key_numbers_are_those_of_run_json_without_a_deposit_in_motion(map_run: Path) -> None:
    found = {words: value for words, (value, _) in numbers(Run(map_run)).items()}
    assert found.items() >= {
        "Deposit volume": "28,800 m³", "Deposit area": "4,800 m²", "Affected area": "16,800 m²", "H/L": "0.4",
        "Travel distance L": "280 m", "Stop time": "8.5 s",
    }.items()  # fmt: skip
    assert "Runout distance L" not in found
    warning = "the slide is not at rest at 10 s (mean velocity 20 m/s)."
    update_facts(map_run, at_rest=False, rest_since_s=None, simulated_time_s=10.0, warnings=[warning])
    run = Run(map_run)
    assert (run.last_state, run.end_note) == ("10 s (not at rest)", "The sliding mass is not at rest at 10 s. ")
    found = numbers(run)
    assert found["Covered volume at 10 s (not at rest)"][0] == "28,800 m³"
    assert found["Covered area at 10 s (not at rest)"][0] == "4,800 m²"
    assert found["Stop time"][0] == "not reached" and "at 10 s (not at rest)" in found["Travel distance L"][1]
    assert not any("eposit" in words for words in found)
    figure = plotted("extent_maps", map_run)
    assert figure.get_suptitle() == "Slab on a plane: extent, up to 10 s (not at rest)"
    assert titled(figure, "(d) flow thickness at\n10 s (not at rest)")
    page = page_of(map_run)
    assert f'<p class="note">Warning: {warning}</p>' in page and "Deposit" not in page


def test_outline_is_the_polygon_of_the_affected_area(map_run: Path) -> None:
    ring = np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [0.0, 0.0]])
    blob = b"GP\0\1" + struct.pack("<i", 31287) + struct.pack("<BIII", 1, 3, 1, len(ring)) + ring.tobytes()
    map_runs.write_layer(map_run / "maps" / "results.gpkg", "affected_area", [blob])
    site = make_site(Run(map_run))
    np.testing.assert_array_equal(site.affected, [ring])
    of_edges = "edge cells count by their covered fraction, the release by its outline"
    assert site.outline_words == f"affected area, thickness > 0.1 m; {of_edges}"
    axes = Figure().subplots()
    site.draw_outline(axes)
    np.testing.assert_array_equal(np.column_stack(axes.lines[0].get_data()), ring)


def test_missing_maps_are_errors(map_run: Path, fails: Fails) -> None:
    (map_run / "maps" / "results.gpkg").unlink()
    with pytest.raises(NotInRunError, match=r"results\.gpkg: no flow path\. Specify maps\.path"):
        plotted("cross_sections", map_run)
    (map_run / "maps" / "max_speed.tif").unlink()
    with pytest.raises(NotInRunError, match=r"max_speed\.tif: no such map \(found: "):
        list(Animation(Run(map_run)).frames(40))
    (map_run / "maps" / "terrain.tif").unlink()
    fails([str(map_run), "--only", "slide_speed"], "terrain.tif: no such map. Repeat the run.")


def test_maps_require_snapshots_and_heat(map_run: Path) -> None:
    edit(map_run / "case.toml", "enabled = true", "enabled = false")
    with pytest.raises(NotInRunError, match=r"heat\.enabled: temperatures are constant"):
        plotted("slide_temperature", map_run)
    for path in (map_run / "snapshots").iterdir():
        path.unlink()
    with pytest.raises(NotInRunError, match=r"no snapshots\. Set"):
        plotted("slide_speed", map_run)
    with pytest.raises(NotInRunError, match=r"too few snapshots for an animation \(found 0; allowed 2 or more\)"):
        Animation(Run(map_run))


def test_maps_of_a_run_without_motion_are_plotted(map_run: Path) -> None:
    x, _ = centres()
    for name in ("max_thickness", "final_thickness", "max_speed", "release"):
        write_map(map_run / "maps" / f"{name}.tif", np.zeros(x.shape))
    assert make_site(Run(map_run)).scene.box == pytest.approx((WEST, WEST + 600.0, SOUTH, SOUTH + 300.0))
    assert [axes.get_title(loc="left") for axes in maps_of(plotted("extent_maps", map_run))] == ["(a) arrival time"]


def test_maps_fit_a_page_and_their_terrain() -> None:
    heights = np.add.outer(np.arange(3000.0), np.arange(3000.0))
    scene = map_panel.make_scene(Map(Grid(5.0, 5.0, 10.0, 10.0, 3000, 3000), heights), (0.0, 30_000.0, 0.0, 30_000.0))
    assert max(scene.shade.shape) <= map_panel.MOST_CELLS and scene.terrain.grid.cell_x == 40.0
    # Two columns would leave half of the page empty; (count, aspect) of the comparison on a slope of the Alps.
    found = layout(7, 0.49, 0.62, 0.3, 1.2)
    assert found.columns == 3 and found.columns * (found.width + 0.62) > 0.7 * WIDTH
    whole = (0.0, 1000.0, 0.0, 2000.0)
    west, east, south, north = map_panel.page_box((900.0, 1100.0, 0.0, 2000.0), whole)
    assert (east, south, north) == (1000.0, 0.0, 2000.0)
    assert (east - west) / (north - south) == pytest.approx(0.45)
    assert map_panel.page_box((100.0, 500.0, 100.0, 400.0), whole) == (100.0, 500.0, 100.0, 400.0)
    values = np.ones((30, 30))
    values[12:, :12] = 0.0
    found = Map(Grid(0.5, 0.5, 1.0, 1.0, 30, 30), values)
    assert map_panel.quiet_corner(found, found.grid.box) == "upper left" and map_panel.covered_box(found, 2.0) is None
    assert map_panel.covered_box(found) == (0.0, 30.0, 0.0, 30.0)


@pytest.mark.parametrize("bar", [0.0, 0.72])
@pytest.mark.parametrize("aspect", [0.45, 0.7, 1.0, 1.6, 2.4])
@pytest.mark.parametrize("count", [1, 2, 4, 5, 6])
def test_maps_fill_a_page_within_its_margins(count: int, aspect: float, bar: float) -> None:
    found = layout(count, aspect, bar, 0.3, 1.5)
    rows = -(-count // found.columns)
    assert 1.15 <= found.width == pytest.approx(found.height * aspect)
    assert found.columns * (found.width + bar) <= WIDTH and rows * (found.height + 0.3) + 1.5 <= HIGHEST + 1e-9
    assert rows * found.columns - count <= 1


@pytest.mark.parametrize("inches", [0.6, 0.9, 1.0, 1.2, 2.0, 3.5, 6.8])
@pytest.mark.parametrize(
    ("low", "high"), [(5_199_140.0, 5_199_690.0), (380_000.0, 389_000.0), (6_500_000.0, 6_504_400.0), (-210.0, 130.0)]
)
def test_labels_of_coordinates_do_not_overlap(low: float, high: float, inches: float) -> None:
    found = map_panel.coordinates(low, high, inches)
    assert (2 if inches >= 2.0 else 1) <= len(found) <= 5
    assert low <= found[0] and found[-1] <= high
    lengths = np.array([len(map_panel.coordinate_text(place)) for place in found])
    assert (np.diff(found) * inches / (high - low) > 0.07 * 0.5 * (lengths[1:] + lengths[:-1])).all()


VIEW = sys.modules["thawslide.figures.view"]  # the package exports a function of the same name


@pytest.mark.parametrize("towards", [0.0, 1.0, -2.5])
def test_projection_keeps_lengths_to_the_right_and_hides_what_is_behind(towards: float) -> None:
    project = VIEW.Projection(towards)
    at = np.zeros(1)
    right, nearer = project.right, project.to_viewer
    np.testing.assert_allclose(project(at + right[0], at + right[1], at), [[1.0, 0.0]], atol=1e-12)
    np.testing.assert_allclose(project(at, at, at + 1.0), [[0.0, np.cos(np.radians(32.0))]], atol=1e-12)
    below = [[0.0, -np.sin(np.radians(32.0))]]
    np.testing.assert_allclose(project(at + nearer[0], at + nearer[1], at), below, atol=1e-12)
    assert np.isnan(project(at, at, np.full(1, np.nan))).all()


def test_viewer_is_in_front_of_the_slide_and_nearer_terrain_is_painted_last(map_run: Path) -> None:
    run = Run(map_run)
    assert VIEW._direction(make_site(run)) == pytest.approx(0.0, abs=1e-9)  # the slab moves to the east
    figure = VIEW.view(run)
    patches = [each.get_paths() for each in figure.axes[0].collections if isinstance(each, PolyCollection)]
    (paths,) = [each for each in patches if len(each) > 100]
    grid = VIEW._surroundings(make_site(Run(map_run))).grid
    assert len(paths) == (grid.rows - 1) * (grid.columns - 1)
    assert paths[0].vertices.mean(axis=0)[1] > paths[-1].vertices.mean(axis=0)[1]
    assert figure.axes[1].get_ylabel() == "maximum speed (m/s)"
