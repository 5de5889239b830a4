"""Files of any content: each input of the fuzzing corpus gives a value or an error within a time limit."""

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
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "python")}
TIME_LIMIT = 10.0  # s, on a busy machine
# Inputs with errors, and words of the messages.
ERRORS = {
    "force_record/long": "band-pass 0.5 to 4 s over 1e+12 s: too many samples (found 8e+13; allowed 20,000,000)",
    "geometry/cut": "a geometry ends too early: ",
    "history/time_back": "history.csv:4: time_s does not increase (found 0.5 after 1)",
    "history/uneven": "band-pass 2 to 8 s over 1e+09 s: too many samples (found 1e+18; allowed 20,000,000)",
    "layer/computed_column": "string or blob too big",
    "layer/endless_list": "no table gpkg_geometry_columns",
    "layer/endless_view": "path is no table",
    "map/huge_and_empty": "200000 x 200000 cells of float64 in blocks of 268,435,456; allowed 100,000,000 cells",
    "map/huge_blocks": "in blocks of 268,435,456",
    "map/other_format": "not recognized as being in a supported file format",
    "snapshot/claims_memory": "cannot be read as HDF5",  # without a limit, HDF5 allocates more than 20 GB
    "snapshot_parts/changes": "could not convert string to float: 'later'",
    "targets/utf16": "targets.csv: encoded as UTF-16; save it as UTF-8",
}


def test_every_reader_has_a_corpus() -> None:
    assert {path.parent.name for path in SEEDS} == set(READERS)
    assert set(ERRORS) <= {f"{path.parent.name}/{path.stem}" for path in SEEDS}


@pytest.mark.parametrize("seed", SEEDS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_inputs_of_the_corpus_give_a_value_or_an_error(seed: Path) -> None:
    start = time.monotonic()
    errors = Folder(seed.parent.name).check(seed.read_bytes())
    assert time.monotonic() - start < TIME_LIMIT
    expected = ERRORS.get(f"{seed.parent.name}/{seed.stem}")
    assert (expected in errors) if expected is not None else (errors == "" or seed.stem not in ("sound", "windows"))


@pytest.mark.parametrize(
    "reader", ["snapshot", "layer", "map", "history", "facts", "case", "targets", "force_record", "setup"]
)
def test_incomplete_files_give_a_value_or_an_error(reader: str) -> None:
    folder = Folder(reader)
    whole = next(
        path for path in SEEDS if path.parent.name == reader and path.stem in ("sound", "section")
    ).read_bytes()
    for length in range(0, len(whole), max(1, len(whole) // 150)):
        folder.check(whole[:length])


@pytest.mark.parametrize("reader", ["snapshot", "layer", "map"])
def test_wrong_bytes_give_a_value_or_an_error(reader: str) -> None:
    folder = Folder(reader)
    whole = (CORPUS / reader / f"sound{SEED}").read_bytes()
    for place in range(0, len(whole), max(1, len(whole) // 300)):
        folder.check(whole[:place] + bytes([whole[place] ^ 0xFF]) + whole[place + 1 :])


def test_deeply_nested_collections_are_errors() -> None:
    """Without a limit, nested collections would overflow the stack."""
    head = b"GP\0\1" + struct.pack("<i", 0)
    inside = struct.pack("<BII", 1, 7, 1) * 2000
    assert "more than 8 nested collections" in Folder("geometry").check(head + inside)


@pytest.mark.parametrize(
    ("reader", "text", "message"),
    [
        ("facts", '{"a":' * 5000 + "1" + "}" * 5000, "run.json: "),
        ("facts", '{"status": "done", "a": ' + "[" * 40 + "]" * 40 + "}", "run.json: too deeply nested (allowed 32"),
        ("facts", '{"status": "done", "steps": ' + "9" * 5000 + "}", "run.json: not valid JSON (Exceeds the limit"),
        ("facts", '{"status": "sleeping"}', "run.json: status: invalid value (found sleeping; allowed running, "),
        ("facts", "{}", "run.json: status: invalid value (found None; allowed running, done, "),
        ("facts", '{"status": "done", "simulated_time_s": "2"}', "run.json: simulated_time_s: not a number (found 2)"),
        ("facts", '{"status": "done", "drop_height_m": NaN}', "run.json: drop_height_m: not a number (found nan)"),
        ("case", "a = " + "[" * 5000, "case.toml: not valid TOML"),
        ("case", "[case]\ndimension = 4\n", "case.toml: case.dimension: invalid value (found 4; allowed 2 or 3)"),
        ("case", '[case]\nwidth = "wide"\n', "width: invalid value (found wide; allowed a finite number, or as many"),
        ("case", "[case]\nwidth = { x = [0, 1], value = [1] }\n", "case.width: invalid value (found {"),
        ("case", "[case]\nwidth = { x = [1, 0], value = [1, 2] }\n", "case.width: invalid value (found {"),
        ("case", "[case]\nwidth = { x = [0, 1], value = [1, 0] }\n", "case.width: invalid value (found {"),
        ("case", "case = 1\n", "case.toml: case: not a table. Repeat the run."),
        ("case", "[report]\ntimes = [1, nan]\n", "report.times: invalid value (found [1, nan]; allowed a list"),
        ("case", "[probe.a]\npoint = [1]\n", "probe.a.point: invalid value (found [1]; allowed a list"),
        ("case", "[grid]\ncell = 1e-9\nmin = [0, 0]\nmax = [9, 9]\n", "grid: invalid domain (found 0 to 9 with cells"),
        ("history", "time_s,time_s\n0,0\n", "history.csv:1: duplicate column 'time_s'"),
        ("history", "time_s,a\n0,1_0\n", "history.csv:2: expected a number, found '1_0'"),
        ("history", "time_s,a\nnan,1\n", "history.csv:2: time_s does not increase (found nan after -inf)"),
        ("terrain", "distance_m,terrain_elevation_m\n0,1\n0,2\n", "terrain.csv:3: distance_m does not increase"),
        ("terrain", "distance_m,terrain_elevation_m\n", "terrain.csv: no rows after the header"),
        ("terrain", "distance_m,terrain_elevation_m\n0,inf\n", "terrain.csv:2: expected a finite number, found 'inf'"),
    ],
)  # fmt: skip
def test_messages_name_the_error(reader: str, text: str, message: str) -> None:
    assert message in Folder(reader).check(text.encode())


def test_zero_bytes_end_the_history(tmp_path: Path) -> None:
    folder = Folder("history")
    whole = (CORPUS / "history" / f"sound{SEED}").read_bytes()
    assert folder.check(whole + bytes(4096)) == ""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited on Linux only")
def test_memory_of_damaged_snapshots_is_released() -> None:
    """HDF5 allocates half a gigabyte for each; a separate process has a new heap."""
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
    finished = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, env=ENVIRONMENT
    )
    assert finished.returncode == 0, finished.stderr
    mapped = [int(word) for word in finished.stdout.split()]
    assert len(mapped) == 8
    assert max(mapped) < 2**30, mapped
