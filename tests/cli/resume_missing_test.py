"""Files that a run wrote at its start, and that are gone when it goes on."""

from __future__ import annotations

from pathlib import Path

from conftest import LAMPLUGH, Program, sets
from faults import as_killed


def test_what_stands_from_the_start_is_written_again(thawslide: Program, done: Path) -> None:
    as_killed(done)
    ground = (done / "terrain.csv").read_bytes()
    (done / "terrain.csv").unlink()
    assert thawslide("resume", done).returncode == 0
    assert (done / "terrain.csv").read_bytes() == ground


def test_maps_of_the_ground_are_written_again(thawslide: Program, tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = sets(grid__cell=60, time__end=0.1, time__output_interval=0.1)
    assert thawslide("run", LAMPLUGH.parent / "valley3d", "--output", run, *words).returncode == 0
    names = ("terrain.tif", "release.tif", "release.qml")
    maps = {name: (run / "maps" / name).read_bytes() for name in names}
    for name in names:
        as_killed(run)
        (run / "maps" / name).unlink()
        outcome = thawslide("resume", run)
        assert outcome.returncode == 0, outcome.stderr
        assert {each: (run / "maps" / each).read_bytes() for each in names} == maps
