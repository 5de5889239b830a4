"""cases/valley3d rotated by 90 degrees starts alike; tests/cpp/verification has slides to rest, and shifted grids."""

import json
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import ROOT, Program, history, sets

VALLEY = ROOT / "cases" / "valley3d"
CELL = 40.0  # m, twice the case's

Place = list[float]
Turn = Callable[[Place], Place]


def words_of(folder: Path, corners: tuple[Place, Place], probes: dict[str, Place]) -> list[str]:
    """Return the arguments that run the case on coarse cells, with its domain and probes at any position."""
    points = {f"probe__{name}__point": point for name, point in probes.items()}
    return [str(folder), *sets(grid__cell=CELL, grid__min=corners[0], grid__max=corners[1], **points)]


def turned_geometry(coordinates: list, turn: Turn) -> list:
    is_place = isinstance(coordinates[0], float)
    return turn(coordinates) if is_place else [turned_geometry(part, turn) for part in coordinates]


def words_of_turned(folder: Path, lowest: Place, highest: Place, probes: dict[str, Place]) -> list[str]:
    """Write the valley rotated by 90 degrees anticlockwise, and return its arguments."""
    folder.mkdir()
    with rasterio.open(VALLEY / "valley.tif") as file:
        heights, there, bounds = np.rot90(file.read(1)), file.profile, file.bounds

    def turn(at: Place) -> Place:
        return [bounds.left + bounds.top - at[1], bounds.bottom + at[0] - bounds.left]

    point = there["transform"].a
    rows, columns = heights.shape
    transform = rasterio.Affine(point, 0.0, bounds.left, 0.0, -point, bounds.bottom + rows * point)
    there.update(width=columns, height=rows, transform=transform)
    with rasterio.open(folder / "valley.tif", "w", **there) as file:
        file.write(heights, 1)
    for name in ("release.geojson", "path.geojson"):
        features = json.loads((VALLEY / name).read_text())
        for feature in features["features"]:
            feature["geometry"]["coordinates"] = turned_geometry(feature["geometry"]["coordinates"], turn)
        (folder / name).write_text(json.dumps(features))
    (folder / "case.toml").write_bytes((VALLEY / "case.toml").read_bytes())
    ends = turn(lowest), turn(highest)
    corners = [*map(min, *ends), lowest[2]], [*map(max, *ends), highest[2]]
    return words_of(folder, corners, {name: turn(at) for name, at in probes.items()})


def test_the_rotated_valley_starts_alike(thawslide: Program, tmp_path: Path) -> None:
    """The rotation by 90 degrees maps grid, particles and triangles onto themselves: only round-off differs."""
    case = tomllib.loads((VALLEY / "case.toml").read_text())
    probes = {name: probe["point"] for name, probe in case["probe"].items()}
    corners, ends = (case["grid"]["min"], case["grid"]["max"]), []
    plain, turned = words_of(VALLEY, corners, probes), words_of_turned(tmp_path / "case", *corners, probes)
    for name, words in (("plain", plain), ("turned", turned)):
        thawslide.ok("run", *words, *sets(time__end=2.0), "--output", tmp_path / name)
        ends.append({column: values[-1] for column, values in history(tmp_path / name).items()})
    before, after = ends
    assert before["mean_displacement_m"] > 1.0
    for column in ("front_position_m", "runout_m", "mean_displacement_m", "kinetic_J", "friction_heat_J", "plastic_J"):
        assert after[column] == pytest.approx(before[column], rel=1e-6), column
    weight = before["mass_kg"] * 9.81
    assert after["basal_force_y_N"] == pytest.approx(before["basal_force_x_N"], abs=1e-6 * weight)
    assert after["basal_force_x_N"] == pytest.approx(-before["basal_force_y_N"], abs=1e-6 * weight)
