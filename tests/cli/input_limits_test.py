"""Inputs that are too large, too deep, or links: refused, or treated as docs/reference/limits.md states."""

import os
import re
from pathlib import Path

import pytest
from conftest import PROFILE, Program, Ran, Slope, assert_identical, run_facts, sets, with_profile
from terrain_files import CELL, SOUTH, WEST, write_rectangle


def test_a_large_profile_is_refused(thawslide: Program, small_case: Path) -> None:
    profile = with_profile(small_case, "distance_m,terrain_elevation_m\n")
    os.truncate(profile, 200_000_000)
    message = thawslide.error("check", small_case, quiet=True)
    assert f'{profile}: the file has 200 MB; allowed: 100 MB. A DEM is read with terrain.type = "dem".' in message


@pytest.mark.parametrize("text", ["a{} = 1\n", "[a{}]\nb = 1\n", "[time]\nend = {{ b{} = 1 }}\n", "a {} = 1\n"])
def test_a_key_of_many_parts_is_refused(thawslide: Program, tmp_path: Path, text: str) -> None:
    """The parser would exhaust the stack."""
    file = tmp_path / "deep.toml"
    file.write_text(text.format((" . a" if text.startswith("a {") else ".a") * 200_000))
    line = 2 if "time" in text else 1
    assert thawslide.error("check", file, quiet=True) == (
        f"error: {file}:{line}: this is not a case: a key of more than 50 parts; allowed: TABLE.NAME.KEY. Is it the "
        "right file?\n"
    )


def test_long_texts_and_control_characters_are_not_repeated(thawslide: Program, small_case: Path) -> None:
    message = thawslide.error("check", small_case, "--set", 'time.end="\\u001b[2J' + "x" * 100_000 + '"', quiet=True)
    assert "\x1b" not in message and 'time.end is the text "?[2J' in message and 'xxx..."; allowed: a number' in message


def test_a_variant_can_be_named_without_a_folder(thawslide: Program, small_case: Path) -> None:
    (small_case / "variant.toml").write_text('[case]\nbased_on = "case.toml"\n')
    for words in (("check", "variant.toml"), ("run", "variant.toml", "--output", "run", *sets(time__end=0.01))):
        thawslide.ok(*words, folder=small_case)


@pytest.mark.parametrize("remarks", [0, 510_000])
def test_the_copy_of_a_linked_input_is_a_copy(ran: Ran, thawslide: Program, small_case: Path, remarks: int) -> None:
    """Links to files outside the folder are refused: tests/cpp/config/named_files_test.cpp."""
    profile = with_profile(small_case, PROFILE + ("#" * 99 + "\n") * remarks)
    original = profile.rename(small_case / "real.csv")
    profile.symlink_to("real.csv")
    run = ran(*sets(time__end=0.01))
    copy = run / "inputs" / "profile.csv"
    assert not copy.is_symlink() and not copy.samefile(original)
    assert copy.read_bytes() == original.read_bytes()
    with original.open("a") as file:
        file.write("# a remark\n")
    printed = thawslide.ok("resume", run, "--end", 0.02)
    note = f"{profile} has changed since the run began. The run continues with its copy, inputs/profile.csv"
    assert f"warning: {note}\n" in printed and printed.count("has changed") == 1
    assert run_facts(run)["parts"][1]["warnings"] == [note]


def test_a_linked_case_file_is_read_and_a_linked_base_is_refused(thawslide: Program, small_case: Path) -> None:
    """A linked case file is read with the files next to the link; its base case must be in the folder."""
    outside = small_case.parent / "other.toml"
    (small_case / "case.toml").rename(outside)
    (small_case / "case.toml").symlink_to(outside)
    thawslide.ok("check", small_case)
    variant = small_case / "variant.toml"
    variant.write_text('[case]\nbased_on = "case.toml"\n')
    assert thawslide.error("check", variant, quiet=True) == (
        f'error: {variant}:2:12: case.based_on is "case.toml", a link that leads out of the folder; allowed: a case '
        "file in it. Copy it there.\n"
    )


def test_linked_output_folders_are_written_and_kept_or_refused(thawslide: Program, small_case: Path) -> None:
    disk, run, plain = (small_case.parent / name for name in ("disk", "run", "plain"))
    disk.mkdir()
    run.symlink_to(disk)
    words = sets(time__end=0.05)
    thawslide.ok("run", small_case, "--output", run, *words)
    assert run.is_symlink() and (disk / "run.json").is_file()
    thawslide.ok("run", small_case, "--output", plain, *words)
    assert_identical(run, plain)
    run = small_case.parent / "dangling"
    run.symlink_to(small_case.parent / "nowhere")
    problem = "it is a link to a folder that is not there. Give another --output."
    message = thawslide.error("run", small_case, "--output", run, quiet=True)
    assert message == f"error: the output folder {run} cannot be made: {problem}\n"
    assert not (small_case.parent / "nowhere").exists()


def test_rasters_of_other_formats_are_refused(tmp_path: Path, slope: Slope) -> None:
    """A virtual raster can name other files, which a case must not read."""
    dem = slope()
    virtual = tmp_path / "virtual.tif"
    virtual.write_text(
        f'<VRTDataset rasterXSize="40" rasterYSize="40"><GeoTransform>{WEST}, {CELL}, 0, {SOUTH + 40 * CELL}, 0, '
        f'-{CELL}</GeoTransform><VRTRasterBand dataType="Float64" band="1"><SimpleSource><SourceFilename>{dem}'
        "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>"
    )
    message = slope.error(dem=virtual, thickness=20)
    assert not (tmp_path / "slide").exists()
    assert "virtual.tif: the raster cannot be opened" in message
    assert "Allowed: a GeoTIFF or an ESRI ASCII grid" in message


def test_too_many_polygons_and_points_are_refused(tmp_path: Path, slope: Slope, thawslide: Program) -> None:
    polygons = write_rectangle(tmp_path / "many.geojson", WEST + 200.0, SOUTH + 250.0)
    text = polygons.read_text()
    start, end = text.index('{"type": "Feature",'), text.rindex("]")
    polygons.write_text(text[:start] + ",".join([text[start:end]] * 100_001) + text[end:])
    assert "the file has more than 100000 polygons; allowed: as many." in slope.error(release=polygons, thickness=20)
    dem = tmp_path / "large.asc"
    with dem.open("w") as file:
        file.write(f"ncols 30000\nnrows 30000\nxllcorner {WEST}\nyllcorner {SOUTH}\ncellsize 1\nNODATA_value -9999\n")
        file.write(" ".join(["1"] * 1000) + "\n")
        file.truncate(2 * 30000**2)  # long enough for so many values; a sparse file needs no disk space
    message = slope.error("--crs", "EPSG:32631", dem=dem)
    assert "30,000 x 30,000 points of it are needed; allowed: 400,000,000 points. Crop it" in message
    slope.ok(thickness=20)
    message = thawslide.error("check", tmp_path / "slide", "--set", "terrain.resample=0.01", quiet=True)
    assert re.search(
        r"--set terrain\.resample=0\.01: terrain\.resample: \S+dem\.tif: [\d,]+ x [\d,]+ points of it are needed; "
        r"allowed: 400,000,000 points\. Crop it",
        message,
    ), message


def test_a_failed_new_leaves_a_linked_folder_empty(tmp_path: Path, slope: Slope) -> None:
    """The target of the link is empty again, and the link is kept; the message has no location in a removed file."""
    place, folder = tmp_path / "place", tmp_path / "slide"
    place.mkdir()
    folder.symlink_to(place)
    release = write_rectangle(tmp_path / "release.geojson", WEST + 203.0, SOUTH + 252.0)
    message = slope.error("--cell", 200, release=release, thickness=20)
    assert message.startswith("error: no case was created, because it would not run: ") and "case.toml" not in message
    assert folder.is_symlink() and place.is_dir() and not list(place.iterdir())
