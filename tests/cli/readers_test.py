"""Every command that opens rasters or polygons of a user reads the same odd files alike, or refuses them.

The table of files is in odd_files.py. A new command that reads such files belongs in the tables here.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import odd_files as odd
import pytest
import rasterio
from conftest import Program, columns_of, sets, with_profile

from thawslide import Case, Simulation, UserError
from thawslide.errors import ReportError
from thawslide.scarps.command import main as scarp_command
from thawslide.scores.forecast import read_forecast
from thawslide.scores.maps import overlap_areas
from thawslide.scores.observed import Outline
from thawslide.sweeps.probability_command import main as probability_command

CENTRE = (odd.WEST + 105.0, odd.SOUTH + 305.0)  # of a cell
DIP = np.degrees(np.arctan(0.5))
PLANE = f"x={CENTRE[0]},y={CENTRE[1]},dip={DIP:.15g},direction=90,depth={odd.THICK}"


class RefusedError(Exception):
    """The message of a refused file."""


def volume_in(file: Path) -> float:
    """Return the sum of a raster of thickness on cells of the DEM [m3]."""
    with rasterio.open(file) as opened:
        return float(opened.read(1, masked=True).filled(0.0).sum()) * odd.CELL**2


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

    def setup(self, **keys: object) -> dict[str, Any]:
        """Return what `check` reports of the case with keys replaced."""
        checked: dict[str, Any] = json.loads(self.called("check", self.case, "--json", *sets(**keys)))
        return checked

    def checked(self, **keys: object) -> float:
        """Return the volume of the case with keys replaced."""
        return float(self.setup(**keys)["bodies"][0]["volume_m3"])

    def simulation(self, **keys: object) -> Simulation:
        """Return a simulation in memory of the case with keys replaced."""
        changes = {key.replace("__", "."): value for key, value in keys.items()}
        try:
            return Simulation(Case(self.case, {"grid.cell": 20.0, **changes}), threads=1, on_message=lambda _: None)
        except UserError as error:
            raise RefusedError(str(error)) from error

    def simulated(self, **keys: object) -> float:
        """Return the volume of the particles of a simulation."""
        return float(self.simulation(**keys).field("volume").sum())

    def block(self, plain: dict[str, object], **keys: object) -> float:
        """Return the full volume if the rigid block moves as with the plain keys: its output has no volume."""
        moved = self.folder / "block.csv"
        self.called("block", self.case, "--output", moved, *sets(**keys, terrain__smooth=0))
        self.program.ok("block", self.case, "--output", self.folder / "plain.csv", *sets(**plain, terrain__smooth=0))
        found, expected = (columns_of(file)["velocity_m_s"] for file in (moved, self.folder / "plain.csv"))
        return odd.FULL if expected[-1] > 5.0 and np.abs(found - expected).max() < 1e-3 else 0.0

    def substrate(self, **keys: object) -> float:
        """Return the area of a substrate, times the thickness of the square."""
        law = {"substrate__ice__friction": "coefficient", "substrate__ice__friction_coefficient": 0.1}
        return float(self.setup(**law, **keys)["substrates"][0]["covered"]) * odd.THICK

    def new(self, dem: Path, release: Path, *words: object) -> float:
        """Return the volume of a new case, whose DEM must have the elevations of the original."""
        made = self.folder / "made"
        self.called("new", made, "--dem", dem, "--release", release, *words)
        with rasterio.open(made / "dem.tif") as file:
            column = round((file.transform.c - odd.WEST) / odd.CELL)
            row = round((odd.SOUTH + odd.ROWS * odd.CELL - file.transform.f) / odd.CELL)
            expected = odd.heights()[row : row + file.height, column : column + file.width]
            found = file.read(1, masked=True)
            assert np.abs(found - expected).max() < 0.01 and file.units[0] in (None, "m")
        return float(self.program.json("check", made)["bodies"][0]["volume_m3"])

    def scarp(self, dem: Path, within: Path) -> float:
        """Return the volume of the command `scarp`."""
        output = self.folder / "scarp.tif"
        if scarp_command([str(dem), "--plane", PLANE, "--within", str(within), "--output", str(output)]):
            raise RefusedError(self.capsys.readouterr().err)
        return volume_in(output)


def check_with_dem(reader: Reader, file: Path) -> float:
    """Return the volume between another surface and the DEM."""
    surface = f'{{ surface = "{reader.case.parent / "before.tif"}" }}'
    return reader.checked(terrain__file=file, terrain__smooth=0, body__slide__thickness=surface)


def run_with_dem(reader: Reader, file: Path) -> float:
    """Return the volume in the maps of a run of one step."""
    words = sets(terrain__file=file, terrain__smooth=0, time__end=1e-3, grid__cell=20.0)
    reader.called("run", reader.case, "--output", reader.folder / "run", *words)
    return volume_in(reader.folder / "run" / "maps" / "release.tif")


def section_with_dem(reader: Reader, file: Path) -> float:
    """Return the full volume for correct elevations: the section itself has none."""
    ends = [(odd.WEST + x, odd.SOUTH + 255.0) for x in (105.0, 605.0)]
    line = odd.geojson(reader.folder / "line.geojson", "LineString", ends)
    reader.called("section", reader.folder / "made", "--dem", file, "--line", line)
    columns = columns_of(reader.folder / "made" / "profile.csv")
    distance, terrain = columns["distance_m"], columns["terrain_elevation_m"]
    return odd.FULL if np.abs(terrain - (1500.0 - 0.5 * (105.0 + distance))).max() < 0.01 else 0.0


def simulation_with_dem(reader: Reader, file: Path) -> float:
    surface = {"surface": str(reader.case.parent / "before.tif")}
    return reader.simulated(terrain__file=str(file), terrain__smooth=0, body__slide__thickness=surface)


def simulation_with_bed(reader: Reader, file: Path) -> float:
    """Return the volume of an erodible bed, by its mass."""
    law = {"law": "strength", "strength": 1e6, "friction_angle": 20.0, "depth_per_slip": 0.1, "material": "rock_ice"}
    keys = {f"bed__{key}": value for key, value in law.items()}
    masses = [
        reader.simulation(bed__depth={"raster": str(each)}, **keys).history["bed_mass_kg"].iloc[0]
        for each in (file, odd.raster(reader.folder / "bed.tif", odd.thickness()))
    ]
    return float(odd.FULL * masses[0] / masses[1])


def probability_of_thickness(reader: Reader, file: Path) -> float:
    output = reader.folder / "out"
    other = odd.raster(reader.folder / "other.tif", odd.thickness())
    if probability_command([str(file), str(other), "--output", str(output)]):
        raise RefusedError(reader.capsys.readouterr().err)
    return volume_in(output / "thickness_p90.tif")


def score_with_polygons(reader: Reader, file: Path) -> float:
    """Return the observed area that a score compares with the maps of a run, times the thickness of the square."""
    try:
        areas, _ = overlap_areas(read_forecast(reader.case.parent / "run"), Outline(file, False, None), [])
    except ReportError as error:
        raise RefusedError(str(error)) from error
    return float(areas[-1, :2].sum()) * odd.THICK


def check_with_probe(reader: Reader, file: Path) -> float:
    """Return the length for an accepted line: `check` does not report it."""
    reader.setup(probe__gauge__line=file)
    return odd.LENGTH


def block_with_path(reader: Reader, file: Path) -> float:
    """Return the length if the block moves as along the plain line."""
    plain = odd.LINES["plain.geojson"][0](reader.folder / "line.geojson")
    return odd.LENGTH * reader.block({"maps__path": plain}, maps__path=file) / odd.FULL


def section_with_line(reader: Reader, file: Path) -> float:
    reader.called("section", reader.folder / "made", "--dem", reader.dem, "--line", file)
    return float(columns_of(reader.folder / "made" / "profile.csv")["distance_m"][-1])


@pytest.fixture(scope="module")
def plain(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a plain DEM, the surface before the release, polygons, their case, and its run."""
    folder = tmp_path_factory.mktemp("plain")
    odd.raster(folder / "before.tif", odd.heights() + odd.thickness())
    release = odd.geojson(folder / "release.geojson", "Polygon", [odd.ring(odd.SQUARE)])
    thawslide.ok(*odd.new_words(folder, release))
    words = sets(time__end=1e-3, grid__cell=20.0, maps__cell=odd.CELL)
    thawslide.ok("run", folder / "slide", "--output", folder / "run", *words)
    return folder


@pytest.fixture
def reader(thawslide: Program, tmp_path: Path, plain: Path, capsys: pytest.CaptureFixture[str]) -> Reader:
    (tmp_path / "given").mkdir()
    return Reader(thawslide, tmp_path, plain, capsys)


Read = Callable[[Reader, Path], float]
# Readers of each kind of file, by name.
WITH_DEM: dict[str, Read] = {
    "new": lambda reader, file: reader.new(file, reader.release, "--thickness", odd.THICK),
    "check": check_with_dem,
    "run": run_with_dem,
    "block": lambda reader, file: reader.block({}, terrain__file=file),
    "simulation": simulation_with_dem,
    "section": section_with_dem,
    "scarp": lambda reader, file: reader.scarp(file, reader.release),
}
WITH_THICKNESS: dict[str, Read] = {
    "new": lambda reader, file: reader.new(reader.dem, file),
    "check": lambda reader, file: reader.checked(body__slide__thickness=f'{{ raster = "{file}" }}'),
    "block": lambda reader, file: reader.block({}, body__slide__thickness=f'{{ raster = "{file}" }}'),
    "simulation": lambda reader, file: reader.simulated(body__slide__thickness={"raster": str(file)}),
    "bed": simulation_with_bed,
    "probability": probability_of_thickness,
}
WITH_POLYGONS: dict[str, Read] = {
    "new": lambda reader, file: reader.new(reader.dem, file, "--thickness", odd.THICK),
    "check": lambda reader, file: reader.checked(body__slide__release=file),
    "simulation": lambda reader, file: reader.simulated(body__slide__release=str(file)),
    "substrate": lambda reader, file: reader.substrate(substrate__ice__outline=file),
    "scarp": lambda reader, file: reader.scarp(reader.dem, file),
    "score": score_with_polygons,
}
WITH_LINE: dict[str, Read] = {"check": check_with_probe, "block": block_with_path, "section": section_with_line}


def require(reader: Reader, read: Read, file: Path, expected: odd.Expected) -> None:
    """Fail unless the file has the expected volume, or is refused by a message with the words and its name."""
    if isinstance(expected, float):
        assert read(reader, file) == pytest.approx(expected, rel=2e-3)
        return
    with pytest.raises(RefusedError, match=expected) as refused:
        read(reader, file)
    assert file.name in str(refused.value)


@pytest.mark.parametrize("name", odd.RASTERS | odd.PLACES)
@pytest.mark.parametrize("read", WITH_DEM)
def test_dem(reader: Reader, read: str, name: str) -> None:
    write, expected = (odd.RASTERS | odd.PLACES)[name]
    require(reader, WITH_DEM[read], write(reader.folder / "given" / "odd.tif", odd.heights()), expected)


@pytest.mark.parametrize("name", odd.RASTERS)
@pytest.mark.parametrize("read", WITH_THICKNESS)
def test_thickness(reader: Reader, read: str, name: str) -> None:
    write, expected = (odd.RASTERS | (odd.BEDS if read == "bed" else {}))[name]
    require(reader, WITH_THICKNESS[read], write(reader.folder / "given" / "odd.tif", odd.thickness()), expected)


@pytest.mark.parametrize("name", odd.RASTERS)
def test_codes_of_a_substrate(reader: Reader, name: str) -> None:
    def read(reader: Reader, file: Path) -> float:
        return reader.substrate(substrate__ice__raster=file, substrate__ice__code=int(odd.THICK))

    write, expected = (odd.RASTERS | odd.CODES)[name]
    require(reader, read, write(reader.folder / "given" / "odd.tif", odd.thickness()), expected)


@pytest.mark.parametrize(("unit", "factor", "offset"), [("", 1, 0), ("degC", 1, 0), ("K", 1, 273.15), ("F", 1.8, 32)])
def test_temperatures(reader: Reader, unit: str, factor: float, offset: float) -> None:
    values = np.full(odd.heights().shape, -7.0 * factor + offset)
    file = odd.raster(reader.folder / "given" / "odd.tif", values, unit=unit)
    checked = reader.setup(body__slide__temperature=f'{{ raster = "{file}" }}')["bodies"][0]
    assert (checked["coldest_C"], checked["warmest_C"]) == pytest.approx((-7.0, -7.0))


def test_profiles(thawslide: Program, small_case: Path) -> None:
    """Marks, comments, blank lines, spaces, ends of lines and notations of numbers do not change a profile."""
    header, row = "distance_m,terrain_elevation_m\n", "20,-9.25"
    profile = with_profile(small_case, f"{header}0,0.5\n{row}")
    thawslide.ok("block", small_case, "--output", small_case / "plain.csv")
    odd_rows = "# surveyed\n\n distance_m ,\tterrain_elevation_m  \n+0e0,5.0E-01\n# a remark\n 2.0e1 ,-0.925e+1"
    for text in (f"\ufeff{header}0,0.5\r\n{row}\r\n", odd_rows, odd_rows.replace("\n", "\r\n")):
        profile.write_text(text, encoding="utf-8", newline="")
        thawslide.ok("block", small_case, "--output", small_case / "odd.csv")
        assert (small_case / "odd.csv").read_bytes() == (small_case / "plain.csv").read_bytes()


@pytest.mark.parametrize("name", odd.LINES)
@pytest.mark.parametrize("read", WITH_LINE)
def test_line(reader: Reader, read: str, name: str) -> None:
    write, expected = odd.LINES[name]
    require(reader, WITH_LINE[read], write(reader.folder / "given" / name), expected)


@pytest.mark.parametrize("name", odd.POLYGONS)
@pytest.mark.parametrize("read", WITH_POLYGONS)
def test_polygons(reader: Reader, read: str, name: str) -> None:
    write, expected = odd.POLYGONS[name]
    require(reader, WITH_POLYGONS[read], write(reader.folder / "given" / name), expected)
