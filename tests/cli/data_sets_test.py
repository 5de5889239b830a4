"""An input is a set of files: cases, runs, continued runs and digests of sweeps have all of them, and change none.

Names of files and folders may have characters with a meaning in TOML, in comments or in a shell.
"""

import os
import shutil
import tomllib
from collections.abc import Callable
from pathlib import Path

import odd_files as odd
import pytest
import rasterio
from conftest import Program, Ran, Slope, mark_killed, release_volume, sets
from terrain_files import SOUTH, WEST, write_dem, write_line, write_rectangle, write_release

from thawslide.case import Case
from thawslide.sweeps.api import _digest

Write = Callable[[Path], Path]


def with_encoding(file: Path) -> Path:
    """Write a Shapefile whose encoding is in a file of its own."""
    odd.shapefile(file, [[odd.ring(odd.SQUARE)], [odd.ring(odd.HOLE)]], name="Südflanke".encode("cp850"))
    file.with_suffix(".cpg").write_text("CP850")
    return file


def with_other_case(file: Path) -> Path:
    """Write a Shapefile whose parts have suffixes in the other case than the first file."""
    return odd.shapefile(file.with_suffix(".SHP"), [[odd.ring(odd.SQUARE)]])


def with_mask_file(file: Path) -> Path:
    """Write a thickness with wrong values in a corner, which a mask in a file of its own excludes."""
    values = odd.thickness()
    values[:5, -5:] = 77.0
    odd.raster(file, values)
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=False), rasterio.open(file, "r+") as opened:
        opened.write_mask(values != 77.0)
    assert file.with_name(file.name + ".msk").is_file()
    return file


def with_statement(file: Path) -> Path:
    """Write a thickness in centimetres as an ASCII grid, whose unit and system are in files of their own."""
    odd.raster(file.with_name("plain.tif"), 100.0 * odd.thickness())
    with rasterio.open(file.with_name("plain.tif")) as opened:
        profile = {key: opened.profile[key] for key in ("width", "height", "count", "transform", "crs")}
        with rasterio.open(file, "w", driver="AAIGrid", dtype="float64", **profile) as other:
            other.write(opened.read(1), 1)
    file.with_name("plain.tif").unlink()
    unit = '<PAMRasterBand band="1"><UnitType>cm</UnitType></PAMRasterBand>'
    file.with_name(file.name + ".aux.xml").write_text(f"<PAMDataset>{unit}</PAMDataset>")
    return file


# Releases by name, with the number of their files.
SETS: dict[str, tuple[Write, int]] = {
    "open.gpkg": (odd.open_elsewhere, 2),
    "encoded.shp": (with_encoding, 5),
    "capital.shp": (with_other_case, 4),
    "world.tif": (lambda file: odd.world_file(file, odd.thickness()), 2),
    "masked.tif": (with_mask_file, 2),
    "stated.asc": (with_statement, 3),
}


@pytest.fixture(params=SETS)
def given(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    (tmp_path / "given").mkdir()
    write, count = SETS[request.param]
    file = write(tmp_path / "given" / request.param)
    assert len(list(file.parent.iterdir())) == count
    return file


def volume(thawslide: Program, case: Path, *words: object) -> float:
    return float(thawslide.json("check", case, *words)["bodies"][0]["volume_m3"])


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.fixture
def case(thawslide: Program, tmp_path: Path, given: Path) -> Path:
    """Return a case made of the release, whose original files no longer exist."""
    before = contents(given.parent)
    thawslide.ok(*odd.new_words(tmp_path, given))
    assert contents(given.parent) == before
    return tmp_path / "slide"


def test_copies_and_digests_have_every_file_unchanged(case: Path, given: Path, thawslide: Program, run: Path) -> None:
    def digest() -> str:
        return _digest(Case(case), Path.read_bytes)

    assert {path.name for path in Case(case).input_files} == {"dem.tif", *(contents(given.parent))}
    before = digest()
    assert digest() == before
    for name in contents(given.parent):
        content = (case / name).read_bytes()
        is_text = name.endswith(("prj", "cpg", "xml", "tfw", "asc"))
        (case / name).write_bytes(content + (b" " if is_text else b"\0"))  # which changes no meaning
        assert digest() != before, name
        (case / name).write_bytes(content)
    original = contents(given.parent)
    shutil.rmtree(given.parent)
    assert volume(thawslide, case) == pytest.approx(odd.FULL, rel=1e-6)
    assert original.items() <= contents(case).items()
    thawslide.ok("run", case, "--output", run, *sets(time__end=0.02, grid__cell=20.0))
    shutil.rmtree(case)
    assert original.items() <= contents(run / "inputs").items()
    for end in (0.03, 0.04):
        thawslide.ok("resume", run, "--end", end)
    assert release_volume(run) == pytest.approx(odd.FULL, rel=1e-3)
    assert original.items() <= contents(run / "inputs").items()


def test_file_added_to_an_input_of_a_run_is_refused(thawslide: Program, tmp_path: Path, run: Path) -> None:
    thawslide.ok(*odd.new_words(tmp_path, odd.shapefile(tmp_path / "release.shp", [[odd.ring(odd.SQUARE)]])))
    thawslide.ok("run", tmp_path / "slide", "--output", run, *sets(time__end=0.02, grid__cell=20.0))
    mark_killed(run)
    (run / "inputs" / "release.cpg").write_text("UTF-8")
    added = f"{run / 'inputs' / 'release.cpg'} was added and must be removed. A run continues with the inputs of its"
    assert added in thawslide.error("resume", run)


def test_files_of_one_name_are_refused(thawslide: Program, tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    release = odd.shapefile(tmp_path / "a" / "area.shp", [[odd.ring(odd.SQUARE)]])
    thawslide.ok(*odd.new_words(tmp_path, release))
    thick = odd.raster(tmp_path / "b" / "area.tif", odd.thickness())
    thawslide.ok("check", tmp_path / "slide", "--set", f'body.slide.thickness={{ raster = "{thick}" }}')
    grid = with_statement(tmp_path / "b" / "area.asc")
    words = ["--set", f"body.slide.release={release}", "--set", f'body.slide.thickness={{ raster = "{grid}" }}']
    message = thawslide.error("run", tmp_path / "slide", "--output", tmp_path / "run", *words)
    names = f"{release.with_suffix('.prj')} and {grid.with_suffix('.prj')}"
    assert f"{names} have the same name; allowed: names of their own" in message


def test_edits_of_an_open_geopackage_stay_where_they_are(thawslide: Program, tmp_path: Path) -> None:
    """Also the copies in temporary folders are removed."""
    (tmp_path / "given").mkdir()
    (tmp_path / "temporary").mkdir()
    release = odd.open_elsewhere(tmp_path / "given" / "open.gpkg")
    before = contents(release.parent)
    environment = thawslide.environment | {"TMPDIR": str(tmp_path / "temporary")}
    words = odd.new_words(tmp_path, release)
    outcome = thawslide(*words, environment=environment)
    assert "a release of 400,000 m3" in outcome.stdout
    assert contents(release.parent) == before and list((tmp_path / "temporary").iterdir()) == []
    words[1] = tmp_path / "other"
    absent = thawslide(*words, environment=environment | {"TMPDIR": str(tmp_path / "no")})
    assert absent.returncode == 2 and "it cannot be copied to read its latest edits" in absent.stderr
    assert volume(thawslide, tmp_path / "slide") == pytest.approx(odd.FULL, rel=1e-6)


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
    corners = [(105.0, 155.0), (205.0, 155.0), (205.0, 245.0), (105.0, 245.0)]
    release = write_release(tmp_path / f"{name}.geojson", corners, thickness=20.0)
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


@pytest.mark.parametrize(
    ("encoding", "page", "stated"),
    [
        ("latin-1", 0, ""), ("latin-1", 0x57, ""), ("cp1252", 0x03, ""), ("cp850", 0x02, ""), ("cp852", 0x64, ""),
        ("utf-8", 0, ""), ("utf-8", 0, "UTF-8"), ("latin-1", 0, "ISO-8859-1"), ("cp1250", 0, "1250"),
    ],
)  # fmt: skip
def test_names_of_any_encoding(thawslide: Program, tmp_path: Path, encoding: str, page: int, stated: str) -> None:
    """`page`: code page in the table of attributes; `stated`: text of the .cpg file; without both, the likely one."""
    ring, name = odd.ring(odd.SQUARE), "Südflanke".encode(encoding)
    release = odd.shapefile(tmp_path / "area.shp", [[ring]], name=name, page=page)
    if stated:
        release.with_suffix(".cpg").write_text(stated)
    thawslide.ok(*odd.new_words(tmp_path, release))
    assert "400,000 m3" in thawslide.ok("check", tmp_path / "slide", "--set", 'body.slide.polygons=["Südflanke"]')
    message = thawslide.error("check", tmp_path / "slide", "--set", 'body.slide.polygons=["Sudflanke"]')
    assert "the file has: Südflanke; did you mean 'Südflanke'?" in message
