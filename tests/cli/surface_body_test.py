"""A body between the two columns of a profile has the area between them, however long it takes to thin out."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from conftest import Program

CASE = """
[case]
dimension = 2
[time]
end = 1.0
step = 0.002
[grid]
cell = 2.5
min = [-50.0, 700.0]
max = [400.0, 1100.0]
[terrain]
type = "profile"
file = "profile.csv"
extend = true
[material.rock]
law = "elastic"
youngs_modulus = 5.0e7
poisson_ratio = 0.2
[body.b]
material = "rock"
shape = "surface"
[basal]
friction = "constant"
friction_angle = 15.0
[heat]
enabled = false
[pressure]
enabled = false
"""


def test_a_wedge_shaped_upper_end_is_filled(thawslide: Program, tmp_path: Path) -> None:
    """Its upper end is higher than the surface of its thick part."""
    (tmp_path / "case.toml").write_text(CASE)
    (tmp_path / "profile.csv").write_text(
        "distance_m,terrain_elevation_m,surface_elevation_m\n"
        "0,1000,1000\n200,900,920\n300,850,870\n301,849.5,849.5\n350,825,825\n"
    )
    done = thawslide("check", tmp_path, "--json")
    assert done.returncode == 0, done.stderr
    facts = json.loads(done.stdout)
    # 0.5 200 20 + 100 20 + 0.5 1 20 m2, with particles of 1.25 m by 1.25 m
    assert facts["particles"] == pytest.approx(4010.0 / 1.25**2, rel=0.02)
