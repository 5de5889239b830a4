"""The parts of the study `reliability`: reliability_parts.py PART --results FILE [--jobs N] [--quick] [--target NAME].

A part kills runs, makes their writing fail, damages checkpoints and case files, gives random input to readers, or
performs a small run of a million steps. It writes its rows as JSON. THAWSLIDE_BINARY is the program.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "cli"))  # the tests perform a sample of each part

from conftest import SMALL_CASE, sets  # noqa: E402
from faults import (  # noqa: E402
    Subject,
    Trial,
    calls_that_write,
    failing,
    killed,
    limited,
    on_small_disk,
    undisturbed,
)
from wrong_cases import wrong_cases, wrong_messages  # noqa: E402

PROGRAM = Path(os.environ.get("THAWSLIDE_BINARY", ROOT / "build" / "release" / "thawslide"))
RESULTS = ROOT / "docs" / "reliability"  # committed: parts can run on different machines
KILLS, SOAK_STEPS, FUZZING_SECONDS = 200, 1_000_000, 1200
SEED = 20160628
CASES = ROOT / "cases"
VALLEY = tuple(
    sets(grid__cell=40, time__end=20, time__history_interval=0.7, time__output_interval=3.5, checkpoint__interval=2.6)
)
PLANE = tuple(sets(time__end=20, time__history_interval=0.17, time__output_interval=1.45, checkpoint__interval=0.9))
KILLED = (
    Subject("2D, cases/lamplugh", CASES / "lamplugh", PLANE),
    Subject("2D, band columns, cases/lamplugh-columns", CASES / "lamplugh-columns", PLANE),
    Subject("3D with maps, cases/valley3d", CASES / "valley3d", VALLEY),
    Subject("3D with maps and band columns, cases/valley3d/columns.toml", CASES / "valley3d" / "columns.toml", VALLEY),
)


def version() -> str:
    """Return the version of the program."""
    return subprocess.run([str(PROGRAM), "version"], capture_output=True, text=True, check=True).stdout.strip()


def print_progress(done: int, of: int, begin: float) -> None:
    """Print the progress of a part, and its remaining time."""
    left = (time.monotonic() - begin) * (of - done) / max(done, 1)
    print(f"  {done} of {of}, about {left / 60:.0f} min left", flush=True)


def summed(trials: list[Trial]) -> dict[str, Any]:
    """Return the counts of trials, and those that did not pass."""
    return {
        "trials": len(trials),
        "passed": sum(trial.passed for trial in trials),
        "codes": sorted({trial.code for trial in trials}),
        "findings": [vars(trial) for trial in trials if not trial.passed],
    }


def in_parallel(jobs: int, work: Sequence[Callable[[], Trial]]) -> list[Trial]:
    """Call the functions in their order, several at a time."""
    begin = time.monotonic()
    trials: list[Trial] = []
    with ThreadPoolExecutor(jobs) as pool:
        for trial in pool.map(lambda each: each(), work):
            trials.append(trial)
            if not trial.passed:
                print(f"  finding: {trial}", flush=True)
            if len(trials) % 20 == 0:
                print_progress(len(trials), len(work), begin)
    return trials


def kills(folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Kill runs at random moments and resume them."""
    rows = []
    if options.quick:
        (folder / "case.toml").write_text(SMALL_CASE)
    subjects = (Subject("2D, a block on level ground", folder / "case.toml", ()),) if options.quick else KILLED
    for number, subject in enumerate(subjects):
        print(f"kills: {subject.name}", flush=True)
        expected, span = undisturbed(PROGRAM, subject, folder / f"undamaged{number}")

        def trial(run: Path, seed: str, subject: Subject, expected: dict[str, str], span: float) -> Trial:
            outcome = killed(PROGRAM, subject, run, expected, span, random.Random(seed))
            shutil.rmtree(run)
            return outcome

        work = [
            partial(trial, folder / f"killed-{k}", f"{SEED} {number} {k}", subject, expected, span)
            for k in range(2 if options.quick else KILLS // len(KILLED))
        ]
        trials = in_parallel(options.jobs, work)
        killed_ones = sum(each.code != 0 for each in trials)
        rows.append({"subject": subject.name, "seconds": span, "killed": killed_ones, **summed(trials)})
    return rows


def writes(folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Make each call that writes fail in turn, and resume the run."""
    case = folder / "case"
    case.mkdir()
    (case / "case.toml").write_text(SMALL_CASE)
    valley = tuple(sets(grid__cell=40, time__end=1.5, time__output_interval=0.5, checkpoint__interval=0.6))
    rows = []
    for subject, stride in (
        (Subject("2D, a block on level ground", case, tuple(sets(checkpoint__interval=0.06))), 1),
        (Subject("3D with maps, cases/valley3d", CASES / "valley3d", valley), 41),  # maps are thousands of calls
    ):
        expected, _ = undisturbed(PROGRAM, subject, folder / "undamaged")
        calls = calls_that_write(PROGRAM, subject, folder / "counted", folder / "count")
        for kind, reason in (("once", "io"), ("onwards", "full"), ("onwards", "denied"), ("short", "full")):
            words = f"{'each' if stride == 1 else f'every {stride}st'} of {calls} calls"
            print(f"writes: {subject.name}, {kind}, {reason}, {words}", flush=True)

            def trial(at: int, subject: Subject, expected: dict[str, str], kind: str, reason: str) -> Trial:
                run = folder / f"failing-{at}"
                outcome = failing(PROGRAM, subject, run, expected, at, kind, reason)
                shutil.rmtree(run, ignore_errors=True)
                return outcome

            places = range(1, calls + 1, stride * (50 if options.quick else 1))
            trials = in_parallel(options.jobs, [partial(trial, at, subject, expected, kind, reason) for at in places])
            rows.append({"subject": subject.name, "calls": calls, "kind": kind, "reason": reason, **summed(trials)})
        shutil.rmtree(folder / "undamaged")
        shutil.rmtree(folder / "counted")
    return rows + limits(folder, Subject("2D, a block on level ground", case))


def limits(folder: Path, subject: Subject) -> list[dict[str, Any]]:
    """Run on disks that are too small, and under limits of the size of files."""
    expected, _ = undisturbed(PROGRAM, subject, folder / "undamaged")
    sizes = range(1_000, 20_001, 1_000)
    limited_ones = [limited(PROGRAM, subject, folder / f"limited-{size}", expected, size) for size in sizes]
    disks = range(8, 201, 8)
    trials = [on_small_disk(PROGRAM, subject, folder / f"disk-{size}", expected, (size, 10_000)) for size in disks]
    small_disks = [trial for trial in trials if trial is not None]
    rows = [("size", limited_ones), ("disk", small_disks)]
    return [
        {"subject": subject.name, "calls": len(each), "kind": kind, "reason": kind, **summed(each)}
        for kind, each in rows
    ]


def corruption(folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Change one byte of both checkpoints of a killed run; both must be refused."""
    case = folder / "case"
    case.mkdir()
    (case / "case.toml").write_text(SMALL_CASE)
    run = folder / "run"
    undisturbed(PROGRAM, Subject("small", case), run)
    facts = run / "run.json"
    facts.write_text(facts.read_text().replace('"status": "done"', '"status": "running"'))
    undamaged = (run / "checkpoint.bin").read_bytes()
    chance = random.Random(SEED)
    places = sorted(chance.sample(range(len(undamaged)), min(20 if options.quick else 2000, len(undamaged))))
    copies = [folder / f"copy{k}" for k in range(options.jobs)]
    for copy in copies:
        shutil.copytree(run, copy)

    def findings(job: int) -> list[str]:
        found = []
        for place in places[job :: options.jobs]:
            changed = undamaged[place] ^ (1 << place % 8)
            damaged = undamaged[:place] + bytes([changed]) + undamaged[place + 1 :]
            for name in ("checkpoint.bin", "checkpoint.previous.bin"):
                (copies[job] / name).write_bytes(damaged)
            outcome = subprocess.run(
                [str(PROGRAM), "resume", str(copies[job])], capture_output=True, text=True, check=False
            )
            if outcome.returncode != 2 or outcome.stderr.count("is damaged") != 2:
                found.append(f"byte {place}: {outcome.returncode}, {outcome.stderr.strip()}")
        return found

    with ThreadPoolExecutor(options.jobs) as pool:
        found = [each for part in pool.map(findings, range(options.jobs)) for each in part]
    return [{"bytes": len(undamaged), "changed": len(places), "detected": len(places) - len(found), "findings": found}]


def memory_of(process: int) -> int:
    """Return the resident memory of a process [kB]; 0 after its end."""
    try:
        for line in Path(f"/proc/{process}/status").read_text().splitlines():
            if line.startswith("VmRSS:"):
                return int(line.split()[1])
    except FileNotFoundError:
        pass
    return 0


def soak_run(program: Path, folder: Path, name: str, *words: str) -> subprocess.Popen[str]:
    """Start a run of the soak test."""
    command = [str(program), "run", str(folder / "case.toml"), "--output", str(folder / name), "--threads", "1", *words]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def maximum_of(rows: list[dict[str, float]], name: str) -> float:
    """Return the maximum absolute value of a column."""
    return max(abs(row[name]) for row in rows)


def energies(folder: Path) -> dict[str, Any]:
    """Return the maximum energies in the first tenth of a run and in its second half, and whether they are bounded."""
    with (folder / "history.csv").open() as file:
        rows = [{name: float(number) for name, number in row.items()} for row in csv.DictReader(file)]
    names = ("kinetic_J", "strain_J", "mechanical_residual_J")
    first = {name: maximum_of(rows[: len(rows) // 10], name) for name in names}
    second = {name: maximum_of(rows[len(rows) // 2 :], name) for name in names}
    return {"first": first, "second": second, "bounded": all(second[name] <= 1.5 * first[name] for name in names)}


def soak(folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Run a resting block of about 100 particles for a million steps, twice with viscosity and once without."""
    text = SMALL_CASE.replace("max = [14.0, 3.0]", "max = [15.0, 5.0]")
    (folder / "case.toml").write_text(text)
    steps = 2000 if options.quick else SOAK_STEPS
    times = sets(time__end=steps * 0.001, time__output_interval=50.0, time__history_interval=1.0)
    words = [*times, *sets(checkpoint__interval=100.0)]
    viscous = [*words, *sets(material__rock__viscosity_time=0.002)]
    runs = [soak_run(PROGRAM, folder, f"run{k}", *viscous) for k in range(2)]
    memory: list[int] = []
    while any(run.poll() is None for run in runs):
        if runs[0].poll() is None and (now := memory_of(runs[0].pid)) > 0:
            memory.append(now)
        time.sleep(0.5)
    without = soak_run(PROGRAM, folder, "without", *words, *sets(material__rock__viscosity_time=0))
    output = without.communicate()[0]
    facts = json.loads((folder / "run0" / "run.json").read_text())
    names = ("history.csv", "checkpoint.bin")
    return [
        {
            "steps": facts["steps"],
            "particles": facts["particles"],
            "wall_s": facts["wall_s"],
            "codes": [run.returncode for run in runs],
            "memory_after_a_tenth_kB": memory[len(memory) // 10],
            "memory_at_the_end_kB": memory[-1],
            "same_bits": all(
                (folder / "run0" / name).read_bytes() == (folder / "run1" / name).read_bytes() for name in names
            ),
            "energies": energies(folder / "run0"),
            "without_viscosity": energies(folder / "without"),
            "code_without_viscosity": without.returncode,
            "warning_without_viscosity": next((line for line in output.splitlines() if "energy" in line), ""),
        }
    ]


def mistakes(folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Give each parameter a wrong value in turn; the message must name the error."""

    def program(*words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([str(PROGRAM), *map(str, words)], capture_output=True, text=True, check=False)

    cases = list(wrong_cases(json.loads(program("describe", "--json").stdout)))[:: 100 if options.quick else 1]

    def findings(job: int) -> list[str]:
        place = folder / f"job{job}"
        place.mkdir()
        return [each for case in cases[job :: options.jobs] for each in wrong_messages(program, place, case)]

    with ThreadPoolExecutor(options.jobs) as pool:
        found = [each for part in pool.map(findings, range(options.jobs)) for each in part]
    return [{"cases": len(cases), "findings": found}]


def fuzzing(folder: Path, options: argparse.Namespace) -> list[dict[str, Any]]:
    """Fuzz the readers of files; targets that are not selected keep the results of their last run."""
    words = [str(FUZZING_SECONDS), *options.target, "--jobs", str(options.jobs)]
    command = [sys.executable, str(ROOT / "scripts" / "fuzz"), *words, "--json", str(folder / "found.json")]
    subprocess.run(command, check=False)  # exit code 1: findings
    file = RESULTS / "fuzzing.json"  # read late: other targets may have run in the meantime
    before: dict[str, Any] = {"rows": [], "version": ""}
    if options.target and file.exists():
        before = json.loads(file.read_text())
    earlier = [{"version": before["version"], **row} for row in before["rows"]]
    now = [{**row, "version": version()} for row in json.loads((folder / "found.json").read_text())]
    found = {row["target"]: row for row in [*earlier, *now]}
    return [found[name] for name in sorted(found, key=lambda name: ("/" in name, name))]


PARTS = {
    "kills": kills,
    "writes": writes,
    "corruption": corruption,
    "mistakes": mistakes,
    "fuzzing": fuzzing,
    "soak": soak,
}


def main() -> None:
    """Perform a part and write its rows."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", choices=sorted(PARTS))
    parser.add_argument("--results", type=Path, required=True, help="file for the rows")
    parser.add_argument("--target", action="append", default=[], help="fuzz only this target (may be given many times)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="simultaneous runs")
    parser.add_argument("--quick", action="store_true", help="a few trials, to test the script")
    options = parser.parse_args()
    begin = time.monotonic()
    with tempfile.TemporaryDirectory(dir=options.results.parent) as folder:
        rows = PARTS[options.part](Path(folder), options)
    found = {"rows": rows, "wall_s": time.monotonic() - begin, "version": version()}
    options.results.write_text(json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
