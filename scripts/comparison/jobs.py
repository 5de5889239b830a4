"""Runs of programs with one thread each, several at a time; each processor time is written next to the log."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")


@dataclass(frozen=True)
class Job:
    """A run of Thawslide: a case file, the keys that differ from it, and the folder of the results."""

    case: Path
    changes: tuple[str, ...]
    output: Path

    @property
    def log(self) -> Path:
        """The file with the output of the program."""
        return self.output.parent / f"{self.output.name}.log"

    @property
    def is_done(self) -> bool:
        """Whether the run has finished with these changes."""
        facts = self.log.with_suffix(".json")
        return facts.exists() and json.loads(facts.read_text()).get("changes") == list(self.changes)


def call(command: Sequence[str | Path], log: Path, changes: Sequence[str] = ()) -> None:
    """Run a command with one thread; write its processor time [s] and the changes of the case next to the log."""
    print(" ".join(str(part) for part in command), flush=True)
    with log.open("w") as file:
        surroundings = {**os.environ, "OMP_NUM_THREADS": "1"}
        process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, env=surroundings)
        _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"exit code {process.returncode}; {log} has the output of the command")
    facts = {"processor_s": used.ru_utime + used.ru_stime, "changes": list(changes)}
    log.with_suffix(".json").write_text(json.dumps(facts))


def processor_time(file: Path) -> float:
    """Return the processor time [s] of a run, with its start and its output."""
    return float(json.loads(file.read_text())["processor_s"])


def run_job(job: Job) -> None:
    """Run a case, unless it is finished."""
    if job.is_done:
        return
    job.output.parent.mkdir(parents=True, exist_ok=True)
    sets = [part for change in job.changes for part in ("--set", change)]
    call(
        [PROGRAM, "run", job.case, *sets, "--threads", "1", "--output", job.output, "--overwrite"], job.log, job.changes
    )


def run_jobs(jobs: Sequence[Job], at_a_time: int) -> None:
    """Run cases, several at a time; exit at the first failure."""
    with ThreadPoolExecutor(at_a_time) as pool:
        for done in [pool.submit(run_job, job) for job in jobs]:
            done.result()
