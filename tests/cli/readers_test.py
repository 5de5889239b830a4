"""Every command and function that opens rasters or polygons of a user reads the same odd files alike, or refuses them.

The table of files is in odd_files.py. A new command that reads such files belongs in the tables here.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import odd_files as odd
import pytest
import rasterio
from conftest import Program, columns_of, sets

from thawslide import scarp
from thawslide.errors import ReportError
from thawslide.scarps import Plane
from thawslide.scarps.command import main as scarp_command
from thawslide.sweeps.probability_command import main as probability_command

CENTRE = (odd.WEST + 105.0, odd.SOUTH + 305.0)  # of a cell
DIP = np.degrees(np.arctan(0.5))
PLANE = f"x={CENTRE[0]},y={CENTRE[1]},dip={DIP:.15g},direction=90,depth={odd.THICK}"


class RefusedError(Exception):
    """The message of a refused file."""


class Reader:
    """Runs a command with one odd file, and returns the volume that it reads [m3]."""

    def __init__(self, program: Program, folder: Path, plain: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.program, self.folder, self.capsys = program, folder, capsys
        self.dem, self.release, self.case = plain / "dem.tif", plain / "release.geojson", plain / "slide"

    def called(self, *words: object) -> str:
        """Run the program; return what it prints."""
        outcome = self.program(*words)
        if outcome.returncode:
            assert outcome.returncode == 2 and outcome.stderr.startswith("error: "), outcome.stderr
            raise RefusedError(outcome.stderr)
        return outcome.stdout

    def checked(self, **keys: object) -> float:
        """Return the volume of the case with keys replaced."""
        self.called("check", self.case, *sets(**keys))
        checked = self.program.json("check", self.case, *sets(**keys))
        return float(checked["bodies"][0]["volume_m3"])

    def new(self, dem: Path, release: Path, *words: object) -> float:
        """Return the volume of a new case, whose DEM must have the elevations of the original."""
        made = self.folder / "made"
        self.called("new", made, "--dem", dem, "--release", release, *words)
        with rasterio.open(made / "dem.tif") as file:
            column = round((file.transform.c - odd.WEST) / odd.CELL)
            row = round((odd.SOUTH + odd.ROWS * odd.CELL - file.transform.f) / odd.CELL)
            expected = odd.heights()[row : row + file.height, column : column + file.width]
            found = file.read(1, masked=True)
            assert np.abs(found - expected).max() < 0.01
        return float(self.program.json("check", made)["bodies"][0]["volume_m3"])

    def scarp(self, dem: Path, within: Path) -> float:
        """Return the volume of the command `scarp`."""
        output = self.folder / "scarp.tif"
        if scarp_command([str(dem), "--plane", PLANE, "--within", str(within), "--output", str(output)]):
            raise RefusedError(self.capsys.readouterr().err)
        with rasterio.open(output) as file:
            return float(file.read(1).sum()) * odd.CELL**2

    @staticmethod
    def scarp_function(dem: Path, within: Path) -> float:
        """Return the volume of the function `scarp`."""
        plane = Plane(*CENTRE, DIP, 90.0, odd.THICK)
        try:
            return scarp(dem, plane, within=within).volume
        except ReportError as error:
            raise RefusedError(str(error)) from error


def new_with_dem(reader: Reader, file: Path) -> float:
    return reader.new(file, reader.release, "--thickness", odd.THICK)


def check_with_dem(reader: Reader, file: Path) -> float:
    """Return the volume between another surface and the DEM."""
    surface = f'{{ surface = "{reader.case.parent / "before.tif"}" }}'
    return reader.checked(terrain__file=file, terrain__smooth=0, body__slide__thickness=surface)


def run_with_dem(reader: Reader, file: Path) -> float:
    """Return the volume in the maps of a run of one step."""
    words = sets(terrain__file=file, terrain__smooth=0, time__end=1e-3, grid__cell=20.0)
    reader.called("run", reader.case, "--output", reader.folder / "run", *words)
    with rasterio.open(reader.folder / "run" / "maps" / "release.tif") as file_of_release:
        return float(file_of_release.read(1, masked=True).filled(0.0).sum()) * odd.CELL**2


def section_with_dem(reader: Reader, file: Path) -> float:
    """Return the full volume for correct elevations: the section itself has none."""
    ends = [(odd.WEST + x, odd.SOUTH + 255.0) for x in (105.0, 605.0)]
    line = odd.geojson(reader.folder / "line.geojson", "LineString", ends)
    reader.called("section", reader.folder / "made", "--dem", file, "--line", line)
    columns = columns_of(reader.folder / "made" / "profile.csv")
    distance, terrain = columns["distance_m"], columns["terrain_elevation_m"]
    return odd.FULL if np.abs(terrain - (1500.0 - 0.5 * (105.0 + distance))).max() < 0.01 else 0.0


def scarp_with_dem(reader: Reader, file: Path) -> float:
    return reader.scarp(file, reader.release)


def scarp_function_with_dem(reader: Reader, file: Path) -> float:
    return reader.scarp_function(file, reader.release)


def new_with_thickness(reader: Reader, file: Path) -> float:
    return reader.new(reader.dem, file)


def check_with_thickness(reader: Reader, file: Path) -> float:
    return reader.checked(body__slide__thickness=f'{{ raster = "{file}" }}')


def probability_of_thickness(reader: Reader, file: Path) -> float:
    output = reader.folder / "out"
    other = odd.raster(reader.folder / "other.tif", odd.thickness())
    if probability_command([str(file), str(other), "--output", str(output)]):
        raise RefusedError(reader.capsys.readouterr().err)
    with rasterio.open(output / "thickness_p90.tif") as file_of_quantile:
        return float(file_of_quantile.read(1, masked=True).filled(0.0).sum()) * odd.CELL**2


def new_with_polygons(reader: Reader, file: Path) -> float:
    return reader.new(reader.dem, file, "--thickness", odd.THICK)


def check_with_polygons(reader: Reader, file: Path) -> float:
    return reader.checked(body__slide__release=file)


def scarp_with_polygons(reader: Reader, file: Path) -> float:
    return reader.scarp(reader.dem, file)


def scarp_function_with_polygons(reader: Reader, file: Path) -> float:
    return reader.scarp_function(reader.dem, file)


@pytest.fixture(scope="module")
def plain(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a plain DEM, the surface before the release, polygons, and the case made of them."""
    folder = tmp_path_factory.mktemp("plain")
    dem = odd.raster(folder / "dem.tif", odd.heights())
    odd.raster(folder / "before.tif", odd.heights() + odd.thickness())
    release = odd.geojson(folder / "release.geojson", "Polygon", [odd.ring(odd.SQUARE)])
    thawslide.ok("new", folder / "slide", "--dem", dem, "--release", release, "--thickness", odd.THICK)
    return folder


@pytest.fixture
def reader(thawslide: Program, tmp_path: Path, plain: Path, capsys: pytest.CaptureFixture[str]) -> Reader:
    (tmp_path / "given").mkdir()
    return Reader(thawslide, tmp_path, plain, capsys)


WITH_DEM = [
    new_with_dem, check_with_dem, run_with_dem, section_with_dem, scarp_with_dem,
    scarp_function_with_dem,
]  # fmt: skip
WITH_THICKNESS = [new_with_thickness, check_with_thickness, probability_of_thickness]
WITH_POLYGONS = [
    new_with_polygons, check_with_polygons, scarp_with_polygons,
    scarp_function_with_polygons,
]  # fmt: skip
Read = Callable[[Reader, Path], float]


def require(reader: Reader, read: Read, file: Path, expected: odd.Expected) -> None:
    """Fail unless the file has the expected volume, or is refused by a message with the words and its name."""
    if isinstance(expected, float):
        assert read(reader, file) == pytest.approx(expected, rel=2e-3)
        return
    with pytest.raises(RefusedError, match=expected) as refused:
        read(reader, file)
    assert file.name in str(refused.value)


@pytest.mark.parametrize("name", odd.RASTERS | odd.PLACES)
@pytest.mark.parametrize("read", WITH_DEM, ids=lambda read: read.__name__)
def test_dem(reader: Reader, read: Read, name: str) -> None:
    write, expected = (odd.RASTERS | odd.PLACES)[name]
    require(reader, read, write(reader.folder / "given" / "odd.tif", odd.heights()), expected)


@pytest.mark.parametrize("name", odd.RASTERS)
@pytest.mark.parametrize("read", WITH_THICKNESS, ids=lambda read: read.__name__)
def test_thickness(reader: Reader, read: Read, name: str) -> None:
    write, expected = odd.RASTERS[name]
    require(reader, read, write(reader.folder / "given" / "odd.tif", odd.thickness()), expected)


@pytest.mark.parametrize("name", odd.POLYGONS)
@pytest.mark.parametrize("read", WITH_POLYGONS, ids=lambda read: read.__name__)
def test_polygons(reader: Reader, read: Read, name: str) -> None:
    write, expected = odd.POLYGONS[name]
    require(reader, read, write(reader.folder / "given" / name), expected)
