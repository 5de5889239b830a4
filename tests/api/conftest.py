"""The program and a small case, for tests that compare the Python package with the command line."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from slope_case import write_slope_case

import thawslide
from thawslide import Run, Simulation

ROOT = Path(__file__).resolve().parents[2]
VALLEY = ROOT / "cases" / "valley3d"
sys.path.insert(0, str(ROOT / "tests" / "cli"))

CommandLine = Callable[..., subprocess.CompletedProcess[str]]


def silent(_line: str) -> None:
    """Ignore a warning."""


def history_of(folder: Path) -> pd.DataFrame:
    return pd.read_csv(folder / "history.csv")


def assert_identical(found: pd.DataFrame, expected: pd.DataFrame) -> None:
    assert list(found.columns) == list(expected.columns)
    for column in expected.columns:
        np.testing.assert_array_equal(found[column].to_numpy(float), expected[column].to_numpy(float), err_msg=column)


@pytest.fixture
def interrupts() -> Iterator[None]:
    """Let SIGINT raise KeyboardInterrupt: a background process begins with the signal ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def command_line(tmp_path: Path) -> CommandLine:
    program = os.environ.get("THAWSLIDE_BINARY", str(ROOT / "build" / "release" / "thawslide"))

    def start(*arguments: object, code: int = 0) -> subprocess.CompletedProcess[str]:
        command = [program, *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=600)
        assert done.returncode == code, done.stderr
        return done

    return start


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Return the case file of a block that slides down a slope with band columns, 1 s in 200 steps."""
    return write_slope_case(tmp_path / "slope", end=1.0, cell=5.0)


@pytest.fixture
def simulation(slope: Path) -> Simulation:
    """Return a simulation of that case on one thread."""
    return Simulation(slope, threads=1, on_message=silent)


@pytest.fixture
def run(slope: Path, tmp_path: Path) -> Run:
    """Return a run of that case in the folder `run`."""
    return thawslide.run(slope, tmp_path / "run", threads=1, progress=False)
