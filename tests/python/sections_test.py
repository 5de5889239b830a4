"""Cross sections of a 3D run: along a given path, or along the extended track of the centre of mass."""

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import edit
from figure_parts import maps_of, notes, plotted
from map_runs import MIDDLE, THICKNESS, WEST, centres, ground, write_map
from matplotlib.axes import Axes

from thawslide.figures.cross_sections import across, along, extended
from thawslide.figures.site import distances
from thawslide.maps import read_map

TERRAIN = "#6B6459"


def coloured(axes: Axes, colour: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the distance and the height above the plane of the line of a colour."""
    (found,) = [line for line in axes.lines if line.get_color() == colour]
    x, z = found.get_data()
    return x, z - ground(WEST + 20.0 + x, np.full(len(x), MIDDLE))


def test_sections_have_terrain_and_maximum_thickness(map_run: Path) -> None:
    panels = maps_of(plotted("cross_sections", map_run))
    titles = ["(a) flow path", *(f"({c}) cross section at" for c in "cdef")]
    for axes, title in zip((panels[0], *panels[2:]), titles, strict=True):
        assert axes.get_title(loc="left").startswith(title)
    np.testing.assert_allclose(coloured(panels[0], TERRAIN)[1], 0.0, atol=1e-6)
    assert np.max(panels[1].lines[0].get_ydata()) == pytest.approx(THICKNESS)
    # Above the ground of cells that follow the terrain.
    write_map(map_run / "maps" / "ground.tif", ground(*centres()) + 3.0)
    panel = maps_of(plotted("cross_sections", map_run))[0]
    np.testing.assert_allclose(coloured(panel, TERRAIN)[1], 3.0, atol=1e-6)


def test_release_is_not_thicker_than_the_maximum_on_coarser_cells(map_run: Path) -> None:
    """The release has cells of 10 m; the maximum, the same slab, has cells of 30 m."""
    coarse = read_map(map_run / "maps" / "release.tif").values.reshape(10, 3, 20, 3).mean(axis=(1, 3))
    for name in ("max_thickness", "final_thickness"):
        write_map(map_run / "maps" / f"{name}.tif", coarse, cell=30.0)
    thickness = maps_of(plotted("cross_sections", map_run))[1]
    edge = np.concatenate([path.vertices for path in thickness.collections[0].get_paths()])
    distance, largest = (np.asarray(values, dtype=float) for values in thickness.lines[0].get_data())
    assert edge[:, 1].max() > 0.5 * THICKNESS
    assert (edge[:, 1] <= np.interp(edge[:, 0], distance, largest) + 1e-9).all()


def test_section_of_a_steep_path_ends_with_the_path(map_run: Path) -> None:
    x, _ = centres()
    write_map(map_run / "maps" / "terrain.tif", 2000.0 - 2.0 * (x - WEST))
    along_path, thickness, *_ = maps_of(plotted("cross_sections", map_run))
    assert along_path.get_title(loc="left").startswith("(a) flow path")
    for axes in (along_path, thickness):
        assert axes.get_xlim() == pytest.approx((0.0, 560.0), abs=1e-6)
    assert along_path.get_position().width == thickness.get_position().width


def test_exaggeration_of_small_thicknesses_is_stated(map_run: Path) -> None:
    thin = np.where(np.abs(centres()[1] - MIDDLE) < 30.0, 0.5, 0.0)
    for name in ("release", "max_thickness", "final_thickness"):
        write_map(map_run / "maps" / f"{name}.tif", thin)
    panel = maps_of(plotted("cross_sections", map_run))[0]
    times = float(panel.texts[0].get_text().split("thickness exaggeration ")[1].removesuffix("×"))
    assert times > 5.0 and np.nanmax(coloured(panel, "#D55E00")[1]) == pytest.approx(0.5 * times)


def corridor(*boxes: tuple[float, float, float, float]) -> np.ndarray:
    """Return the centres of cells of 10 m within boxes (west, east, south, north)."""
    x, y = np.meshgrid(np.arange(-495.0, 1000.0, 10.0), np.arange(-495.0, 1000.0, 10.0))
    inside = np.any([(x > w) & (x < e) & (y > s) & (y < n) for w, e, s, n in boxes], axis=0)
    return np.stack([x[inside], y[inside]], axis=1)


def test_extended_track_ends_with_the_covered_area_also_after_a_bend() -> None:
    found = extended(np.array([[0.0, 0.0], [100.0, 0.0]]), corridor((-200.0, 300.0, -50.0, 50.0)), 100.0)
    np.testing.assert_allclose(found[[0, -1]], [[-195.0, 0.0], [295.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(found[:, 1], 0.0, atol=1e-9)
    """A straight extension would leave the covered area at x = 450 m and miss its northern part."""
    covered = corridor((-50.0, 450.0, -50.0, 50.0), (350.0, 450.0, -50.0, 800.0))
    points, _ = along(extended(np.array([[0.0, 0.0], [200.0, 0.0]]), covered, 100.0))
    distance = np.sqrt(((points[:, None] - covered[None]) ** 2).sum(axis=2).min(axis=1))
    assert distance.max() < 8.0  # within a cell
    assert points[-1] == pytest.approx([400.0, 795.0], abs=20.0)


def test_note_describes_the_path(map_run: Path) -> None:
    """It has the ranges outside the covered area: here the track cuts a bend."""
    words = "Path: track of the centre of mass, extended at both ends along the middle of the covered area."
    assert words not in notes(plotted("cross_sections", map_run))  # given path
    edit(map_run / "case.toml", 'path = "path.gpkg"\n', "")
    assert notes(plotted("cross_sections", map_run)).endswith(words)
    x, y = centres()
    middle = (x > WEST + 200.0) & (x < WEST + 300.0) & (y < MIDDLE + 50.0)
    for name in ("max_thickness", "final_thickness", "release"):
        covered = np.where(middle | (np.abs(x - WEST - 250.0) > 150.0), 5.0, 0.0)
        write_map(map_run / "maps" / f"{name}.tif", covered)
    text = notes(plotted("cross_sections", map_run))
    (found,) = re.findall(rf"{words} It is outside the covered area at (\d+) to (\d+) m, (\d+) to (\d+) m\.", text)
    # The map is known from WEST + 5 m on; between cell centres it is as thick as they are on average.
    np.testing.assert_allclose(list(map(float, found)), [95.0, 195.0, 295.0, 395.0], atol=7.0)


def test_cross_sections_are_directed_from_left_to_right() -> None:
    line = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0]])
    np.testing.assert_allclose(distances(line), [0.0, 100.0, 200.0])
    np.testing.assert_allclose(across(line, 50.0, 10.0, 5.0), [[50.0, 10.0], [50.0, -10.0]])
    np.testing.assert_allclose(across(line, 150.0, 10.0, 5.0), [[90.0, 50.0], [110.0, 50.0]])
    points, distance = along(line, 5)
    np.testing.assert_allclose(points[:, 0], [0.0, 50.0, 100.0, 100.0, 100.0])
    np.testing.assert_allclose(distance, [0.0, 50.0, 100.0, 150.0, 200.0])
