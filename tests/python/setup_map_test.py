"""Figure of the setup of a case on a DEM: contents of its file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from map_runs import MIDDLE, SOUTH, WEST, centres, ground, slab
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.patches import Rectangle

from thawslide.command_line import main
from thawslide.maps import Grid, Map
from thawslide.setup_map import SetupOnMap, each_cell_once, plot_setup_on_map
from thawslide.setup_picture import read_setup


def grid_form(values: np.ndarray) -> dict[str, Any]:
    rows, columns = values.shape
    heights = [None if np.isnan(value) else value for value in values.ravel().tolist()]
    start = {"x0": WEST + 5.0, "y0": SOUTH + 5.0, "cell_x": 10.0, "cell_y": 10.0}
    return start | {"columns": columns, "rows": rows, "heights": heights}


def setup(**changes: Any) -> dict[str, Any]:
    x, y = centres()
    heights = ground(x, y)
    heights[:3, :3] = np.nan
    corners = [[60.0, -30.0], [140.0, -30.0], [140.0, 30.0], [60.0, 30.0], [60.0, -30.0]]
    outline = (np.array(corners) + np.array([WEST, MIDDLE])).tolist()
    body = {"name": "slab", "material": "ice", "outlines": [outline], "volume_m3": 28800.0}
    return {
        "title": "Slab",
        "crs": "EPSG:31287",
        "cell": 10.0,
        "min": [WEST + 20.0, SOUTH + 20.0],
        "max": [WEST + 580.0, SOUTH + 280.0],
        "terrain": grid_form(heights),
        "bodies": [body | {"thickness": grid_form(slab(x, y, 0.0))}],
        "path": [[WEST + 30.0, MIDDLE], [WEST + 500.0, MIDDLE]],
        "probes": {"gate": [[WEST + 300.0, MIDDLE]], "weir": [[WEST + 400.0, SOUTH + 50.0], [WEST + 400.0, MIDDLE]]},
    } | changes


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def write_setup(data: Any) -> Path:
        path = tmp_path / "setup.json"
        path.write_text(json.dumps(data))
        return path

    return write_setup


def read(path: Path) -> SetupOnMap:
    found = read_setup(path)
    assert isinstance(found, SetupOnMap)
    return found


def test_setup_on_a_dem_is_read(write: Any) -> None:
    found = read(write(setup()))
    x, y = centres()
    assert np.isnan(found.terrain.values[:3, :3]).all()
    np.testing.assert_allclose(found.terrain.values[3:], ground(x, y)[3:])
    assert found.domain == (WEST + 20.0, WEST + 580.0, SOUTH + 20.0, SOUTH + 280.0)
    (release,) = found.releases
    assert release.thickness is not None
    assert release.thickness.volume() == pytest.approx(28800.0)


def test_both_maps_have_domain_release_path_and_probes(write: Any) -> None:
    figure = plot_setup_on_map(read(write(setup())))
    overview, near, bar = figure.axes
    assert overview.get_title(loc="left") == "(a) whole domain; box: (b)"
    assert (near.get_title(loc="left"), near.get_title(loc="right")) == ("(b) release", "grid cells of 10 m")
    assert bar.get_ylabel() == "release thickness (m)"
    frames = [patch for patch in overview.patches if isinstance(patch, Rectangle)]
    assert (WEST + 20.0, 560.0, 260.0) in [(f.get_x(), f.get_width(), f.get_height()) for f in frames]
    (left, right), (low, high) = near.get_xlim(), near.get_ylim()
    assert left < WEST + 60.0 and right > WEST + 140.0 and right - left < 250.0
    assert low < MIDDLE - 30.0 and high > MIDDLE + 30.0
    (legend,) = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words == ["slab (ice): 28,800 m³, maximum thickness 6 m", "domain", "flow path", "probe"]
    assert {"gate", "weir"} <= {text.get_text() for text in overview.texts}
    note = figure.texts[-1].get_text().replace("\n", " ")
    assert note.startswith("Coordinates: EPSG:31287. Hillshade from the north-west, contour interval 20")
    assert note.endswith("(b): contour interval 5 m.")


def test_common_cells_of_bodies_are_painted_once() -> None:
    """Their value is the sum; other cells and maps with other grids are unchanged."""
    west = Map(Grid(0.0, 0.0, 10.0, 10.0, 3, 2), np.array([[4.0, 4.0, 2.0], [4.0, 4.0, 2.0]]))
    east = Map(Grid(20.0, 10.0, 10.0, 10.0, 2, 2), np.array([[1.0, 3.0], [1.0, 3.0]]))
    coarse = Map(Grid(0.0, 0.0, 20.0, 20.0, 1, 1), np.array([[7.0]]))
    first, second, third = each_cell_once([west, east, coarse])
    np.testing.assert_array_equal(first.values, [[4.0, 4.0, 2.0], [4.0, 4.0, 3.0]])
    np.testing.assert_array_equal(second.values, [[0.0, 3.0], [1.0, 3.0]])
    np.testing.assert_array_equal(third.values, [[7.0]])
    assert west.values[1, 2] == 2.0


@pytest.mark.parametrize(
    "changes",
    [
        {"bodies": []},
        {"path": None, "probes": None, "crs": None},
        {"path": [], "probes": {}, "crs": "", "bodies": [{"name": "a", "material": "ice"}]},
        {"bodies": [{"name": "a", "material": "ice", "outlines": [], "volume_m3": 2e7, "thickness": None}]},
    ],
)
def test_optional_parts_can_be_missing(write: Any, tmp_path: Path, changes: dict[str, Any]) -> None:
    picture = tmp_path / "out.png"
    assert main(["--setup", str(write(setup(**changes))), "--picture", str(picture), "--dpi", "50"]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"terrain": {"heights": []}}, "setup.json: not a setup of the simulator (found no key 'x0')."),
        (
            {"terrain": grid_form(np.ones((3, 4))) | {"rows": 5}},
            "setup.json: not a setup of the simulator (12 heights for 4 columns and 5 rows).",
        ),
        ({"bodies": [{"name": "a"}]}, "setup.json: not a setup of the simulator (found no key 'material')"),
    ],
)
def test_invalid_setups_are_errors(
    write: Any, tmp_path: Path, changes: dict[str, Any], text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--setup", str(write(setup(**changes))), "--picture", str(tmp_path / "out.png")]) == 2
    assert text in capsys.readouterr().err


def test_substrates_are_hatched_in_their_cells(write: Any) -> None:
    x, y = centres()
    numbers = np.where(x > WEST + 300.0, 2.0, 0.0) + 0.0 * y
    data = setup(substrates={"names": ["debris", "glacier"], "numbers": grid_form(numbers)})
    figure = plot_setup_on_map(read(write(data)))
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "substrate debris" in labels and "substrate glacier" in labels
    (hatched,) = hatched_areas(figure.axes[0])  # no cell has debris
    ends = np.concatenate([path.vertices for path in hatched.get_paths() if len(path.vertices)])
    assert ends[:, 0].min() == pytest.approx(WEST + 300.0, abs=10.0)
    assert not hatched_areas(plot_setup_on_map(read(write(setup()))).axes[0])


def hatched_areas(axes: Axes) -> list[QuadContourSet]:
    contours = [each for each in axes.collections if isinstance(each, QuadContourSet)]
    return [each for each in contours if any(each.hatches)]
