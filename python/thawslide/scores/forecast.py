"""A forecast: the finished members of a sweep with their weights, or a single run."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError, ReportError
from thawslide.key_numbers import STOPPED_FRACTION
from thawslide.main_numbers import ARRIVED
from thawslide.run_folder import Run
from thawslide.scores.quantities import Quantity
from thawslide.sweeps.folder import DONE, PLAN, SweepFolder
from thawslide.sweeps.numbers import numbers_of_run, series_of
from thawslide.sweeps.results import TABLE, WEIGHT

MOVES = "is_moving_at_end"  # 1 if the mean speed at the end is above 1 % of its peak


@dataclass(frozen=True)
class Forecast:
    """Members in the order of their numbers, and their results by column, shape (members,), nan if not available."""

    folder: Path
    is_sweep: bool
    members: list[int]
    weights: Numbers  # sum 1
    columns: dict[str, Numbers]
    run_folders: list[Path]
    notes: list[str] = field(default_factory=list)

    def column(self, quantity: Quantity) -> Numbers:
        """Return the values of a quantity; NotInRunError if no member has one."""
        values = self.columns.get(quantity.column)
        if values is None or not np.isfinite(values).any():
            raise NotInRunError(f"no value in the column {quantity.column}")
        return values


def read_forecast(folder: Path) -> Forecast:
    """Read the members of a sweep, or a run; ReportError for another folder and without a finished member."""
    if (folder / PLAN).is_file():
        found = _sweep(SweepFolder(folder))
    elif (folder / "run.json").is_file():
        found = _run(folder)
    else:
        raise ReportError(f"{folder}: neither a sweep nor a run (no {PLAN}, no run.json). Specify such a folder.")
    columns = found.columns
    if "travel_distance_m" in columns:
        with np.errstate(divide="ignore"):
            columns.setdefault("mean_speed_m_s", columns["travel_distance_m"] / columns["duration_s"])
    if note := moving_note(found):
        found.notes.append(note)
    return found


def moving_note(found: Forecast) -> str:
    """Return a note on members that still moved at their end; empty if there are none."""
    moving = int(np.count_nonzero(found.columns.get(MOVES, 0)))
    words = f"{moving} of {len(found.members)} members still moved at their end: their travel distance and duration"
    return f"{words} are lower limits" if moving else ""


def front_duration(time: Numbers, distance: Numbers) -> float:
    """Return the time [s] from which the front is beyond 99 % of its final distance, interpolated between rows.

    nan for a front that has not advanced, or without numbers.
    """
    known = np.isfinite(distance)
    time, distance = time[known], distance[known]
    if not time.size or not distance[-1] > max(distance[0], 0.0):
        return float("nan")
    target = ARRIVED * distance[-1]
    before = np.flatnonzero(distance < target)
    if not before.size:
        return float(time[0])
    return float(np.interp(target, distance[before[-1] :][:2], time[before[-1] :][:2]))


def _sweep(folder: SweepFolder) -> Forecast:
    path = folder.path / TABLE
    if not path.is_file():
        raise ReportError(f"{path}: no such file. Repeat the command of the sweep until its members are done.")
    try:
        table = pd.read_parquet(path)
        done = table[table["status"] == DONE].sort_values("member")
        members = [int(number) for number in done["member"]]
    except (OSError, ValueError, KeyError, ImportError) as error:
        raise ReportError(f"{path}: cannot be read ({error}). Repeat the command of the sweep.") from error
    if not members:
        raise ReportError(f"{path}: no member is done. Repeat the command of the sweep.")
    numeric = done.select_dtypes("number").columns
    columns = {name: done[name].to_numpy(dtype=float, na_value=np.nan) for name in numeric}
    columns = _of_series([_read_series(folder.series_file(number)) for number in members]) | columns
    left = len(table) - len(done)
    notes = [f"{left} of {len(table)} members are not done and do not count"] if left else []
    folders = [folder.run_folder(number) for number in members]
    return Forecast(folder.path, True, members, _weights(columns, len(members), path), columns, folders, notes)


def _read_series(path: Path) -> dict[str, Numbers]:
    if not path.is_file():
        return {}
    with np.load(path, allow_pickle=False) as file:
        return {name: file[name].astype(float) for name in file.files}


def _of_series(members: list[dict[str, Numbers]]) -> dict[str, Numbers]:
    """Return the duration of each member [s], and whether it moves at its end, from its series through time."""
    none = np.full(1, np.nan)
    pairs = [(each.get("time_s", none), each.get("runout_m", none)) for each in members]
    speeds = [each.get("speed_m_s", none) for each in members]
    return {
        "duration_s": np.array([front_duration(time, distance) for time, distance in pairs]),
        MOVES: np.array([float(speed[-1] > STOPPED_FRACTION * np.nanmax(speed, initial=0.0)) for speed in speeds]),
    }


def _weights(columns: dict[str, Numbers], count: int, path: Path) -> Numbers:
    """Return the weights of the table, equal ones if it has none."""
    weights = columns.get(WEIGHT, np.ones(count))
    if not np.isfinite(weights).all() or weights.min() < 0.0 or not weights.sum() > 0.0:
        found = f"{weights.min():g} to {weights.max():g}"
        raise ReportError(
            f"{path}: {WEIGHT}: not weights (found {found}; allowed: finite numbers of at least 0, not all 0). Correct "
            "the column."
        )
    return np.asarray(weights / weights.sum())


def _run(folder: Path) -> Forecast:
    run = Run(folder, skip_damaged=True)
    if not run.is_complete:
        raise ReportError(f"{folder}: the run is not complete. Continue it: thawslide resume {folder}")
    columns = {name: np.array([value]) for name, value in numbers_of_run(run, ()).items()}
    columns = _of_series([series_of(run.series)]) | columns
    return Forecast(folder, False, [0], np.ones(1), columns, [folder])
