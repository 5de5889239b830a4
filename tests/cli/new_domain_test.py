"""The cases that `thawslide new` makes run: thin releases on coarse DEMs, and releases near their edge."""

from __future__ import annotations

import json
import re
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


def assert_starts(thawslide: Program, folder: Path) -> None:
    done = thawslide("run", folder / "slide", "--output", folder / "run", "--set", "time.end=0.01")
    assert done.returncode == 0, done.stderr


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
    assert_starts(thawslide, tmp_path)


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
    assert_starts(thawslide, tmp_path)


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
        "--release: edge.geojson: the release reaches the outermost points of the DEM in the west; needed: "
        "10 m of it, one of its cells, beyond the release, and beyond where the slide may go. Take a larger DEM.",
    )


def test_more_particles_than_memory(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    """Refused before any is made, with a cell that fits; `new` leaves nothing behind."""
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 0.02, "--cell", 0.02)
    assert outcome.returncode == 2 and not (tmp_path / "slide").exists()
    assert re.fullmatch(
        r"error: --cell: a release 0\.02 m thick with cells of 0\.02 m and 2\d0,000,000 particles; they need about "
        r"[34]\d0 GB of memory, and \S+ GB are [a-z -()]+\. Set --cell \S+ or more, which is coarser\.\n",
        outcome.stderr,
    ), outcome.stderr
    assert made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24, "--cell", 8).returncode == 0
    refused = thawslide("check", tmp_path / "slide", "--set", "grid.cell=0.04")
    assert refused.returncode == 2
    assert re.fullmatch(
        r"error: --set grid\.cell=0\.04: grid\.cell is 0\.04 m, which makes 3\.6e\+10 particles; allowed: "
        r"230,000,000\. Make grid\.cell 0\.\d+ m or more, or particles_per_axis smaller\.\n",
        refused.stderr,
    ), refused.stderr


def test_holes_in_the_way(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    """`check` and `run` say before the first step where the ground ends, and what becomes of a slide there."""
    made(thawslide, tmp_path / "slide", slope(hole=slice(40, 45)), release, "--thickness", 24)
    note = (
        r"warning: 50 of \d+ points of the DEM within the domain have no data, the nearest at "
        r"\(412400, 5160(2[5-9]|3[0-4])0\), about 70 m from the release: a slide that gets there "
    )
    checked = thawslide("check", tmp_path / "slide", "--set", 'grid.leaving="stop"')
    assert re.search(note + r"ends the run\n", checked.stdout), checked.stdout
    words = ("--set", "time.end=0.01")
    run = thawslide("run", tmp_path / "slide", "--output", tmp_path / "run", *words)
    assert re.search(note + r"is removed and counted\n", run.stdout), run.stdout


def test_web_mercator(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(crs="EPSG:3857"), release, "--thickness", 24),
        tmp_path,
        "--dem: dem.tif: the coordinates are in Web Mercator (EPSG:3857), where lengths at latitude 42 are 1.35 times "
        "too long; allowed: a map projection that keeps lengths. Reproject: gdalwarp -t_srs EPSG:32631 -tr 7.4 7.4 "
        "-r bilinear dem.tif dem-EPSG32631.tif",
    )
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24, "--crs", "EPSG:3857"),
        tmp_path,
        "--crs: EPSG:3857 is Web Mercator, whose lengths are those of the equator; allowed: a map projection in metres "
        'that keeps lengths, such as "EPSG:31287".',
    )


def test_feature_without_a_geometry(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    content = json.loads(release.read_text())
    content["features"][0]["geometry"] = None
    release.write_text(json.dumps(content))
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24),
        tmp_path,
        "--release: release.geojson: polygon 1 (slide) has no geometry; needed: polygons. Delete it or draw it.",
    )


def test_options_that_exclude_each_other(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24, "--cut", "--on-top"),
        tmp_path,
        "--cut excludes --on-top. Run with --help for more information.",
    )


def test_next_commands(thawslide: Program, binary: Path, tmp_path: Path, slope: Slope, release: Path) -> None:
    folder = tmp_path / "a slide"
    outcome = made(thawslide, folder, slope(), release, "--thickness", 24)
    assert f"preview:  {binary} check '{folder}' --picture\nrun:      {binary} run '{folder}'\n" in outcome.stdout
