"""Terrain after an event, moving bottom, hydrographs and assets, on a slab whose results are known in closed form."""

import csv
from pathlib import Path

import map_runs
import numpy as np
import pytest
import rasterio
from conftest import snapshot_file, update_facts
from map_runs import CELL, COLUMNS, LENGTH, MIDDLE, ROWS, SOUTH, SPEED, THICKNESS, VOLUME, WEST, ground, write_map
from terrain_files import write_features

from thawslide import ReportError, Run
from thawslide.handover import assets_hit, terrain_after, write_dtopo, write_hydrographs
from thawslide.handover.command import assets, export, terrain
from thawslide.handover.hydrographs import hydrographs
from thawslide.maps import read_map

X, Y = map_runs.centres()
AFTER = ground(X, Y) + map_runs.slab(X, Y, 10.0)


@pytest.fixture
def run(map_run: Path) -> Run:
    return Run(map_run)


@pytest.fixture
def dem(tmp_path: Path) -> Path:
    """Return the file of the terrain."""
    write_map(tmp_path / "before.tif", ground(X, Y))
    return tmp_path / "before.tif"


def with_placement(run: Run, *placements: str) -> Run:
    """Return the run with bodies of given placements in its case."""
    case = run.folder / "case.toml"
    bodies = "".join(f'[body.b{number}]\nplacement = "{text}"\n' for number, text in enumerate(placements))
    case.write_text(case.read_text() + bodies)
    return Run(run.folder)


def test_terrain_of_the_run_gains_the_deposit(run: Run, tmp_path: Path) -> None:
    after = terrain_after(run)
    np.testing.assert_allclose(after.heights, AFTER, atol=1e-9)
    assert after.deposit == pytest.approx(VOLUME) and after.deposit_of_run == pytest.approx(VOLUME)
    assert after.removed == 0.0
    after.write(tmp_path / "after.tif")
    written = read_map(tmp_path / "after.tif")
    np.testing.assert_allclose(written.values, after.heights, atol=1e-9)
    assert "31287" in written.crs


@pytest.mark.parametrize(("placements", "removed"), [(["cut"], VOLUME), (["on_top", "on_top"], 0.0)])
def test_release_is_cut_out_of_a_given_dem_or_on_top(
    run: Run, tmp_path: Path, placements: list[str], removed: float
) -> None:
    write_map(tmp_path / "before.tif", ground(X, Y) + (map_runs.slab(X, Y, 0.0) if removed else 0.0))
    after = terrain_after(with_placement(run, *placements), tmp_path / "before.tif")
    np.testing.assert_allclose(after.heights, AFTER, atol=1e-9)
    assert after.removed == pytest.approx(removed)


def test_dem_on_other_points_keeps_the_volume(run: Run, tmp_path: Path) -> None:
    x, y = map_runs.centres(2 * COLUMNS, 2 * ROWS, 0.5 * CELL)
    write_map(tmp_path / "fine.tif", ground(x, y), cell=0.5 * CELL)
    after = terrain_after(run, tmp_path / "fine.tif")
    assert after.deposit == pytest.approx(VOLUME, rel=1e-9)
    assert np.max(after.heights - ground(x, y)) == pytest.approx(THICKNESS)


def test_dems_elsewhere_in_another_system_and_for_both_placements_are_refused(run: Run, dem: Path) -> None:
    with rasterio.open(dem, "r+") as file:
        file.transform = rasterio.Affine(CELL, 0.0, WEST + 1e4, 0.0, -CELL, SOUTH)
    with pytest.raises(ReportError, match="does not overlap the maps of the run"):
        terrain_after(run, dem)
    write_map(dem, ground(X, Y), crs="EPSG:31254")
    with pytest.raises(ReportError, match="another coordinate reference system than the run"):
        terrain_after(run, dem)
    write_map(dem, ground(X, Y))
    with pytest.raises(ReportError, match="Omit --dem to use the terrain of the run"):
        terrain_after(with_placement(run, "cut", "on_top"), dem)


def test_moving_bottom_is_the_change_of_thickness_at_equal_intervals(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "slide.tt3"
    grid, times = write_dtopo(run, path)
    lines = path.read_text().splitlines()
    head = {name: float(value) for value, name in (line.split() for line in lines[:9])}
    assert list(head) == ["mx", "my", "mt", "xlower", "ylower", "t0", "dx", "dy", "dt"]
    assert (head["mx"], head["my"], head["mt"]) == (COLUMNS, ROWS, 6)
    assert (head["xlower"], head["ylower"]) == (WEST + 0.5 * CELL, SOUTH + 0.5 * CELL)
    assert (head["t0"], head["dt"], head["dx"]) == (0.0, 2.0, CELL)
    blocks = np.array([[float(text) for text in line.split()] for line in lines[9:]]).reshape(6, ROWS, COLUMNS)
    assert np.all(blocks[0] == 0.0)
    last = blocks[-1][::-1]  # rows from the south
    assert np.sum(last) * CELL * CELL == pytest.approx(0.0, abs=1e-6 * VOLUME)
    at_release = (int((WEST + 100.0 - WEST) // CELL), int((MIDDLE - SOUTH) // CELL))
    assert last[at_release[1], at_release[0]] == pytest.approx(-THICKNESS, rel=1e-3)
    at_end = int((60.0 + SPEED * 10.0 + 0.5 * LENGTH) // CELL)
    assert last[at_release[1], at_end] == pytest.approx(THICKNESS, rel=1e-3)
    assert len(times) == 6 and grid.columns == COLUMNS
    for number, time in enumerate((0.0, 4.0, 8.0, 10.0)):
        map_runs.write_particles(snapshot_file(run.folder, number), time)
    for number in (4, 5):
        snapshot_file(run.folder, number).unlink()
    _, times = write_dtopo(Run(run.folder), tmp_path / "slide.tt3")
    np.testing.assert_array_equal(times, [0.0, 4.0, 8.0, 12.0])
    update_facts(run.folder, at_rest=False)
    moving = Run(run.folder)
    with pytest.raises(ReportError, match="snapshots at unequal intervals"):
        write_dtopo(moving, tmp_path / "slide.tt3")
    np.testing.assert_array_equal(moving.times, [0.0, 4.0, 8.0, 10.0])
    for number in (1, 2, 3):
        snapshot_file(run.folder, number).unlink()
    with pytest.raises(ReportError, match="a moving bottom needs two or more"):
        write_dtopo(Run(run.folder), tmp_path / "one.tt3")
    assert not (tmp_path / "one.tt3").exists()


def test_a_dem_of_a_part_of_the_deposit_has_a_note(run: Run, dem: Path) -> None:
    heights = ground(X, Y)
    heights[:, 30:] = np.nan  # the deposit begins at 260 m, the DEM ends at 300 m
    write_map(dem, heights)
    after = terrain_after(run, dem)
    assert after.notes == ["note: the DEM covers 50 % of the deposit."]
    assert after.deposit == pytest.approx(0.5 * VOLUME)


def test_hydrographs_are_those_of_the_lines(run: Run, tmp_path: Path) -> None:
    (path,) = write_hydrographs(hydrographs(run), tmp_path / "flow")
    assert path.name == "weir.csv"
    rows = list(csv.reader(path.open()))
    assert rows == [["time_s", "discharge_m3_s"], ["0.0", "0.0"], ["5.0", "-6480.0"], ["10.0", "0.0"]]
    (weir,) = hydrographs(run)
    assert weir.volume == -6480.0 * 5.0 and weir.peak == (0.0, 0.0)
    (run.folder / "probes.csv").write_text("time_s,gate_thickness_m\n0,0\n")
    with pytest.raises(ReportError, match=r"Add \[probe\.NAME\] with a `line`"):
        hydrographs(Run(run.folder))


def test_assets_have_the_largest_values_of_the_slab(run: Run, tmp_path: Path) -> None:
    hut, barn = assets_hit(run, points=[("hut", WEST + 300.0, MIDDLE), ("barn", WEST + 300.0, SOUTH + 5.0)])
    assert hut.max_pressure_kpa == pytest.approx(1900.0 * SPEED**2 * 1e-3)
    assert hut.max_thickness_m == THICKNESS and hut.max_speed_m_s == SPEED
    assert hut.arrival_time_s == pytest.approx((300.0 - 140.0) / SPEED, abs=CELL / SPEED)
    assert hut.is_hit and not barn.is_hit and np.isnan(barn.arrival_time_s)
    with pytest.raises(ReportError, match=r"hut: outside the maps of the run \(found x = 0"):
        assets_hit(run, points=[("hut", 0.0, 0.0)])
    west, south = WEST + 290.0, SOUTH
    ring = [[west, south], [west + 30.0, south], [west + 30.0, MIDDLE], [west, MIDDLE], [west, south]]
    features = [([ring], each) for each in ({"name": "School"}, {"Name": "a\nb"}, {"name": ""}, {})]
    path = write_features(tmp_path / "assets.geojson", "Polygon", features, "EPSG:31287")
    found, *others = assets_hit(run, polygons=path)
    assert found.name == "School" and [each.name for each in others] == ["polygon 2", "polygon 3", "polygon 4"]
    assert found.max_thickness_m == THICKNESS
    assert found.arrival_time_s == pytest.approx((290.0 - 140.0) / SPEED, abs=CELL / SPEED)


def test_commands_write_their_files(run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = str(run.folder)
    assert terrain([folder]) == 0 and (run.folder / "terrain-after.tif").is_file()
    assert terrain([folder]) == 2  # exists
    assert terrain([folder, "--overwrite"]) == 0 and export([folder]) == 2
    assert export([folder, "--dtopo", str(tmp_path / "a.tt3"), "--hydrographs", str(tmp_path / "flow")]) == 0
    assert assets([folder]) == 2 and assets([folder, "--point", "hut"]) == 2
    capsys.readouterr()
    points = [f"hut,{WEST + 300.0},{MIDDLE}", f"barn,{WEST + 5.0},{SOUTH + 5.0}"]
    assert assets([folder, "--point", points[0], "--point", points[1]]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[1].split() == ["hut", "760", "8.3", "8.3", "6", "20"]
    assert printed[2].split() == ["barn", "not", "reached"]
    rows = list(csv.reader((run.folder / "assets.csv").open()))
    assert rows[1][:2] == ["hut", "760.0"] and rows[2] == ["barn", "0.0", "", "", "0.0", "0.0"]
