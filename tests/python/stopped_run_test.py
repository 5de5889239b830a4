"""Figures of an incomplete run state its ending and time."""

import errno
import fcntl
import os
import time
from pathlib import Path

import pytest
from conftest import page_of, update_facts, write_facts
from map_runs import maps_of, notes, plotted

from thawslide import Run
from thawslide.pages.notes import ending_note
from thawslide.run_facts import LOCK, Ending, is_held


def test_figures_of_a_stopped_run_have_its_last_time(map_run: Path) -> None:
    update_facts(map_run, status="stopped", simulated_time_s=9.51)
    with (map_run / "case.toml").open("a") as case:
        case.write("[time]\nend = 60.0\n[report]\ntimes = [0.0, 2.0]\n")
    note = "The run was stopped at 9.51 s of 60 s. "
    extent = plotted("extent_maps", map_run)
    assert maps_of(extent)[-1].get_title(loc="left") == "(d) flow thickness at\n9.51 s (stopped)"
    assert maps_of(plotted("impact_maps", map_run))[-1].get_title(loc="left")[4:] == (
        "elevation change at 9.51 s (stopped)"
    )
    speeds, sections = plotted("slide_speed", map_run), plotted("cross_sections", map_run)
    assert [axes.get_title(loc="left") for axes in maps_of(speeds)] == ["(a) t = 0 s", "(b) t = 2 s", "(c) t = 10 s"]
    assert "at 9.51 s (stopped)" in [text.get_text() for text in sections.legends[0].get_texts()]
    for figure in (extent, speeds, sections):
        assert note in notes(figure).replace("\n", " ") + " "


@pytest.mark.parametrize(
    ("facts", "note", "state"),
    [
        ({"status": "done", "simulated_time_s": 10.0}, "", "10 s"),
        ({"status": "failed", "simulated_time_s": 10.4087}, "The run failed at 10.4 s. ", "10.4 s (failed)"),
        (
            {"status": "running", "simulated_time_s": 0}, "The run terminated unexpectedly at 10 s. ",
            "10 s (terminated?)",
        ),
    ],
)  # fmt: skip
def test_notes_state_the_ending(map_run: Path, facts: dict[str, object], note: str, state: str) -> None:
    write_facts(map_run, **facts)
    run = Run(map_run)
    assert (run.end_note, run.last_state) == (note, state)


def test_a_run_whose_lock_is_held_is_running(map_run: Path) -> None:
    write_facts(map_run, status="running", simulated_time_s=0.0)
    with (map_run / LOCK).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run = Run(map_run)
        assert run.ending is Ending.RUNNING
        assert (run.end_note, run.last_state) == ("The run was still running at 10 s. ", "10 s (still running)")
        assert "(was still running when this page was written)" in ending_note(run)
    assert Run(map_run).ending is Ending.KILLED, "the file exists, but no process holds it"


def test_ending_is_undetermined_without_locks(map_run: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", refuse)
    (map_run / LOCK).touch()
    write_facts(map_run, status="running", simulated_time_s=0.0)
    long_ago = time.time() - 3 * 3600
    for file in map_run.rglob("*"):
        os.utime(file, (long_ago, long_ago))
    assert is_held(map_run / LOCK) is None
    run = Run(map_run)
    assert run.ending is Ending.UNDETERMINED
    assert run.end_note == "The run was running or terminated unexpectedly at 10 s. "
    assert ending_note(run) == (
        "The status of this run in run.json is running. It cannot be checked, because the file system has no locks. "
        "The last file was written 3 hours before this page. If the run has terminated, "
        f"`thawslide resume {map_run}` continues from its last checkpoint. The figures show the results so far."
    )
    write_facts(map_run)
    assert Run(map_run).ending is Ending.DONE


def test_lock_is_checked_without_keeping_it_or_blocking(tmp_path: Path) -> None:
    lock = tmp_path / LOCK
    lock.touch()
    with lock.open() as other:
        fcntl.flock(other, fcntl.LOCK_SH)
        assert not is_held(lock)
    with lock.open() as starts:
        assert not is_held(lock)
        fcntl.flock(starts, fcntl.LOCK_EX | fcntl.LOCK_NB)
    os.mkfifo(tmp_path / "pipe")
    assert not is_held(tmp_path / "pipe")
    assert not is_held(tmp_path / "nothing")
    (tmp_path / "circle").symlink_to("circle")
    assert not is_held(tmp_path / "circle")


@pytest.mark.parametrize("status", ["stopped", "done", None])
def test_held_lock_overrides_run_json(map_run: Path, status: str | None) -> None:
    write_facts(map_run, status=status)
    if status is None:
        (map_run / "run.json").unlink()
    with (map_run / LOCK).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        assert Run(map_run).ending is Ending.RUNNING


def test_page_has_warnings_and_the_command_to_resume(map_run: Path) -> None:
    write_facts(map_run, status="running")
    page = page_of(map_run)
    assert "This run terminated unexpectedly: its status in run.json is running, but no process holds run.lock." in page
    assert f"To continue from its last checkpoint: `thawslide resume {map_run.name}`." in page
    parts = [{"warnings": []}, {}, {"warnings": ["history.csv lacks 2 of the 16 rows"]}, {"warnings": 3}, 4]
    write_facts(map_run, parts=parts)
    assert '<p class="note">history.csv lacks 2 of the 16 rows</p>' in page_of(map_run)
    (map_run / "run.json").unlink()
    run = Run(map_run)
    assert ending_note(run) == "There is no run.json: it is unknown whether this run is complete."
    assert run.end_note == ""
