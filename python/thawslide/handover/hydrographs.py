"""Hydrographs at lines: discharge of the slide through probes, as inflow of flood codes."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from thawslide.arrays import Numbers
from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.run_folder import Run

_DISCHARGE = "_discharge_m3_s"


@dataclass(frozen=True)
class Hydrograph:
    """Discharge [m3/s] through a line over time [s], positive downstream."""

    name: str
    time: Numbers
    discharge: Numbers
    volume: float  # that has passed, net [m3]

    @property
    def peak(self) -> tuple[float, float]:
        """The largest discharge [m3/s] and its time [s]."""
        at = int(np.argmax(self.discharge))
        return float(self.discharge[at]), float(self.time[at])


def hydrographs(run: Run) -> list[Hydrograph]:
    """Return the hydrograph of each line among the probes of a run; ReportError without any."""
    table = run.probe_series
    names = [] if table is None else [column for column in table if column.endswith(_DISCHARGE)]
    if table is None or not names:
        raise ReportError(
            f"{run.folder}: no line to measure discharge at. Add [probe.NAME] with a `line` to the case and repeat it."
        )
    time = np.asarray(table["time_s"])
    found = []
    for column in names:
        discharge = np.asarray(table[column])
        volume = float(np.sum(0.5 * (discharge[1:] + discharge[:-1]) * np.diff(time)))
        found.append(Hydrograph(column.removesuffix(_DISCHARGE), time, discharge, volume))
    return found


def write_hydrographs(found: Sequence[Hydrograph], folder: Path) -> list[Path]:
    """Write one file NAME.csv per line, with the columns time_s and discharge_m3_s, and return the files."""
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for each in found:
        path = folder / f"{each.name}.csv"
        with atomic_file(path) as part, part.open("w", encoding="utf-8") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["time_s", "discharge_m3_s"])
            rows.writerows(zip(each.time.tolist(), each.discharge.tolist(), strict=True))
        files.append(path)
    return files
