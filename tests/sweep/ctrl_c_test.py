"""Ctrl-C in a terminal reaches all processes of a sweep, also workers that are just starting."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from kills_test import workers_of

from thawslide.sweeps.folder import SweepFolder

MEMBERS = 4
SLOW = '[case]\nbased_on = "case.toml"\n[time]\nend = 3.0\nstep = 0.0005\n'


@pytest.mark.parametrize("delay", [0.0, 1.0, 4.0])
def test_ctrl_c_prints_one_line_and_the_sweep_continues(slope: Path, tmp_path: Path, delay: float) -> None:
    case, folder = slope.with_name("slow.toml"), SweepFolder(tmp_path / "sweep")
    case.write_text(SLOW)
    words = [str(case), "--vary", "basal.friction_angle=20,25,30,35", "--workers", "2", "--quiet"]
    command = [sys.executable, "-m", "thawslide.sweeps.command", *words, "--output", str(folder.path)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        while len(workers_of(process.pid)) < 3:  # two workers, and the tracker of resources
            assert process.poll() is None
            time.sleep(0.02)
        time.sleep(delay)
        os.killpg(process.pid, signal.SIGINT)
        errors = process.communicate(timeout=120)[1]
    assert "Traceback" not in errors and process.returncode == 4, errors
    assert errors.endswith("interrupted. All finished members are kept. To continue, repeat the command.\n")
    assert not any(folder.record(number)["status"] == "failed" for number in range(MEMBERS))
