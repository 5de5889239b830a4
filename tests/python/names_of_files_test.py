"""Names of a run's files: what goes with a run that is replaced, parts of files, and what is no file."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from conftest import MakeRun

from thawslide import Run, Snapshot
from thawslide.errors import ReportError
from thawslide.figures import FIGURES
from thawslide.maps import read_map
from thawslide.report import make_report
from thawslide.whole_file import written_whole

ROOT = Path(__file__).resolve().parents[2]


def names_in(list_name: str) -> set[str]:
    """Return the names in a list of src/io/run_files.cpp."""
    text = (ROOT / "src" / "io" / "run_files.cpp").read_text()
    found = re.search(rf"\b{list_name}\[\] = {{(.*?)}};", text, re.DOTALL)
    assert found
    return set(re.findall(r'"(\w+)"', found[1]))


def test_figures_are_known() -> None:
    assert names_in("figures_of_a_run") == set(FIGURES)


def test_maps_are_known() -> None:
    kinds = set(re.findall(r'^ +{"(\w+)", "', (ROOT / "src" / "sim" / "map_kinds.cpp").read_text(), re.MULTILINE))
    assert len(kinds) >= 10
    assert names_in("maps_of_a_run") == kinds | {"terrain", "release"}


def test_two_reports_at_once_take_no_file_from_each_other(tmp_path: Path) -> None:
    """Of another process, as whose the first name is told."""
    path = tmp_path / "motion.png"
    of_another = tmp_path / ".motion.1.thawslide-part.png"
    of_another.write_text("the other")
    with written_whole(path) as beside:
        assert beside.name == f".motion.{os.getpid()}.thawslide-part.png"
        beside.write_text("ours")
    assert path.read_text() == "ours" and of_another.read_text() == "the other"


def test_a_link_in_the_place_of_a_part_is_not_followed(tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    victim.write_text("mine")
    (tmp_path / f".motion.{os.getpid()}.thawslide-part.png").symlink_to(victim)
    with written_whole(tmp_path / "motion.png") as beside:
        beside.write_text("ours")
    assert victim.read_text() == "mine" and not (tmp_path / "motion.png").is_symlink()


@pytest.mark.parametrize("what", ["pipe", "/dev/zero"])
def test_pipes_and_devices_keep_no_reader_waiting(make_run: MakeRun, tmp_path: Path, what: str) -> None:
    folder = make_run()
    os.mkfifo(tmp_path / "pipe")
    file = folder / "snapshots" / "000003.vtkhdf"
    file.unlink()
    file.symlink_to(tmp_path / what)
    with pytest.raises(ReportError, match=r"000003\.vtkhdf: not a file; it is damaged"):
        Snapshot(file)
    with pytest.raises(ReportError, match=r"000003\.vtkhdf: not a file; run the case again"):
        read_map(file)
    assert 3.0 not in Run(folder, leave_out_damaged=True).times
    page = make_report(Run(folder, leave_out_damaged=True), names=["velocity"], dpi=50).page
    assert "000003.vtkhdf: not a file" in page.read_text(encoding="utf-8")
