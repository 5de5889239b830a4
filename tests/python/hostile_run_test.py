"""Reports of damaged and incomplete run folders: intact data are plotted, damage and endings are named."""

import errno
import fcntl
import json
import os
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, edit, history_columns, page_of, snapshot_file, update_facts, write_facts, write_history
from figure_parts import maps_of, notes, plotted, titled

from thawslide import Run
from thawslide.atomic_file import atomic_file
from thawslide.command_line import main
from thawslide.pages.notes import ending_note
from thawslide.report_page import make_report
from thawslide.run_facts import LOCK, Ending, is_held


def report(folder: Path, capsys: pytest.CaptureFixture[str], *only: str) -> tuple[int, str, str]:
    """Return exit code, standard error and page, for all figures that suit the run or those named."""
    code = main([str(folder), "--dpi", "50", *(["--only", ",".join(only)] if only else [])])
    page = folder / "report.html"
    return code, capsys.readouterr().err, page.read_text(encoding="utf-8") if page.is_file() else ""


def history(change: Callable[[str], str]) -> Callable[[Path], object]:
    return lambda folder: (folder / "history.csv").write_text(change((folder / "history.csv").read_text()))


def damage_row(text: str) -> str:
    lines = text.splitlines(keepends=True)
    return "".join([*lines[:40], lines[40][:30] + "\n", *lines[41:]])


def damage_snapshots(folder: Path) -> None:
    snapshot_file(folder, 3).unlink()
    snapshot_file(folder, 5).write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))


# Damage, exit code, words of standard error, words of the page; without words of the page, there is none.
DAMAGE = {
    "incomplete last row": (
        history(lambda text: text[: len(text) // 2]), 0,
        ["warning: ", "history.csv: the last row is incomplete and is ignored"],
        ["history.csv: the last row is incomplete and is ignored"],
    ),
    "damaged row": (
        history(damage_row), 2,
        ["history.csv:41: ", "Repeat the rows after the last checkpoint with `thawslide resume`."], [],
    ),
    "missing and damaged snapshots": (
        damage_snapshots, 0, words := [
            "000003.vtkhdf: missing. The figures use the other snapshots.", "000005.vtkhdf: cannot be read as HDF5",
        ], words,
    ),
    "no run.json": (
        lambda folder: (folder / "run.json").unlink(), 0, [],
        ["There is no run.json: it is unknown whether this run is complete."],
    ),
} | {
    f"run.json with {text[:9]!r}": (lambda run, text=text: (run / "run.json").write_text(text), 2, ["run.json"], [])
    for text in ('{"status": "running", "simu', "", "\0" * 50)
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(make_run: MakeRun, capsys: pytest.CaptureFixture[str], name: str) -> None:
    damage, expected, errors_expected, page_expected = DAMAGE[name]
    folder = make_run()
    damage(folder)
    code, errors, page = report(folder, capsys, *(["velocity"] if "snapshots" in name else ["motion"]))
    assert code == expected
    assert all(words in errors for words in errors_expected)
    assert all(words in page for words in page_expected)
    assert bool(page) == bool(page_expected)


def test_damaged_field_affects_only_its_figures(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    with h5py.File(snapshot_file(folder, 4), "a") as file:
        del file["VTKHDF/PointData/velocity"]
        file["VTKHDF/PointData/velocity"] = np.ones(3)
    code, errors, page = report(folder, capsys)
    assert code == 2 and "error: velocity: not plotted: " in errors
    assert "000004.vtkhdf: damaged (found the shape (3,) of 'VTKHDF/PointData/velocity')" in errors
    assert "Not plotted: velocity, interactive view. Section &#x27;Missing figures&#x27; has the reasons." in page
    assert (folder / "figures" / "motion.png").is_file()


@pytest.mark.parametrize("damaged", ["max_thickness.tif", "terrain.tif", "results.gpkg"])
def test_damaged_maps_affect_their_figures(map_run: Path, damaged: str, capsys: pytest.CaptureFixture[str]) -> None:
    whole = (map_run / "maps" / damaged).read_bytes()
    (map_run / "maps" / damaged).write_bytes(whole[: len(whole) // 2])
    code, errors, page = report(map_run, capsys)
    assert code == 2 and f"{damaged}: cannot be read as a Geo" in errors
    assert "Not plotted: " in page and (map_run / "figures" / "motion.png").is_file()


def test_overflow_affects_only_its_figures(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder, columns = make_run(), history_columns(11, 2)
    for name, values in columns.items():
        if name not in ("time_s", "step"):
            values[5:] = [1e30, 1e200, -1e308, np.inf, -np.inf, np.nan]
    write_history(folder / "history.csv", columns)
    with warnings.catch_warnings(record=True) as noise:
        warnings.simplefilter("always")
        code, errors, page = report(folder, capsys)
    assert [str(each.message) for each in noise if issubclass(each.category, RuntimeWarning)] == []
    assert code == 2 and "error: band: not plotted: " in errors
    assert "Not plotted: band. Section &#x27;Missing figures&#x27; has the reasons." in page
    assert (folder / "figures" / "motion.png").is_file()


@pytest.mark.filterwarnings("ignore:Glyph")  # the font has no Chinese
def test_special_characters_are_text(make_run: MakeRun) -> None:
    """A pair of dollar signs would be a formula, and an invalid formula is an error."""
    folder = make_run(targets='quantity,time_s,value,unit,source\nmean_velocity,4,9,m/s,"$\\nothing$, $5 and $6"\n')
    title = r"$\frac{ 5 $ & <b> 氷 \u0007 x"
    edit(folder / "case.toml", '"Block on a slope & <more>"', json.dumps(title))
    figure = plotted("motion", folder)
    figure.savefig(folder / "motion.png", dpi=50)
    assert figure.get_suptitle() == f"{title}: motion"
    legend = figure.axes[0].get_legend().get_texts()
    assert r"reported: $\nothing$, $5 and $6" in [text.get_text() for text in legend]
    assert len(make_report(Run(folder), dpi=50).figures) == 8


def test_title_is_no_template_and_a_failed_write_keeps_the_file(make_run: MakeRun) -> None:
    folder = make_run()
    edit(folder / "case.toml", "Block on a slope & <more>", "BODY of TITLE")
    page = page_of(folder)
    assert "<title>BODY of TITLE</title>" in page and page.count("<h1>") == 1
    report = make_report(Run(folder), names=["motion"], dpi=50)
    before = {path: path.read_bytes() for path in (report.page, report.figures["motion"])}
    for path in before:
        with pytest.raises(OSError, match="full"), atomic_file(path) as temporary:
            temporary.write_bytes(b"the first half")
            raise OSError("full")
        assert path.read_bytes() == before[path] and not list(path.parent.glob(".*part*"))


def test_ticks_of_powers_are_formulas(make_run: MakeRun) -> None:
    figure = plotted("energy", make_run())
    figure.draw_without_rendering()
    logarithmic = [axes for axes in figure.axes if axes.get_yscale() == "log"]
    powers = [text for axes in logarithmic for text in axes.get_yticklabels() if text.get_text()]
    assert powers and all(text.get_parse_math() for text in powers)


def test_figures_of_a_stopped_run_have_its_last_time(map_run: Path) -> None:
    update_facts(map_run, status="stopped", simulated_time_s=9.51)
    with (map_run / "case.toml").open("a") as case:
        case.write("[time]\nend = 60.0\n[report]\ntimes = [0.0, 2.0]\n")
    note = "The run was stopped at 9.51 s of 60 s. "
    extent = plotted("extent_maps", map_run)
    assert titled(extent, "(d) flow thickness at\n9.51 s (stopped)")
    assert titled(plotted("impact_maps", map_run), "(e) elevation change at 9.51 s (stopped)")
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
            {"status": "running", "simulated_time_s": 0},
            "The run terminated unexpectedly at 10 s. ",
            "10 s (terminated?)",
        ),
    ],
)
def test_notes_state_the_ending(map_run: Path, facts: dict[str, object], note: str, state: str) -> None:
    write_facts(map_run, **facts)
    run = Run(map_run)
    assert (run.end_note, run.last_state) == (note, state)


def test_a_run_whose_lock_is_held_is_running_whatever_run_json_states(map_run: Path) -> None:
    write_facts(map_run, status="running", simulated_time_s=0.0)
    with (map_run / LOCK).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run = Run(map_run)
        assert run.ending is Ending.RUNNING
        assert (run.end_note, run.last_state) == ("The run was still running at 10 s. ", "10 s (still running)")
        assert "(was still running when this page was written)" in ending_note(run)
    assert Run(map_run).ending is Ending.KILLED, "the file exists, but no process holds it"
    with (map_run / LOCK).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        for status in ("stopped", "done"):
            write_facts(map_run, status=status)
            assert Run(map_run).ending is Ending.RUNNING
        (map_run / "run.json").unlink()
        assert Run(map_run).ending is Ending.RUNNING


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
    assert not is_held(tmp_path / "pipe") and not is_held(tmp_path / "nothing")
    (tmp_path / "circle").symlink_to("circle")
    assert not is_held(tmp_path / "circle")


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
