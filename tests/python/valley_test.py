"""The valley of cases/valley3d: its files are what its script makes, and what its page says of them."""

from __future__ import annotations

import importlib.util
import json
import tomllib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import rasterio

FOLDER = Path(__file__).resolve().parents[2] / "cases" / "valley3d"


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("make_valley", FOLDER / "make_valley.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def geometry(name: str) -> dict:
    return json.loads((FOLDER / name).read_text())["features"][0]["geometry"]


def test_files_are_what_the_script_makes(script: ModuleType) -> None:
    with rasterio.open(FOLDER / "valley.tif") as file:
        assert file.crs.to_epsg() == 32608
        assert file.bounds == (script.WEST, script.SOUTH, script.WEST + 10_000.0, script.SOUTH + 4_400.0)
        assert np.abs(file.read(1) - script.valley()).max() < 0.101  # rounded to the decimetre, which may tip over
    assert geometry("release.geojson")["coordinates"] == [script.release()]
    assert geometry("path.geojson")["coordinates"] == script.path()
    assert (FOLDER / "valley.tif").stat().st_size < 2**18


def test_floor_falls_as_the_profile_and_has_no_kink(script: ModuleType) -> None:
    along, points, _ = script.centre_line()
    chosen = (along >= 0.0) & (along <= 9_000.0)
    foot, across = script.valley_coordinates(*points[chosen].T)
    assert np.abs(foot - along[chosen]).max() < 1e-6
    assert np.abs(across).max() < 1e-6
    fine = np.arange(-500.0, 9_000.0, 0.5)
    slope = np.diff(script.long_profile(fine)) / 0.5
    assert np.abs(np.diff(slope)).max() < 0.06  # the profile's own points are 10 m apart, in slopes that round it
    assert slope.min() == pytest.approx(-np.tan(np.radians(48.0)), abs=1e-3)


def test_places_beside_the_bend_know_how_far_along_and_across_they_are(script: ModuleType) -> None:
    along, points, angle = script.centre_line()
    for distance, left in [(500.0, 900.0), (3_800.0, 1_200.0), (3_800.0, -1_200.0), (7_000.0, 300.0)]:
        k = int(np.searchsorted(along, distance))
        place = points[k] + left * np.array([-np.sin(angle[k]), np.cos(angle[k])])
        foot, across = script.valley_coordinates(place[:1], place[1:])
        assert foot[0] == pytest.approx(distance, abs=1e-3)
        assert across[0] == pytest.approx(left, abs=1e-3)


def test_release_is_some_52_million_cubic_metres(script: ModuleType) -> None:
    corners = np.array(script.release())
    east, north = (corners - corners.mean(axis=0)).T
    area = 0.5 * np.sum(east[:-1] * north[1:] - east[1:] * north[:-1])
    assert area > 0.0  # anticlockwise, as GeoJSON has it (RFC 7946)
    assert script.RELEASE_THICKNESS * area == pytest.approx(52e6, rel=0.01)
    assert "taper" not in tomllib.loads((FOLDER / "case.toml").read_text())["body"]["slide"]


def test_release_and_domain_lie_within_the_dem(script: ModuleType) -> None:
    grid = tomllib.loads((FOLDER / "case.toml").read_text())["grid"]
    low, high = np.array(grid["min"][:2]), np.array(grid["max"][:2])
    half = script.POINT / 2.0
    assert (low >= [script.WEST + half, script.SOUTH + half]).all()
    assert (high <= [script.WEST + 10_000.0 - half, script.SOUTH + 4_400.0 - half]).all()
    for corner in script.release():
        assert (low < corner).all()
        assert (corner < high).all()
