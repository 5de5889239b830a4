"""Output of a run as plain lines and on a terminal, streams that are closed or full, and limits during a run."""

import os
import pty
import re
import resource
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import HANG, LAMPLUGH, Program, Ran, Slope, history, mark_killed, run_facts, sets
from terrain_files import DEPTH, SOUTH, WEST, WIDTH

STATE = r"\d+\.\d of 2 s \| \d+ steps/s \| \S+ (s|min) left \| front \d+ m"
SPEED = r" at -?\d+\.\d m/s"


@pytest.fixture(scope="module")
def run_output(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> tuple[list[str], Path]:
    """Return the lines of a run whose output is not a terminal, and its folder."""
    run = tmp_path_factory.mktemp("runs") / "run"
    printed = thawslide.ok("run", LAMPLUGH, "--output", run, "--threads", 1, *sets(time__end=2))
    assert "\r" not in printed and "\033" not in printed
    return printed.splitlines(), run


def test_plain_lines_have_a_title_and_the_progress(run_output: tuple[list[str], Path]) -> None:
    lines, run = run_output
    particles = run_facts(run)["particles"]
    title = "Lamplugh rock-ice avalanche, 2016, reproduction of the paper"
    assert lines[0] == f"{title}: {particles:,} particles, 2 s to simulate, on 1 thread"
    percentages = []
    for line in lines[1:]:
        if "%" in line and "left" in line:
            # A speed requires two positions of the front.
            reported = re.fullmatch(rf" *(\d+) % \| {STATE}{SPEED if percentages else ''}", line)
            assert reported, line
            percentages.append(int(reported[1]))
    assert percentages[0] == 10 and 8 <= len(percentages) <= 10
    assert percentages == sorted(set(percentages)) and percentages[-1] <= 100


def test_summary_reports_throughput_and_result(run_output: tuple[list[str], Path]) -> None:
    lines, run = run_output
    facts = run_facts(run)
    first = next(k for k, line in enumerate(lines) if "particle-steps per second" in line)
    reported = re.fullmatch(
        r"([\d,]+) particles, (\S+) steps in \d+ s: (\S+) million particle-steps per second on 1 thread", lines[first]
    )
    assert reported and int(reported[1].replace(",", "")) == facts["particles"]
    assert int(reported[2].replace(",", "")) == facts["steps"]
    assert reported[3] == f"{facts['particle_steps_per_second'] / 1e6:.3g}"
    assert re.fullmatch(
        r"at 2 s, not at rest: mean velocity \d+\.\d\d m/s, mean displacement \d+ m, front at \d+ m, runout \d+ m",
        lines[first + 1],
    )
    shown = [re.fullmatch(r"  (\S.*?) {2,}(\S+) (.*)", line) for line in lines[first + 2 : -2]]
    expected = {
        ("volume change by dilation", "m3"): facts["dilation_volume_m3"],
        ("relative volume change", "%"): 100.0 * facts["dilation_fraction"],
        ("mass of removed particles", "kg"): facts["left_mass_kg"],
    }
    found = {(line[1], line[3]): float(line[2].replace(",", "")) for line in shown if line}
    assert len(found) == len(shown) and found == pytest.approx(expected, rel=5e-3)
    assert facts["at_rest"] is False and len(facts["warnings"]) == 1
    assert lines[-2] == f"warning: {facts['warnings'][0]}"
    assert lines[-2].startswith("warning: the slide is not at rest at 2 s (mean velocity ")
    assert lines[-1] == f"results in {run}"


def read_terminal(descriptor: int) -> bytes:
    """Return the output on a terminal until the program closes it."""
    shown = b""
    while True:
        try:
            part = os.read(descriptor, 65536)
        except OSError:  # on Linux: the other side has closed
            return shown
        if not part:
            return shown
        shown += part


def test_the_bar_on_a_terminal_is_redrawn_in_place(thawslide: Program, tmp_path: Path) -> None:
    terminal, program_side = pty.openpty()
    words = sets(time__end=2, time__step=0.001)
    with thawslide.start("run", LAMPLUGH, "--output", tmp_path / "run", *words, stdout=program_side) as process:
        os.close(program_side)
        shown = read_terminal(terminal).decode()
        os.close(terminal)
        assert process.wait(timeout=HANG) == 0
    bars = re.findall(rf"\r\033\[K\[(=* *)\] +(\d+) % \| {STATE}({SPEED})?", shown)
    assert bars and not bars[0][3] and all(bar[3] for bar in bars[1:])
    for bar, share, *_ in bars:
        assert len(bar) == 24
        assert bar.count("=") == pytest.approx(int(share) * 24 / 100, abs=1.2)
    percentages = [int(share) for _, share, *_ in bars]
    assert percentages == sorted(percentages)
    # The bar is redrawn in place: no new line between the first and the last, and one before the summary.
    first, last = shown.index("\r\033[K["), shown.rindex("\r\033[K[")
    assert "\n" not in shown[first:last]
    assert re.search(r"m( at -?\d+\.\d m/s)?\r\n[\d,]+ particles, 2,000 steps in ", shown[last:])


def test_a_slide_that_barely_moved_has_no_front(thawslide: Program, slope: Slope, tmp_path: Path) -> None:
    slope.new()
    printed = thawslide.ok("run", tmp_path / "slide", "--output", tmp_path / "run", *sets(time__end=0.05))
    assert "nan" not in printed
    assert re.search(
        r"\nat 0\.05 s, not at rest: mean velocity 0\.\d\d m/s, mean displacement 0 m, no front: maps\.path is not "
        r"set, and the slide has barely moved\n",
        printed,
    )


def test_a_run_ends_when_all_particles_have_left(thawslide: Program, slope: Slope, tmp_path: Path, run: Path) -> None:
    slope.new()
    words = [
        *sets(time__end=60, grid__cell=16, grid__leaving='"remove"', basal__friction_angle=3, band__model="scaled"),
        *sets(grid__min=[WEST + 128, SOUTH + 176, 960], grid__max=[WEST + 512, SOUTH + 432, 1216]),
        *sets(heat__enabled="false", pressure__enabled="false", body__slide__velocity=[20, 0, 0]),
    ]
    printed = thawslide.ok("run", tmp_path / "slide", "--output", run, "--threads", 1, *words)
    facts, columns = run_facts(run), history(run)
    reported = re.fullmatch(
        r"the whole slide has left the domain or the known terrain at t = (\S+) s \(step \d+\)\. mass_kg still "
        r"includes the last (\S+) kg, which left in this step\. Specify a larger domain \(\[grid\] min and max\) or a "
        r"larger DEM, and repeat the run\.",
        facts["message"],
    )
    assert reported and facts["status"] == "done"
    assert printed.splitlines()[-1] == facts["message"]
    work = re.search(r"\n([\d,]+) particles, ([\d,]+) at the end, .*: (\S+) million particle-steps", printed)
    assert work and int(work[1].replace(",", "")) == facts["particles"] > int(work[2].replace(",", ""))
    assert work[3] == f"{facts['particle_steps_per_second'] / 1e6:.3g}"
    assert facts["particle_steps_per_second"] * facts["wall_s"] < facts["particles"] * facts["steps"]
    assert columns["time_s"][-1] == pytest.approx(float(reported[1]), rel=1e-5)
    assert columns["mass_kg"][-1] == pytest.approx(float(reported[2].replace(",", "")), rel=6e-3)
    np.testing.assert_allclose(columns["mass_kg"] + columns["left_mass_kg"], columns["mass_kg"][0], rtol=1e-12)
    # Final maps are empty; maximum values are kept.
    assert facts["covered_volume_m3"] == facts["covered_area_m2"] == 0.0
    assert facts["affected_area_m2"] > WIDTH * DEPTH
    assert facts["at_rest"] is None and facts["left_mass_kg"] == pytest.approx(columns["left_mass_kg"][-1])
    (left,) = [line for line in printed.splitlines() if line.startswith("warning: ") and "have left" in line]
    assert left == f"warning: {facts['warnings'][0]}"
    number = facts["removed_particles"]["left"]
    start = f"warning: {number} particles have left the domain or the known terrain and were removed: "
    assert left.startswith(start) and left.endswith(" Use a larger domain or DEM.")
    for name, low, high in (("final", 0.0, 0.0), ("max", 20.0, np.inf)):
        with rasterio.open(run / "maps" / f"{name}_thickness.tif") as file:
            assert low <= file.read(1, masked=True).max() <= high


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
