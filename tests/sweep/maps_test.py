"""Sweeps of a 3D case: probability maps equal those of the members' maps, and maps that are not kept are removed."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import Capture
from probability_test import CELL, read, write, write_box

from thawslide.sweeps.command import main
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.probability_command import main as probability

COLUMNS, ROWS, NORTH = 24, 16, 6_500_160.0


@pytest.fixture
def plane(tmp_path: Path) -> Path:
    """Return the folder of a 3D case: a body on an inclined plane, 0.5 s in 50 steps."""
    folder = tmp_path / "plane"
    folder.mkdir()
    x = (np.arange(COLUMNS) + 0.5) * CELL
    write(folder / "dem.tif", np.tile(200.0 - 0.6 * x, (ROWS, 1)), 400_000.0, NORTH)
    thickness = np.zeros((ROWS, COLUMNS))
    thickness[5:11, 4:9] = 20.0
    write(folder / "thickness.tif", thickness, 400_000.0, NORTH)
    (folder / "case.toml").write_text(
        """case = { dimension = 3 }
time = { end = 0.5, step = 0.01, output_interval = 0.5, history_interval = 0.1 }
grid = { cell = 10.0, min = [400010.0, 6500010.0, 0.0], max = [400230.0, 6500150.0, 260.0] }
terrain = { type = "dem", file = "dem.tif" }
material.rock = { law = "mohr_coulomb", youngs_modulus = 1.0e7, poisson_ratio = 0.2, friction_angle = 35.0, \
cohesion = 1.0e5 }
basal = { friction_angle = 10.0 }
maps = { cell = 10.0 }

[body.slide]
material = "rock"
shape = "release"
thickness = { raster = "thickness.tif" }
velocity = [5.0, 0.0, -3.0]
temperature = -1.0
porosity = 0.3
"""
    )
    return folder


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


def test_depths_of_a_bed_vary_and_changed_polygons_run_again(plane: Path, tmp_path: Path) -> None:
    with (plane / "case.toml").open("a") as case:
        case.write(
            '[bed]\nlaw = "strength"\noutline = "bed.geojson"\ndepth = 1.0\nstrength = 0.0\ndepth_per_slip = 0.1\n'
            'material = "rock"\n'
        )
    sweep = SweepFolder(tmp_path / "sweep")
    for east in (400_150.0, 400_163.0):
        west, south, height = 400_080.0, 6_500_045.0, 67.0
        write_box(plane / "bed.geojson", west, east, south, south + height)
        assert main([str(plane), "--vary", "bed.depth=0.5,2.0", "--output", str(tmp_path / "sweep")]) == 0
        histories = [pd.read_csv(sweep.run_folder(number) / "history.csv") for number in sweep.done_members()]
        for depth, rows in zip((0.5, 2.0), histories, strict=True):
            density = rows["entrained_mass_kg"].iloc[-1] / rows["entrained_volume_m3"].iloc[-1]
            assert rows["bed_mass_kg"].iloc[0] == pytest.approx(density * depth * (east - west) * height, rel=1e-11)
