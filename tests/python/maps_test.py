"""Maps: reading, cropping, thinning, interpolation, errors, hillshade by Horn's formula, averages of particles."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import change_snapshot, edit
from map_runs import CELL, COLUMNS, MIDDLE, ROWS, SOUTH, SPEED, THICKNESS, VOLUME, WEST, centres, ground, write_map
from rasterio.errors import NotGeoreferencedWarning

from thawslide import NotInRunError, ReportError, Run
from thawslide.binning import FIELDS, gather, spread
from thawslide.maps import Grid, Map, Maps, on_map, read_map
from thawslide.relief import contour_levels, hillshade, round_number, slopes


def test_map_has_grid_unit_and_perhaps_a_reference_system(tmp_path: Path) -> None:
    x, y = centres()
    values = ground(x, y)
    values[2, 5] = np.nan
    write_map(tmp_path / "a.tif", values, "m3/s2", "momentum flux")
    found = read_map(tmp_path / "a.tif")
    np.testing.assert_array_equal(found.values, values)
    np.testing.assert_allclose(found.grid.x, x[0])
    np.testing.assert_allclose(found.grid.y, y[:, 0])
    assert found.grid.box == (WEST, WEST + COLUMNS * CELL, SOUTH, SOUTH + ROWS * CELL)
    assert (found.unit, found.description) == ("m3/s2", "momentum flux")
    assert found.crs == "MGI / Austria Lambert (EPSG:31287)"
    write_map(tmp_path / "a.tif", np.ones((3, 4)), crs=None)
    assert read_map(tmp_path / "a.tif").crs == ""


def test_maps_are_cropped_and_interpolated_within_their_box() -> None:
    x, y = centres()
    whole = Map(Grid(WEST + 5.0, SOUTH + 5.0, CELL, CELL, COLUMNS, ROWS), ground(x, y))
    part = whole.cropped((WEST + 20.0, WEST + 41.0, SOUTH - 100.0, SOUTH + 10.0))
    assert (part.grid.columns, part.grid.rows) == (3, 1)
    np.testing.assert_array_equal(part.values, whole.values[:1, 2:5])
    assert part.grid.x0 == WEST + 25.0
    assert whole.cropped((WEST + 1e6, WEST + 2e6, SOUTH, SOUTH + 5.0)).values.shape == (1, 1)
    at_x, at_y = WEST + np.array([5.0, 123.4, 595.0]), SOUTH + np.array([5.0, 77.7, 295.0])
    np.testing.assert_allclose(whole.at(at_x, at_y), ground(at_x, at_y), rtol=1e-12)
    assert np.isnan(whole.at(np.array([WEST + 4.0]), np.array([SOUTH + 50.0]))).all()
    whole.values[3, 4] = np.nan
    near = whole.at(np.array([WEST + 40.0, WEST + 35.0]), np.array([SOUTH + 35.0, SOUTH + 35.0]))
    assert np.isnan(near[0]) and np.isfinite(near[1])


def test_thinned_and_averaged_maps_keep_means_and_volume() -> None:
    values = np.arange(35, dtype=float).reshape(5, 7)
    values[0, 0] = values[2:4, 2:4] = np.nan
    whole = Map(Grid(0.5, 0.5, 1.0, 1.0, 7, 5), values)
    mean, maximum = whole.thinned(4), whole.thinned(4, "maximum")
    assert mean.grid == Grid(1.0, 1.0, 2.0, 2.0, 4, 3)
    assert mean.values[0, 0] == pytest.approx((1.0 + 7.0 + 8.0) / 3.0) and np.isnan(mean.values[1, 1])
    assert (maximum.values[2, 3], maximum.values.shape) == (34.0, (3, 4))
    assert whole.thinned(7) is whole
    values = np.random.default_rng(1).random((12, 18))
    whole = Map(Grid(0.0, 0.0, 2.0, 3.0, 18, 12), values)
    assert whole.thinned(6).volume() == pytest.approx(whole.volume(), rel=1e-12)
    values = np.array([[1.0, 2.0, 4.0], [np.nan, 8.0, 16.0]])
    fine = Map(Grid(1.0, 1.0, 2.0, 2.0, 3, 2), values)  # 0..6 by 0..4 m
    found = fine.averaged_over(Grid(1.5, 2.0, 3.0, 4.0, 3, 1))
    assert found.grid == Grid(1.5, 2.0, 3.0, 4.0, 3, 1)
    np.testing.assert_allclose(found.values, [[2.0, 25.0 / 3.0, 0.0]])
    np.testing.assert_allclose(fine.averaged_over(fine.grid).values, np.nan_to_num(values))
    whole = fine.averaged_over(Grid(-0.7, 1.2, 1.7, 3.0, 6, 3))
    assert whole.volume() == pytest.approx(fine.volume(), rel=1e-12)


def test_maps_of_a_run_on_a_dem_are_read_by_name(map_run: Path) -> None:
    maps = Maps(Run(map_run))
    assert repr(maps) == f"Maps({', '.join(maps)})"
    assert "max_thickness" in maps and "depth" not in maps
    assert maps["release"].volume() == pytest.approx(VOLUME)
    assert maps.about("max_pressure") == ("max pressure", "Pa")
    with pytest.raises(NotInRunError, match=r"depth\.tif: no such map \(found: arrival_time, elevation_change, "):
        maps["depth"]
    assert on_map(Run(map_run))
    shutil.rmtree(map_run / "maps")
    assert on_map(Run(map_run))
    with pytest.raises(NotInRunError, match=r"maps: no such folder\. Only a 3D run on a DEM writes maps"):
        Maps(Run(map_run))
    edit(map_run / "case.toml", '"dem"', '"plane"')
    assert not on_map(Run(map_run))


def test_damaged_files_are_errors(tmp_path: Path) -> None:
    unreadable = "cannot be read as a GeoTIFF ("
    (tmp_path / "text.tif").write_text("no map")
    write_map(tmp_path / "half.tif", np.random.default_rng(0).random((300, 300)))
    half = (tmp_path / "half.tif").read_bytes()
    (tmp_path / "half.tif").write_bytes(half[: len(half) // 2])
    profile = {"driver": "GTiff", "width": 4, "height": 3, "count": 1, "dtype": "float64"}
    turned = rasterio.Affine(1.0, 0.2, 0.0, 0.0, -1.0, 5.0)
    rasterio.open(tmp_path / "turned.tif", "w", transform=turned, **profile).close()
    with pytest.warns(NotGeoreferencedWarning):
        rasterio.open(tmp_path / "bare.tif", "w", **profile).close()
    for name, text in (
        ("absent.tif", unreadable), ("text.tif", unreadable), ("half.tif", unreadable),
        ("turned.tif", "not aligned with north. Repeat the run."),
        ("bare.tif", "no coordinates; not a map of the simulator."),
    ):  # fmt: skip
        with pytest.raises(ReportError, match=re.escape(f"{name}: {text}")):
            read_map(tmp_path / name)


def test_terrain_with_gaps_is_shaded_in_cells_with_data() -> None:
    path = Path(__file__).resolve().parents[3] / "shared" / "data" / "alr" / "alr.tif"
    if not path.is_file():
        pytest.skip("the shared terrain alr.tif is not here")
    terrain = read_map(path)
    assert (terrain.grid.columns, terrain.grid.rows, terrain.grid.cell_x) == (417, 915, 5.0)
    assert terrain.crs == "MGI / Austria Lambert (EPSG:31287)"
    shade = hillshade(terrain.values, 5.0, 5.0)
    assert np.isnan(shade[np.isnan(terrain.values)]).all()
    assert np.nanmin(shade) >= 0.0 and np.nanmax(shade) <= 1.0
    assert np.isfinite(shade).sum() > 0.97 * np.isfinite(terrain.values).sum()


def plane(slope_x: float, slope_y: float) -> np.ndarray:
    x, y = np.meshgrid(10.0 * np.arange(7), 5.0 * np.arange(6))
    return slope_x * x + slope_y * y


@pytest.mark.parametrize("slope_x", [-1.0, 0.0, 0.3])
@pytest.mark.parametrize("slope_y", [-0.5, 0.0, 2.0])
@pytest.mark.parametrize("exaggeration", [1.0, 3.0])
def test_brightness_of_a_plane_is_the_cosine_to_the_light(slope_x: float, slope_y: float, exaggeration: float) -> None:
    normal = np.array([-exaggeration * slope_x, -exaggeration * slope_y, 1.0])
    light = np.array([-0.5, 0.5, np.sqrt(0.5)])  # from the north-west, 45 degrees high
    wanted = max(0.0, float(normal @ light) / float(np.linalg.norm(normal)))
    np.testing.assert_allclose(hillshade(plane(slope_x, slope_y), 10.0, 5.0, exaggeration), wanted, atol=1e-12)


def test_brightness_depends_on_aspect_light_and_data() -> None:
    assert hillshade(np.zeros((4, 4)), 1.0, 1.0) == pytest.approx(np.sin(np.pi / 4))
    towards = plane(np.sqrt(0.5), -np.sqrt(0.5))  # falls to the north-west by 45 degrees
    assert hillshade(towards, 10.0, 5.0) == pytest.approx(1.0)
    assert hillshade(-2.0 * towards, 10.0, 5.0) == pytest.approx(0.0)
    assert hillshade(plane(-1.0, 0.0), 10.0, 5.0, azimuth=90.0, altitude=45.0) == pytest.approx(1.0)
    heights = plane(0.1, 0.2)
    heights[3, 3] = np.nan
    shade = hillshade(heights, 10.0, 5.0)
    assert np.isnan(shade[2:5, 2:5]).sum() >= 8 and np.isfinite(shade[:2]).all()


def test_slopes_have_weights_one_two_one_and_two_rows() -> None:
    heights = np.zeros((3, 3))
    heights[0, 2], heights[1, 2], heights[2, 2] = 8.0, 80.0, 800.0
    slope_x, slope_y = slopes(heights, 2.0, 4.0)
    assert slope_x[1, 1] == pytest.approx((8.0 + 2 * 80.0 + 800.0) / 16.0)
    assert slope_y[1, 1] == pytest.approx((800.0 - 8.0) / 32.0)
    with pytest.raises(ValueError, match=r"at least 2 x 2 heights \(found \(1, 5\)\)"):
        slopes(np.zeros((1, 5)), 1.0, 1.0)


def test_round_numbers_are_positive_and_level_terrain_has_no_contour_lines() -> None:
    for value, found in (1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (49.0, 20.0), (730.0, 500.0), (0.07, 0.05):
        assert round_number(value) == pytest.approx(found)
    with pytest.raises(ValueError, match="expected a positive number, found 0"):
        round_number(0.0)
    assert not contour_levels(np.full((3, 3), 7.0), 10).size
    assert not contour_levels(np.full((3, 3), np.nan), 10).size


@pytest.mark.parametrize("span", [0.7, 3.0, 95.0, 1234.0, 3999.0])
@pytest.mark.parametrize("most", [5, 16, 24])
def test_contour_levels_are_few_round_and_inside(span: float, most: int) -> None:
    levels = contour_levels(np.array([[812.3, 812.3 + span, np.nan]]), most)
    assert 1 <= len(levels) <= most
    assert levels[0] >= 812.3 and levels[-1] <= 812.3 + span
    if len(levels) > 1:
        step = levels[1] - levels[0]
        assert round_number(step * (1 + 1e-9)) == pytest.approx(step)
        assert len(levels) > most / 6


GRID = Grid(0.5, 1.0, 1.0, 2.0, 20, 12)  # cells of 1 m x 2 m over 0..20 m x 0..24 m


@pytest.mark.parametrize("width", [0.1, 1.0, 1.7, 4.0, 5.3])
def test_sums_are_conserved_for_any_width(width: float) -> None:
    random = np.random.default_rng(3)
    x, y = random.uniform(4.0, 16.0, 500), random.uniform(4.0, 20.0, 500)
    amounts = [random.random(500), random.normal(size=500)]
    for total, amount in zip(spread(GRID, x, y, width, amounts), amounts, strict=True):
        assert (total.shape, total.sum()) == ((12, 20), pytest.approx(amount.sum(), rel=1e-12))


def test_fractions_are_areas_inside_the_grid() -> None:
    (one,) = spread(GRID, np.array([5.75]), np.array([9.0]), 2.0, [np.array([8.0])])
    # 4.75..6.75 m of x: a quarter of a cell, one, three quarters; 8..10 m of y: the fifth row.
    wanted = np.zeros((12, 20))
    wanted[4, 4:7] = 1.0, 4.0, 3.0
    np.testing.assert_allclose(one, wanted, atol=1e-12)
    (one,) = spread(GRID, np.array([0.0, 20.0, -30.0]), np.array([1.0, 23.0, 1.0]), 2.0, [np.ones(3)])
    assert one.sum() == pytest.approx(1.0)


def test_thickness_and_basal_temperature_of_a_slab_are_exact_without_invalid_particles(map_run: Path) -> None:
    run = Run(map_run)
    columns = gather(Maps(run)["release"].grid, run.snapshot(0, fields=FIELDS), 10.0)
    assert columns.thickness.volume() == pytest.approx(VOLUME, rel=1e-12)
    assert columns.thickness.at(np.array([WEST + 100.0]), np.array([MIDDLE])) == pytest.approx(THICKNESS)
    assert np.nanmax(columns.speed.values) == pytest.approx(SPEED)
    assert np.nanmin(columns.speed.values) == pytest.approx(SPEED) and np.isnan(columns.speed.values[0, 0])
    columns = gather(Maps(run)["release"].grid, run.snapshot(5, fields=FIELDS), 10.0)
    values = columns.temperature.values[np.isfinite(columns.temperature.values)]
    np.testing.assert_allclose(values, 10.0)  # those above are at -50
    assert columns.time == 10.0
    change_snapshot(map_run, 0, 0, points=np.nan)
    change_snapshot(map_run, 0, 1, volume=np.nan)
    run = Run(map_run)
    columns = gather(Maps(run)["release"].grid, run.snapshot(0, fields=FIELDS), 10.0)
    assert columns.thickness.volume() == pytest.approx(VOLUME - 2 * 50.0, rel=1e-12)
    assert sorted(Run(map_run).snapshot(0, fields=FIELDS)) == sorted(FIELDS)
