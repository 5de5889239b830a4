"""The program and a small case, for tests that compare the Python package with the command line."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from slope_case import write_slope_case

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))

CommandLine = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def interrupts() -> Iterator[None]:
    """Let SIGINT raise KeyboardInterrupt: a background process begins with the signal ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def command_line(tmp_path: Path) -> CommandLine:
    program = os.environ.get("THAWSLIDE_BINARY", str(ROOT / "build" / "release" / "thawslide"))

    def start(*arguments: object) -> subprocess.CompletedProcess[str]:
        command = [program, *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, timeout=600)

    return start


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Return the case file of a block that slides down a slope with band columns, 1 s in 200 steps."""
    return write_slope_case(tmp_path / "slope", end=1.0, cell=5.0)
