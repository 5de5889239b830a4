"""Links, pipes, folders and foreign files in place of a run's files: nothing outside changes, nothing blocks."""

import os
from pathlib import Path

import pytest
from conftest import Program, Ran, Slope, sets
from faults import before_its_first_checkpoint
from terrain_files import SOUTH, WEST

NO_FILE = "a regular file is needed. Replace it by the file itself, or remove it.\n"


def test_a_3d_run_keeps_other_files(
    ran: Ran, thawslide: Program, small_case: Path, tmp_path: Path, slope: Slope
) -> None:
    """A link in place of probes is replaced; a replaced run is removed with all its maps, and no others."""
    folder, victim = tmp_path / "slide", tmp_path / "victim"
    victim.write_text("mine\n")
    slope.ok()
    with (folder / "case.toml").open("a") as case:
        case.write(f"\n[probe.gauge]\npoint = [{WEST + 330.0}, {SOUTH + 300.0}]\n")
    words = sets(time__end=0.2, time__output_interval=0.1)
    run = ran(*words, case=folder)
    before_its_first_checkpoint(run)
    (run / "probes.csv").unlink()
    (run / "probes.csv").symlink_to(victim)
    thawslide.ok("resume", run)
    assert victim.read_text() == "mine\n" and not (run / "probes.csv").is_symlink()
    assert len(list((run / "maps").iterdir())) > 20
    alps = run / "maps" / "alps.tif"
    alps.write_text("mine\n")
    thawslide.ok("run", small_case, "--output", run, "--overwrite")
    assert list((run / "maps").iterdir()) == [alps] and not (run / "probes.csv").exists()
    alps.unlink()
    (run / "maps").rmdir()
    assert sorted(path.name for path in (run / "inputs").iterdir()) == ["case.toml"]


@pytest.mark.parametrize(("name", "kind"), [("pipe", "a pipe"), ("/dev/zero", "a device")])
@pytest.mark.parametrize("file", ["run.json", "case.toml", "history.csv", "checkpoint.bin"])
def test_pipes_do_not_block(thawslide: Program, killed: Path, tmp_path: Path, file: str, name: str, kind: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    (killed / file).unlink()
    (killed / file).symlink_to(tmp_path / name)  # an absolute name replaces tmp_path
    status, resume = thawslide("status", killed), thawslide("resume", killed)
    if file == "checkpoint.bin":
        assert (status.returncode, resume.returncode) == (0, 0), resume.stderr
        assert f"warning: {killed / file} is {kind}, no file; it is kept as " in resume.stdout
        return
    assert resume.returncode == 2
    assert f"{killed / file} is {kind}" in resume.stderr
    assert status.returncode == (2 if file == "run.json" else 0)
    assert f"{killed / file} is {kind}" in status.stdout + status.stderr


def test_status_works_with_an_unreadable_history(thawslide: Program, killed: Path) -> None:
    rows = killed / "history.csv"
    rows.unlink()
    rows.mkdir()
    outcome = thawslide("status", killed)
    assert (outcome.returncode, outcome.stderr) == (0, "")
    first, second, third, fourth, fifth = outcome.stdout.splitlines(keepends=True)
    reason = "the process was killed, the machine stopped, or the disk was full"
    assert first == f"{killed}: terminated unexpectedly: {reason}\n"
    assert second == "  0.2 of 0.2 s simulated (100 %)\n"
    assert third == f"  it may have come further: {rows} is a folder; {NO_FILE}"
    assert fourth.startswith("  last checkpoint ") and fifth == f"  to continue: thawslide resume {killed}\n"
    assert thawslide.json("status", killed)["state"] == "killed"
