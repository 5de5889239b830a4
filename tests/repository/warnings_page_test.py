"""The pages of warnings and errors contain the messages of the sources."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_pages_of_warnings_and_errors_are_current() -> None:
    command = [sys.executable, ROOT / "scripts" / "warnings-page", "--check"]
    checked = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert checked.returncode == 0, checked.stderr
