"""thawslide block in a V channel has the friction of two sides: tan(phi)/sin(half the opening angle)."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from conftest import Program
from terrain_files import EAST, NORTH, place, write_dem, write_geojson, write_line

SLOPE, FRICTION, CELL = 35.0, 15.0, 5.0  # degrees, degrees, m
MIDDLE = 102.5  # y of the thalweg [m], on points of the DEM
CASE = f"""
[case]
dimension = 3
[time]
end = 6.0
stepping = "adaptive"
history_interval = 1.0
output_interval = 6.0
[grid]
cell = {CELL}
min = [{EAST + 5.0}, {NORTH + 5.0}, 400.0]
max = [{EAST + 795.0}, {NORTH + 200.0}, 1200.0]
[terrain]
type = "dem"
file = "dem.tif"
[maps]
path = "path.geojson"
[material.rock]
law = "elastic"
youngs_modulus = 5.0e7
poisson_ratio = 0.2
[body.slide]
material = "rock"
shape = "release"
release = "release.geojson"
thickness = 15.0
[basal]
friction = "constant"
friction_angle = {FRICTION}
[heat]
enabled = false
[pressure]
enabled = false
"""


@pytest.mark.parametrize(
    ("opening", "note"), [(180.0, False), (160.0, False), (120.0, True), (90.0, True), (60.0, True)]
)
def test_block_in_a_v_channel(thawslide: Program, tmp_path: Path, opening: float, note: bool) -> None:
    slope, half = np.radians(SLOPE), np.radians(opening / 2.0)
    side = 1.0 / np.tan(half) / np.cos(slope)  # across, in the map
    write_dem(
        tmp_path / "dem.tif",
        lambda x, y: 1000.0 - np.tan(slope) * x + side * np.abs(y - MIDDLE),
        columns=160,
        rows=41,
        cell=CELL,
    )
    corners = [(100.0, MIDDLE - 20.0), (200.0, MIDDLE - 20.0), (200.0, MIDDLE + 20.0), (100.0, MIDDLE + 20.0)]
    ring = [place(*corner) for corner in [*corners, corners[0]]]
    write_geojson(tmp_path / "release.geojson", "Polygon", [ring])
    write_line(tmp_path / "path.geojson", [(50.0, MIDDLE), (790.0, MIDDLE)])
    (tmp_path / "case.toml").write_text(CASE)
    done = thawslide("block", tmp_path, "--output", tmp_path / "block.csv")
    assert done.returncode == 0, done.stderr
    header, *rows = csv.reader((tmp_path / "block.csv").read_text().splitlines())
    columns = dict(zip(header, np.array(rows, dtype=float).T, strict=True))
    factor = 1.0 / np.sin(half)
    assert columns["valley_factor"] == pytest.approx(factor, rel=1e-6)
    acceleration = 9.81 * (np.sin(slope) - factor * np.tan(np.radians(FRICTION)) * np.cos(slope))
    assert columns["velocity_m_s"][-1] / columns["time_s"][-1] == pytest.approx(acceleration, rel=1e-6)
    assert ("the path follows a valley, whose sides raise friction by a factor of" in done.stdout) == note
