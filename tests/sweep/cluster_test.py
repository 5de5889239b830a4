"""Sweeps on a Dask cluster of separate processes: the same table, and members whose workers die."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from cluster import ALLOWED_FAILURES, cluster

import thawslide
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.member import Task, perform

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


def test_a_cluster_and_one_process_give_the_same_table(slope: Path, tmp_path: Path) -> None:
    with cluster(tmp_path / "cluster") as address:
        found = thawslide.sweep(slope, tmp_path / "sweep", vary=VARY, scheduler=address, progress=False)
    folder = SweepFolder(tmp_path / "one")
    (folder.path / "members").mkdir(parents=True)
    for number, angle in enumerate(VARY["basal.friction_angle"]):
        perform(Task(number, folder.path, str(slope), {"basal.friction_angle": angle}))  # in this process
    expected = thawslide.sweep(slope, tmp_path / "local", vary=VARY, workers=1, progress=False)
    pd.testing.assert_frame_equal(found.drop(columns="wall_s"), expected.drop(columns="wall_s"))
    for number in range(len(found)):
        numbers = folder.record(number)["numbers"]
        assert all(found[name][number] == value for name, value in numbers.items() if value is not None)


def test_a_member_whose_workers_die_is_reported_and_the_others_finish(slope: Path, tmp_path: Path) -> None:
    with cluster(tmp_path / "cluster", DEADLY) as address:
        table = thawslide.sweep(
            slope, tmp_path / "sweep", vary=MANY, block=True, scheduler=address, progress=False
        )  # fmt: skip
    assert list(table["status"]) == ["done", "failed", *(len(table) - 2) * ["done"]]
    assert table["error"][1] == f"{ALLOWED_FAILURES + 1} workers died during this member"
