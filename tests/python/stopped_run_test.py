"""Figures of a run that did not come to its end say so, and when that was."""

from __future__ import annotations

import errno
import fcntl
import json
import os
import time
from pathlib import Path

import pytest
from map_figure_parts import drawn, maps_of, notes

from thawslide import Run
from thawslide.report import ending_note, make_report
from thawslide.run_facts import LOCK, Ending, is_held


def test_figures_of_a_stopped_run_say_when_it_stopped(map_run: Path) -> None:
    """With the state the run was left in, where the case asks for earlier times only."""
    facts = json.loads((map_run / "run.json").read_text()) | {"status": "stopped", "simulated_time_s": 9.51}
    (map_run / "run.json").write_text(json.dumps(facts))
    with (map_run / "case.toml").open("a") as case:
        case.write("[time]\nend = 60.0\n[report]\ntimes = [0.0, 2.0]\n")
    said = "The run was stopped at 9.51 s of 60 s. "
    extent = drawn("extent_maps", map_run)
    assert maps_of(extent)[-1].get_title(loc="left") == "(d) thickness at 9.51 s (stopped)"
    assert maps_of(drawn("impact_maps", map_run))[-1].get_title(loc="left")[4:] == (
        "change of elevation at 9.51 s (stopped)"
    )
    speeds, sections = drawn("slide_speed", map_run), drawn("cross_sections", map_run)
    assert [axes.get_title(loc="left") for axes in maps_of(speeds)] == ["(a) t = 0 s", "(b) t = 2 s", "(c) t = 10 s"]
    assert "at 9.51 s (stopped)" in [text.get_text() for text in sections.legends[0].get_texts()]
    for figure in (extent, speeds, sections):
        assert said in notes(figure).replace("\n", " ") + " "


@pytest.mark.parametrize(
    ("facts", "note", "state"),
    [
        ({"status": "done", "simulated_time_s": 10.0}, "", "10 s"),
        ({"status": "failed", "simulated_time_s": 10.4087}, "The run failed at 10.41 s. ", "10.41 s (failed)"),
        (
            {"status": "running", "simulated_time_s": 0.0},
            "The run stopped without a word at 10 s. ",
            "10 s (killed?)",
        ),
    ],
)
def test_how_a_run_ended(map_run: Path, facts: dict[str, object], note: str, state: str) -> None:
    (map_run / "run.json").write_text(json.dumps(facts))
    run = Run(map_run)
    assert (run.end_note, run.last_state) == (note, state)


def test_a_run_whose_lock_is_held_is_running(map_run: Path) -> None:
    (map_run / "run.json").write_text(json.dumps({"status": "running", "simulated_time_s": 0.0}))
    with (map_run / LOCK).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run = Run(map_run)
        assert run.ending is Ending.RUNNING
        assert (run.end_note, run.last_state) == ("The run was still running at 10 s. ", "10 s (still running)")
        assert "(was still running when this was written)" in ending_note(run)
    assert Run(map_run).ending is Ending.KILLED, "the file is there, but nobody holds it"


def test_where_there_are_no_locks_it_cannot_be_told_whether_a_run_lives(
    map_run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "flock", refuse)
    (map_run / LOCK).touch()
    (map_run / "run.json").write_text(json.dumps({"status": "running", "simulated_time_s": 0.0}))
    long_ago = time.time() - 3 * 3600
    for file in map_run.rglob("*"):
        os.utime(file, (long_ago, long_ago))
    assert is_held(map_run / LOCK) is None
    run = Run(map_run)
    assert run.ending is Ending.UNTOLD
    assert run.end_note == "The run was running or killed at 10 s. "
    assert ending_note(run) == (
        "run.json says that this run is running; whether it is cannot be told, as its file system has no locks. Its "
        "last file was written 3 hours before this page. If nothing writes there any more, `thawslide resume "
        f"{map_run}` goes on from its last checkpoint. The figures show what it has written."
    )
    (map_run / "run.json").write_text(json.dumps({"status": "done"}))
    assert Run(map_run).ending is Ending.DONE


def test_several_can_ask_for_the_lock_at_once_and_none_keeps_it(tmp_path: Path) -> None:
    lock = tmp_path / LOCK
    lock.touch()
    with lock.open() as other:
        fcntl.flock(other, fcntl.LOCK_SH)
        assert not is_held(lock)
    with lock.open() as starts:
        assert not is_held(lock)
        fcntl.flock(starts, fcntl.LOCK_EX | fcntl.LOCK_NB)


def test_what_is_no_lock_file_is_answered_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert not is_held(tmp_path / "pipe")
    assert not is_held(tmp_path / "nothing")
    (tmp_path / "circle").symlink_to("circle")
    assert not is_held(tmp_path / "circle")


@pytest.mark.parametrize("text", ['{"status": "stopped"}', '{"status": "done"}', None])
def test_a_run_whose_lock_is_held_runs_again_whatever_run_json_says(map_run: Path, text: str | None) -> None:
    if text is None:
        (map_run / "run.json").unlink()
    else:
        (map_run / "run.json").write_text(text)
    with (map_run / LOCK).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        assert Run(map_run).ending is Ending.RUNNING


def test_the_page_of_a_killed_run_says_how_to_go_on(map_run: Path) -> None:
    (map_run / "run.json").write_text(json.dumps({"status": "running"}))
    page = make_report(Run(map_run), names=["motion"], dpi=50).page.read_text(encoding="utf-8")
    assert "This run stopped without a word: run.json says that it runs, but no process holds run.lock." in page
    assert f"`thawslide resume {map_run}` goes on from its last checkpoint." in page


def test_the_page_of_a_run_that_had_lost_rows_says_so(map_run: Path) -> None:
    parts = [{"warnings": []}, {}, {"warnings": ["history.csv lacks 2 of the 16 rows"]}, {"warnings": 3}, 4]
    (map_run / "run.json").write_text(json.dumps({"status": "done", "parts": parts}))
    page = make_report(Run(map_run), names=["motion"], dpi=50).page.read_text(encoding="utf-8")
    assert '<p class="note">history.csv lacks 2 of the 16 rows</p>' in page


def test_the_page_of_a_run_without_run_json_says_so(map_run: Path) -> None:
    (map_run / "run.json").unlink()
    run = Run(map_run)
    assert ending_note(run) == "There is no run.json, so whether this run came to its end is not known."
    assert run.end_note == ""
