"""Output that cannot be written: reported with exit code 5, unless the reader has closed the pipe."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

FULL = Path("/dev/full")
LOST = "error: the output cannot be written: No space left on device. Redirect it to a disk with free space.\n"

pytestmark = pytest.mark.skipif(not FULL.exists(), reason="the system has no /dev/full")


def run_to_full_disk(binary: Path, environment: dict[str, str], *words: object) -> tuple[int, str]:
    """Return exit code and standard error of a command whose output is written to a full disk."""
    with FULL.open("w") as full:
        done = subprocess.run(
            [str(binary), *map(str, words)],
            env=environment,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
            check=False,
        )
    return done.returncode, done.stderr


@pytest.mark.parametrize("words", [["describe"], ["describe", "--md"], ["version"], ["--help"], ["check", "--help"]])
def test_lost_output_is_reported(binary: Path, plain_environment: dict[str, str], words: list[str]) -> None:
    assert run_to_full_disk(binary, plain_environment, *words) == (5, LOST)


@pytest.mark.parametrize("words", [["check"], ["check", "--json"], ["block"]])
def test_lost_output_about_a_case_is_reported(
    binary: Path, plain_environment: dict[str, str], small_case: Path, words: list[str]
) -> None:
    command, *more = words
    assert run_to_full_disk(binary, plain_environment, command, small_case, *more) == (5, LOST)


def test_a_run_needs_no_terminal(
    binary: Path, plain_environment: dict[str, str], small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    assert run_to_full_disk(binary, plain_environment, "run", small_case, "--output", run) == (0, "")
    assert (run / "run.json").exists()
    assert run_to_full_disk(binary, plain_environment, "status", run) == (5, LOST)
    assert run_to_full_disk(binary, plain_environment, "resume", run, "--end", 0.21) == (0, "")


@pytest.mark.parametrize("trap", ["", "trap '' PIPE; "])
def test_a_pipe_closed_by_the_reader_is_no_error(binary: Path, plain_environment: dict[str, str], trap: str) -> None:
    """The same applies if the parent process ignores SIGPIPE."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            ["bash", "-c", f'{trap}exec "$0" describe --md', str(binary)],
            env=plain_environment,
            stdout=write,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
            check=False,
        )
    finally:
        os.close(write)
    assert done.stderr == ""
    assert done.returncode == (0 if trap else -13)


def test_an_error_that_cannot_be_reported_keeps_its_exit_code(binary: Path, plain_environment: dict[str, str]) -> None:
    with FULL.open("w") as full:
        done = subprocess.run(
            [str(binary), "check", "nowhere"], env=plain_environment, stdout=full, stderr=full, timeout=60, check=False
        )
    assert done.returncode == 2
