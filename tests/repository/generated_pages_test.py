"""Generated pages contain the help texts of the program, and the messages of the sources."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("THAWSLIDE_BINARY", ROOT / "build" / "release" / "thawslide"))
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason=f"there is no program {PROGRAM}")
PAGES = [["warnings-page"], pytest.param(["command-line-page", PROGRAM], marks=needs_program)]


@pytest.mark.parametrize("words", PAGES)
def test_generated_pages_are_current(words: list[str | Path]) -> None:
    command = [sys.executable, ROOT / "scripts" / words[0], *words[1:], "--check"]
    checked = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert checked.returncode == 0, checked.stderr
