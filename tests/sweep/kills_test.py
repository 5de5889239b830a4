"""A sweep that is killed at ten random moments, driver and workers, gives the table of an undisturbed one."""

import contextlib
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from thawslide.sweeps.folder import DONE, RUNNING, SweepFolder

SEED, KILLS, MEMBERS = 1, 10, 40
MOST_WAIT = 3.0  # seconds from the start of a member to a kill
DURING_START = 0.2  # fraction of the kills that do not wait for a member
SLOW = '[case]\nbased_on = "case.toml"\n[time]\nend = {end}\nstep = 0.0001\n[checkpoint]\ninterval = 0.1\n'


def start(case: Path, sweep: Path) -> subprocess.Popen[bytes]:
    """Start or continue the sweep in a session of its own."""
    angles = ",".join(str(15 + number) for number in range(MEMBERS))
    command = [sys.executable, "-m", "thawslide.sweeps.command", str(case), "--vary", f"basal.friction_angle={angles}"]
    return subprocess.Popen(
        [*command, "--workers", "2", "--output", str(sweep)], stderr=subprocess.DEVNULL, start_new_session=True
    )


def workers_of(driver: int) -> list[int]:
    try:
        files = list(Path(f"/proc/{driver}/task").glob("*/children"))
        return [int(number) for file in files for number in file.read_text().split()]
    except OSError:  # a thread of the driver has ended
        return []


def is_running(folder: SweepFolder, driver: int) -> bool:
    workers = workers_of(driver)
    records = [folder.record(number) for number in range(MEMBERS)]
    return any(record["status"] == RUNNING and record["process"] in workers for record in records)


def done_starts(folder: SweepFolder) -> dict[int, int]:
    records = {number: folder.record(number) for number in range(MEMBERS)}
    return {number: record["starts"] for number, record in records.items() if record["status"] == DONE}


@pytest.mark.long
def test_ten_kills_at_random_moments_do_not_change_the_table(slope: Path, tmp_path: Path) -> None:
    case = slope.with_name("slow.toml")
    case.write_text(SLOW.format(end=6.0))
    whole, killed = SweepFolder(tmp_path / "whole"), SweepFolder(tmp_path / "killed")
    assert start(case, whole.path).wait(1800) == 0

    moments = random.Random(SEED)
    finished: dict[int, int] = {}
    process, kills = start(case, killed.path), {"driver": 0, "worker": 0, "all": 0}
    while sum(kills.values()) < KILLS:
        waits = moments.random() > DURING_START
        while waits and process.poll() is None and not is_running(killed, process.pid):
            time.sleep(0.1)
        time.sleep(moments.uniform(0.0, MOST_WAIT))
        target = moments.choice(list(kills))
        assert process.poll() is None, f"the sweep ended after {kills}"
        workers = workers_of(process.pid)
        if target == "worker" and not workers:
            continue  # they have not started yet
        with contextlib.suppress(ProcessLookupError):
            if target == "all":
                os.killpg(process.pid, signal.SIGKILL)
            else:
                os.kill(moments.choice(workers) if target == "worker" else process.pid, signal.SIGKILL)
        kills[target] += 1
        if target != "worker":
            process.wait()
            process = start(case, killed.path)
        now = done_starts(killed)
        assert finished.items() <= now.items()
        finished = now
    assert process.wait(1800) == 0
    assert finished.items() <= done_starts(killed).items()  # no finished member started again

    found, expected = (pd.read_parquet(each.path / "members.parquet") for each in (killed, whole))
    assert list(expected["starts"]) == [1] * MEMBERS and found["starts"].sum() > MEMBERS
    pd.testing.assert_frame_equal(found.drop(columns=["starts", "wall_s"]), expected.drop(columns=["starts", "wall_s"]))
    print(f"\nkills: {kills}; starts: {list(found['starts'])}; done before the last kill: {len(finished)}")
