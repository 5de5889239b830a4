"""Sections of a 3D run: along a path that is given, or the way of the centre of mass and on from there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from map_figure_parts import drawn, maps_of, notes
from map_runs import MIDDLE, THICKNESS, WEST, centres, ground, write_map

from thawslide.figures.cross_sections import across, along, reaching
from thawslide.figures.site import distances


def test_sections_along_and_across_the_path(map_run: Path) -> None:
    figure = drawn("cross_sections", map_run)
    panels = maps_of(figure)
    assert panels[0].get_title(loc="left").startswith("(a) along the path, true scale")
    assert [axes.get_title(loc="left").split(",")[0] for axes in panels[2:]] == [f"({c}) across" for c in "cdef"]
    (surface,) = [line for line in panels[0].lines if line.get_color() == "#6B6459"]
    x, z = (np.asarray(values, dtype=float) for values in surface.get_data())
    np.testing.assert_allclose(z, ground(WEST + 20.0 + x, np.full(len(x), MIDDLE)), rtol=1e-9)
    largest = panels[1].lines[0]
    assert float(np.max(np.asarray(largest.get_ydata(), dtype=float))) == pytest.approx(THICKNESS)


def test_a_section_along_a_steep_path_shows_no_more_than_the_path(map_run: Path) -> None:
    x, _ = centres()
    write_map(map_run / "maps" / "terrain.tif", 2000.0 - 2.0 * (x - WEST))
    along_path, thickness, *_ = maps_of(drawn("cross_sections", map_run))
    assert along_path.get_title(loc="left").startswith("(a) along the path, true scale")
    for axes in (along_path, thickness):
        assert axes.get_xlim() == pytest.approx((0.0, 560.0), abs=1e-6)
    assert along_path.get_position().width == thickness.get_position().width


def test_a_thin_slide_is_drawn_thicker_and_the_panel_says_so(map_run: Path) -> None:
    y = centres()[1]
    thin = np.where(np.abs(y - MIDDLE) < 30.0, 0.5, 0.0)
    for name in ("release", "max_thickness", "final_thickness"):
        write_map(map_run / "maps" / f"{name}.tif", thin)
    panel = maps_of(drawn("cross_sections", map_run))[0]
    title = panel.get_title(loc="left")
    times = float(title.split("thickness ×")[1])
    assert times > 5.0
    (line,) = [line for line in panel.lines if line.get_color() == "#D55E00"]
    distance, height = (np.asarray(values, dtype=float) for values in line.get_data())
    above = height - ground(WEST + 20.0 + distance, np.full(len(distance), MIDDLE))
    assert np.nanmax(above) == pytest.approx(0.5 * times)


def corridor(*boxes: tuple[float, float, float, float]) -> np.ndarray:
    """Return the centres of cells of 10 m within boxes (west, east, south, north)."""
    x, y = np.meshgrid(np.arange(-495.0, 1000.0, 10.0), np.arange(-495.0, 1000.0, 10.0))
    inside = np.any([(x > w) & (x < e) & (y > s) & (y < n) for w, e, s, n in boxes], axis=0)
    return np.stack([x[inside], y[inside]], axis=1)


def test_the_way_of_a_centre_reaches_the_ends_of_the_slide() -> None:
    line = np.array([[0.0, 0.0], [100.0, 0.0]])
    found = reaching(line, corridor((-200.0, 300.0, -50.0, 50.0)), 100.0)
    np.testing.assert_allclose(found[[0, -1]], [[-195.0, 0.0], [295.0, 0.0]], atol=1e-9)
    np.testing.assert_allclose(found[:, 1], 0.0, atol=1e-9)


def test_the_way_of_a_centre_goes_on_round_the_bend() -> None:
    """Straight on, as it went before, it would leave the slide at x = 450 m and never see what lies to the north."""
    slide = corridor((-50.0, 450.0, -50.0, 50.0), (350.0, 450.0, -50.0, 800.0))
    points, _ = along(reaching(np.array([[0.0, 0.0], [200.0, 0.0]]), slide, 100.0))
    to_slide = np.sqrt(((points[:, None] - slide[None]) ** 2).sum(axis=2).min(axis=1))
    assert to_slide.max() < 8.0  # within a cell of it
    assert points[-1] == pytest.approx([400.0, 795.0], abs=20.0)


def test_sections_say_what_line_the_path_is(map_run: Path) -> None:
    """And where it leaves what the slide covered: here the way cuts a bend."""
    told = "Path: the way of the centre of mass, at its ends on along the middle of what the slide covered."
    assert told not in notes(drawn("cross_sections", map_run))  # it is given
    case = (map_run / "case.toml").read_text()
    (map_run / "case.toml").write_text(case.replace('path = "path.gpkg"\n', ""))
    assert notes(drawn("cross_sections", map_run)).endswith(told)
    x, y = centres()
    for name in ("max_thickness", "final_thickness", "release"):
        write_map(
            map_run / "maps" / f"{name}.tif",
            np.where(
                (x > WEST + 200.0) & (x < WEST + 300.0) & (y < MIDDLE + 50.0) | (np.abs(x - WEST - 250.0) > 150.0),
                5.0,
                0.0,
            ),
        )
    said = re.search(
        rf"{told} It runs beside that at (\d+) to (\d+) m, (\d+) to (\d+) m\.",
        notes(drawn("cross_sections", map_run)).replace("\n", " "),
    )
    assert said
    # The map is known from WEST + 5 m on; between cell centres it is as thick as they are on average.
    np.testing.assert_allclose([float(part) for part in said.groups()], [95.0, 195.0, 295.0, 395.0], atol=7.0)


def test_sections_run_from_left_to_right_across_the_path() -> None:
    line = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0]])
    np.testing.assert_allclose(distances(line), [0.0, 100.0, 200.0])
    np.testing.assert_allclose(across(line, 50.0, 10.0, 5.0), [[50.0, 10.0], [50.0, -10.0]])
    np.testing.assert_allclose(across(line, 150.0, 10.0, 5.0), [[90.0, 50.0], [110.0, 50.0]])
    points, distance = along(line, 5)
    np.testing.assert_allclose(points[:, 0], [0.0, 50.0, 100.0, 100.0, 100.0])
    np.testing.assert_allclose(distance, [0.0, 50.0, 100.0, 150.0, 200.0])
