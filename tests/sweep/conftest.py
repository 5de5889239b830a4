"""A small case for sweeps."""

import os
import sys
from pathlib import Path

import pytest

Capture = pytest.CaptureFixture[str]
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "api"))

from slope_case import write_slope_case  # noqa: E402


@pytest.fixture
def with_program(monkeypatch: pytest.MonkeyPatch) -> None:
    program = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    if not program.is_file():
        pytest.skip(f"program not found: {program}. Build it, or set THAWSLIDE_BINARY.")
    monkeypatch.setenv("THAWSLIDE_PROGRAM", str(program))


@pytest.fixture
def slope(tmp_path: Path) -> Path:
    """Return the case file of a block that slides down a slope, 0.5 s in 100 steps."""
    return write_slope_case(tmp_path / "slope", end=0.5, cell=10.0, friction="lubricated")
