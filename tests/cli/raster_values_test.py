"""Rasters and polygons with masks, units, fine cells, and names that differ in case.

The files are those of ../shared/data/faults; their READMEs state the expected values.
"""

from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import ROOT, Program, sets

FAULTS = ROOT.parent / "shared" / "data" / "faults"
MASKS, UNITS = FAULTS / "g01-mask-band", FAULTS / "g02-unit-of-values"
FINE, NAMES = FAULTS / "g11-fine-thickness", FAULTS / "g04-names-by-case"

pytestmark = pytest.mark.skipif(not FAULTS.is_dir(), reason=f"no input files at {FAULTS}")

US_FOOT = 1200.0 / 3937.0
RIBS = 160_000.0  # m3, of ribs 20 m thick, one metre in five, over 200 m x 200 m
BLOCK = 400_000.0  # m3, 10 m over 200 m x 200 m


class Maker:
    """Creates cases with `thawslide new`, and returns results of `thawslide check`."""

    def __init__(self, thawslide: Program, folder: Path) -> None:
        self.thawslide, self.folder = thawslide, folder

    def made(self, dem: Path, release: Path, *words: object) -> str:
        """Create the case and return the output of `new`."""
        return self.thawslide.ok("new", self.folder, "--dem", dem, "--release", release, *words)

    def volume(self, **keys: object) -> float:
        """Return the volume of the release [m3] with keys of the body replaced."""
        checked = self.thawslide.json("check", self.folder, *self.replaced(keys))
        return float(checked["bodies"][0]["volume_m3"])

    def refused(self, **keys: object) -> str:
        """Return the message of a case that is refused."""
        return self.thawslide.error("check", self.folder, *self.replaced(keys))

    @staticmethod
    def replaced(keys: dict[str, object]) -> list[str]:
        """Return options that replace keys of the body."""
        return sets(**{f"body__slide__{key}": value for key, value in keys.items()})


@pytest.fixture
def maker(thawslide: Program, tmp_path: Path) -> Maker:
    return Maker(thawslide, tmp_path / "slide")


def from_file(kind: str, file: Path) -> str:
    return f'{{ {kind} = "{file}" }}'


@pytest.mark.parametrize("name", ["thickness-masked.tif", "thickness-msk.tif"])
def test_masked_thickness_is_zero(maker: Maker, name: str) -> None:
    assert "a release of 400,000 m3" in maker.made(MASKS / "dem.tif", MASKS / name)
    assert maker.volume() == pytest.approx(BLOCK, rel=1e-6)


@pytest.mark.parametrize(
    "raster",
    [
        *(MASKS / name for name in ("thickness-masked.tif", "thickness-msk.tif")),
        *(UNITS / name for name in ("thickness-ft.tif", "thickness-cm.tif", "thickness-compound-ft.tif")),
    ],
    ids=lambda raster: raster.name,
)
def test_thickness_within_polygons_is_masked_and_converted_to_metres(maker: Maker, raster: Path) -> None:
    maker.made(raster.parent / "dem.tif", raster.parent / "release.gpkg", "--thickness", 10)
    with rasterio.open(raster) as file:
        east, north = file.xy(*np.nonzero((file.read_masks(1) > 0) & (file.read(1) != 0)))
    within = (np.array(east) < 500_300.0) & (np.array(north) > 5_200_200.0)
    expected = 10.0 * 100.0 * float(within.sum())
    tolerance = 1e-6 if raster.parent == MASKS else 1e-4
    assert maker.volume(thickness=from_file("raster", raster)) == pytest.approx(expected, rel=tolerance)


@pytest.mark.parametrize("name", ["dem-masked.tif", "dem-alpha.tif"])
def test_terrain_next_to_a_mask_is_known(maker: Maker, name: str) -> None:
    maker.made(MASKS / name, MASKS / "release.gpkg", "--thickness", 10)
    assert maker.volume() == pytest.approx(BLOCK, rel=1e-6)
    with rasterio.open(MASKS / name) as file:
        hidden = int((file.read_masks(1) == 0).sum())
    with rasterio.open(maker.folder / "dem.tif") as file:
        assert int((file.read_masks(1) == 0).sum()) == hidden


def test_masked_terrain_is_nodata(thawslide: Program, tmp_path: Path) -> None:
    release = MASKS / "release-over-masked.gpkg"
    words = ("--dem", MASKS / "dem-masked.tif", "--release", release, "--thickness", 10)
    message = thawslide.error("new", tmp_path / "slide", *words)
    assert "the release lies over nodata of the DEM at 100 of its points" in message


def test_masked_temperature_is_missing(maker: Maker) -> None:
    maker.made(MASKS / "dem.tif", MASKS / "release.gpkg", "--thickness", 10)
    message = maker.refused(temperature=from_file("raster", MASKS / "temperature-masked.tif"))
    assert "within the release, the temperature is missing" in message


@pytest.mark.parametrize(
    ("name", "unit"),
    [("thickness-ft.tif", "ft"), ("thickness-cm.tif", "cm"), ("thickness-compound-ft.tif", "US survey foot")],
)
def test_thickness_is_converted_to_metres(maker: Maker, name: str, unit: str) -> None:
    note = f"note: {name} states the unit '{unit}': its values were converted to metres\n"
    assert note in maker.made(UNITS / "dem.tif", UNITS / name)
    assert maker.volume() == pytest.approx(BLOCK, rel=1e-4)


def test_surface_is_converted_to_metres(maker: Maker) -> None:
    maker.made(UNITS / "dem.tif", UNITS / "release.gpkg", "--thickness", 10)
    volume = maker.volume(thickness=from_file("surface", UNITS / "surface-ft.tif"))
    assert volume == pytest.approx(BLOCK, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "unit", "metres"),
    [
        ("dem-us-ft.tif", "US survey foot", US_FOOT),
        ("dem-dm.tif", "dm", 0.1),
        ("dem-cm.tif", "cm", 0.01),
        ("dem-km.tif", "km", 1000.0),
        ("dem-low-dm.tif", "dm", 0.1),
        ("dem-low-cm.tif", "centimetre", 0.01),
    ],
)
def test_elevations_are_converted_to_metres(maker: Maker, name: str, unit: str, metres: float) -> None:
    note = f"note: {name} states the unit '{unit}': its values were converted to metres\n"
    assert note in maker.made(UNITS / name, UNITS / "release.gpkg", "--thickness", 10)
    assert maker.volume() == pytest.approx(BLOCK, rel=1e-6)
    with rasterio.open(UNITS / name) as stated, rasterio.open(maker.folder / "dem.tif") as made:
        rows, columns = stated.index(*made.xy(0, 0))
        expected = metres * stated.read(1)[rows : rows + made.height, columns : columns + made.width].astype(float)
        assert made.units == ("m",)
        assert np.abs(made.read(1) - expected).max() < 1e-6


@pytest.mark.parametrize("dem", ["dem.tif", "dem30.tif"])
@pytest.mark.parametrize("name", ["thickness-1m", "thickness-1m-wide", "thickness-1m-25833", "thickness-1m-rough"])
@pytest.mark.parametrize("polygons", [False, True])
def test_fine_thickness_keeps_its_volume(maker: Maker, dem: str, name: str, polygons: bool) -> None:
    raster = FINE / f"{name}.tif"
    with rasterio.open(raster) as file:
        expected = float(file.read(1).astype(float).sum())  # cells of 1 m2
    if name != "thickness-1m-rough":
        assert expected == pytest.approx(RIBS)
    if polygons:
        maker.made(FINE / dem, FINE / "release.gpkg", "--thickness", 10)
        volume = maker.volume(thickness=from_file("raster", raster))
    else:
        maker.made(FINE / dem, raster)
        volume = maker.volume()
    assert volume == pytest.approx(expected, rel=0.001 if "25833" not in name else 0.01)


def test_names_are_matched_exactly_first(maker: Maker) -> None:
    maker.made(NAMES / "dem.tif", NAMES / "release.geojson")
    assert maker.volume() == pytest.approx(BLOCK, rel=1e-6)
    assert maker.volume(thickness='{ attribute = "Thickness" }') == pytest.approx(BLOCK / 5.0, rel=1e-6)
    assert maker.volume(polygons='["a"]') == pytest.approx(BLOCK, rel=1e-6)
    message = maker.refused(thickness='{ attribute = "THICKNESS" }')
    assert (
        "release.geojson: several attributes are called like 'THICKNESS', which body.slide.thickness asks for: "
        "Thickness, thickness; allowed: one, or one of exactly this name." in message
    )
