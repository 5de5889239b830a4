"""The script of the page on band columns, shortened: one second of three members and two variants."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from conftest import ROOT

SCRIPT = ROOT / "scripts" / "lamplugh-columns-page"


def test_columns_page_shortened(binary: Path, report_environment: dict[str, str], tmp_path: Path) -> None:
    page = tmp_path / "page" / "results.md"
    words = [sys.executable, str(SCRIPT), "--quick", "--program", str(binary), "--page", str(page)]
    environment = report_environment | {"HOME": os.environ.get("HOME", "")}

    def call(*more: str) -> str:
        done = subprocess.run(
            [*words, "--output", str(tmp_path / "runs"), *more],
            env=environment, capture_output=True, text=True, timeout=120, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "4 runs, 0 of them complete" in call()
    text = page.read_text(encoding="utf-8")
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 120
    assert "## 3 members" in text
    assert "| model | peak of the mean velocity [m/s] | 80 | 72 to 88 |" in text
    # A second of sliding is not enough for 8 m/s.
    assert "- from 8 m/s to the peak: no member has it (accepted: 28 to 42)" in text
    assert "| bound | maximum P over averaged N |  | at most 1 | 0.000 | 0.000 | 3 of 3 | yes |" in text
    assert "| `band.thickness=" in text and "not run" not in text
    assert "@" not in text and "{" not in text
    page.unlink()
    assert "runs," not in call("--draw-only")
    assert page.read_text(encoding="utf-8") == text


def test_columns_page_needs_the_program(tmp_path: Path) -> None:
    words = [sys.executable, str(SCRIPT), "--program", str(tmp_path / "none")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert "Build it with ./run --setup." in done.stderr
