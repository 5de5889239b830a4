"""Maps: reading, cropping, thinning, interpolation, and messages of errors."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import edit
from map_runs import CELL, COLUMNS, ROWS, SOUTH, WEST, centres, ground, write_map
from rasterio.errors import NotGeoreferencedWarning

from thawslide import NotInRunError, ReportError, Run
from thawslide.maps import Grid, Map, Maps, on_map, read_map
from thawslide.relief import hillshade


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


def test_cropped_map_has_the_cells_of_the_box() -> None:
    x, y = centres()
    whole = Map(Grid(WEST + 5.0, SOUTH + 5.0, CELL, CELL, COLUMNS, ROWS), ground(x, y))
    part = whole.cropped((WEST + 20.0, WEST + 41.0, SOUTH - 100.0, SOUTH + 10.0))
    assert (part.grid.columns, part.grid.rows) == (3, 1)
    np.testing.assert_array_equal(part.values, whole.values[:1, 2:5])
    assert part.grid.x0 == WEST + 25.0
    assert whole.cropped((WEST + 1e6, WEST + 2e6, SOUTH, SOUTH + 5.0)).values.shape == (1, 1)


def test_thinning_keeps_means_maxima_and_volume() -> None:
    values = np.arange(35, dtype=float).reshape(5, 7)
    values[0, 0] = np.nan
    values[2:4, 2:4] = np.nan
    whole = Map(Grid(0.5, 0.5, 1.0, 1.0, 7, 5), values)
    mean, maximum = whole.thinned(4), whole.thinned(4, "maximum")
    assert mean.grid == Grid(1.0, 1.0, 2.0, 2.0, 4, 3)
    assert mean.values[0, 0] == pytest.approx((1.0 + 7.0 + 8.0) / 3.0) and np.isnan(mean.values[1, 1])
    assert (maximum.values[2, 3], maximum.values.shape) == (34.0, (3, 4))
    assert whole.thinned(7) is whole
    values = np.random.default_rng(1).random((12, 18))
    whole = Map(Grid(0.0, 0.0, 2.0, 3.0, 18, 12), values)
    assert whole.thinned(6).volume() == pytest.approx(whole.volume(), rel=1e-12)


def test_means_over_other_cells_are_weighted_by_area() -> None:
    values = np.array([[1.0, 2.0, 4.0], [np.nan, 8.0, 16.0]])
    fine = Map(Grid(1.0, 1.0, 2.0, 2.0, 3, 2), values)  # 0..6 by 0..4 m
    found = fine.averaged_over(Grid(1.5, 2.0, 3.0, 4.0, 3, 1))
    assert found.grid == Grid(1.5, 2.0, 3.0, 4.0, 3, 1)
    np.testing.assert_allclose(found.values, [[2.0, 25.0 / 3.0, 0.0]])
    np.testing.assert_allclose(fine.averaged_over(fine.grid).values, np.nan_to_num(values))
    whole = fine.averaged_over(Grid(-0.7, 1.2, 1.7, 3.0, 6, 3))
    assert whole.volume() == pytest.approx(fine.volume(), rel=1e-12)


def test_interpolation_is_linear_and_ends_with_the_map() -> None:
    x, y = centres()
    field = Map(Grid(WEST + 5.0, SOUTH + 5.0, CELL, CELL, COLUMNS, ROWS), ground(x, y))
    at_x, at_y = WEST + np.array([5.0, 123.4, 595.0]), SOUTH + np.array([5.0, 77.7, 295.0])
    np.testing.assert_allclose(field.at(at_x, at_y), ground(at_x, at_y), rtol=1e-12)
    assert np.isnan(field.at(np.array([WEST + 4.0]), np.array([SOUTH + 50.0]))).all()
    field.values[3, 4] = np.nan
    near = field.at(np.array([WEST + 40.0, WEST + 35.0]), np.array([SOUTH + 35.0, SOUTH + 35.0]))
    assert np.isnan(near[0]) and np.isfinite(near[1])


def test_maps_of_a_run_are_read_by_name(map_run: Path) -> None:
    maps = Maps(Run(map_run))
    assert repr(maps) == f"Maps({', '.join(maps)})"
    assert "max_thickness" in maps and "depth" not in maps
    assert maps["release"].volume() == pytest.approx(80.0 * 60.0 * 6.0)
    assert maps.about("max_pressure") == ("max pressure", "Pa")
    with pytest.raises(NotInRunError, match=r"depth\.tif: no such map \(found: arrival_time, elevation_change, "):
        maps["depth"]


def test_runs_on_a_dem_are_on_a_map(map_run: Path) -> None:
    assert on_map(Run(map_run))
    shutil.rmtree(map_run / "maps")
    assert on_map(Run(map_run))
    with pytest.raises(NotInRunError, match=r"maps: no such folder\. Only a 3D run on a DEM writes maps"):
        Maps(Run(map_run))
    edit(map_run / "case.toml", '"dem"', '"plane"')
    assert not on_map(Run(map_run))


def write_raw(path: Path, transform: rasterio.Affine) -> None:
    with rasterio.open(
        path, "w", driver="GTiff", width=4, height=3, count=1, dtype="float64", transform=transform
    ) as file:
        file.write(np.ones((3, 4)), 1)


def test_damaged_files_are_errors(tmp_path: Path) -> None:
    unreadable = "cannot be read as a GeoTIFF ("
    (tmp_path / "text.tif").write_text("no map")
    write_map(tmp_path / "half.tif", np.random.default_rng(0).random((300, 300)))
    half = (tmp_path / "half.tif").read_bytes()
    (tmp_path / "half.tif").write_bytes(half[: len(half) // 2])
    write_raw(tmp_path / "turned.tif", rasterio.Affine(1.0, 0.2, 0.0, 0.0, -1.0, 5.0))
    with pytest.warns(NotGeoreferencedWarning):
        write_raw(tmp_path / "bare.tif", rasterio.Affine.identity())
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
