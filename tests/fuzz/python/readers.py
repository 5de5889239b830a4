"""Files of users that the Python package reads: each reader returns a value or raises a ReportError for any bytes.

`check` is called by fuzz.py with bytes of the fuzzer, and by tests/python/hostile_files_test.py with those in corpus/.
"""

import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from thawslide.errors import ReportError
from thawslide.figures.force_record import caption, compared
from thawslide.key_numbers import found_for
from thawslide.run_folder import Run

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


def _targets(folder: Path) -> None:
    run = Run(folder)
    for target in run.targets:
        found_for(run, target)


def _force_record(folder: Path) -> None:
    run = Run(folder)
    compared(run)
    caption(run)


@dataclass(frozen=True)
class Reader:
    """A file in a run folder, and its reader."""

    file: str
    read: Callable[[Path], object]


READERS = {"force_record": Reader("inputs/force.csv", _force_record), "targets": Reader("inputs/targets.csv", _targets)}


def write_run(folder: Path) -> None:
    """Write the text files of a small valid run."""
    (folder / "inputs").mkdir()
    (folder / "case.toml").write_text(_CASE)
    (folder / "history.csv").write_text(_HISTORY)
    (folder / "inputs" / "targets.csv").write_text(_TARGETS)
    (folder / "inputs" / "force.csv").write_text(_FORCE)
    (folder / "run.json").write_text(json.dumps({"status": "done", "simulated_time_s": 2.0}))


class Folder:
    """A run folder in which one file is written again for each input."""

    def __init__(self, reader: Reader) -> None:
        """Create the folder, in memory if the system has a memory file system."""
        self.reader = reader
        memory = Path("/dev/shm")
        self._made = tempfile.TemporaryDirectory(prefix="thawslide-", dir=memory if memory.is_dir() else None)
        self.path = Path(self._made.name)
        write_run(self.path)

    def check(self, data: bytes) -> str:
        """Read a file with these bytes; return the text of the ReportError, "" for none. Raise other exceptions."""
        (self.path / self.reader.file).write_bytes(data)
        try:
            self.reader.read(self.path)
        except ReportError as error:
            return str(error)
        return ""
