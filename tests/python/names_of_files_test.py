"""Names of files of a run: files that the simulator removes with a run, temporary files, and other kinds of files."""

import os
import re
from pathlib import Path

import pytest
from conftest import MakeRun

from thawslide import Run, Snapshot
from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.figures import FIGURES
from thawslide.maps import read_map
from thawslide.report_page import make_report

ROOT = Path(__file__).resolve().parents[2]


def names_in(list_name: str) -> set[str]:
    text = (ROOT / "src" / "io" / "run_files.cpp").read_text()
    found = re.search(rf"\b{list_name}\[\] = {{(.*?)}};", text, re.DOTALL)
    assert found
    return set(re.findall(r'"(\w+)"', found[1]))


def test_simulator_has_all_names_of_figures_and_maps() -> None:
    assert names_in("figures_of_a_run") == set(FIGURES)
    source = (ROOT / "src" / "sim" / "maps" / "map_kinds.cpp").read_text()
    kinds = set(re.findall(r'^ +{"(\w+)", "', source, re.MULTILINE))
    assert len(kinds) >= 10
    assert names_in("maps_of_a_run") == kinds | {"terrain", "release", "ground"}


def test_temporary_files_of_two_reports_do_not_collide(tmp_path: Path) -> None:
    """The first name is that of another process."""
    path = tmp_path / "motion.png"
    of_another = tmp_path / ".motion.1.thawslide-part.png"
    of_another.write_text("the other")
    with atomic_file(path) as temporary:
        assert temporary.name == f".motion.{os.getpid()}.thawslide-part.png"
        temporary.write_text("new")
    assert path.read_text() == "new" and of_another.read_text() == "the other"


def test_link_in_place_of_a_temporary_file_is_not_followed(tmp_path: Path) -> None:
    victim = tmp_path / "victim"
    victim.write_text("mine")
    (tmp_path / f".motion.{os.getpid()}.thawslide-part.png").symlink_to(victim)
    with atomic_file(tmp_path / "motion.png") as temporary:
        temporary.write_text("new")
    assert victim.read_text() == "mine" and not (tmp_path / "motion.png").is_symlink()


@pytest.mark.parametrize("what", ["pipe", "/dev/zero"])
def test_pipes_and_devices_do_not_block_readers(make_run: MakeRun, tmp_path: Path, what: str) -> None:
    folder = make_run()
    os.mkfifo(tmp_path / "pipe")
    file = folder / "snapshots" / "000003.vtkhdf"
    file.unlink()
    file.symlink_to(tmp_path / what)
    with pytest.raises(ReportError, match=r"000003\.vtkhdf: not a file\. Remove it"):
        Snapshot(file)
    with pytest.raises(ReportError, match=r"000003\.vtkhdf: not a file\. Repeat the run"):
        read_map(file)
    assert 3.0 not in Run(folder, skip_damaged=True).times
    page = make_report(Run(folder, skip_damaged=True), names=["velocity"], dpi=50).page
    assert "000003.vtkhdf: not a file" in page.read_text(encoding="utf-8")
