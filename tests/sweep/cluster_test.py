"""Sweeps on a Dask cluster of separate processes: the same table, members whose workers die, memory, and Slurm.

The Slurm job script is generated and parsed here; no test submits it to Slurm.
"""

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
import pytest

import thawslide
from thawslide.program import find_program
from thawslide.sweeps import resources
from thawslide.sweeps.design import Design
from thawslide.sweeps.engine import MOST_DEATHS
from thawslide.sweeps.resources import bytes_of_worker, workers_that_fit
from thawslide.sweeps.slurm import slurm_cluster
from thawslide.sweeps.variables import Uniform

WORKERS = 2
ALLOWED_FAILURES = 1  # of the scheduler: a member fails after two deaths of workers
_LIMIT = 600.0  # seconds until the scheduler is ready
VARY = {"basal.friction_angle": [20.0, 25.0, 30.0]}
MANY = {"basal.friction_angle": [20.0 + angle for angle in range(12)]}  # members wait on a worker that dies

# Ends the process of a worker as soon as it begins member 1.
DEADLY = """
import os
from thawslide.sweeps import engine
from thawslide.sweeps.member import perform

def deadly(task, report):
    if task.number == 1:
        os._exit(1)
    return perform(task, report)

engine.perform = deadly
"""


@contextlib.contextmanager
def cluster(folder: Path, preload: str = "") -> Iterator[str]:
    """Yield the address of a scheduler; the workers run the Python text `preload` at their start."""
    folder.mkdir()
    file, script = folder / "scheduler.json", folder / "preload.py"
    script.write_text(preload)
    environment = os.environ | {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(ALLOWED_FAILURES)}
    scheduler = ["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
    worker = ["worker", "--nthreads", "1", "--no-dashboard", "--scheduler-file", str(file), "--preload", str(script)]
    with contextlib.ExitStack() as ended:
        for arguments in (scheduler, *WORKERS * [worker]):
            command = [sys.executable, "-m", "dask", *arguments]
            quiet = {"stderr": subprocess.DEVNULL, "start_new_session": True}
            process = subprocess.Popen(command, cwd=folder, env=environment, **quiet)
            ended.callback(_end, process)
        deadline = time.monotonic() + _LIMIT
        while not file.is_file():
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.1)
        yield str(json.loads(file.read_text())["address"])


def _end(process: subprocess.Popen[bytes]) -> None:
    """Kill a process with those that it started."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def test_a_cluster_and_one_process_give_the_same_table(slope: Path, tmp_path: Path) -> None:
    with cluster(tmp_path / "cluster") as address:
        found = thawslide.sweep(slope, tmp_path / "sweep", vary=VARY, scheduler=address, progress=False)
    expected = thawslide.sweep(slope, tmp_path / "local", vary=VARY, workers=1, progress=False)
    pd.testing.assert_frame_equal(found.drop(columns="wall_s"), expected.drop(columns="wall_s"))


def test_a_member_whose_workers_die_is_reported_and_the_others_finish(slope: Path, tmp_path: Path) -> None:
    with cluster(tmp_path / "cluster", DEADLY) as address:
        table = thawslide.sweep(slope, tmp_path / "sweep", vary=MANY, block=True, scheduler=address, progress=False)
    assert list(table["status"]) == ["done", "failed", *(len(table) - 2) * ["done"]]
    assert table["error"][1] == f"{ALLOWED_FAILURES + 1} workers died during this member"


def test_a_job_has_one_single_threaded_worker_for_each_core() -> None:
    cluster = slurm_cluster(
        jobs=4, cores=8, memory="16GB", walltime="02:00:00", account="hazards", queue="short",
        job_script_prologue=["module load gcc"], interface=None,
    )  # fmt: skip
    try:
        script = cluster.job_script()
        assert cluster.scheduler.allowed_failures == MOST_DEATHS - 1
    finally:
        cluster.close()
    for line in ("#SBATCH -A hazards", "#SBATCH -p short", "#SBATCH --cpus-per-task=8", "#SBATCH -t 02:00:00"):
        assert line in script.splitlines()
    assert "module load gcc" in script
    assert "--nthreads 1 " in script and "--nworkers 8 " in script and "tcp://" in script
    assert subprocess.run(["bash", "-n"], input=script, text=True, check=False).returncode == 0


def test_the_estimate_combines_the_extremes_of_all_keys(slope: Path, with_program: None) -> None:
    sizes = (Uniform("grid.cell", 1.0, 4.0), Uniform("body.block.particles_per_axis", 1.0, 4.0))

    def need(cell: float, particles: float) -> float:
        program = find_program()
        assert program
        changes = {"grid.cell": cell, "body.block.particles_per_axis": round(particles)}
        found = resources._need(program, str(slope), changes)
        assert found
        return found

    members = Design((str(slope),), sizes, "lhs", 4, 1).members()
    for member in members:
        member.changes["body.block.particles_per_axis"] = round(member.changes["body.block.particles_per_axis"])
    cells, particles = ([member.changes[key] for member in members] for key in members[0].changes)
    found = bytes_of_worker(members)
    assert found == pytest.approx(0.4e9 + 1.2 * need(min(cells), max(particles)))
    assert found >= max(0.4e9 + 1.2 * need(*member.changes.values()) for member in members)


def test_at_least_one_worker_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(resources, "available_bytes", lambda: 10e9)
    assert [workers_that_fit(8, need) for need in (None, 1e9, 4e9, 20e9)] == [8, 8, 2, 1]
