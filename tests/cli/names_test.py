"""Names of files and folders with characters that have a meaning in TOML, in comments or in a shell."""

import os
import tomllib
import unicodedata
from pathlib import Path

import odd_files as odd
import pytest
from conftest import Program, Ran, Slope, sets
from terrain_files import SOUTH, WEST, write_dem, write_line, write_rectangle, write_release

NAMES = ['quo"te', "back\\slash", 'x"\n[time]\nend = 5\n#', "it's $(id) `id`", "tab\there"]


@pytest.mark.parametrize("name", NAMES)
def test_names_are_only_values_in_the_case_file_and_the_next_command(
    ran: Ran, thawslide: Program, tmp_path: Path, slope: Slope, name: str
) -> None:
    release = write_rectangle(tmp_path / f"{name}.geojson", WEST + 200.0, SOUTH + 250.0)
    folder = tmp_path / name
    printed = slope.ok(folder=folder, dem=slope(f"{name}.tif"), release=release)
    case = tomllib.loads((folder / "case.toml").read_text())
    assert case["case"]["title"] == name
    assert case["body"]["slide"]["release"] == f"{name}.geojson"
    assert case["time"]["end"] == 60.0
    run = ran(*sets(time__end=0.01), case=folder)
    resolved = tomllib.loads((run / "case.toml").read_text())
    assert resolved["case"]["title"] == name and resolved["time"]["end"] == 0.01
    assert resolved["body"]["slide"]["release"] == f"inputs/{name}.geojson"
    command = printed.partition("\npreview:")[2].partition(" --picture\n")[0]
    pasted = thawslide.finish(["bash", "-c", f"{command} --json"])
    assert pasted.returncode == 0 and '"particles": 1400' in pasted.stdout, pasted.stderr


@pytest.mark.parametrize("name", NAMES)
def test_a_section_from_files_of_any_name_can_be_run(thawslide: Program, tmp_path: Path, name: str) -> None:
    dem = write_dem(tmp_path / f"{name}.tif", lambda x, _y: 1000.0 - 0.5 * x)
    release = write_release(
        tmp_path / f"{name}.geojson", [(105.0, 155.0), (205.0, 155.0), (205.0, 245.0), (105.0, 245.0)], thickness=20.0
    )
    line = write_line(tmp_path / f"{name} line.geojson", [(15.0, 200.0), (775.0, 200.0)])
    folder = tmp_path / name
    thawslide.ok("section", folder, "--dem", dem, "--line", line, "--release", release)
    assert tomllib.loads((folder / "case.toml").read_text())["case"]["title"] == name
    comments = [each for each in (folder / "profile.csv").read_text().splitlines() if each.startswith("#")]
    plain = name.replace("\n", "?").replace("\t", "?")
    assert comments[0].startswith(f"# Cut by `thawslide section` out of {plain}.tif along {plain} line.geojson")
    assert len(comments) == 3
    thawslide.ok("check", folder)


def test_a_name_that_is_not_utf8_is_refused_before_anything_is_written(tmp_path: Path, slope: Slope) -> None:
    folder = Path(os.fsdecode(os.fsencode(str(tmp_path)) + b"/sl\xffide"))
    outcome = slope.new(folder=folder, text=False)
    assert outcome.returncode == 2
    assert b"is not UTF-8, as required for names in a case file" in outcome.stderr
    assert not folder.exists()


@pytest.mark.parametrize(("written", "stored"), [("NFC", "NFD"), ("NFD", "NFC")])
def test_names_have_any_composition(
    thawslide: Program, tmp_path: Path, slope: Slope, written: str, stored: str
) -> None:
    """Systems and programs write a letter with a mark as one character or as two."""
    slope.ok(folder=tmp_path / "slide")
    name, other = (unicodedata.normalize(form, "Südhang Gürtelé") for form in (written, stored))
    assert name != other
    (tmp_path / other).mkdir()
    release = write_rectangle(tmp_path / other / f"{other}.geojson", WEST + 200.0, SOUTH + 250.0, **{other: 24.0})
    release.write_text(release.read_text().replace('"slide"', f'"{other}"'), encoding="utf-8")
    keys = sets(
        body__slide__release=tmp_path / name / f"{name}.geojson", body__slide__thickness=f'{{ attribute = "{name}" }}',
        body__slide__polygons=f'["{name}"]',
    )  # fmt: skip
    (tmp_path / "slide" / "case.toml").rename(tmp_path / "slide" / f"{other}.toml")
    (tmp_path / "slide" / "case.toml").write_text(f'case.based_on = "{name}.toml"\n', encoding="utf-8")
    (tmp_path / "slide").rename(tmp_path / other / other)
    checked = thawslide.json("check", tmp_path / name / name, *keys)
    assert checked["bodies"][0]["volume_m3"] == pytest.approx(288_000.0, rel=1e-6)


@pytest.mark.parametrize(
    ("encoding", "page", "stated"),
    [
        ("latin-1", 0, ""), ("latin-1", 0x57, ""), ("cp1252", 0x03, ""), ("cp850", 0x02, ""), ("cp852", 0x64, ""),
        ("utf-8", 0, ""), ("utf-8", 0, "UTF-8"), ("latin-1", 0, "ISO-8859-1"), ("cp1250", 0, "1250"),
    ],
)  # fmt: skip
def test_names_have_the_encoding_of_their_shapefile(
    thawslide: Program, tmp_path: Path, encoding: str, page: int, stated: str
) -> None:
    """`page`: code page in the table of attributes; `stated`: text of the .cpg file; without both, the likely one."""
    release = odd.shapefile(
        tmp_path / "area.shp", [[odd.ring(odd.SQUARE)]], name="Südflanke".encode(encoding), page=page
    )
    if stated:
        release.with_suffix(".cpg").write_text(stated)
    thawslide.ok(*odd.new_words(tmp_path, release))
    assert "400,000 m3" in thawslide.ok("check", tmp_path / "slide", "--set", 'body.slide.polygons=["Südflanke"]')
    message = thawslide.error("check", tmp_path / "slide", "--set", 'body.slide.polygons=["Sudflanke"]')
    assert "the file has: Südflanke; did you mean 'Südflanke'?" in message
