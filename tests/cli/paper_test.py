"""`./run paper`, with shortened cases."""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys
from pathlib import Path

from conftest import ROOT


def test_paper_shortened(binary: Path, report_environment: dict[str, str], tmp_path: Path) -> None:
    output = tmp_path / "paper"
    words = [sys.executable, "-m", "reproduction", "--quick", "--program", str(binary), "--cases"]
    environment = report_environment | {"PYTHONPATH": f"{ROOT}:{ROOT / 'python'}", "HOME": os.environ.get("HOME", "")}
    done = subprocess.run(
        [*words, str(ROOT / "cases"), "--output", str(output)],
        env=environment, capture_output=True, text=True, timeout=180, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    page = (output / "report.html").read_text(encoding="utf-8")
    links = re.findall(r'<img src="([^"]+)"', page)
    assert len(links) == 15
    assert all((output / link).read_bytes().startswith(b"\x89PNG") for link in links)
    assert "Shortened runs" in page
    assert len(re.findall(r"<td><b>(?:true|false|undetermined)</b></td>", page)) > 50
    rows = dict(line.split(",") for line in (output / "measures.csv").read_text().splitlines()[1:])
    # After 864 s the fronts are in the first cell; without latent heat, cooling has passed through several cells.
    assert float(rows["freezing_m050_no_latent_rms_error"]) < 0.01
    # The published update creates heat spuriously as soon as the bar freezes.
    assert float(rows["freezing_m100_printed_heat"]) > 1.0
    # The block starts with its frozen band at the pressure of ice, rho_I g H.
    assert math.isclose(float(rows["block_e050_pressure_start"]), 917 * 9.81 * 50 / 1e3, rel_tol=1e-3)


def test_paper_reports_a_program_without_results(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "reproduction", "--program", "false", "--cases", str(tmp_path), "--output"]
    environment = dict(os.environ) | {"PYTHONPATH": f"{ROOT}:{ROOT / 'python'}"}
    done = subprocess.run(
        [*words, str(tmp_path / "paper")], env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 2
    assert "./run paper: error: " in done.stderr
