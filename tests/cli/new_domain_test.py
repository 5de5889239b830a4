"""The cases that `thawslide new` makes run: thin releases on coarse terrain models, and releases near their edge."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import Program
from slope_files import (
    CELL,
    COLUMNS,
    DEPTH,
    ROWS,
    SOUTH,
    WEST,
    WIDTH,
    Slope,
    assert_refused,
    made,
    write_release,
)


@pytest.mark.parametrize("placement", ["--on-top", "--cut"])
@pytest.mark.parametrize("thickness", [3.0, 1.0])
def test_thin_release(thawslide: Program, tmp_path: Path, slope: Slope, thickness: float, placement: str) -> None:
    """Of a release thinner than the slope falls across a cell of the DEM no particle is outside the domain."""
    release = write_release(tmp_path / "thin.geojson", WEST + 203.0, SOUTH + 252.0, 31.0, 23.0)
    outcome = made(
        thawslide,
        tmp_path / "slide",
        slope(),
        release,
        "--thickness",
        thickness,
        placement,
    )
    assert outcome.returncode == 0, outcome.stderr
    done = thawslide(
        "run",
        tmp_path / "slide",
        "--output",
        tmp_path / "run",
        "--set",
        "time.end=0.001",
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(
    "corner",
    [(6.0, 7.0), ((COLUMNS - 1) * CELL - WIDTH - 6.0, (ROWS - 1) * CELL - DEPTH - 7.0)],
    ids=["low", "high"],
)
def test_release_at_the_edge_of_the_dem(
    thawslide: Program, tmp_path: Path, slope: Slope, corner: tuple[float, float]
) -> None:
    """The domain reaches to the outermost points although these are no multiple of the grid's cell, 6 m."""
    release = write_release(tmp_path / "edge.geojson", WEST + corner[0], SOUTH + corner[1])
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 23)
    assert outcome.returncode == 0, outcome.stderr
    done = thawslide(
        "run",
        tmp_path / "slide",
        "--output",
        tmp_path / "run",
        "--set",
        "time.end=0.01",
    )
    assert done.returncode == 0, done.stderr


def test_release_beyond_the_edge_of_the_dem(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    """Within half a cell of the outermost points there is no ground for what stands on them."""
    assert_refused(
        made(
            thawslide,
            tmp_path / "slide",
            slope(),
            write_release(tmp_path / "edge.geojson", WEST + 1.0, SOUTH + 100.0),
            "--thickness",
            24,
        ),
        tmp_path,
        "--release: edge.geojson: the release reaches the outermost points of the terrain model in the west; needed: "
        "10 m of it, one of its cells, beyond the release, and beyond where the slide may go. Take a larger terrain "
        "model.",
    )
