"""Damaged, missing and changed files of a run: `resume` repairs them or continues without them, or refuses them."""

from collections.abc import Callable
from pathlib import Path

import conftest
import h5py
import pytest
from conftest import Program, Ran, assert_identical, content_of, history, mark_killed, run_facts, sets, snapshot_files

WORDS = sets(checkpoint__interval=0.15)  # checkpoints at 0, 0.15 and 0.2 s; rows each 0.01 s, snapshots each 0.05 s


@pytest.fixture
def uninterrupted(ran: Ran) -> Path:
    return ran(*WORDS, name="uninterrupted")


@pytest.fixture
def killed(ran: Ran) -> Path:
    """Return the folder of a run that was killed after its checkpoint at 0.15 s and before the one at its end."""
    run = ran(*WORDS)
    mark_killed(run)
    (run / "checkpoint.previous.bin").rename(run / "checkpoint.bin")
    return run


def resumed(thawslide: Program, run: Path) -> list[str]:
    """Resume a run to its end; return its warnings of damage, which run.json also contains."""
    outcome = thawslide("resume", run)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stderr == ""
    lines = outcome.stdout.splitlines()
    begins = next(k for k, line in enumerate(lines) if line.startswith("continuing from t = 0.15 s"))
    notes = [line.removeprefix("warning: ") for line in lines[:begins]]  # warnings of the case follow
    assert run_facts(run)["status"] == "done" and run_facts(run)["parts"][-1]["warnings"] == notes
    return notes


def hundredths(run: Path) -> list[int]:
    return [round(100 * time) for time in history(run)["time_s"]]


# Changes of the rows of a history, the first of which is its header.
DAMAGE: dict[str, Callable[[list[str]], list[str]]] = {
    "truncated": lambda rows: rows[:6],
    "removed": lambda rows: rows[:7] + rows[9:],
    "header": lambda rows: ["\0" * 20 + "\n", *rows[1:]],
}


@pytest.mark.parametrize("name", DAMAGE)
def test_a_damaged_history_is_kept_and_starts_again(thawslide: Program, killed: Path, name: str) -> None:
    file = killed / "history.csv"
    header = file.read_text().splitlines()[0]
    file.write_text("".join(DAMAGE[name](file.read_text().splitlines(keepends=True))))
    found = file.read_bytes()
    assert resumed(thawslide, killed) == [
        "history.csv is damaged or was changed: it starts again, without the 16 rows up to t = 0.15 s; what there was "
        "is kept as history.damaged.csv"
    ]
    assert (killed / "history.damaged.csv").read_bytes() == found
    assert hundredths(killed) == list(range(16, 21)) and file.read_text().splitlines()[0] == header
    # After the report, the run continues like any other.
    mark_killed(killed)
    assert "history.csv" not in thawslide.ok("resume", killed)


def test_a_lost_history_starts_again(thawslide: Program, killed: Path) -> None:
    (killed / "history.csv").unlink()
    warning = "history.csv was missing: it starts again, without the 16 rows up to t = 0.15 s"
    assert resumed(thawslide, killed) == [warning]
    assert hundredths(killed) == list(range(16, 21))


def test_damaged_copies_are_removed_with_the_run(thawslide: Program, small_case: Path, killed: Path) -> None:
    (killed / "history.damaged.csv").write_text("an earlier one\n")
    (killed / "history.csv").write_text("")
    resumed(thawslide, killed)
    assert (killed / "history.damaged.csv").read_text() == "an earlier one\n"
    assert (killed / "history.damaged.2.csv").read_text() == ""
    thawslide.ok("run", small_case, "--output", killed, "--overwrite")
    assert not list(killed.glob("*.damaged*"))


def index_times(run: Path) -> list[float]:
    with h5py.File(run / "particles.vtkhdf") as file:
        return [round(float(time), 9) for time in file["VTKHDF/Steps/Values"][()]]


def test_a_damaged_last_snapshot_is_written_again(thawslide: Program, uninterrupted: Path, killed: Path) -> None:
    last = snapshot_files(killed)[-1]
    last.write_bytes(b"")
    assert resumed(thawslide, killed) == []
    assert_identical(uninterrupted, killed)
    assert index_times(killed) == [0, 0.05, 0.1, 0.15, 0.2]


@pytest.mark.parametrize(
    ("numbers", "words", "times"),
    [
        ([1], "000001", [0, 0.1, 0.15, 0.2]),
        ([0, 2, 3], "000000, 000002 to 000003", [0.05, 0.2]),
        ([0, 1, 2, 3], "000000 to 000003", [0.2]),
    ],
)
@pytest.mark.parametrize("is_there", [True, False])
def test_lost_earlier_snapshots_are_reported(
    thawslide: Program, uninterrupted: Path, killed: Path, numbers: list[int], words: str, times: list[float],
    is_there: bool,
) -> None:  # fmt: skip
    for number in numbers:
        file = killed / "snapshots" / f"{number:06d}.vtkhdf"
        if is_there:
            file.write_bytes(file.read_bytes()[:3000])
        else:
            file.unlink()
    assert resumed(thawslide, killed) == [
        f"of the 4 snapshots up to here these are missing or damaged: {words}; particles.vtkhdf omits them"
    ]
    assert index_times(killed) == times
    names = [f"{number:06d}.vtkhdf" for number in range(5) if is_there or number not in numbers]
    assert [file.name for file in snapshot_files(killed)] == names
    assert (killed / "history.csv").read_bytes() == (uninterrupted / "history.csv").read_bytes()


def test_a_run_without_snapshots_is_completed(thawslide: Program, done: Path) -> None:
    mark_killed(done)
    for file in snapshot_files(done):
        file.unlink()
    thawslide.ok("resume", done)
    assert not (done / "particles.vtkhdf").exists()


@pytest.mark.parametrize(
    ("text", "found"), [("", "it is empty"), ("{\n", "it is not JSON from byte 3 on"), ("{}", "key 'parts' not found")]
)
def test_a_damaged_run_json_is_reported_with_a_remedy(thawslide: Program, killed: Path, text: str, found: str) -> None:
    (killed / "run.json").write_text(text)
    for command in ("resume", "status"):
        message = thawslide.error(command, killed)
        assert message == (
            f"error: {killed / 'run.json'} is damaged: {found}. Without it, the run cannot continue. Put back a copy "
            f"of it, or run the case again into another folder: thawslide run {killed} --output OTHER.\n"
        )


@pytest.mark.parametrize(("name", "content"), [("case.toml", "other"), ("profile.csv", "no profile")])
def test_a_changed_input_is_refused_and_a_changed_original_reported(
    thawslide: Program, small_case: Path, tmp_path: Path, name: str, content: str
) -> None:
    """The original need not be that of the start, and the copy need not be valid."""
    conftest.with_profile(small_case)
    run, original = tmp_path / "run", small_case / name
    thawslide.ok("run", small_case, "--output", run)
    mark_killed(run)
    original.write_text(original.read_text() + "# a remark\n")
    warning = f"{original} has changed since the run began. The run continues with its copy, inputs/{name}\n"
    assert f"warning: {warning}" in thawslide.ok("resume", run)
    mark_killed(run)
    copy = run / "inputs" / name
    copy.write_text(content)
    assert thawslide.error("resume", run) == (
        f"error: {copy} has changed. A run continues with the inputs of its start (run.json has their SHA-256): put "
        "them back, or run the case again.\n"
    )


@pytest.mark.parametrize("name", ["snapshots", "inputs"])
def test_a_link_in_place_of_a_folder_is_refused(thawslide: Program, done: Path, tmp_path: Path, name: str) -> None:
    elsewhere = (done / name).rename(tmp_path / "elsewhere")
    (done / name).symlink_to(elsewhere)
    before = content_of(elsewhere)
    assert thawslide.error("resume", done, "--end", 0.3) == (
        f"error: {done / name} is a link; a run writes and reads its files in its own folder alone. Put the folder "
        "itself there.\n"
    )
    assert content_of(elsewhere) == before
