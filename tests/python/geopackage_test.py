"""Layers of a GeoPackage: kinds of geometries, and messages of errors."""

import struct
from pathlib import Path

import numpy as np
import pytest
from map_runs import line_blob, write_layer

from thawslide import NotInRunError, ReportError
from thawslide.geopackage import geometry_parts, read_layer

HEAD = b"GP\0\1" + struct.pack("<i", 0)


def points(values: list[list[float]], order: str = "<") -> bytes:
    return struct.pack(f"{order}I", len(values)) + np.array(values, f"{order}f8").tobytes()


def test_lines_have_their_attributes(tmp_path: Path) -> None:
    line = np.array([[1.0, 2.0], [3.0, 5.0], [7.0, 11.0]])
    write_layer(tmp_path / "a.gpkg", "path", [line_blob(line), line_blob(line + 1.0, envelope=True)])
    first, second = read_layer(tmp_path / "a.gpkg", "path")
    np.testing.assert_array_equal(first.parts[0], line)
    np.testing.assert_array_equal(second.parts[0], line + 1.0)
    assert second.attributes == {"fid": 2, "time_s": 1.5}


def test_points_and_polygons_with_holes_are_read() -> None:
    np.testing.assert_array_equal(geometry_parts(HEAD + struct.pack("<BI2d", 1, 1, 4.0, 5.0))[0], [[4.0, 5.0]])
    ring, hole = [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0], [0.0, 0.0]], [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [1.0, 1.0]]
    polygon = struct.pack("<BII", 1, 3, 2) + points(ring) + points(hole)
    outer, inner = geometry_parts(HEAD + polygon)
    np.testing.assert_array_equal(outer, ring)
    np.testing.assert_array_equal(inner, hole)
    assert len(geometry_parts(HEAD + struct.pack("<BII", 1, 6, 3) + 3 * polygon)) == 6


def test_heights_are_ignored_in_either_byte_order_and_no_geometry_has_no_parts() -> None:
    line = struct.pack(">BI", 0, 1002) + points([[1.0, 2.0, 800.0], [3.0, 4.0, 900.0]], ">")
    np.testing.assert_array_equal(geometry_parts(HEAD + line)[0], [[1.0, 2.0], [3.0, 4.0]])
    assert geometry_parts(None) == []


def test_unreadable_layers_are_errors(tmp_path: Path) -> None:
    path = tmp_path / "a.gpkg"
    with pytest.raises(NotInRunError, match=r"a\.gpkg: no such file\. Only a 3D run on a DEM writes it"):
        read_layer(path, "path")
    write_layer(path, "path", [line_blob(np.eye(2))[:-4]])
    with pytest.raises(NotInRunError, match=r"a\.gpkg: no layer front \(found: path\)"):
        read_layer(path, "front")
    with pytest.raises(ReportError, match=r"a\.gpkg: cannot be read as a GeoPackage"):
        read_layer(path, "path")
    path.write_text("nothing of the kind, but long enough to be looked into" * 20)
    with pytest.raises(ReportError, match=r"a\.gpkg: cannot be read as a GeoPackage"):
        read_layer(path, "path")


@pytest.mark.parametrize(
    ("blob", "text"),
    [
        (b"XX" + HEAD[2:], "does not begin with GP"),
        (HEAD[:3] + b"\x0d" + HEAD[4:], "envelope of unknown kind 6"),
        (HEAD + struct.pack("<BII", 1, 5002, 1), "unknown type 5002"),
        (HEAD + struct.pack("<BII", 1, 13, 1), "unknown type 13"),
    ],
)
def test_invalid_geometries_are_errors(blob: bytes, text: str) -> None:
    with pytest.raises(ValueError, match=text):
        geometry_parts(blob)
