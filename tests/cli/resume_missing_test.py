"""Files written at the start of a run and missing when it is resumed."""

from __future__ import annotations

from pathlib import Path

from conftest import LAMPLUGH, Program, sets
from faults import mark_killed


def test_a_missing_terrain_file_is_written_again(thawslide: Program, done: Path) -> None:
    mark_killed(done)
    ground = (done / "terrain.csv").read_bytes()
    (done / "terrain.csv").unlink()
    assert thawslide("resume", done).returncode == 0
    assert (done / "terrain.csv").read_bytes() == ground


def test_missing_maps_of_the_terrain_are_written_again(thawslide: Program, tmp_path: Path) -> None:
    run = tmp_path / "run"
    words = sets(grid__cell=60, time__end=0.1, time__output_interval=0.1)
    assert thawslide("run", LAMPLUGH.parent / "valley3d", "--output", run, *words).returncode == 0
    names = ("terrain.tif", "release.tif", "release.qml")
    maps = {name: (run / "maps" / name).read_bytes() for name in names}
    for name in names:
        mark_killed(run)
        (run / "maps" / name).unlink()
        outcome = thawslide("resume", run)
        assert outcome.returncode == 0, outcome.stderr
        assert {each: (run / "maps" / each).read_bytes() for each in names} == maps
