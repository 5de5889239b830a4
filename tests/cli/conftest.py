"""Fixtures that run the program: its start, a small case, and readers of its output."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from slope_files import SOUTH, WEST, Slope, write_release, write_slope

ROOT = Path(__file__).resolve().parents[2]
LAMPLUGH = ROOT / "cases" / "lamplugh"
LIMIT = 60.0  # s, of a command without a longer limit

# A block that rests on flat ground: a valid case with 48 particles.
SMALL_CASE = """[case]
title = "Block on flat ground"

[time]
end = 0.2
step = 0.001
output_interval = 0.05
history_interval = 0.01

[grid]
cell = 1.0
min = [0.0, -2.0]
max = [20.0, 10.0]

[terrain]
type = "flat"
elevation = 0.0

[material.rock]
law = "mohr_coulomb"
youngs_modulus = 1.0e8
poisson_ratio = 0.2
friction_angle = 35.0
cohesion = 1.0e5

[body.block]
material = "rock"
shape = "box"
min = [10.0, 0.0]
max = [14.0, 3.0]
temperature = -10.0
porosity = 0.3

[basal]
friction_angle = 10.0
cohesion = 0.0
"""

# Tests in the background of a shell ignore SIGINT, and the programs that they start would inherit it.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

Outcome = subprocess.CompletedProcess[str]
Program = Callable[..., Outcome]
Interrupted = Callable[[Path, Path, list[str], int, int], int]


@pytest.fixture(scope="session")
def binary() -> Path:
    path = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    if not path.is_file():
        pytest.skip(f"program not found: {path}. Build it, or set THAWSLIDE_BINARY.")
    return path


@pytest.fixture(scope="session")
def plain_environment() -> dict[str, str]:
    """Return an environment whose PATH excludes thawslide-report."""
    environment = dict(os.environ)
    folders = environment.get("PATH", "/usr/bin:/bin").split(os.pathsep)
    environment["PATH"] = os.pathsep.join(each for each in folders if not shutil.which("thawslide-report", path=each))
    return environment


@pytest.fixture(scope="session")
def report_environment(plain_environment: dict[str, str]) -> dict[str, str]:
    """Return an environment whose PATH includes thawslide-report."""
    folder = str(Path(sys.executable).parent)
    if not shutil.which("thawslide-report", path=folder):
        pytest.skip(f"thawslide-report not found in {folder}. Run ./run --setup.")
    return plain_environment | {"PATH": folder + os.pathsep + plain_environment["PATH"], "MPLBACKEND": "Agg"}


@pytest.fixture(scope="session")
def thawslide(binary: Path, plain_environment: dict[str, str]) -> Program:
    """Return a function that runs the program with arguments and returns its outcome."""

    def start(
        *words: object, environment: dict[str, str] | None = None, folder: Path | None = None, limit: float = LIMIT
    ) -> Outcome:
        return subprocess.run(
            [str(binary), *map(str, words)],
            env=environment or plain_environment,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=limit,
            check=False,
        )

    return start


@pytest.fixture(scope="session")
def interrupted(binary: Path, plain_environment: dict[str, str]) -> Interrupted:
    """Return a function that runs a case, sends a signal at a percentage, and returns the exit code."""

    def start(case: Path, run: Path, words: list[str], number: int, percent: int) -> int:
        command = [str(binary), "run", str(case), "--output", str(run), *words]
        pipe = subprocess.PIPE
        with subprocess.Popen(command, env=plain_environment, stdout=pipe, stderr=pipe, text=True) as process:
            assert process.stdout and process.stderr
            for line in process.stdout:
                progress = line.split("%")[0].strip()
                if "%" in line and progress.isdigit() and int(progress) >= percent:
                    process.send_signal(number)
                    break
            process.communicate(timeout=LIMIT)
            return process.returncode

    return start


@pytest.fixture
def small_case(tmp_path: Path) -> Path:
    folder = tmp_path / "small"
    folder.mkdir()
    (folder / "case.toml").write_text(SMALL_CASE)
    return folder


@pytest.fixture
def done(thawslide: Program, small_case: Path, tmp_path: Path) -> Path:
    """Return the folder of a finished run of that case, of 0.2 s."""
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    return run


@pytest.fixture
def slope(tmp_path: Path) -> Slope:
    """Return a function that writes a slope as a DEM."""

    def write(name: str = "dem.tif", **words: Any) -> Path:
        return write_slope(tmp_path / name, **words)

    return write


@pytest.fixture
def release(tmp_path: Path) -> Path:
    return write_release(tmp_path / "release.geojson", WEST + 200.0, SOUTH + 250.0)


def sets(**values: object) -> list[str]:
    """Return options --set; two underscores represent the dot: time__end=1."""
    return [word for key, value in values.items() for word in ("--set", f"{key.replace('__', '.')}={value}")]


def run_facts(run: Path) -> dict[str, Any]:
    facts: dict[str, Any] = json.loads((run / "run.json").read_text())
    return facts


def content_of(run: Path) -> dict[Path, bytes]:
    """Return the content of each file of a run by its path."""
    return {path: path.read_bytes() for path in run.rglob("*") if path.is_file()}


def history(run: Path) -> dict[str, np.ndarray]:
    """Return the columns of history.csv; fail if a field is not a number."""
    with (run / "history.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    numbers = np.array([[float(field) for field in row] for row in rows])
    return dict(zip(header, numbers.T, strict=True))


def snapshot_files(run: Path) -> list[Path]:
    return sorted((run / "snapshots").glob("[0-9]*.vtkhdf"))


def datasets(file: Path) -> dict[str, np.ndarray]:
    """Return every dataset of an HDF5 file by its path."""
    found: dict[str, np.ndarray] = {}

    def collect(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            found[name] = item[()]

    with h5py.File(file) as opened:
        opened.visititems(collect)
    return found


def assert_bitwise_identical(one: Path, other: Path) -> None:
    """Fail unless histories and snapshots of two runs are bitwise identical."""
    assert (one / "history.csv").read_bytes() == (other / "history.csv").read_bytes()
    names = [file.name for file in snapshot_files(one)]
    assert names == [file.name for file in snapshot_files(other)]
    for name in names:
        first, second = (datasets(one / "snapshots" / name), datasets(other / "snapshots" / name))
        assert first.keys() == second.keys()
        for key, values in first.items():
            assert values.dtype == second[key].dtype and values.shape == second[key].shape, f"{name}: {key}"
            assert values.tobytes() == second[key].tobytes(), f"{name}: {key}"
