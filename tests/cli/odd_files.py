"""Valid but unusual rasters and polygons, as programs of users write them: all mean the same DEM, thickness or area.

The DEM falls towards the east by 1 in 2. The area is a square of 200 m on it, 10 m thick; some files have a hole of
100 m in it. A table gives each file the volume that it means [m3], or words of the message that refuses it.
"""

import sqlite3
import struct
import zipfile
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import rasterio
from rasterio.enums import ColorInterp
from rasterio.warp import transform
from terrain_files import write_geojson

from thawslide.arrays import Numbers
from thawslide.map_files import write_polygons

WEST, SOUTH, CELL, COLUMNS, ROWS = 500_000.0, 5_200_000.0, 10.0, 100, 60
CRS = "EPSG:32633"
SQUARE, HOLE = (100.0, 200.0, 300.0, 400.0), (150.0, 250.0, 250.0, 350.0)  # x and y of corners, from the south-west
FULL, HOLED = 400_000.0, 300_000.0  # m3
THICK = 10.0  # m

Expected = float | str
Ring = list[tuple[float, float]]
Values = Callable[[], Numbers]


def heights() -> Numbers:
    """Return the elevations of the DEM [m], rows from the north."""
    x = CELL * (np.arange(COLUMNS) + 0.5)
    return np.tile(1500.0 - 0.5 * x, (ROWS, 1))


def thickness() -> Numbers:
    """Return the thickness of the square [m], rows from the north."""
    x, y = CELL * (np.arange(COLUMNS) + 0.5), CELL * (np.arange(ROWS)[::-1] + 0.5)
    inside_x, inside_y = (x > SQUARE[0]) & (x < SQUARE[2]), (y > SQUARE[1]) & (y < SQUARE[3])
    return THICK * np.outer(inside_y, inside_x).astype(float)


def raster(
    file: Path, values: Numbers, kind: str = "float64", bands: int = 1, crs: str | None = CRS,
    place: rasterio.Affine | None = None, nodata: float | None = None, scale: float = 1.0, offset: float = 0.0,
    unit: str = "", **stored: Any,
) -> Path:  # fmt: skip
    """Write values as (value - offset) / scale; `stored`: creation options of GDAL."""
    place = place or rasterio.Affine(CELL, 0.0, WEST, 0.0, -CELL, SOUTH + ROWS * CELL)
    rows, columns = values.shape
    shape = {"width": columns, "height": rows, "count": bands, "dtype": kind, "nodata": nodata}
    packed = (values - offset) / scale
    packed = np.round(packed) if "int" in kind else packed
    with rasterio.open(file, "w", **{"driver": "GTiff"} | stored, crs=crs, transform=place, **shape) as opened:
        for band in range(1, bands + 1):
            opened.write(packed.astype(kind), band)
        if (scale, offset) != (1.0, 0.0):
            opened.scales, opened.offsets = (scale,), (offset,)
        if unit:
            opened.set_band_unit(1, unit)
    return file


def new_words(folder: Path, release: Path) -> list[object]:
    """Write the DEM; return the arguments of `thawslide` that create the case folder/slide."""
    words = ["new", folder / "slide", "--dem", raster(folder / "dem.tif", heights()), "--release", release]
    return words if release.suffix in (".tif", ".asc") else [*words, "--thickness", THICK]


def at_points(file: Path, values: Numbers) -> Path:
    """Write a raster whose values are those of points, at the centres of its cells."""
    with rasterio.open(raster(file, values), "r+") as opened:
        opened.update_tags(AREA_OR_POINT="Point")
    return file


def masked(file: Path, values: Numbers) -> Path:
    """Write a raster with wrong values in a corner, which an internal mask excludes."""
    known = np.ones(values.shape, bool)
    known[:5, -5:] = False
    with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=True):
        raster(file, np.where(known, values, 77.0))
        with rasterio.open(file, "r+") as opened:
            opened.write_mask(known)
    return file


def with_opacity(file: Path, values: Numbers) -> Path:
    """Write a raster with wrong values in a corner, where a second band has no opacity."""
    opaque = np.full(values.shape, 255.0)
    opaque[:5, -5:] = 0.0
    raster(file, np.where(opaque > 0.0, values, 77.0), bands=2)
    with rasterio.open(file, "r+") as opened:
        opened.write(opaque, 2)
        opened.colorinterp = (ColorInterp.gray, ColorInterp.alpha)
    return file


def south_up(file: Path, values: Numbers) -> Path:
    """Write the rows from the south."""
    return raster(file, values[::-1], place=rasterio.Affine(CELL, 0.0, WEST, 0.0, CELL, SOUTH))


def turned(file: Path, values: Numbers) -> Path:
    """Write columns and rows in exchange, which the georeference states."""
    return raster(file, values.T, place=rasterio.Affine(0.0, CELL, WEST, -CELL, 0.0, SOUTH + ROWS * CELL))


def world_file(file: Path, values: Numbers) -> Path:
    """Write a raster without georeference, which is in a file of its own."""
    plain = raster(file.with_name("plain.tif"), values)
    with rasterio.open(plain) as opened:
        profile = {key: value for key, value in opened.profile.items() if key != "transform"}
        with rasterio.open(file, "w", **profile) as other:
            other.write(opened.read(1), 1)
    plain.unlink()
    numbers = (CELL, 0.0, 0.0, -CELL, WEST + CELL / 2, SOUTH + (ROWS - 0.5) * CELL)
    file.with_suffix(".tfw").write_text("".join(f"{number}\n" for number in numbers))
    return file


def renamed(file: Path, values: Numbers) -> Path:
    """Write a raster in a format that may refer to other files."""
    plain = raster(file.with_name("plain.tif"), values)
    with rasterio.open(plain) as opened, rasterio.open(file, "w", **{**opened.profile, "driver": "ENVI"}) as other:
        other.write(opened.read(1), 1)
    return file


def in_system(crs: str, factor: float = 1.0, unit: str = "") -> Callable[[Path, Numbers], Path]:
    """Return a function that writes values in another system, whose coordinates are multiplied by a factor."""
    place = rasterio.Affine(CELL * factor, 0.0, WEST * factor, 0.0, -CELL * factor, (SOUTH + ROWS * CELL) * factor)
    return lambda file, values: raster(file, values, crs=crs, place=place, unit=unit)


# Rasters of lengths: of elevations as well as of thicknesses.
RASTERS: dict[str, tuple[Callable[[Path, Numbers], Path], Expected]] = {
    "plain": (raster, FULL),
    "bytes": (lambda file, values: raster(file, values, "uint16", scale=0.1), FULL),
    "big-endian": (lambda file, values: raster(file, values, ENDIANNESS="BIG", BIGTIFF="YES"), FULL),
    "tiles": (
        lambda file, values: raster(file, values, tiled=True, blockxsize=16, blockysize=32, compress="lzw"),
        FULL,
    ),
    "point": (at_points, FULL),
    "scale": (lambda file, values: raster(file, values, "int32", scale=0.01), FULL),
    "scale-and-offset": (lambda file, values: raster(file, values, "int32", scale=0.01, offset=-100.0), FULL),
    "feet": (lambda file, values: raster(file, values / 0.3048, unit="ft"), FULL),
    "survey-feet": (lambda file, values: raster(file, values * 3937.0 / 1200.0, unit="US survey foot"), FULL),
    "centimetres": (lambda file, values: raster(file, 100.0 * values, unit="cm"), FULL),
    "kilometres": (lambda file, values: raster(file, values / 1000.0, unit="km"), FULL),
    "kelvin": (lambda file, values: raster(file, values, unit="K"), "the unit of the values is 'K'"),
    "mask": (masked, FULL),
    "opacity": (with_opacity, FULL),
    "south-up": (south_up, FULL),
    "turned": (turned, "rotated or mirrored"),
    "world-file": (world_file, FULL),
    "two-bands": (lambda file, values: raster(file, values, bands=2), "2 bands"),
    "complex": (lambda file, values: raster(file, values, "complex64"), "the values are of the type CFloat32"),
    "format": (renamed, "cannot be opened"),
    "compound": (in_system("EPSG:32633+5773"), FULL),
    "heights-in-feet": (lambda file, values: raster(file, values / 0.3048, crs="EPSG:32633+8228"), FULL),
}

# Rasters whose place is unusual: for a DEM only, as others follow it.
PLACES: dict[str, tuple[Callable[[Path, Numbers], Path], Expected]] = {
    "no-system": (lambda file, values: raster(file, values, crs=None), "names no coordinate reference system"),
    "degrees": (in_system("EPSG:4326"), "the tag specifies degrees"),
    "feet-of-survey": (in_system("EPSG:2225", 3937.0 / 1200.0), "the coordinates are in the unit"),
    "world-mercator": (in_system("EPSG:3395"), "times those on the ground"),
    "web-mercator": (in_system("EPSG:3857"), "times those on the ground"),
    "equidistant": (in_system("EPSG:4087"), "times those on the ground"),
    "undeclared-nodata": (
        lambda file, values: raster(file, np.where(np.arange(COLUMNS) > 90, -32768.0, values)), "impossible on Earth",
    ),
}  # fmt: skip


# Those that mean something else as the depth of a bed, which is needed in the whole domain.
BEDS: dict[str, tuple[Callable[[Path, Numbers], Path], Expected]] = {
    "mask": (masked, "the depth of the bed is missing"),
    "opacity": (with_opacity, "the depth of the bed is missing"),
}

# Those that mean something else as codes of substrates, which have no unit.
CODES: dict[str, tuple[Callable[[Path, Numbers], Path], Expected]] = {
    **{name: (RASTERS[name][0], "allowed: whole numbers") for name in ("feet", "survey-feet", "kilometres")},
    "heights-in-feet": (RASTERS["heights-in-feet"][0], "allowed: whole numbers"),
    "centimetres": (RASTERS["centimetres"][0], "stands nowhere in the domain"),
    "kelvin": (RASTERS["kelvin"][0], FULL),
}


def ring(box: tuple[float, float, float, float], clockwise: bool = True) -> Ring:
    """Return the closed ring of a box, in the coordinates of the DEM."""
    (x0, y0, x1, y1) = (WEST + box[0], SOUTH + box[1], WEST + box[2], SOUTH + box[3])
    corners = [(x0, y0), (x0, y1), (x1, y1), (x1, y0), (x0, y0)]
    return corners if clockwise else corners[::-1]


def shapefile(
    file: Path, records: list[list[Ring]], kind: int = 5, deleted: tuple[int, ...] = (), name: bytes = b"a",
    page: int = 0,
) -> Path:  # fmt: skip
    """Write a Shapefile of polygons or lines (ESRI Shapefile Technical Description, 1998), each with a name."""
    shapes, index, at = b"", b"", 50
    for number, rings in enumerate(records, 1):
        points = np.array([corner for each in rings for corner in each])
        starts = np.cumsum([0, *(len(each) for each in rings[:-1])])
        box = (*points.min(axis=0), *points.max(axis=0))
        body = struct.pack("<i4d2i", kind, *box, len(rings), len(points)) + starts.astype("<i4").tobytes()
        if kind == 31:  # outer and inner rings
            body += struct.pack(f"<{len(rings)}i", *range(2, 2 + len(rings)))
        body += points.astype("<f8").tobytes()
        if kind in (13, 15, 23, 25, 31):  # elevations or measures, with their range
            body += bytes(16 + 8 * len(points))
        index += struct.pack(">2i", at, len(body) // 2)
        shapes += struct.pack(">2i", number, len(body) // 2) + body
        at += 4 + len(body) // 2
    every = np.array([corner for rings in records for each in rings for corner in each])

    def header(words: int) -> bytes:
        box = (*every.min(axis=0), *every.max(axis=0), 0.0, 0.0, 0.0, 0.0)
        return struct.pack(">7i", 9994, 0, 0, 0, 0, 0, words) + struct.pack("<2i8d", 1000, kind, *box)

    file.write_bytes(header(at) + shapes)
    file.with_suffix(".shx").write_bytes(header(50 + len(index) // 2) + index)
    head = struct.pack("<4BIHH", 3, 124, 1, 1, len(records), 65, 21) + bytes(17) + bytes([page, 0, 0])
    column = b"name".ljust(11, b"\0") + b"C" + bytes(4) + bytes([20]) + bytes(15)
    rows = b"".join((b"*" if number in deleted else b" ") + name.ljust(20) for number in range(len(records)))
    file.with_suffix(".dbf").write_bytes(head + column + b"\r" + rows + b"\x1a")
    file.with_suffix(".prj").write_text(rasterio.crs.CRS.from_user_input(CRS).to_wkt(version="WKT1_ESRI"))
    return file


def without(ending: str) -> Callable[[Path], Path]:
    """Return a function that writes a Shapefile whose part with this ending is lost."""

    def write(file: Path) -> Path:
        shapefile(file, [[ring(SQUARE)]]).with_suffix(ending).unlink()
        return file

    return write


def zipped(file: Path) -> Path:
    """Write a Shapefile with all its parts in one archive."""
    shapefile(file.parent / "area.shp", [[ring(SQUARE)]])
    with zipfile.ZipFile(file, "w") as archive:
        for part in sorted(file.parent.glob("area.*")):
            archive.write(part, part.name)
            part.unlink()
    return file


def geojson(file: Path, kind: str, coordinates: Any, crs: str | None = CRS) -> Path:
    """Write one feature as GeoJSON; without a system, in longitude and latitude."""
    return write_geojson(file, kind, coordinates, crs=crs)


def reprojected(corners: Ring, crs: str) -> Ring:
    """Return a ring in another system."""
    return list(zip(*transform(CRS, crs, *zip(*corners, strict=True)), strict=True))


def kml(file: Path, rings: list[Ring]) -> Path:
    """Write one polygon as KML."""
    boundaries = ""
    for number, corners in enumerate(rings):
        text = " ".join(f"{x:.12f},{y:.12f},0" for x, y in reprojected(corners, "EPSG:4326"))
        side = "inner" if number else "outer"
        coordinates = f"<LinearRing><coordinates>{text}</coordinates></LinearRing>"
        boundaries += f"<{side}BoundaryIs>{coordinates}</{side}BoundaryIs>"
    content = f"<Placemark><name>a</name><Polygon>{boundaries}</Polygon></Placemark>"
    file.write_text(f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{content}</Document></kml>')
    return file


def geopackage(file: Path, polygons: list[list[Ring]]) -> Path:
    """Write one feature with several polygons as a GeoPackage."""
    parts = [[np.array(each) for each in rings] for rings in polygons]
    write_polygons(file, "release", [parts], [{"name": "a"}], rasterio.crs.CRS.from_user_input(CRS).to_wkt())
    return file


def open_elsewhere(file: Path) -> Path:
    """Write a GeoPackage with a smaller square, whose edit to the full one is not yet in the file.

    Its copy is that of the file while another program has it open.
    """
    edited = geopackage(file.with_name("edited.gpkg"), [[ring((100.0, 200.0, 200.0, 300.0))]])
    whole = geopackage(file.with_name("whole.gpkg"), [[ring(SQUARE)]])
    with closing(sqlite3.connect(whole)) as database:
        (geometry,) = database.execute("SELECT geom FROM release").fetchone()
    with closing(sqlite3.connect(edited)) as database:
        database.execute("PRAGMA journal_mode = wal")
        for (trigger,) in database.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            database.execute(f'DROP TRIGGER "{trigger}"')  # of the spatial index, with functions of GDAL
        database.execute("UPDATE release SET geom = ?", (geometry,))
        database.commit()
        file.write_bytes(edited.read_bytes())
        file.with_name(file.name + "-wal").write_bytes(edited.with_name("edited.gpkg-wal").read_bytes())
    for each in (edited, whole):
        each.unlink()
    return file


_BOTH = [ring(SQUARE), ring(HOLE, clockwise=False)]
_ALIKE = [ring(SQUARE), ring(HOLE)]
_ANTICLOCKWISE = [ring(SQUARE, clockwise=False), ring(HOLE, clockwise=False)]
_REVERSED = [ring(SQUARE, clockwise=False), ring(HOLE)]
_ISLAND = ring((190.0, 290.0, 210.0, 310.0))
_CROSSING = [ring(SQUARE)[0], ring(SQUARE)[2], ring(SQUARE)[1], ring(SQUARE)[3], ring(SQUARE)[0]]
_MERCATOR = reprojected(ring(SQUARE), "EPSG:3857")
_FAR = ring((500.0, 200.0, 700.0, 400.0))

# Files of polygons, by name with suffix.
POLYGONS: dict[str, tuple[Callable[[Path], Path], Expected]] = {
    "plain.geojson": (lambda file: geojson(file, "Polygon", [ring(SQUARE)]), FULL),
    "plain.shp": (lambda file: shapefile(file, [[ring(SQUARE)]]), FULL),
    "plain.gpkg": (lambda file: geopackage(file, [[ring(SQUARE)]]), FULL),
    "plain.kml": (lambda file: kml(file, [ring(SQUARE)]), FULL),
    "with-z.shp": (lambda file: shapefile(file, [[ring(SQUARE)]], kind=15), FULL),
    "with-m.shp": (lambda file: shapefile(file, [[ring(SQUARE)]], kind=25), FULL),
    "multipatch.shp": (lambda file: shapefile(file, [[ring(SQUARE)]], kind=31), FULL),
    "deleted.shp": (lambda file: shapefile(file, [[ring(SQUARE)], [_FAR]], deleted=(1,)), FULL),
    "UPPER.SHP": (lambda file: shapefile(file, [[ring(SQUARE)]]), FULL),
    "no-table.shp": (without(".dbf"), FULL),
    "no-system.shp": (without(".prj"), FULL),
    "no-index.shp": (without(".shx"), "the index of the Shapefile, no-index.shx, is missing"),
    "packed.shp.zip": (zipped, FULL),
    "packed.zip": (zipped, "the file cannot be opened"),
    "encoding.shp": (lambda file: shapefile(file, [[ring(SQUARE)]], name="Südflanke".encode("latin-1")), FULL),
    "hole.shp": (lambda file: shapefile(file, [_BOTH]), HOLED),
    "hole-alike.shp": (lambda file: shapefile(file, [_ALIKE]), HOLED),
    "hole-anticlockwise.shp": (lambda file: shapefile(file, [_ANTICLOCKWISE]), HOLED),
    "hole-reversed.shp": (lambda file: shapefile(file, [_REVERSED]), HOLED),
    "island.shp": (lambda file: shapefile(file, [[*_ALIKE, _ISLAND]]), HOLED + 400.0 * THICK),
    "hole-first.geojson": (lambda file: geojson(file, "Polygon", _BOTH[::-1]), HOLED),
    "hole-alike.geojson": (lambda file: geojson(file, "Polygon", _ALIKE), HOLED),
    "hole-as-part.geojson": (lambda file: geojson(file, "MultiPolygon", [[each] for each in _ALIKE]), HOLED),
    "hole-alike.gpkg": (lambda file: geopackage(file, [_ALIKE]), HOLED),
    "hole-as-part.gpkg": (lambda file: geopackage(file, [[each] for each in _REVERSED]), HOLED),
    "hole.kml": (lambda file: kml(file, _ALIKE), HOLED),
    "open.gpkg": (open_elsewhere, FULL),
    "degrees.geojson": (lambda file: geojson(file, "Polygon", [reprojected(ring(SQUARE), "EPSG:4326")], None), FULL),
    "projected.geojson": (lambda file: geojson(file, "Polygon", [_MERCATOR], "EPSG:3857"), FULL),
    "line.geojson": (lambda file: geojson(file, "LineString", ring(SQUARE)), "has no polygons"),
    "empty-part.geojson": (lambda file: geojson(file, "MultiPolygon", [[], [ring(SQUARE)]]), FULL),
    "empty-hole.geojson": (lambda file: geojson(file, "Polygon", [ring(SQUARE), []]), FULL),
    "repeated-part.geojson": (lambda file: geojson(file, "MultiPolygon", [[ring(SQUARE)], [ring(SQUARE)]]), FULL),
    "empty.geojson": (lambda file: geojson(file, "Polygon", []), "has no geometry"),
    "crossing.geojson": (lambda file: geojson(file, "Polygon", [_CROSSING]), "crosses itself"),
    "flat.geojson": (lambda file: geojson(file, "Polygon", [[*ring(SQUARE)[:2], ring(SQUARE)[0]]]), "has no area"),
}  # fmt: skip

_LINE = [(WEST + 105.0, SOUTH + 255.0), (WEST + 305.0, SOUTH + 255.0), (WEST + 505.0, SOUTH + 255.0)]
LENGTH = 400.0  # m

# Files of one line, by name with suffix, with its length [m] or words of a message.
LINES: dict[str, tuple[Callable[[Path], Path], Expected]] = {
    "plain.geojson": (lambda file: geojson(file, "LineString", _LINE), LENGTH),
    "multi.geojson": (lambda file: geojson(file, "MultiLineString", [_LINE]), LENGTH),
    "with-z.geojson": (lambda file: geojson(file, "LineString", [(*each, 7.0) for each in _LINE]), LENGTH),
    "plain.shp": (lambda file: shapefile(file, [[_LINE]], kind=3), LENGTH),
    "with-z.shp": (lambda file: shapefile(file, [[_LINE]], kind=13), LENGTH),
    "with-m.shp": (lambda file: shapefile(file, [[_LINE]], kind=23), LENGTH),
    "deleted.shp": (lambda file: shapefile(file, [[_LINE], [_FAR]], kind=3, deleted=(1,)), LENGTH),
    "degrees.geojson": (lambda file: geojson(file, "LineString", reprojected(_LINE, "EPSG:4326"), None), LENGTH),
    "web.geojson": (lambda file: geojson(file, "LineString", reprojected(_LINE, "EPSG:3857"), "EPSG:3857"), LENGTH),
    "two.geojson": (lambda file: geojson(file, "MultiLineString", [_LINE, _LINE[::-1]]), "has 2 lines"),
    "polygon.geojson": (lambda file: geojson(file, "Polygon", [ring(SQUARE)]), "has no lines"),
    "empty.geojson": (lambda file: geojson(file, "LineString", []), "has no geometry"),
    "raster.tif": (lambda file: raster(file, heights()), "the file is a raster"),
}  # fmt: skip
