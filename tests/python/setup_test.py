"""Figures of the setup of a 2D case and of a case on a DEM: contents of their files."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Fails
from map_runs import MIDDLE, SOUTH, WEST, centres, ground, slab
from matplotlib.axes import Axes
from matplotlib.collections import FillBetweenPolyCollection, LineCollection, PolyCollection
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from thawslide.command_line import main
from thawslide.maps import Grid, Map
from thawslide.setup_map import SetupOnMap, each_cell_once, plot_setup_on_map
from thawslide.setup_picture import plot_setup, read_setup

Write = Callable[[Any], Path]


def section(**changes: Any) -> dict[str, Any]:
    x, z = np.meshgrid(np.arange(0.05, 1.0, 0.1), np.arange(0.05, 0.5, 0.1))
    points = np.stack([x.ravel(), z.ravel()], 1).tolist()
    return {
        "title": "Block", "cell": 0.2, "min": [-1.0, -0.4], "max": [6.0, 2.0],
        "boundary": {"x_min": "roller", "x_max": "roller", "y_min": "fixed", "y_max": "open"},
        "terrain": {"x": [-1.0, 6.0], "z": [0.0, 0.0]},
        "bodies": [{"name": "block", "material": "ice", "points": points, "spacing": 0.1}],
        "frames": [{"name": "pusher", "min": [-0.3, 0.0], "max": [0.0, 0.6], "axis": "x", "velocity": 2.0}],
    } | changes  # fmt: skip


def grid_form(values: np.ndarray) -> dict[str, Any]:
    rows, columns = values.shape
    heights = [None if np.isnan(value) else value for value in values.ravel().tolist()]
    start = {"x0": WEST + 5.0, "y0": SOUTH + 5.0, "cell_x": 10.0, "cell_y": 10.0}
    return start | {"columns": columns, "rows": rows, "heights": heights}


def on_map(**changes: Any) -> dict[str, Any]:
    x, y = centres()
    heights = ground(x, y)
    heights[:3, :3] = np.nan
    corners = [[60.0, -30.0], [140.0, -30.0], [140.0, 30.0], [60.0, 30.0], [60.0, -30.0]]
    outline = (np.array(corners) + np.array([WEST, MIDDLE])).tolist()
    body = {"name": "slab", "material": "ice", "outlines": [outline], "volume_m3": 28800.0}
    return {
        "title": "Slab", "crs": "EPSG:31287", "cell": 10.0, "min": [WEST + 20.0, SOUTH + 20.0],
        "max": [WEST + 580.0, SOUTH + 280.0], "terrain": grid_form(heights),
        "bodies": [body | {"thickness": grid_form(slab(x, y, 0.0))}],
        "path": [[WEST + 30.0, MIDDLE], [WEST + 500.0, MIDDLE]],
        "probes": {"gate": [[WEST + 300.0, MIDDLE]], "weir": [[WEST + 400.0, SOUTH + 50.0], [WEST + 400.0, MIDDLE]]},
    } | changes  # fmt: skip


@pytest.fixture
def write(tmp_path: Path) -> Write:

    def write_setup(data: Any) -> Path:
        path = tmp_path / "setup.json"
        path.write_text(data if isinstance(data, str) else json.dumps(data))
        return path

    return write_setup


def plotted_section(path: Path) -> Figure:
    return plot_setup(read_setup(path))


def legend_of(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_both_panels_have_all_parts_and_borders_of_cells(write: Write) -> None:
    figure = plotted_section(write(section()))
    overview, zoom = figure.axes
    assert overview.get_title(loc="left") == "(a) whole domain, true scale; box: (b)"
    assert zoom.get_title(loc="left") == "(b) bodies, true scale, cells of 0.2 m"
    assert (zoom.get_xlabel(), zoom.get_ylabel()) == ("distance (m)", "elevation (m)")
    for axes in (overview, zoom):
        ground, *bodies = [c for c in axes.collections if isinstance(c, PolyCollection)]
        assert isinstance(ground, FillBetweenPolyCollection)
        assert [len(body.get_paths()) for body in bodies] == [50]
        frames = [p for p in axes.patches if isinstance(p, Rectangle) and p.get_hatch()]
        assert [(p.get_x(), p.get_y(), p.get_width(), p.get_height()) for p in frames] == [(-0.3, 0.0, 0.3, 0.6)]
    left, right = overview.get_xlim()
    assert left < -1.0 and right > 6.0
    (box,) = [p for p in overview.patches if not p.get_hatch()]
    assert (box.get_x(), box.get_x() + box.get_width()) == pytest.approx(zoom.get_xlim())
    assert legend_of(figure) == [
        "block (ice): 50 particles, spacing 0.1 m", "terrain", "frame pusher, 2 m/s along x", "roller: x min, x max",
        "fixed: y min", "open: y max",
    ]  # fmt: skip
    sides = [found for found in figure.axes[0].lines if found.get_color() == "black"]
    assert [found.get_linestyle() for found in sides] == ["--", "--", "-", ":"]
    assert list(sides[2].get_ydata()) == [-0.4, -0.4]
    (grid,) = [c for c in zoom.collections if isinstance(c, LineCollection)]
    upright = sorted(s[0][0] for s in (np.asarray(p.vertices) for p in grid.get_paths()) if s[0][0] == s[1][0])
    left, right = zoom.get_xlim()
    cells = (np.array(upright) + 1.0) / 0.2
    np.testing.assert_allclose(cells, np.round(cells[0]) + np.arange(len(cells)), atol=1e-9)
    assert left - 1e-9 <= upright[0] and upright[-1] <= right and len(upright) > 10
    _, zoom = plotted_section(write(section(cell=0.002))).axes
    assert zoom.get_title(loc="left").startswith("(b) bodies, true scale, cells of 0.002 m, one grid line per ")
    (grid,) = [c for c in zoom.collections if isinstance(c, LineCollection)]
    assert len(grid.get_paths()) < 500


def test_substrates_are_lines_on_the_terrain(write: Write) -> None:
    terrain = {"x": [-1.0, 1.0, 3.0, 6.0], "z": [0.0, 0.0, -1.0, -1.0]}
    data = section(terrain=terrain, substrates={"names": ["glacier"], "numbers": [0, 0, 1, 1]})
    figure = plotted_section(write(data))
    assert "substrate glacier" in legend_of(figure)
    (line,) = [each for each in figure.axes[0].lines if each.get_linewidth() == 3.0]
    shown = ~np.isnan(np.asarray(line.get_ydata(), float))
    assert np.asarray(line.get_xdata())[shown].tolist() == [3.0, 6.0]


def test_both_maps_have_domain_release_path_and_probes(write: Write) -> None:
    found = read_setup(write(on_map()))
    assert isinstance(found, SetupOnMap) and np.isnan(found.terrain.values[:3, :3]).all()
    np.testing.assert_allclose(found.terrain.values[3:], ground(*centres())[3:])
    figure = plot_setup_on_map(found)
    overview, near, bar = figure.axes
    assert overview.get_title(loc="left") == "(a) whole domain; box: (b)"
    assert (near.get_title(loc="left"), near.get_title(loc="right")) == ("(b) release", "grid cells of 10 m")
    assert bar.get_ylabel() == "release thickness (m)"
    frames = [patch for patch in overview.patches if isinstance(patch, Rectangle)]
    assert (WEST + 20.0, 560.0, 260.0) in [(f.get_x(), f.get_width(), f.get_height()) for f in frames]
    (left, right), (low, high) = near.get_xlim(), near.get_ylim()
    assert left < WEST + 60.0 and right > WEST + 140.0 and right - left < 250.0
    assert low < MIDDLE - 30.0 and high > MIDDLE + 30.0
    assert legend_of(figure) == ["slab (ice): 28,800 m³, maximum thickness 6 m", "domain", "flow path", "probe"]
    assert {"gate", "weir"} <= {text.get_text() for text in overview.texts}
    note = figure.texts[-1].get_text().replace("\n", " ")
    assert note.startswith("Coordinates: EPSG:31287. Hillshade from the north-west, contour interval 20")
    assert note.endswith("(b): contour interval 5 m.")


def test_common_cells_of_bodies_are_painted_once() -> None:
    west = Map(Grid(0.0, 0.0, 10.0, 10.0, 3, 2), np.array([[4.0, 4.0, 2.0], [4.0, 4.0, 2.0]]))
    east = Map(Grid(20.0, 10.0, 10.0, 10.0, 2, 2), np.array([[1.0, 3.0], [1.0, 3.0]]))
    coarse = Map(Grid(0.0, 0.0, 20.0, 20.0, 1, 1), np.array([[7.0]]))
    first, second, third = each_cell_once([west, east, coarse])
    np.testing.assert_array_equal(first.values, [[4.0, 4.0, 2.0], [4.0, 4.0, 3.0]])
    np.testing.assert_array_equal(second.values, [[0.0, 3.0], [1.0, 3.0]])
    np.testing.assert_array_equal(third.values, [[7.0]])
    assert west.values[1, 2] == 2.0


def test_substrates_are_hatched_in_their_cells(write: Write) -> None:
    x, y = centres()
    numbers = np.where(x > WEST + 300.0, 2.0, 0.0) + 0.0 * y
    data = on_map(substrates={"names": ["debris", "glacier"], "numbers": grid_form(numbers)})
    figure = plot_setup_on_map(read_setup(write(data)))
    assert {"substrate debris", "substrate glacier"} <= set(legend_of(figure))
    (hatched,) = hatched_areas(figure.axes[0])  # no cell has debris
    ends = np.concatenate([path.vertices for path in hatched.get_paths() if len(path.vertices)])
    assert ends[:, 0].min() == pytest.approx(WEST + 300.0, abs=10.0)
    assert not hatched_areas(plot_setup_on_map(read_setup(write(on_map()))).axes[0])


def hatched_areas(axes: Axes) -> list[QuadContourSet]:
    contours = [each for each in axes.collections if isinstance(each, QuadContourSet)]
    return [each for each in contours if any(each.hatches)]


LITTLE = [
    section(terrain=None), section(bodies=[]), section(bodies=None, frames=None, boundary=None), on_map(bodies=[]),
    on_map(path=None, probes=None, crs=None),
    on_map(path=[], probes={}, crs="", bodies=[{"name": "a", "material": "ice"}]),
    on_map(bodies=[{"name": "a", "material": "ice", "outlines": [], "volume_m3": 2e7, "thickness": None}]),
]  # fmt: skip


@pytest.mark.parametrize("data", LITTLE)
def test_optional_parts_can_be_missing(write: Write, tmp_path: Path, data: dict[str, Any]) -> None:
    picture = tmp_path / "new" / "out.png"
    assert main(["--setup", str(write(data)), "--picture", str(picture), "--dpi", "50"]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


NO_SETUP = "setup.json: not a setup of the simulator"
FIVE_ROWS = on_map(terrain=grid_form(np.ones((3, 4))) | {"rows": 5})


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("{", "setup.json: not valid JSON"), ([], "setup.json: not a JSON object."), (section(cell="wide"), NO_SETUP),
        ({"title": "Block"}, f"{NO_SETUP} (found no key 'min'). Repeat `thawslide check --picture`."),
        (section(cell=0.0), "domain from -1 to 6 m with cells of 0 m"), (section(cell=1e-9), "m with cells of 1e-09 m"),
        (section(max=[1e400, 20.0]), "domain from -1 to inf m"),
        (section(terrain={"x": [0.0, 1.0], "z": [0.0]}), "x, z and substrates of the terrain differ in length"),
        (section(terrain={"x": [0.0, None], "z": [0.0, 1.0]}), "a number is missing or not finite"),
        (on_map(terrain={"heights": []}), f"{NO_SETUP} (found no key 'x0')."),
        (FIVE_ROWS, f"{NO_SETUP} (12 heights for 4 columns and 5 rows)."),
        (on_map(bodies=[{"name": "a"}]), f"{NO_SETUP} (found no key 'material')"),
    ],
)  # fmt: skip
def test_invalid_setups_are_errors(write: Write, tmp_path: Path, fails: Fails, content: Any, text: str) -> None:
    fails(["--setup", str(write(content)), "--picture", str(tmp_path / "out.png")], text)


def test_missing_setup_and_unknown_image_type_are_errors(write: Write, tmp_path: Path, fails: Fails) -> None:
    fails(["--setup", str(tmp_path / "none.json"), "--picture", str(tmp_path / "out.png")], "none.json: no such file")
    command = ["--setup", str(write(section())), "--picture", str(tmp_path / "out.nothing")]
    fails(command, "out.nothing: unknown file type (allowed: .")
