"""Types of the package: a user's script passes `mypy --strict`, and wrong types are found."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

SCRIPT = """
import numpy as np

import thawslide
from thawslide import Case, Run, RunError, Simulation, UserError


def peak_of(case: Case) -> float:
    simulation = Simulation(case, threads=1)
    simulation.run(until=1.0)
    return float(simulation.history["mean_velocity_m_s"].max())


case = Case("slope", {"basal.friction_angle": 20.0})
case["band.thickness"] = 0.3
try:
    print(peak_of(case), np.pi)
    run: Run = thawslide.run(case, output="out", progress=False)
    print(run.key_numbers["peak_speed_m_s"])
except (UserError, RunError) as error:
    print(error)
table = thawslide.sweep("slope", "sweep", vary={"band.thickness": [0.1, 0.2]}, progress=False)
print(table["status"].tolist())
"""


def mypy(tmp_path: Path, script: str) -> str:
    (tmp_path / "study.py").write_text(script)
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\nstrict = True\n")
    command = [sys.executable, "-m", "mypy", "--config-file", settings, "--cache-dir", ROOT / "build" / "mypy-user"]
    return subprocess.run([*command, "study.py"], cwd=tmp_path, capture_output=True, text=True).stdout


def test_strict_check_accepts_a_script_and_finds_a_wrong_type(tmp_path: Path) -> None:
    assert "Success: no issues found" in mypy(tmp_path, SCRIPT)
    assert 'has incompatible type "str"; expected "float' in mypy(tmp_path, SCRIPT.replace("until=1.0", 'until="1"'))
