"""Cases by `thawslide new` run: thin releases on coarse DEMs, and releases near the edge of a DEM."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from conftest import Program
from slope_files import CELL, COLUMNS, DEPTH, ROWS, SOUTH, WEST, WIDTH, Slope, assert_refused, made, write_release


def assert_starts(thawslide: Program, folder: Path) -> None:
    done = thawslide("run", folder / "slide", "--output", folder / "run", "--set", "time.end=0.01")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("placement", ["--on-top", "--cut"])
@pytest.mark.parametrize("thickness", [3.0, 1.0])
def test_a_thin_release_is_inside_the_domain(
    thawslide: Program, tmp_path: Path, slope: Slope, thickness: float, placement: str
) -> None:
    """The release is thinner than the fall of the slope across a cell of the DEM."""
    release = write_release(tmp_path / "thin.geojson", WEST + 203.0, SOUTH + 252.0, 31.0, 23.0)
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", thickness, placement)
    assert outcome.returncode == 0, outcome.stderr
    assert_starts(thawslide, tmp_path)


@pytest.mark.parametrize(
    "corner", [(6.0, 7.0), ((COLUMNS - 1) * CELL - WIDTH - 6.0, (ROWS - 1) * CELL - DEPTH - 7.0)], ids=["low", "high"]
)
def test_a_release_at_the_edge_of_the_dem_runs(
    thawslide: Program, tmp_path: Path, slope: Slope, corner: tuple[float, float]
) -> None:
    """The domain includes the outermost points, although their distance is no multiple of the grid's cell, 6 m."""
    release = write_release(tmp_path / "edge.geojson", WEST + corner[0], SOUTH + corner[1])
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 23)
    assert outcome.returncode == 0, outcome.stderr
    assert_starts(thawslide, tmp_path)


def test_a_release_beyond_the_edge_of_the_dem_is_refused(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    """Bodies on the outermost points need terrain half a cell beyond them."""
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
        "--release: edge.geojson: the release reaches the outermost points of the DEM in the west "
        "(needed: at least 10 m, one cell, beyond the release). Use a DEM that covers the flow path too.",
    )


def test_more_particles_than_memory_are_refused(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    """The message proposes a cell that fits, and `new` writes no files."""
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


def test_holes_in_the_flow_path_have_a_warning(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    """Before the first step, `check` and `run` report where the terrain ends, and the consequence for the slide."""
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


def test_web_mercator_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
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


def test_a_feature_without_a_geometry_is_refused(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    content = json.loads(release.read_text())
    content["features"][0]["geometry"] = None
    release.write_text(json.dumps(content))
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24),
        tmp_path,
        "--release: release.geojson: polygon 1 (slide) has no geometry; needed: polygons. Delete it or draw it.",
    )


def test_options_that_exclude_each_other_are_refused(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24, "--cut", "--on-top"),
        tmp_path,
        "--cut excludes --on-top. Run with --help for more information.",
    )


def test_new_prints_the_next_commands(
    thawslide: Program, binary: Path, tmp_path: Path, slope: Slope, release: Path
) -> None:
    folder = tmp_path / "a slide"
    outcome = made(thawslide, folder, slope(), release, "--thickness", 24)
    assert f"preview:  {binary} check '{folder}' --picture\nrun:      {binary} run '{folder}'\n" in outcome.stdout
