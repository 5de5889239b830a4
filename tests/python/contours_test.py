"""Polygons of a map above a threshold, their files, and layers of a GeoPackage."""

import json
import sqlite3
import struct
import subprocess
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from conftest import Fails
from map_runs import CELL, SOUTH, WEST, line_blob, write_layer, write_map

from thawslide import NotInRunError, ReportError
from thawslide.command_line import main
from thawslide.contours import areas_beyond
from thawslide.geopackage import geometry_parts, read_layer
from thawslide.maps import read_map

RADIUS, TOP = 100.0, 8.0  # of a cone [m]
MIDDLE = np.array([WEST + 200.0, SOUTH + 150.0])


def cone(folder: Path, hole: float = 0.0, crs: str | None = "EPSG:31287") -> Path:
    """Write a map of a cone of thickness, and return its file; the cells within `hole` [m] of the axis are empty."""
    x, y = np.meshgrid(WEST + CELL * (np.arange(40) + 0.5), SOUTH + CELL * (np.arange(30) + 0.5))
    distance = np.hypot(x - MIDDLE[0], y - MIDDLE[1])
    values = np.where(distance < RADIUS, TOP * (1.0 - distance / RADIUS), np.nan)
    write_map(folder / "cone.tif", np.where(distance < hole, 0.0, values), "m", "maximum thickness", crs=crs)
    return folder / "cone.tif"


def test_areas_beyond_a_threshold_have_holes_as_rings_and_no_zero_around_times(tmp_path: Path) -> None:
    half, quarter = areas_beyond(read_map(cone(tmp_path)), [4.0, 6.0])
    assert half.size == pytest.approx(np.pi * 50.0**2, rel=0.01)
    assert quarter.size == pytest.approx(np.pi * 25.0**2, rel=0.04)
    ((ring,),) = half.polygons
    np.testing.assert_allclose(np.hypot(*(ring - MIDDLE).T), 50.0, atol=0.5)
    assert (ring[0] == ring[-1]).all()
    (area,) = areas_beyond(read_map(cone(tmp_path, hole=30.0)), [2.0])
    ((outline, hole),) = area.polygons
    assert area.size == pytest.approx(np.pi * (75.0**2 - 30.0**2), rel=0.02)
    assert np.hypot(*(outline - MIDDLE).T).min() > np.hypot(*(hole - MIDDLE).T).max()
    x = WEST + CELL * (np.arange(20) + 0.5)
    times = np.tile((x - x[0]) / 10.0, (10, 1))  # 1 s per cell
    times[:2] = np.nan
    write_map(tmp_path / "arrival_time.tif", times, "s")
    (early,) = areas_beyond(read_map(tmp_path / "arrival_time.tif"), [5.0], below=True, zero=False)
    assert early.size == pytest.approx(5.0 * CELL * 7.0 * CELL)


def test_geopackage_is_read_back_with_its_attributes_also_by_gdal(map_run: Path) -> None:
    words = ["contours", str(map_run), "--map", "max_thickness", "--threshold", "0.5", "--threshold", "3"]
    assert main(words) == 0
    file = map_run / "contours-max_thickness.gpkg"
    low, high = read_layer(file, "max_thickness_contours")
    assert (low.attributes["threshold"], high.attributes["threshold"]) == (0.5, 3.0)
    assert low.attributes["unit"] == "m" and low.attributes["run"] == map_run.name
    assert low.attributes["area_m2"] > high.attributes["area_m2"] > 0.0
    before = file.read_bytes()
    assert main(words) == 0
    assert file.read_bytes() == before
    with closing(sqlite3.connect(file)) as database:
        assert database.execute("SELECT srs_id FROM gpkg_contents").fetchall() == [(31287,)]
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    assert main(["contours", str(map_run), "--map", "max_thickness", "--threshold", "1"]) == 0
    try:
        command = ["ogrinfo", "-so", "-al", str(map_run / "contours-max_thickness.gpkg")]
        text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    except FileNotFoundError:
        pytest.skip("ogrinfo not found. Install gdal-bin.")
    assert "Geometry: Multi Polygon" in text and "Feature Count: 1" in text
    assert "MGI / Austria Lambert" in text and "threshold: Real" in text


def test_geojson_in_degrees_requires_a_coordinate_system(map_run: Path, tmp_path: Path, fails: Fails) -> None:
    file = tmp_path / "areas.geojson"
    assert main(["contours", str(map_run), "--map", "max_speed", "--threshold", "1", "--output", str(file)]) == 0
    ((feature),) = json.loads(file.read_text())["features"]
    corners = np.concatenate([np.array(ring) for rings in feature["geometry"]["coordinates"] for ring in rings])
    assert (corners > [9.0, 46.0]).all() and (corners < [18.0, 49.5]).all()  # Austria
    cone(map_run / "maps", crs=None)
    words = ["contours", str(map_run), "--map", "cone", "--threshold", "1"]
    fails([*words, "--output", str(map_run / "a.geojson")], "no coordinate system, which GeoJSON requires")
    assert main(words) == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--map", "max_thicknes", "--threshold", "1"], "--map: no map 'max_thicknes'; did you mean max_thickness?"),
        (["--map", "max_thickness", "--threshold", "0"], "Use thresholds above 0, or --below."),
        (["--map", "elevation_change", "--threshold", "1", "--below"], "Use negative thresholds with --below."),
        (["--map", "max_thickness", "--threshold", "99"], "no value above 99 m. Change --threshold."),
        (["--map", "max_speed", "--threshold", "1", "--output", "a.shp"], "a.shp: unknown format (allowed: .gpkg, "),
    ],
)
def test_invalid_options_are_refused(map_run: Path, fails: Fails, words: list[str], message: str) -> None:
    fails(["contours", str(map_run), *words], message)


HEAD = b"GP\0\1" + struct.pack("<i", 0)


def points(values: list[list[float]], order: str = "<") -> bytes:
    return struct.pack(f"{order}I", len(values)) + np.array(values, f"{order}f8").tobytes()


def test_lines_points_and_polygons_with_holes_are_read_without_heights(tmp_path: Path) -> None:
    line = np.array([[1.0, 2.0], [3.0, 5.0], [7.0, 11.0]])
    write_layer(tmp_path / "a.gpkg", "path", [line_blob(line), line_blob(line + 1.0, envelope=True)])
    first, second = read_layer(tmp_path / "a.gpkg", "path")
    np.testing.assert_array_equal(first.parts[0], line)
    np.testing.assert_array_equal(second.parts[0], line + 1.0)
    assert second.attributes == {"fid": 2, "time_s": 1.5}
    np.testing.assert_array_equal(geometry_parts(HEAD + struct.pack("<BI2d", 1, 1, 4.0, 5.0))[0], [[4.0, 5.0]])
    ring, hole = [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [0.0, 0.0]], [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [1.0, 1.0]]
    polygon = struct.pack("<BII", 1, 3, 2) + points(ring) + points(hole)
    outer, inner = geometry_parts(HEAD + polygon)
    np.testing.assert_array_equal(outer, ring)
    np.testing.assert_array_equal(inner, hole)
    assert len(geometry_parts(HEAD + struct.pack("<BII", 1, 6, 3) + 3 * polygon)) == 6
    line = struct.pack(">BI", 0, 1002) + points([[1.0, 2.0, 800.0], [3.0, 4.0, 900.0]], ">")
    np.testing.assert_array_equal(geometry_parts(HEAD + line)[0], [[1.0, 2.0], [3.0, 4.0]])
    assert geometry_parts(None) == []


def test_unreadable_layers_are_errors(tmp_path: Path) -> None:
    path, other = tmp_path / "a.gpkg", tmp_path / "other.gpkg"
    write_layer(path, "path", [line_blob(np.eye(2))[:-4]])
    other.write_text("nothing of the kind, but long enough to be looked into" * 20)
    for file, layer, kind, text in (
        (tmp_path / "no", "path", NotInRunError, r"no: no such file\. Only a 3D run on a DEM writes it"),
        (path, "front", NotInRunError, r"a\.gpkg: no layer front \(found: path\)"),
        (path, "path", ReportError, r"a\.gpkg: cannot be read as a GeoPackage"),
        (other, "path", ReportError, r"other\.gpkg: cannot be read as a GeoPackage"),
    ):
        with pytest.raises(kind, match=text):
            read_layer(file, layer)


@pytest.mark.parametrize(
    ("blob", "text"),
    [
        (b"XX" + HEAD[2:], "does not begin with GP"), (HEAD[:3] + b"\x0d" + HEAD[4:], "envelope of unknown kind 6"),
        *((HEAD + struct.pack("<BII", 1, kind, 1), f"unknown type {kind}") for kind in (5002, 13)),
    ],
)  # fmt: skip
def test_invalid_geometries_are_errors(blob: bytes, text: str) -> None:
    with pytest.raises(ValueError, match=text):
        geometry_parts(blob)
