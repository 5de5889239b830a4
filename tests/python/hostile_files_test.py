"""Files of any content: every input that fuzzing kept is answered by a value or a clear error, and soon."""

from __future__ import annotations

import os
import resource
import struct
import subprocess
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fuzz" / "python"))

from readers import CORPUS, READERS, SEED, Folder

SEEDS = sorted(CORPUS.glob(f"*/*{SEED}"))
ROOT = Path(__file__).resolve().parents[2]
SURROUNDINGS = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
SOON = 10.0  # s, on a busy machine
# What is answered by an error, and the words of it that tell what is wrong.
REFUSED = {
    "force_record/long": "a force between periods of 0.5 and 4 s over 1e+12 s takes 8e+13 samples, above 2e+07",
    "geometry/cut": "a geometry ends too early: ",
    "history/time_back": "history.csv:4: time_s is 0.5 after 1; rows must go forward in time",
    "history/uneven": "a force between periods of 2 and 8 s over 1e+09 s takes 1e+18 samples, above 2e+07",
    "layer/computed_column": "string or blob too big",
    "layer/endless_list": "no table gpkg_geometry_columns",
    "layer/endless_view": "path is no table",
    "map/huge_and_empty": "200000 x 200000 cells of float64 in blocks of 268435456; allowed: 100,000,000 cells",
    "map/huge_blocks": "in blocks of 268435456",
    "map/other_format": "not recognized as being in a supported file format",
    "snapshot/claims_memory": "cannot be read as HDF5",  # unbounded, HDF5 takes more than 20 GB for it
    "snapshot_parts/changes": "could not convert string to float: 'later'",
    "targets/utf16": "targets.csv: encoded as UTF-16; save it as UTF-8",
}


def test_every_reader_has_a_corpus() -> None:
    assert {path.parent.name for path in SEEDS} == set(READERS)
    assert set(REFUSED) <= {f"{path.parent.name}/{path.stem}" for path in SEEDS}


@pytest.mark.parametrize("seed", SEEDS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_answered_by_a_value_or_an_error(seed: Path) -> None:
    start = time.monotonic()
    told = Folder(seed.parent.name).check(seed.read_bytes())
    assert time.monotonic() - start < SOON
    expected = REFUSED.get(f"{seed.parent.name}/{seed.stem}")
    assert (expected in told) if expected is not None else (told == "" or seed.stem not in ("sound", "windows"))


@pytest.mark.parametrize(
    "reader", ["snapshot", "layer", "map", "history", "facts", "case", "targets", "force_record", "setup"]
)
def test_cut_off_anywhere(reader: str) -> None:
    """A file that ends too early: nothing but errors, and whole parts of what can be read in part."""
    folder = Folder(reader)
    whole = next(
        path for path in SEEDS if path.parent.name == reader and path.stem in ("sound", "section")
    ).read_bytes()
    for length in range(0, len(whole), max(1, len(whole) // 150)):
        folder.check(whole[:length])


@pytest.mark.parametrize("reader", ["snapshot", "layer", "map"])
def test_any_byte_wrong(reader: str) -> None:
    folder = Folder(reader)
    whole = (CORPUS / reader / f"sound{SEED}").read_bytes()
    for place in range(0, len(whole), max(1, len(whole) // 300)):
        folder.check(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])


def test_collections_without_end_are_refused() -> None:
    """Each holds one further collection: read without a bound they would fill the stack."""
    head = b"GP\0\1" + struct.pack("<i", 0)
    inside = struct.pack("<BII", 1, 7, 1) * 2000
    assert "more than 8 collections inside one another" in Folder("geometry").check(head + inside)


@pytest.mark.parametrize(
    ("reader", "text", "told"),
    [
        ("facts", '{"a":' * 5000 + "1" + "}" * 5000, "run.json: "),
        ("facts", '{"status": "done", "a": ' + "[" * 40 + "]" * 40 + "}", "run.json: more than 32 levels deep"),
        ("facts", '{"status": "done", "steps": ' + "9" * 5000 + "}", "run.json: not valid JSON: Exceeds the limit"),
        ("facts", '{"status": "sleeping"}', "run.json: status must be running, done, stopped, failed, found sleeping"),
        ("facts", "{}", "run.json: status must be running, done, stopped, failed, found None"),
        ("facts", '{"status": "done", "simulated_time_s": "2"}', "run.json: simulated_time_s must be a number, found "),
        ("facts", '{"status": "done", "drop_height_m": NaN}', "run.json: drop_height_m must be a number, found nan"),
        ("case", "a = " + "[" * 5000, "case.toml: not valid TOML"),
        ("case", "[case]\ndimension = 4\n", "case.toml: case.dimension must be 2 or 3, found 4"),
        ("case", '[case]\nwidth = "wide"\n', "case.width must be a finite number, or as many ascending x as values"),
        ("case", "[case]\nwidth = { x = [0, 1], value = [1] }\n", "case.width must be a finite number, or as many"),
        ("case", "[case]\nwidth = { x = [1, 0], value = [1, 2] }\n", "case.width must be a finite number, or as many"),
        ("case", "[case]\nwidth = { x = [0, 1], value = [1, 0] }\n", "case.width must be a finite number, or as many"),
        ("case", "case = 1\n", "case.toml: case must be a table"),
        ("case", "[report]\ntimes = [1, nan]\n", "case.toml: report.times must be a list of finite numbers"),
        ("case", "[probe.a]\npoint = [1]\n", "case.toml: probe.a.point must be a list of 2 or 3 finite numbers"),
        ("case", "[grid]\ncell = 1e-9\nmin = [0, 0]\nmax = [9, 9]\n", "a domain from 0 to 9 with cells of 1e-09"),
        ("history", "time_s,time_s\n0,0\n", "history.csv:1: two columns 'time_s'"),
        ("history", "time_s,a\n0,1_0\n", "history.csv:2: expected a number, found '1_0'"),
        ("history", "time_s,a\nnan,1\n", "history.csv:2: time_s is nan after -inf; rows must go forward in time"),
        ("terrain", "distance_m,terrain_elevation_m\n0,1\n0,2\n", "terrain.csv:3: distance_m must rise from row"),
        ("terrain", "distance_m,terrain_elevation_m\n", "terrain.csv: no rows after the header"),
        ("terrain", "distance_m,terrain_elevation_m\n0,inf\n", "terrain.csv:2: expected a finite number, found 'inf'"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named(reader: str, text: str, told: str) -> None:
    assert told in Folder(reader).check(text.encode())


def test_zero_bytes_after_a_power_cut_end_the_history(tmp_path: Path) -> None:
    folder = Folder("history")
    whole = (CORPUS / "history" / f"sound{SEED}").read_bytes()
    assert folder.check(whole + bytes(4096)) == ""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is bounded on Linux alone")
def test_memory_of_damaged_snapshots_does_not_add_up() -> None:
    """HDF5 takes half a gigabyte for each before it is refused; in a process of its own, where malloc is new."""
    program = f"""
import sys
from pathlib import Path
from thawslide.errors import ReportError
from thawslide.snapshot import Snapshot
for _ in range(8):
    try:
        Snapshot(Path({str(CORPUS / "snapshot" / f"claims_memory{SEED}")!r}))
        sys.exit("read")
    except ReportError:
        print(int(Path("/proc/self/statm").read_text().split()[0]) * {resource.getpagesize()})
"""
    told = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, env=SURROUNDINGS
    )
    assert told.returncode == 0, told.stderr
    mapped = [int(word) for word in told.stdout.split()]
    assert len(mapped) == 8
    assert max(mapped) < 2**30, mapped
