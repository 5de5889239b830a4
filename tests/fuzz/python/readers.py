"""What the Python package reads, each reader with the file it reads: a value or a ReportError, whatever the bytes.

`check` is called by fuzz.py with bytes of the fuzzer, and by tests/python/hostile_files_test.py with those in corpus/.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import built_snapshot

from thawslide.errors import ReportError
from thawslide.figures.force_record import caption, compared
from thawslide.geopackage import geometry_parts, read_layer
from thawslide.key_numbers import boiling_note, found_for, key_numbers
from thawslide.maps import read_map
from thawslide.report import ending_note, facts_of
from thawslide.run import Run
from thawslide.setup_picture import read_setup
from thawslide.snapshot import Snapshot, snapshot_time

CORPUS = Path(__file__).resolve().parent / "corpus"
SEED = ".seed"  # how the names of files in it end

_CASE = """[case]
title = "Slope"
dimension = 2
width = 10.0
[grid]
cell = 2.0
min = [0.0, 0.0]
max = [200.0, 150.0]
[report]
times = [0.0, 1.0]
targets = "inputs/targets.csv"
force_record = "inputs/force.csv"
force_periods = [0.5, 4.0]
"""
_HISTORY = (
    "time_s,mean_velocity_m_s,mean_displacement_m,runout_m,band_saturation,seismic_force_x_N,seismic_force_y_N,"
    "front_position_m\n0,0,0,40,nan,nan,nan,40\n1,2,1,41,0.1,1e9,1e9,41\n2,0,2,42,0.2,-1e9,-1e9,42\n"
)
_FORCE = "time_s,up_N,north_N,east_N\n0,1e9,-1e9,0\n1,2e9,-1e9,0\n2,-1e9,2e9,0\n"
_TARGETS = "quantity,time_s,value,unit,source\nmean_displacement,1,0.6,km,x\nmax_seismic_force_2_8_s,1,1,GN,x\n"


def _history(folder: Path) -> None:
    run = Run(folder)
    key_numbers(run)
    boiling_note(run)
    for target in run.targets:
        found_for(run, target)


def _facts(folder: Path) -> None:
    run = Run(folder)
    facts_of(run.facts)
    ending_note(run)
    _ = run.end_note, run.last_state
    key_numbers(run)


def _case(folder: Path) -> None:
    run = Run(folder)
    _ = run.title, run.dimension, run.per_metre, run.report_times, run.targets, run.end_note


def _force_record(folder: Path) -> None:
    run = Run(folder)
    compared(run)
    caption(run)


def _snapshot(folder: Path) -> None:
    snapshot_time(folder / "0.vtkhdf")
    Snapshot(folder / "0.vtkhdf")


def _geometry(folder: Path) -> None:
    try:
        geometry_parts((folder / "geometry").read_bytes())
    except ValueError as error:  # what read_layer, whose part it is, tells of a geometry
        raise ReportError(str(error)) from error


@dataclass(frozen=True)
class Reader:
    """A file in a run folder, what reads it there, and what makes its bytes of the fuzzer's where these are not it."""

    file: str
    read: Callable[[Path], object]
    build: Callable[[bytes, Path], object] = lambda data, path: path.write_bytes(data)


READERS = {
    "case": Reader("case.toml", _case),
    "facts": Reader("run.json", _facts),
    "force_record": Reader("inputs/force.csv", _force_record),
    "geometry": Reader("geometry", _geometry),
    "history": Reader("history.csv", _history),
    "layer": Reader("results.gpkg", lambda folder: read_layer(folder / "results.gpkg", "path")),
    "map": Reader("map.tif", lambda folder: read_map(folder / "map.tif")),
    "probes": Reader("probes.csv", lambda folder: Run(folder).probes),
    "setup": Reader("setup.json", lambda folder: read_setup(folder / "setup.json")),
    "snapshot": Reader("0.vtkhdf", _snapshot),
    "snapshot_parts": Reader("0.vtkhdf", _snapshot, built_snapshot.build),
    "targets": Reader("inputs/targets.csv", _history),
    "terrain": Reader("terrain.csv", lambda folder: Run(folder).terrain),
}


def write_run(folder: Path) -> None:
    """Write the text files of a small sound run."""
    (folder / "inputs").mkdir()
    (folder / "case.toml").write_text(_CASE)
    (folder / "history.csv").write_text(_HISTORY)
    (folder / "inputs" / "targets.csv").write_text(_TARGETS)
    (folder / "inputs" / "force.csv").write_text(_FORCE)
    (folder / "run.json").write_text(json.dumps({"status": "done", "simulated_time_s": 2.0}))


class Folder:
    """A run folder in which one file is written again for each input."""

    def __init__(self, name: str) -> None:
        """Make the folder, in memory where the system has such a place."""
        self.reader = READERS[name]
        memory = Path("/dev/shm")
        self._made = tempfile.TemporaryDirectory(prefix="thawslide-", dir=memory if memory.is_dir() else None)
        self.path = Path(self._made.name)
        write_run(self.path)

    def check(self, data: bytes) -> str:
        """Read what these bytes make; return the text of the error, "" for none. What is no ReportError comes out."""
        (self.path / self.reader.file).unlink(missing_ok=True)
        self.reader.build(data, self.path / self.reader.file)
        try:
            self.reader.read(self.path)
        except ReportError as error:
            return str(error)
        return ""
