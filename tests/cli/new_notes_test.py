"""What `thawslide new` and `thawslide check` say of releases and terrain models that run, but hardly as meant."""

from __future__ import annotations

import re
from pathlib import Path

import rasterio
from conftest import Program
from slope_files import (
    SOUTH,
    THICKNESS,
    WEST,
    Slope,
    assert_refused,
    made,
    said,
    write_release,
)

ACROSS = (
    "the body slide has 1.6 particles across its median thickness of 24 m; fewer than 4 do not tell how it shears and "
    "thins. A cell of "
)


def test_particles_across_the_thickness(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    """`check` tells them; where the user's cell makes them too few, `new` and `check` say so."""
    outcome = made(thawslide, tmp_path / "fine", slope(), release, "--thickness", THICKNESS)
    assert outcome.returncode == 0 and "note:" not in outcome.stdout, outcome.stderr
    checked = thawslide("check", tmp_path / "fine")
    assert (
        "  body        slide: 2.88e+05 m3 and 5.94e+08 kg, over 1.2e+04 m2; 24 m thick in the mean, 24 m in the "
        "median and 24 m at most (vertical)\n"
        "              4512 particles 4 m apart; 6 across in the median and 6 at most; -5 C\n"
        "  particles "
    ) in checked.stdout
    coarse = made(
        thawslide,
        tmp_path / "coarse",
        slope(),
        release,
        "--thickness",
        THICKNESS,
        "--cell",
        30,
    )
    assert f"note: {ACROSS}8 m has 6 and more\n" in coarse.stdout, coarse.stderr
    told = thawslide("check", tmp_path / "coarse").stdout
    assert "; 1.6 across in the median and 1.6 at most; " in told
    fitting = re.search(rf"/coarse/case\.toml:\d+:\d+: {re.escape(ACROSS)}(\S+) m has 6 and more\n", told)
    assert fitting and 4.0 < float(fitting[1]) <= 8.0, told
    finer = thawslide("check", tmp_path / "coarse", "--set", f"grid.cell={fitting[1]}")
    assert finer.returncode == 0 and ACROSS[-20:] not in finer.stdout, finer.stderr


def test_release_smaller_than_a_cell_of_the_dem(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    tiny = write_release(tmp_path / "tiny.geojson", WEST + 203.0, SOUTH + 252.0, 3.0, 3.0)
    assert_refused(
        made(thawslide, tmp_path / "slide", slope(), tiny, "--thickness", 20),
        tmp_path,
        "--release: tiny.geojson: the release has 9 m2, less than one cell of the terrain model, 100 m2: it would be "
        "spread over the cell and become as much thinner. Draw it larger, or resample the terrain model (gdalwarp -tr "
        "0.8 0.8 -r bilinear dem.tif finer.tif).",
    )


def test_thickness_of_the_order_of_the_width(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 300)
    assert outcome.stdout.startswith(
        "note: the release of the body slide is up to 300 m thick and, by its area, 109.5 m wide: is the thickness in "
        "metres?\n"
    ), outcome.stdout + outcome.stderr


def test_hole_filled_with_zeros(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    """A slide would fall into it: `new`, `check` and `run` tell of it."""
    dem = slope()
    with rasterio.open(dem, "r+") as file:
        heights = file.read(1)
        heights[27:30, 40:45] = 0.0
        file.write(heights, 1)
    outcome = made(thawslide, tmp_path / "slide", dem, release, "--thickness", THICKNESS)
    note = (
        "note: 15 points of dem.tif are exactly 0 m amid ground of 1000 to 1035 m, such as (412400, 5160300): a hole "
        "without data? Then say so in the file, gdal_edit.py -a_nodata 0 {}dem.tif, or fill it\n"
    )
    assert said(outcome.stdout, tmp_path).startswith(note.format("")), outcome.stdout + outcome.stderr
    for words in (
        ("check",),
        ("run", "--output", tmp_path / "run", "--set", "time.end=0.01"),
    ):
        done = thawslide(words[0], tmp_path / "slide", *words[1:])
        assert done.returncode == 0, done.stderr
        assert note.format("slide/") in said(done.stdout, tmp_path)


def test_crs_by_a_bare_number(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    bare = slope("bare.tif", crs=None)
    assert_refused(
        made(
            thawslide,
            tmp_path / "slide",
            bare,
            release,
            "--thickness",
            THICKNESS,
            "--crs",
            32632,
        ),
        tmp_path,
        "--crs: '32632' is no coordinate reference system that is known; did you mean \"EPSG:32632\"? Allowed: a "
        'number of the EPSG registry such as "EPSG:31287" (epsg.io finds it), or a WKT.',
    )


def test_resampling_a_made_case_tells_the_domain_that_fits(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    folder = tmp_path / "slide"
    assert made(thawslide, folder, slope(), release, "--thickness", THICKNESS).returncode == 0
    words = ("--set", "terrain.resample=40")
    outcome = thawslide("check", folder, *words)
    assert outcome.returncode == 2
    told = outcome.stderr.partition("Set ")[2].partition(", or take a larger")[0]
    low, _, high = told.partition(" and ")
    assert low.startswith("grid.min = [") and high.startswith("grid.max = ["), outcome.stderr
    done = thawslide(
        "check",
        folder,
        *words,
        "--set",
        low.replace(" ", ""),
        "--set",
        high.replace(" ", ""),
    )
    assert done.returncode == 0, done.stderr
