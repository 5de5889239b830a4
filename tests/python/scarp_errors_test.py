"""Refused releases: the message states the problem, the exit code is 2, and no file is written."""

from pathlib import Path

import pytest
from scarp_files import Ring, centre, rectangle, write_dem, write_outline
from scarp_test import flat, slope

from thawslide.scarps.command import main

X, Y = centre()
AT = f"x={X},y={Y}"
PLANE = f"--plane {AT},dip=30,direction=90"
ELLIPSOID = f"--ellipsoid {AT},half_length=300,half_width=150,azimuth=0"
WITHIN = "--slbl --within"
SLBL = f"dem.tif {WITHIN} in.geojson"
INSIDE = rectangle((-200.0, 200.0), (-100.0, 100.0))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_dem(tmp_path / "dem.tif", slope)
    write_dem(tmp_path / "flat.tif", flat)
    write_dem(tmp_path / "hole.tif", slope, no_data=(50, 52))
    write_dem(tmp_path / "kelvin.tif", slope, unit="K")
    write_dem(tmp_path / "degrees.tif", slope, crs="EPSG:4326")
    write_dem(tmp_path / "nowhere.tif", slope, crs=None)
    (tmp_path / "text.tif").write_text("no raster")
    write_outline(tmp_path / "in.geojson", INSIDE)
    write_outline(tmp_path / "out.geojson", rectangle((300.0, 600.0), (0.0, 100.0)))
    write_outline(tmp_path / "edge.geojson", rectangle((300.0, 500.0), (0.0, 100.0)))
    write_outline(tmp_path / "tiny.geojson", rectangle((1.0, 2.0), (1.0, 2.0)))
    empty: list[Ring] = [[]]
    write_outline(tmp_path / "empty.geojson", *empty)
    (tmp_path / "text.geojson").write_text("[")
    (tmp_path / "line.shp").write_bytes(bytes(200))
    (tmp_path / "outline.kml").write_text("<kml/>")
    return tmp_path


# Arguments, and the beginning of the message.
REFUSED = f"""
dem.tif -> failure surface: specify one of --plane, --ellipsoid and --slbl.
dem.tif --slbl {PLANE} -> failure surface: specify one of
dem.tif {PLANE} --tolerance 1 -> --tolerance and --max-depth: allowed with --slbl only.
dem.tif --plane x=1,y=2 -> --plane: missing: dip, direction. Specify them.
dem.tif --plane x=1,y=2,dipp=3 -> --plane: no key 'dipp' (allowed: x, y, dip, direction, depth, z); did you mean
dem.tif --plane x=1,y=two -> --plane: y: not a number (found 'two'). Correct it.
dem.tif --plane x=1,x=2 -> --plane: x: specified twice. Omit one.
dem.tif {PLANE},depth=nan -> --plane: depth: not a finite number (found nan).
dem.tif --plane {AT},dip=90,direction=0 -> --plane: dip: out of range (found 90; allowed 0 to 89 degrees).
dem.tif {PLANE},depth=10,z=1000 -> --plane: depth and z are both specified.
dem.tif {PLANE} -> --plane: not below the DEM at x = 400500, y = 6503500. Increase depth or
dem.tif {PLANE},depth=10 -> --plane: the release reaches the edge of the DEM or cells without data
hole.tif {PLANE},depth=10 -> --plane: the release reaches the edge
dem.tif --plane x=1,y=2,dip=30,direction=0,depth=1 -> --plane: outside the DEM dem.tif (found x = 1, y = 2; allowed
dem.tif {PLANE},z=9000 --within in.geojson -> dem.tif: no cell of the DEM is above the failure surface.
dem.tif {ELLIPSOID} -> --ellipsoid: neither depth nor a volume is specified.
dem.tif {ELLIPSOID},depth=10 --volume 1e6 -> --ellipsoid: depth and a volume are both specified.
dem.tif {ELLIPSOID},depth=-5 -> --ellipsoid: depth: invalid number (found -5 m; allowed above 0, at most 10,000).
dem.tif {ELLIPSOID},depth=5,dip=3 -> --ellipsoid: only one of dip and direction is specified.
hole.tif {ELLIPSOID},depth=5 -> --ellipsoid: cells without data in hole.tif (found 1; the first at x = 400525
dem.tif --ellipsoid {AT},half_length=900,half_width=9,azimuth=0,depth=5 -> \
--ellipsoid: outside the DEM dem.tif (found x = 400491 to 400509, y = 6502600 to 6504400; allowed
dem.tif --ellipsoid {AT},half_length=5,half_width=5,azimuth=0,depth=5 -> \
--ellipsoid: too small for the DEM (0 cells of 10 m). Enlarge the half axes.
dem.tif {ELLIPSOID} --volume 0 -> --volume: invalid number (found 0 m3; allowed above 0, at most 10,000,000,000).
{SLBL} --volume 1e300 -> --volume: invalid number (found 1e+300 m3; allowed
dem.tif --slbl --tolerance 1 -> --slbl: no outline is specified. Specify --within FILE.
{SLBL} -> --slbl: specify one of --tolerance, --max-depth and --volume (found: none).
{SLBL} --tolerance -1 -> --tolerance: invalid number (found -1 m; allowed 0 to 10,000).
{SLBL} --max-depth 0 -> --max-depth: invalid number (found 0 m; allowed above 0, at most 10,000).
flat.tif {WITHIN} in.geojson --tolerance 0 -> flat.tif: no cell of the DEM is above the failure surface.
dem.tif {WITHIN} edge.geojson --tolerance 1 -> --slbl: the outline reaches the edge of dem.tif.
dem.tif {WITHIN} out.geojson --tolerance 1 -> --within out.geojson: outside the DEM dem.tif (found x = 400800
hole.tif {WITHIN} in.geojson --tolerance 1 -> --within in.geojson: cells without data in hole.tif (found 1;
dem.tif {WITHIN} tiny.geojson --tolerance 1 -> --within tiny.geojson: no centre of a cell of dem.tif is inside.
dem.tif {WITHIN} empty.geojson --tolerance 1 -> empty.geojson: polygon 1 has no geometry; needed: polygons.
dem.tif {WITHIN} text.geojson --tolerance 1 -> text.geojson: the file cannot be opened
dem.tif {WITHIN} line.shp --tolerance 1 -> line.shp: the index of the Shapefile, line.shx, is missing.
dem.tif {WITHIN} outline.kml --tolerance 1 -> outline.kml: the layer is empty; needed: polygons.
dem.tif {WITHIN} absent.gpkg --tolerance 1 -> absent.gpkg: there is no such file.
absent.tif {PLANE} -> absent.tif: there is no such file. Correct the path.
text.tif {PLANE} -> text.tif: the raster cannot be opened
in.geojson {PLANE} -> in.geojson: the file has polygons, lines or points; needed: a raster
dem.tif {WITHIN} hole.tif --tolerance 1 -> hole.tif: the file is a raster; needed: polygons
kelvin.tif {PLANE} -> kelvin.tif: the unit of the values is 'K'; allowed: a unit of length
degrees.tif {PLANE} -> degrees.tif: the tag specifies degrees (EPSG:4326), but the numbers are metric
nowhere.tif {PLANE} --crs EPSG:0 -> --crs: 'EPSG:0' is not a known coordinate reference system;
nowhere.tif {PLANE} -> nowhere.tif: the file names no coordinate reference system (x from 400000 to 401000, y
dem.tif {PLANE} --output a.asc -> --output: a.asc: unknown format (allowed: .tif). Change the name.
dem.tif {PLANE} --output dem.tif --overwrite -> --output: dem.tif: would replace the input dem.tif.
dem.tif {PLANE} --output flat.tif -> --output: flat.tif: exists. Change the name, or specify --overwrite.
dem.tif {PLANE} --output no/a.tif -> --output: no/a.tif: the folder does not exist.
dem.tif {ELLIPSOID},depth=5 --picture a.pdf -> --picture: a.pdf: unknown format (allowed: .png). Change the name.
""".strip().splitlines()


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    words, message = case.split(" -> ")
    monkeypatch.chdir(folder)
    before = {path: path.read_bytes() for path in folder.iterdir()}
    assert main(words.split()) == 2
    printed = capsys.readouterr()
    assert printed.err.startswith(f"thawslide scarp: error: {message}"), printed.err
    assert printed.err.endswith((".\n", ".shp\n", ".tif\n")) and printed.out == ""  # a sentence or a command
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


def test_volume_that_joins_two_parts_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def terraces(x: object, _y: object) -> object:
        return 1000.0 + 100.0 * ((x > -200.0) & (x < 200.0) & (abs(_y) < 300.0)) - 50.0 * (abs(x) < 20.0)  # type: ignore

    dem = write_dem(tmp_path / "dem.tif", terraces)  # type: ignore[arg-type]
    surface = f"x={X - 100.0},y={Y},dip=0,direction=0"
    assert main([str(dem), "--plane", surface, "--volume", "6e6", "--output", str(tmp_path / "a.tif")]) == 2
    message = capsys.readouterr().err
    assert "--volume: 6,000,000 m3 cannot be reached (at one depth, the volume jumps from" in message


def test_volume_below_that_of_the_bumps_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    dem = write_dem(tmp_path / "dem.tif", lambda x, y: slope(x, y) - (x**2 + y**2) / 1000.0)
    within = write_outline(tmp_path / "in.geojson", INSIDE)
    words = [str(dem), "--slbl", "--within", str(within), "--output", str(tmp_path / "a.tif")]
    assert main([*words, "--volume", "1000"]) == 2
    assert "is the minimum). Change the volume" in capsys.readouterr().err
    assert main([*words, "--max-depth", "0.01"]) == 2
    assert "is the minimum). Increase it." in capsys.readouterr().err
