"""Figure of the setup of a 2D case: contents of its file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import FillBetweenPolyCollection, LineCollection, PolyCollection
from matplotlib.patches import Rectangle

from thawslide.command_line import main
from thawslide.setup_picture import plot_setup, read_setup


def setup(**changes: Any) -> dict[str, Any]:
    x, z = np.meshgrid(np.arange(0.05, 1.0, 0.1), np.arange(0.05, 0.5, 0.1))
    return {
        "title": "Block",
        "cell": 0.2,
        "min": [-1.0, -0.4],
        "max": [6.0, 2.0],
        "boundary": {"x_min": "roller", "x_max": "roller", "y_min": "fixed", "y_max": "open"},
        "terrain": {"x": [-1.0, 6.0], "z": [0.0, 0.0]},
        "bodies": [
            {"name": "block", "material": "ice", "points": np.stack([x.ravel(), z.ravel()], 1).tolist(), "spacing": 0.1}
        ],
        "frames": [{"name": "pusher", "min": [-0.3, 0.0], "max": [0.0, 0.6], "axis": "x", "velocity": 2.0}],
    } | changes


@pytest.fixture
def write(tmp_path: Path) -> Any:
    def write_setup(data: Any) -> Path:
        path = tmp_path / "setup.json"
        path.write_text(data if isinstance(data, str) else json.dumps(data))
        return path

    return write_setup


def test_both_panels_have_bodies_terrain_and_frame(write: Any) -> None:
    figure = plot_setup(read_setup(write(setup())))
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


def test_grid_lines_are_the_borders_of_cells(write: Any) -> None:
    _, zoom = plot_setup(read_setup(write(setup()))).axes
    (grid,) = [c for c in zoom.collections if isinstance(c, LineCollection)]
    upright = sorted(s[0][0] for s in (np.asarray(p.vertices) for p in grid.get_paths()) if s[0][0] == s[1][0])
    left, right = zoom.get_xlim()
    cells = (np.array(upright) + 1.0) / 0.2
    np.testing.assert_allclose(cells, np.arange(cells[0], cells[0] + len(cells)), atol=1e-9)
    np.testing.assert_allclose(cells, np.round(cells), atol=1e-9)
    assert left - 1e-9 <= upright[0] and upright[-1] <= right and len(upright) > 10


def test_grid_lines_of_small_cells_are_thinned(write: Any) -> None:
    _, zoom = plot_setup(read_setup(write(setup(cell=0.002)))).axes
    assert zoom.get_title(loc="left").startswith("(b) bodies, true scale, cells of 0.002 m, one grid line per ")
    (grid,) = [c for c in zoom.collections if isinstance(c, LineCollection)]
    assert len(grid.get_paths()) < 500


def test_legend_has_all_parts(write: Any) -> None:
    (legend,) = plot_setup(read_setup(write(setup()))).legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "block (ice): 50 particles, spacing 0.1 m",
        "terrain",
        "frame pusher, 2 m/s along x",
        "roller: x min, x max",
        "fixed: y min",
        "open: y max",
    ]


def test_boundaries_have_line_styles(write: Any) -> None:
    overview, _ = plot_setup(read_setup(write(setup()))).axes
    sides = [found for found in overview.lines if found.get_color() == "black"]
    assert [found.get_linestyle() for found in sides] == ["--", "--", "-", ":"]
    assert list(sides[2].get_ydata()) == [-0.4, -0.4]


@pytest.mark.parametrize(
    "changes", [{"terrain": None}, {"bodies": []}, {"bodies": None, "frames": None, "boundary": None}]
)
def test_optional_parts_can_be_missing(write: Any, tmp_path: Path, changes: dict[str, Any]) -> None:
    picture = tmp_path / "new" / "out.png"
    assert main(["--setup", str(write(setup(**changes))), "--picture", str(picture)]) == 0
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("{", "setup.json: not valid JSON"),
        (
            {"title": "Block"},
            "setup.json: not a setup of the simulator (found no key 'min'). Repeat `thawslide check --picture`.",
        ),
        ([], "setup.json: not a JSON object."),
        (setup(cell="wide"), "setup.json: not a setup of the simulator"),
        (setup(cell=0.0), "domain from -1 to 6 m with cells of 0 m"),
        (setup(cell=1e-9), "m with cells of 1e-09 m"),
        (setup(max=[1e400, 20.0]), "domain from -1 to inf m"),
        (setup(terrain={"x": [0.0, 1.0], "z": [0.0]}), "x, z and substrates of the terrain differ in length"),
        (setup(terrain={"x": [0.0, None], "z": [0.0, 1.0]}), "a number is missing or not finite"),
    ],
)
def test_invalid_setups_are_errors(
    write: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str], content: Any, text: str
) -> None:
    assert main(["--setup", str(write(content)), "--picture", str(tmp_path / "out.png")]) == 2
    assert text in capsys.readouterr().err


def test_missing_setup_and_unknown_image_type_are_errors(
    write: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--setup", str(tmp_path / "none.json"), "--picture", str(tmp_path / "out.png")]) == 2
    assert "none.json: no such file" in capsys.readouterr().err
    assert main(["--setup", str(write(setup())), "--picture", str(tmp_path / "out.nothing")]) == 2
    assert "out.nothing: unknown file type (allowed: ." in capsys.readouterr().err


def test_substrates_are_lines_on_the_terrain(write: Any) -> None:
    terrain = {"x": [-1.0, 1.0, 3.0, 6.0], "z": [0.0, 0.0, -1.0, -1.0]}
    data = setup(terrain=terrain, substrates={"names": ["glacier"], "numbers": [0, 0, 1, 1]})
    figure = plot_setup(read_setup(write(data)))
    assert "substrate glacier" in [text.get_text() for text in figure.legends[0].get_texts()]
    (line,) = [each for each in figure.axes[0].lines if each.get_linewidth() == 3.0]
    shown = ~np.isnan(np.asarray(line.get_ydata(), float))
    assert np.asarray(line.get_xdata())[shown].tolist() == [3.0, 6.0]
