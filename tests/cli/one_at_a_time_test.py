"""The script of the Lamplugh case that changes one assumption at a time, shortened: half a second of a few rows."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from conftest import LAMPLUGH


def test_one_at_a_time_shortened(binary: Path, report_environment: dict[str, str], tmp_path: Path) -> None:
    page = tmp_path / "page" / "assumptions.md"
    words = [sys.executable, str(LAMPLUGH / "one-at-a-time"), "--quick", "--program", str(binary), "--page", str(page)]
    rows = ["--only", "case", "no-viscosity", "thick", "s-c100"]
    environment = report_environment | {"HOME": os.environ.get("HOME", "")}
    done = subprocess.run(
        [*words, *rows, "--output", str(tmp_path / "runs")],
        env=environment, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "min left: " in done.stdout
    text = page.read_text(encoding="utf-8")
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 120
    lines = [line for line in text.splitlines() if line.startswith("| no viscosity |")]
    assert len(lines) == 1 and "`material.rock_ice.viscosity_time=0.0`" in lines[0] and "not run" not in lines[0]
    assert "| lubrication off | not run |" in text
    assert "[thick-body.toml](thick-body.toml)" in text
    for name in ("assumptions", "block", "deposit"):
        assert (page.parent / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_one_at_a_time_needs_the_program(tmp_path: Path) -> None:
    words = [sys.executable, str(LAMPLUGH / "one-at-a-time"), "--program", str(tmp_path / "none")]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert "Build it with ./run --setup." in done.stderr
