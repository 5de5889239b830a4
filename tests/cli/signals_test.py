"""Signals during a run, in addition to the tests in status_test.py and resume_test.py."""

from __future__ import annotations

import json
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import LIMIT, Program, sets


def started(binary: Path, run: Path, *words: object, ignored: signal.Signals | None = None) -> subprocess.Popen[str]:
    """Start a run whose parent ignores a signal, as nohup does with SIGHUP."""

    def ignore() -> None:
        if ignored:
            signal.signal(ignored, signal.SIG_IGN)

    return subprocess.Popen(
        [str(binary), "run", *map(str, words), "--output", str(run)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=ignore,
    )


def wait_for(file: Path) -> None:
    until = time.monotonic() + LIMIT
    while not file.exists():
        assert time.monotonic() < until, f"{file} does not appear"
        time.sleep(0.02)


@pytest.mark.parametrize("ignored", [signal.SIGHUP, signal.SIGINT])
def test_ignored_signals_remain_ignored(
    binary: Path, small_case: Path, tmp_path: Path, ignored: signal.Signals
) -> None:
    run = tmp_path / "run"
    process = started(binary, run, small_case, *sets(time__end=1000), ignored=ignored)
    wait_for(run / "checkpoint.bin")
    process.send_signal(ignored)
    time.sleep(0.3)
    assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    assert f"interrupted by signal {int(signal.SIGTERM)} at t = " in process.communicate(timeout=LIMIT)[1]
    assert process.returncode == 4


def test_a_signal_ends_the_settling(binary: Path, thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = sets(mechanics__initial_stress="settle", mechanics__settle_time=1000, mechanics__settle_damping=10)
    process = started(binary, run, small_case, *words)
    wait_for(run / "run.json")
    time.sleep(0.3)
    process.send_signal(signal.SIGTERM)
    message = process.communicate(timeout=LIMIT)[1]
    assert process.returncode == 4
    assert message == f"interrupted by signal 15 while the body settled. To start again: thawslide resume {run}\n"
    facts = json.loads((run / "run.json").read_text())
    assert (facts["status"], facts["message"], facts["simulated_time_s"]) == ("stopped", "signal 15", 0.0)
    assert thawslide("status", run).stdout.startswith(f"{run}: stopped")


def test_slow_energy_growth_is_reported_once(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    slow = sets(time__end=30, time__history_interval=1, time__output_interval=10, guards__energy_growth=0.02)
    outcome = thawslide("run", small_case, "--output", tmp_path / "run", *slow, "--set", "body.block.max=[15.0, 5.0]")
    assert outcome.returncode == 0, outcome.stderr
    message = outcome.stdout + outcome.stderr
    assert message.count("gradually and without a physical cause") == 1
    assert "viscosity_time" in message
    damped = thawslide(
        *("run", small_case, "--output", tmp_path / "damped", *slow, "--set", "body.block.max=[15.0, 5.0]"),
        *sets(material__rock__viscosity_time=0.002),
    )
    assert damped.returncode == 0
    assert "without a physical cause" not in damped.stdout + damped.stderr
