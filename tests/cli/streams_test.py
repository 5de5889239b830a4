"""Output that cannot be written, streams that the parent process has closed, and limits reached during a run."""

import os
import re
import resource
import subprocess
import time
from pathlib import Path

import pytest
from conftest import Program, Ran, mark_killed, run_facts, sets

FULL = Path("/dev/full")
LOST = "error: the output cannot be written: No space left on device. Redirect it to a disk with free space.\n"

needs_full_disk = pytest.mark.skipif(not FULL.exists(), reason="the system has no /dev/full")


@needs_full_disk
@pytest.mark.parametrize(
    "words",
    ["describe", "describe --md", "version", "--help", "check --help", "check {}", "check {} --json", "block {}"],
)
def test_lost_output_is_reported(thawslide: Program, small_case: Path, words: str) -> None:
    done = thawslide.shell(f'"$@" > {FULL}', *words.format(small_case).split())
    assert (done.returncode, done.stderr) == (5, LOST)


@needs_full_disk
def test_a_run_needs_no_terminal(thawslide: Program, small_case: Path, run: Path) -> None:
    for words, code in (
        (["run", small_case, "--output", run], 0),
        (["status", run], 5),
        (["resume", run, "--end", 0.21], 0),
    ):
        done = thawslide.shell(f'"$@" > {FULL}', *words)
        assert (done.returncode, done.stderr) == (code, LOST if code else "")
    assert (run / "run.json").exists()


@needs_full_disk
def test_an_error_that_cannot_be_reported_keeps_its_exit_code(thawslide: Program) -> None:
    assert thawslide.shell(f'"$@" > {FULL} 2>&1', "check", "nowhere").returncode == 2


@pytest.mark.parametrize("trap", ["", "trap '' PIPE; "])
def test_a_pipe_closed_by_the_reader_is_no_error(thawslide: Program, trap: str) -> None:
    """The same applies if the parent process ignores SIGPIPE."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = thawslide.shell(f'{trap}exec "$@"', "describe", "--md", stdout=write)
    finally:
        os.close(write)
    assert (done.returncode, done.stderr) == (0 if trap else -13, "")


@pytest.mark.parametrize("closed", ["<&- >&-", "<&- >&- 2>&-", ">&-", ">&- 2>&-", "<&-", "2>&-"])
def test_closed_streams_are_not_written_to_files(thawslide: Program, small_case: Path, done: Path, closed: str) -> None:
    """Otherwise files of the run get the numbers of closed streams, and progress is written into them."""
    run = done.with_name("closed")
    assert thawslide.shell(f'"$@" {closed}', "run", small_case, "--output", run).returncode == 0
    assert thawslide.shell(f'"$@" {closed}', "resume", run, "--end", 0.25).returncode == 0
    thawslide.ok("resume", done, "--end", 0.25)
    files = sorted(file.relative_to(done) for file in done.rglob("*") if file.is_file())
    assert files == sorted(file.relative_to(run) for file in run.rglob("*") if file.is_file())
    same = [file for file in files if file.name == "history.csv" or file.parent.name == "snapshots"]
    assert len(same) > 4
    assert all((run / file).read_bytes() == (done / file).read_bytes() for file in same)


def test_results_for_a_closed_stream_are_lost_and_reported(thawslide: Program) -> None:
    done = thawslide.shell('"$@" >&-', "describe")
    assert done.returncode == 5
    assert done.stderr.startswith("error: the output cannot be written: Bad file descriptor.")


@pytest.mark.parametrize("words", ["describe --md", "check --json {}"])
def test_a_file_above_its_limit_is_reported(thawslide: Program, small_case: Path, tmp_path: Path, words: str) -> None:
    script = f'ulimit -f 1; "$@" > {tmp_path / "output"}'
    done = thawslide.shell(script, *words.format(small_case).split())
    assert done.returncode == 5, done.stderr
    assert "error: the output cannot be written: File too large." in done.stderr


def test_memory_exhausted_during_a_run_stops_it_resumably(thawslide: Program, small_case: Path, run: Path) -> None:
    fine = sets(grid__cell=0.5, body__block__particles_per_axis=16, time__end=60, time__output_interval=0.02)
    words = ("run", small_case, *fine, "--output", run, "--threads", 1)
    with thawslide.start(*words, stdout=subprocess.DEVNULL) as process:
        assert process.stderr
        while len(list(run.glob("snapshots/*"))) < 2:
            assert process.poll() is None
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
    assert "was exhausted during the run" in thawslide.ok("status", run)
    thawslide.ok("resume", run, "--end", round(run_facts(run)["simulated_time_s"] + 0.02, 3))


def test_files_with_future_times_are_reported(thawslide: Program, done: Path) -> None:
    mark_killed(done)
    later = time.time() + 1e6
    for file in done.rglob("*"):
        os.utime(file, (later, later))
    assert "  last checkpoint later than it is now by this machine's clock\n" in thawslide.ok("status", done)


@needs_full_disk
@pytest.mark.parametrize("where", [f"> {FULL}", ">&-", "| head -c 1 > /dev/null"])
def test_reports_need_no_stream(thawslide: Program, report_environment: dict[str, str], done: Path, where: str) -> None:
    script = f'set -o pipefail; "$@" {where}'
    report = thawslide.shell(script, "report", done, "--only", "motion", env=report_environment)
    assert (report.returncode, report.stderr) == (0, "")
    assert (done / "report.html").exists()


def test_control_characters_are_replaced(thawslide: Program, ran: Ran, report_environment: dict[str, str]) -> None:
    run = ran("--set", 'case.title="A \\u001b[31mred\\u0007 \\u202eslide"')
    printed = thawslide.ok("report", run, "--only", "motion", environment=report_environment)
    assert printed.startswith("A ?[31mred? ?slide: ")
    assert not set(printed) & {"\x1b", "\x07", "\u202e"}
    assert not set((run / "report.html").read_text(encoding="utf-8")) & {"\x1b", "\x07", "\u202e"}
