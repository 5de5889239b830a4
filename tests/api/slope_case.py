"""A case of a block that slides down a slope with band columns, for the tests of the package and of sweeps."""

from pathlib import Path

CASE = """case = {{ title = "Block on a slope" }}
time = {{ end = {end}, step = 0.005, output_interval = 0.25, history_interval = 0.05 }}
grid = {{ cell = {cell}, min = [0.0, -20.0], max = [200.0, 140.0] }}
terrain = {{ type = "profile", file = "profile.csv" }}
basal = {{ friction = "{friction}", friction_angle = 10.0 }}
band = {{ thickness = 0.1 }}

[material]
rock = {{ law = "mohr_coulomb", youngs_modulus = 1.0e8, poisson_ratio = 0.2, friction_angle = 35.0, cohesion = 1.0e5 }}

[body.block]
material = "rock"
shape = "polygon"
vertices = [[40.0, 80.0], [80.0, 60.0], [80.0, 80.0], [40.0, 100.0]]
temperature = -1.0
porosity = 0.3
"""


def write_slope_case(folder: Path, end: float, cell: float, friction: str = "constant") -> Path:
    """Write the case with its profile into a new folder, and return its file."""
    folder.mkdir()
    (folder / "profile.csv").write_text("distance_m,terrain_elevation_m\n0,100\n200,0\n")
    (folder / "case.toml").write_text(CASE.format(end=end, cell=cell, friction=friction))
    return folder / "case.toml"
