"""Streams that the parent process has closed, and limits that the program reaches during a run."""

from __future__ import annotations

import json
import os
import re
import resource
import subprocess
import time
from pathlib import Path

import pytest
from conftest import LIMIT, Outcome, Program, run_facts, sets

FULL = Path("/dev/full")


def by_shell(binary: Path, environment: dict[str, str], script: str, *words: object) -> Outcome:
    """Run the program as `"$@"` of a shell's script."""
    return subprocess.run(
        ["bash", "-c", script, "bash", str(binary), *map(str, words)],
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=LIMIT,
        check=False,
    )


@pytest.mark.parametrize("closed", ["<&- >&-", "<&- >&- 2>&-", ">&-", ">&- 2>&-", "<&-", "2>&-"])
def test_output_to_closed_streams_is_not_written_into_files(
    binary: Path, plain_environment: dict[str, str], thawslide: Program, small_case: Path, tmp_path: Path, closed: str
) -> None:
    """Otherwise files of the run get the numbers of closed streams, and progress is written into them."""
    known, run = tmp_path / "known", tmp_path / "run"
    assert thawslide("run", small_case, "--output", known).returncode == 0
    assert by_shell(binary, plain_environment, f'"$@" {closed}', "run", small_case, "--output", run).returncode == 0
    assert by_shell(binary, plain_environment, f'"$@" {closed}', "resume", run, "--end", 0.25).returncode == 0
    assert thawslide("resume", known, "--end", 0.25).returncode == 0
    files = sorted(file.relative_to(known) for file in known.rglob("*") if file.is_file())
    assert files == sorted(file.relative_to(run) for file in run.rglob("*") if file.is_file())
    same = [file for file in files if file.name == "history.csv" or file.parent.name == "snapshots"]
    assert len(same) > 4
    for file in same:
        assert (run / file).read_bytes() == (known / file).read_bytes(), file


def test_results_for_a_closed_stream_are_lost_and_reported(binary: Path, plain_environment: dict[str, str]) -> None:
    done = by_shell(binary, plain_environment, '"$@" >&-', "describe")
    assert done.returncode == 5
    assert done.stderr.startswith("error: the output cannot be written: Bad file descriptor.")


@pytest.mark.parametrize("words", [["describe", "--md"], ["check", "--json"]])
def test_a_file_above_its_size_limit_is_reported(
    binary: Path, plain_environment: dict[str, str], small_case: Path, tmp_path: Path, words: list[str]
) -> None:
    command = [*words, small_case] if words[0] == "check" else words
    done = by_shell(binary, plain_environment, f'ulimit -f 1; "$@" > {tmp_path / "output"}', *command)
    assert done.returncode == 5, done.stderr
    assert "error: the output cannot be written: File too large." in done.stderr


def test_memory_exhausted_during_a_run_stops_it_resumably(
    binary: Path, plain_environment: dict[str, str], thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    fine = sets(grid__cell=0.5, body__block__particles_per_axis=16, time__end=60, time__output_interval=0.02)
    command = [str(binary), "run", str(small_case), *fine, "--output", str(run), "--threads", "1"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=plain_environment, stdout=subprocess.DEVNULL, stderr=pipe, text=True) as process:
        assert process.stderr
        deadline = time.monotonic() + LIMIT
        while len(list(run.glob("snapshots/*"))) < 2 and time.monotonic() < deadline:
            time.sleep(0.05)
        pages = int(Path(f"/proc/{process.pid}/statm").read_text().split()[0])
        bound = pages * os.sysconf("SC_PAGE_SIZE") + 2**21  # the stack may grow; a snapshot needs far more
        resource.prlimit(process.pid, resource.RLIMIT_AS, (bound, resource.RLIM_INFINITY))
        reported = process.stderr.read()
    assert process.returncode == 2, reported
    assert re.search(
        r"error: the memory of this machine, or its limit \(ulimit -v\), was exhausted during the run\n"
        rf"stopped at t = \S+ s\. All files are intact: `thawslide resume {re.escape(str(run))}` ",
        reported,
    ), reported
    assert run_facts(run)["status"] == "stopped"
    assert "was exhausted during the run" in thawslide("status", run).stdout
    end = run_facts(run)["simulated_time_s"] + 0.02
    assert thawslide("resume", run, "--end", round(end, 3)).returncode == 0


def test_files_with_future_times_are_reported(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    (run / "run.json").write_text(json.dumps(run_facts(run) | {"status": "running"}))
    later = time.time() + 1e6
    for file in run.rglob("*"):
        os.utime(file, (later, later))
    assert "  last checkpoint later than it is now by this machine's clock\n" in thawslide("status", run).stdout


@pytest.mark.skipif(not FULL.exists(), reason="the system has no /dev/full")
@pytest.mark.parametrize("where", [f"> {FULL}", ">&-", "| head -c 1 > /dev/null"])
def test_a_report_needs_no_terminal(
    binary: Path, report_environment: dict[str, str], thawslide: Program, small_case: Path, tmp_path: Path, where: str
) -> None:
    run = tmp_path / "run"
    assert thawslide("run", small_case, "--output", run).returncode == 0
    done = by_shell(binary, report_environment, f'set -o pipefail; "$@" {where}', "report", run, "--only", "motion")
    assert (done.returncode, done.stderr) == (0, "")
    assert (run / "report.html").exists()


def test_control_characters_in_titles_are_replaced(
    thawslide: Program, report_environment: dict[str, str], small_case: Path, tmp_path: Path
) -> None:
    run = tmp_path / "run"
    steering = 'case.title="A \\u001b[31mred\\u0007 \\u202eslide"'
    assert thawslide("run", small_case, "--set", steering, "--output", run).returncode == 0
    done = thawslide("report", run, "--only", "motion", environment=report_environment)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("A ?[31mred? ?slide: ")
    assert not set(done.stdout) & {"\x1b", "\x07", "\u202e"}
    assert not set((run / "report.html").read_text(encoding="utf-8")) & {"\x1b", "\x07", "\u202e"}
