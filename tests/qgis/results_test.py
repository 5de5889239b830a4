"""The algorithm 'Load results with styles': group, layers and styles of the saved project, and its picture."""

import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
import rasterio
from conftest import ROOT, Algorithm, Outcome, Script

Project = tuple[list[dict[str, Any]], Path, Path]
OUTLINES = ["front", "path", "affected_area", "deposit_area", "release_area"]


@pytest.fixture(scope="module")
def project(finished: tuple[Path, Outcome], script: Script, tmp_path_factory: pytest.TempPathFactory) -> Project:
    """Return the layers of the saved project, its picture, and the run."""
    run = finished[0]
    folder = tmp_path_factory.mktemp("project")
    assert script("load_results.py", run, folder / "slope.qgz")["is_saved"]
    read = script("read_project.py", folder / "slope.qgz", folder / "map.png")
    assert (read["errors"], list(read["groups"])) == ([], ["slope"])
    return read["groups"]["slope"], folder / "map.png", run


def test_group_contains_maps_and_styled_outlines(project: Project) -> None:
    layers, _, run = project
    maps = sorted(path.stem for path in (run / "maps").glob("*.tif"))
    assert [layer["name"] for layer in layers] == [*OUTLINES, *(name for name in maps if name != "terrain"), "terrain"]
    assert all(layer["is_valid"] for layer in layers)
    visible = [layer["name"] for layer in project[0] if layer["is_visible"]]
    assert visible == ["front", "path", "affected_area", "release_area", "max_thickness", "terrain"]
    styles = {layer["name"]: layer for layer in project[0]}
    assert styles["affected_area"]["color"] == "#b2182b"
    assert (styles["path"]["renderer"], styles["terrain"]["renderer"]) == ("singleSymbol", "hillshade")


def test_maps_have_the_colours_of_their_style_files(project: Project) -> None:
    layers, _, run = project
    compared = 0
    for layer in (layer for layer in layers if (run / "maps" / f"{layer['name']}.qml").is_file()):
        style = (run / "maps" / f"{layer['name']}.qml").read_text()
        stops = [[float(value), color] for value, color in re.findall(r'<item value="(\S+)".*? color="(\S+?)"', style)]
        assert layer["renderer"] == "singlebandpseudocolor"
        assert [color for _, color in layer["stops"]] == [color for _, color in stops]
        assert [value for value, _ in layer["stops"]] == pytest.approx([value for value, _ in stops])
        compared += 1
    assert compared >= 10


def test_picture_shows_the_release_on_the_terrain(project: Project) -> None:
    with rasterio.open(project[1]) as file:
        red, green, blue = (file.read(band).astype(int) for band in (1, 2, 3))
    is_coloured = abs(red - green) + abs(green - blue) > 30
    assert 0.02 < is_coloured.mean() < 0.2
    assert (~is_coloured & (red < 250)).mean() > 0.5


def test_a_run_without_maps_is_refused(algorithm: Algorithm, project: Project, binary: Path, tmp_path: Path) -> None:
    case = ROOT / "cases" / "incline" / "D.toml"
    command = [binary, "run", case, "--output", tmp_path / "run", "--threads", "1", "--set", "time.end=0.01"]
    subprocess.run(command, check=True, capture_output=True)
    opened = f"--PROJECT_PATH={project[1].with_name('slope.qgz')}"
    refused = algorithm("loadresults", opened, RUN=tmp_path / "run", code=1)
    assert "contains no maps. Choose the folder of a 3D run." in refused.stderr


def test_results_need_a_project(algorithm: Algorithm, finished: tuple[Path, Outcome]) -> None:
    assert "The results need an open project." in algorithm("loadresults", RUN=finished[0], code=None).stderr
