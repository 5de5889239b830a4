"""Releases that `thawslide new --cut` and `thawslide section --cut` cut out of a DEM leave the cut."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import Program, history, sets
from slope_files import CELL, SOUTH, WEST, Slope, made, write_release
from terrain_files import write_dem, write_line
from terrain_files import write_release as write_outline

SIDE, THICK = 200.0, 20.0  # of the release [m]
VOLUME = SIDE * SIDE * THICK
# A slide on the slope of 30 degrees moves with friction of 17 degrees; with 25, the level ramp stops it at any width.
COARSE = sets(grid__cell=12, time__end=8, basal__friction="constant", basal__friction_angle=17)


def test_a_release_that_is_cut_out_leaves_the_cut(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    """The motion is nearly that of a release on top; walls would stop it."""
    folder = tmp_path / "slide"
    release = write_release(tmp_path / "wide.geojson", WEST + 150.0, SOUTH + 200.0, SIDE, SIDE)
    outcome = made(thawslide, folder, slope(), release, "--thickness", THICK, "--cut")
    assert outcome.returncode == 0, outcome.stderr
    # The cell is that for most of the volume; most of the area is below ramps.
    assert [line for line in outcome.stdout.splitlines() if line.startswith("warning: --cell")] == [
        "warning: --cell: across the median thickness of body slide, 10 m, there are too few particles to resolve "
        "shear and thinning (found 3.3; needed 4). Set --cell to 3 m, at about 16 times the run time."
    ]
    assert (
        'placement = "cut"  # out of the DEM, which is the surface before the slide; "on_top": onto it\n'
        "# The edges of the cut are ramps of this width, half of it beyond the outline, and the volume is preserved. "
        "Vertical\n# edges would trap the slide. At their steepest, the ramps rise 29.7 degrees against the DEM, which "
        "falls 30.0\n# degrees here.\ntaper = 70.0  # m\n"
    ) in (folder / "case.toml").read_text()
    walls = sets(body__slide__taper=0)
    top = [*walls, *sets(body__slide__placement="on_top")]
    speeds = {}
    for name, words in (("ramps", []), ("walls", walls), ("top", top)):
        done = thawslide("run", folder, "--output", tmp_path / name, *COARSE, *words)
        assert done.returncode == 0, done.stderr
        speeds[name] = history(tmp_path / name)["mean_velocity_m_s"][-1]
        with rasterio.open(tmp_path / name / "maps" / "release.tif") as file:
            assert file.read(1, masked=True).sum() * CELL**2 == pytest.approx(VOLUME, rel=1e-9), name
    assert speeds["ramps"] > 0.6 * speeds["top"]
    assert speeds["walls"] < 0.4 * speeds["top"]


def test_ramps_near_the_edge_of_the_dem_are_as_wide_as_possible(
    thawslide: Program, tmp_path: Path, slope: Slope
) -> None:
    """Their width has a warning, and the case runs."""
    folder = tmp_path / "slide"
    release = write_release(tmp_path / "edge.geojson", WEST + 23.0, SOUTH + 200.0, SIDE, SIDE)
    outcome = made(thawslide, folder, slope(), release, "--thickness", THICK, "--cut")
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout.startswith(
        "warning: --cut: the edges of the cut are too narrow, because the release is narrow or near the edge of the "
        "known terrain (found 40 m; needed 70 m). They rise by up to 45 degrees against the terrain, which falls by 30 "
        "degrees, and may stop the slide. Use --on-top, which has no such edges\n"
    ), outcome.stdout
    assert (
        "the ramps rise 45.0 degrees against the DEM, which falls 30.0\n"
        "# degrees here; 70.0 m is needed, but the release is too narrow.\ntaper = 40.0  # m\n"
    ) in (folder / "case.toml").read_text()
    done = thawslide("run", folder, "--output", tmp_path / "run", "--set", "time.end=0.01")
    assert done.returncode == 0, done.stderr
    with rasterio.open(tmp_path / "run" / "maps" / "release.tif") as file:
        assert file.read(1, masked=True).sum() * CELL**2 == pytest.approx(VOLUME, rel=1e-9)


def test_a_section_has_the_ramps_too(thawslide: Program, tmp_path: Path) -> None:
    outline = [(155.0, 105.0), (355.0, 105.0), (355.0, 305.0), (155.0, 305.0)]
    words = [
        *("--dem", write_dem(tmp_path / "dem.tif", lambda x, y: 1000.0 - 0.5 * x)),
        *("--release", write_outline(tmp_path / "release.geojson", outline)),
        *("--line", write_line(tmp_path / "line.geojson", [(15.0, 205.0), (775.0, 205.0)])),
    ]
    outcome = thawslide("section", tmp_path / "case", *words, "--thickness", THICK, "--cut")
    assert outcome.returncode == 0, outcome.stderr
    lines = (tmp_path / "case" / "profile.csv").read_text().splitlines()
    assert lines[3] == (
        "# The edges of the cut are ramps 80 m wide, half of it beyond the outline: vertical edges would trap "
        "the slide."
    )
    distance, terrain, surface = np.array([line.split(",") for line in lines[5:]], dtype=float).T
    assert np.trapezoid(surface - terrain, distance) == pytest.approx(SIDE * THICK, rel=1e-9)
    assert (surface - terrain).max() == pytest.approx(THICK, abs=1e-9)
    steepest = np.max(np.diff(terrain) / np.diff(distance))
    assert -0.05 < steepest < 0.01, "the base falls or is level everywhere"
