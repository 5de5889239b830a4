"""Probability and quantile maps against NumPy, those of sweeps of a 3D case, extents, and refused rasters."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rasterio
from conftest import CELL, Capture, read, write

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.figures.colours import PROBABILITY_LIMITS
from thawslide.sweeps.command import main
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.map_figure import probability_maps
from thawslide.sweeps.probability import rasters_in, write_probability_maps
from thawslide.sweeps.probability_command import main as probability


@pytest.fixture
def ensemble(tmp_path: Path) -> tuple[list[Path], dict[str, Numbers]]:
    random = np.random.default_rng(3)
    thickness = random.gamma(0.5, 2.0, (37, 70, 90))
    thickness[random.random(thickness.shape) < 0.5] = np.nan
    stacks = {"max_thickness": thickness, "max_speed": 10.0 * thickness, "arrival_time": 100.0 / thickness}
    folders = [tmp_path / f"member{number}" for number in range(37)]
    for name, stack in stacks.items():
        for folder, values in zip(folders, stack, strict=True):
            write(folder / "maps" / f"{name}.tif", values)
    return folders, stacks


@pytest.mark.parametrize("is_weighted", [False, True])
def test_maps_match_numpy(ensemble: tuple[list[Path], dict[str, Numbers]], tmp_path: Path, is_weighted: bool) -> None:
    """Unweighted maps match exactly; a member with an integer weight counts as so many."""
    folders, stacks = ensemble
    output = tmp_path / "out"
    weights = np.random.default_rng(4).integers(0, 5, len(folders)) if is_weighted else np.ones(len(folders), int)
    # Windows of 16 cells: the maps are computed in many parts.
    write_probability_maps(rasters_in(folders), output, memory=1.0, weights=weights if is_weighted else None)
    thickness, speed, arrival = (np.repeat(stack, weights, axis=0) for stack in stacks.values())
    thickness, speed = np.nan_to_num(thickness), np.nan_to_num(speed)
    for name, reached in (
        ("reached", np.isfinite(arrival)), ("thickness_above_0.5", thickness > 0.5), ("speed_above_5", speed > 5.0),
    ):  # fmt: skip
        found, expected = read(output / f"{name}.tif"), reached.mean(axis=0)
        assert found == pytest.approx(expected) if is_weighted else np.array_equal(found, expected)
    times = np.where(np.isnan(arrival), 1e30, arrival)
    for percent in (10, 50, 90):
        for name, stack in (("thickness", thickness), ("speed", speed), ("arrival", times)):
            expected = np.quantile(stack, percent / 100.0, axis=0, method="inverted_cdf")
            expected[expected == 1e30] = np.nan
            assert np.array_equal(read(output / f"{name}_p{percent}.tif"), expected, equal_nan=True)


def test_maps_have_styles_and_thresholds_also_of_reached_cells(
    ensemble: tuple[list[Path], dict[str, Numbers]], tmp_path: Path
) -> None:
    folders, _ = ensemble
    rasters = rasters_in(folders)
    paths = write_probability_maps(rasters, tmp_path / "out")
    assert all("colorrampshader" in path.with_suffix(".qml").read_text() for path in paths)
    with rasterio.open(tmp_path / "out" / "speed_p50.tif") as file:
        assert file.units == ("m/s",) and file.descriptions == ("50 % quantile of maximum speed",)
    names = {path.stem for path in write_probability_maps(rasters, tmp_path, {"speed": [7.0]})}
    assert {"speed_above_7", "thickness_above_0.5", "thickness_above_1", "thickness_above_5"} <= names
    assert "speed_above_5" not in names
    words = "probability of being reached: thickness above"

    def found(rasters: dict[str, list[Path]]) -> tuple[str, str]:
        write_probability_maps(rasters, tmp_path / "out")
        with rasterio.open(tmp_path / "out" / "reached.tif") as file:
            return file.descriptions[0], file.tags()["THRESHOLD"]

    assert found(rasters) == (f"{words} maps.arrival_thickness", "maps.arrival_thickness")
    for folder in folders:
        (folder / "case.toml").write_text("[maps]\narrival_thickness = 0.5\n")
    assert found(rasters) == (f"{words} 0.5 m", "0.5 m")
    thickness = {"thickness": rasters["thickness"]}
    assert found(thickness) == ("probability of being reached: maximum flow thickness above 0.1 m", "0.1 m")


def test_extents_can_differ_by_whole_cells_only(tmp_path: Path) -> None:
    values = {"a": [[1.0, 2.0]], "b": [[3.0, 4.0]]}
    files = [write(tmp_path / f"{k}.tif", np.array(values[k]), west=west) for k, west in (("a", 0.0), ("b", CELL))]
    assert probability([*map(str, files), "--output", str(tmp_path / "out"), "--thickness", "1.5"]) == 0
    assert np.array_equal(read(tmp_path / "out" / "thickness_above_1.5.tif"), [[0.0, 1.0, 0.5]])
    first = write(tmp_path / "first.tif", np.ones((2, 2)))
    for other in (
        write(tmp_path / "moved.tif", np.ones((2, 2)), west=4.0),
        write(tmp_path / "c.tif", np.ones((2, 2)), cell=20.0),
    ):
        with pytest.raises(ReportError, match="cells do not coincide"):
            write_probability_maps({"thickness": [first, other]}, tmp_path / "out")


def test_folders_without_maps_are_refused(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "empty").mkdir()
    assert probability([str(tmp_path / "empty")]) == 2 and "no map" in capsys.readouterr().err
    assert probability([str(tmp_path / "absent")]) == 2 and "no such file or folder" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("values", "quantity", "is_noted"),
    [
        (np.linspace(1002.0, 1498.0, 12), "thickness", True),  # a DEM
        (np.linspace(2.0, 400.0, 12), "thickness", True),  # near the sea
        (np.linspace(0.0, 600.0, 12), "thickness", True),
        (np.linspace(-1.0, 1.0, 12), "thickness", True),  # a difference
        (np.linspace(1002.0, 1498.0, 12), "arrival", True),
        (np.linspace(0.0, 900.0, 12), "speed", True),
        (np.linspace(0.0, 300.0, 12), "thickness", False),
        (np.where(np.arange(12) > 5, np.nan, 900.0), "arrival", False),
    ],
)  # fmt: skip
def test_other_rasters_are_named(
    tmp_path: Path, capsys: Capture, values: Numbers, quantity: str, is_noted: bool
) -> None:
    plain = write(tmp_path / "plain.tif", np.where(np.arange(12) > 5, np.nan, 3.0).reshape(3, 4))
    odd = write(tmp_path / "odd.tif", values.reshape(3, 4))
    assert probability([str(plain), str(odd), "--quantity", quantity, "--output", str(tmp_path / "out")]) == 0
    noted = [line for line in capsys.readouterr().err.splitlines() if "such as a DEM" in line]
    assert [str(odd) in line for line in noted] == [True] * is_noted


def test_figure_has_probabilities_in_classes_and_one_bar_for_each_quantity(tmp_path: Path) -> None:
    x = np.linspace(0.0, 1.0, 60)[None, :] * np.ones((40, 1))
    fields = {"reached": x, "thickness_above_1": 0.5 * x, "thickness_p50": 3.0 * x, "thickness_p90": 12.0 * x}
    files = [write(tmp_path / f"{name}.tif", values) for name, values in fields.items()]
    for path in files[2:]:
        with rasterio.open(path, "r+") as file:
            file.units = ("m",)
    figure = probability_maps(files, write(tmp_path / "terrain.tif", 100.0 * x), 8)
    maps = [axes for axes in figure.axes if axes.get_title(loc="left").startswith("(")]
    bars = [axes for axes in figure.axes if axes not in maps]
    assert [axes.get_ylabel() for axes in bars] == ["probability", "thickness (m)"]
    labels = [label.get_text() for label in bars[0].get_yticklabels()]
    assert labels == ["0", "0.05", "0.25", "0.5", "0.75", "0.95", "1"]
    norms = [axes.images[-1].norm for axes in maps]
    for norm in norms[:2]:
        shades = [float(norm(0.5 * (low + high))) for low, high in pairwise(PROBABILITY_LIMITS)]
        assert len(set(shades)) == 6 and norm(0.051) == norm(0.249) != norm(0.251)
    assert norms[2].vmax == norms[3].vmax == pytest.approx(12.0)


def test_probability_maps_are_those_of_members(plane: Path, tmp_path: Path, capfd: Capture) -> None:
    sweep = tmp_path / "sweep"
    command = [str(plane), "--vary", "basal.friction_angle=5:35:10", "--output", str(sweep), "--thickness", "2,10"]
    assert main([*command, "--speed", "5"]) == 0
    table = pd.read_parquet(sweep / "members.parquet")
    assert list(table["status"]) == ["done"] * 4 and table["peak_speed_m_s"].is_monotonic_decreasing
    folders = [SweepFolder(sweep).run_folder(number) for number in SweepFolder(sweep).done_members()]
    thickness = np.array([read(folder / "maps" / "max_thickness.tif") for folder in folders])
    arrival = np.array([read(folder / "maps" / "arrival_time.tif") for folder in folders])
    maps = sweep / "probability"
    assert np.array_equal(read(maps / "reached.tif"), np.isfinite(arrival).mean(axis=0))
    assert np.array_equal(read(maps / "thickness_above_10.tif"), (np.nan_to_num(thickness) > 10.0).mean(axis=0))
    median = np.quantile(np.nan_to_num(thickness), 0.5, axis=0, method="inverted_cdf")
    assert np.array_equal(read(maps / "thickness_p50.tif"), median)
    assert {path.name for path in folders[0].iterdir()} == {"case.toml", "history.csv", "maps", "run.json"}
    page = (sweep / "sweep.html").read_text()
    assert page.count("data:image/png") == 5 and "Not available" not in page
    assert "Reached: thickness above 0.1 m." in page
    assert probability([str(sweep), "--output", str(tmp_path / "again"), "--thickness", "10"]) == 0
    again = (tmp_path / "again" / "thickness_above_10.tif").read_bytes()
    assert again == (maps / "thickness_above_10.tif").read_bytes()
    assert capfd.readouterr().err.endswith("maps of 4 members\n")
    SweepFolder(sweep).write_record(3, {"status": "running", "starts": 1})
    assert probability([str(sweep), "--output", str(tmp_path / "three")]) == 0
    words = "maps of 3 members; not finished: 1. To continue, repeat the command of the sweep.\n"
    assert capfd.readouterr().err.endswith(words)


def test_maps_that_are_not_kept_are_removed(plane: Path, tmp_path: Path, capfd: Capture) -> None:
    sweep = tmp_path / "sweep"
    command = [str(plane), "--vary", "basal.friction_angle=5,25", "--output", str(sweep), "--keep", "none"]
    assert main(command) == 0
    reached = read(sweep / "probability" / "reached.tif")
    assert np.nanmax(reached) == 1.0
    assert not (SweepFolder(sweep).run_folder(0) / "maps").exists()
    assert main(command) == 0  # the page is written again from the maps of the sweep
    assert np.array_equal(read(sweep / "probability" / "reached.tif"), reached)
    assert list(pd.read_parquet(sweep / "members.parquet")["starts"]) == [1, 1]
    assert main([*command, "--thickness", "2"]) == 2
    assert "the thresholds cannot change (found thickness 2; allowed 0.5,1,5)" in capfd.readouterr().err
