"""The command-line page contains the help texts of the program."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("THAWSLIDE_BINARY", ROOT / "build" / "release" / "thawslide"))


@pytest.mark.skipif(not PROGRAM.exists(), reason=f"there is no program {PROGRAM}")
def test_command_line_page_is_current() -> None:
    command = [sys.executable, ROOT / "scripts" / "command-line-page", PROGRAM, "--check"]
    checked = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert checked.returncode == 0, checked.stderr
