"""A run folder as Python sees it: the resolved case, the history, the terrain, the snapshots and the targets."""

from __future__ import annotations

import csv
import difflib
import json
import tomllib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from thawslide.errors import NotInRunError, ReportError

Numbers = NDArray[np.float64]


class History(Mapping[str, Numbers]):
    """The columns of history.csv or probes.csv by name, each of shape (rows,), in the unit its name ends with."""

    def __init__(self, file: str, columns: dict[str, Numbers]) -> None:
        self.file = file
        self._columns = columns
        self.rows = len(columns["time_s"])

    def __getitem__(self, name: str) -> Numbers:
        if name not in self._columns:
            near = difflib.get_close_matches(name, self._columns, 1)
            hint = f" (nearest: {near[0]})" if near else ""
            raise NotInRunError(f"{self.file} has no column {name}{hint}")
        return self._columns[name]

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)


class Snapshot(Mapping[str, NDArray[Any]]):
    """Every particle at one time: points [m] of shape (n, 3) and the fields by name, rows sorted by id.

    `base` has what each piece of base with a band column holds, by name with its unit, of shape (pieces,), and
    "position_m" of shape (pieces, 3); it is empty where the band is not of columns.
    """

    def __init__(self, path: Path, fields: Collection[str] | None = None) -> None:
        """Read one snapshot file, all its fields or those named; ReportError when it is damaged or incomplete."""
        self.path = path
        with _open_snapshot(path) as file:
            group = _snapshot_group(file, path)
            self.time = float(group.attrs["time"])
            self.step = int(group.attrs.get("step", -1))
            if "Points" not in group or "PointData" not in group:
                raise ReportError(f"{path}: snapshot without Points or PointData; it is damaged, run the case again")
            self.points: Numbers = np.asarray(group["Points"], dtype=np.float64)
            self._fields: dict[str, NDArray[Any]] = {}
            self._units: dict[str, str] = {}
            for name, data in group["PointData"].items():
                if fields is not None and name not in fields:
                    continue
                self._fields[name] = np.asarray(data)
                self._units[name] = _text(data.attrs.get("unit", ""))
            base: dict[str, h5py.Dataset] = dict(file.get("base", {}))
            self.base: dict[str, Numbers] = {name: np.asarray(base[name], dtype=np.float64) for name in base}
        for name, values in self._fields.items():
            if len(values) != len(self.points):
                raise ReportError(f"{path}: field {name} has {len(values)} rows for {len(self.points)} particles")

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._fields:
            raise NotInRunError(f"{self.path}: no field {name}; it has {', '.join(self._fields) or 'none'}")
        return self._fields[name]

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def unit(self, name: str) -> str:
        """Return the unit of a field as the file states it, "" where it states none."""
        self[name]
        return self._units[name]


@dataclass(frozen=True)
class Target:
    """One reported value to compare with, from the CSV file named in [report] targets."""

    quantity: str
    time: float  # s
    value: float  # in `unit`
    unit: str
    source: str


class Run:
    """A run folder; files are read when first asked for."""

    def __init__(self, folder: Path | str) -> None:
        """Open a run folder; ReportError when it is none."""
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise ReportError(f"{self.folder}: no such folder; give the folder a run has written, e.g. runs/lamplugh")
        absent = [name for name in ("case.toml", "history.csv") if not (self.folder / name).is_file()]
        if absent:
            raise ReportError(f"{self.folder}: not a run folder, {' and '.join(absent)} not found there")
        self.warnings: list[str] = []

    @cached_property
    def case(self) -> dict[str, Any]:
        """The resolved case file, as nested dictionaries."""
        path = self.folder / "case.toml"
        try:
            return tomllib.loads(path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ReportError(f"{path}: not valid TOML: {error}") from error

    @property
    def title(self) -> str:
        """The title of the case, or the folder's name."""
        return str(self.section("case").get("title") or self.folder.resolve().name)

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return int(self.section("case").get("dimension", 2))

    @property
    def vertical(self) -> int:
        """The column of points that is drawn upwards: y in 2D, z in 3D."""
        return 1 if self.dimension == 2 else 2

    @property
    def per_metre(self) -> bool:
        """Whether extensive columns are per metre of width: a 2D case that states no width."""
        return self.dimension == 2 and not self.section("case").get("width", 0.0)

    @property
    def report_times(self) -> list[float]:
        """The times [s] the case asks snapshot figures for; empty when it names none."""
        return [float(time) for time in self.section("report").get("times", [])]

    def section(self, name: str) -> dict[str, Any]:
        """Return one table of the case file, empty when it is not there."""
        found = self.case.get(name, {})
        return found if isinstance(found, dict) else {}

    @cached_property
    def history(self) -> History:
        """The history; a last row cut off while it was written is left out, with a warning."""
        return _read_history(self.folder / "history.csv", self.warnings)

    @property
    def has_band_columns(self) -> bool:
        """Whether the band is of columns: its figures are then means over the base by area."""
        return "band_normal_pressure_Pa" in self.history

    @cached_property
    def probes(self) -> History | None:
        """What probes saw through time, None for a run without any."""
        path = self.folder / "probes.csv"
        if not path.is_file():
            return None
        return _read_history(path, self.warnings)

    @cached_property
    def terrain(self) -> tuple[Numbers, Numbers] | None:
        """Distance and elevation [m] of the ground, or None for a run without terrain."""
        path = self.folder / "terrain.csv"
        if not path.is_file():
            return None
        rows = _read_table(path, ("distance_m", "terrain_elevation_m"))
        return (
            np.array([_number(row["distance_m"], path, line) for line, row in rows]),
            np.array([_number(row["terrain_elevation_m"], path, line) for line, row in rows]),
        )

    @cached_property
    def targets(self) -> list[Target]:
        """The reported values to compare with; empty when the case names none."""
        name = self.section("report").get("targets", "")
        if not name:
            return []
        path = self.folder / str(name)
        if not path.is_file():
            raise ReportError(f"{path}: no such file; [report] targets in {self.folder / 'case.toml'} names it")
        rows = _read_table(path, ("quantity", "time_s", "value"))
        return [
            Target(
                row["quantity"],
                _number(row["time_s"], path, line),
                _number(row["value"], path, line),
                row.get("unit", ""),
                row.get("source", ""),
            )
            for line, row in rows
        ]

    @cached_property
    def facts(self) -> dict[str, Any]:
        """What run.json says of version, machine and speed; empty when it is not there."""
        path = self.folder / "run.json"
        if not path.is_file():
            return {}
        try:
            facts = json.loads(path.read_text(encoding="utf-8"))
        except (json.JSONDecodeError, UnicodeDecodeError) as error:
            raise ReportError(f"{path}: not valid JSON: {error}") from error
        if not isinstance(facts, dict):
            raise ReportError(f"{path}: expected a JSON object")
        return facts

    @property
    def ended(self) -> bool:
        """Whether the run came to its end; one that no run.json tells of is taken to have."""
        return bool(self.facts.get("status", "done") == "done")

    @property
    def last_time(self) -> float:
        """The time [s] that the run has come to."""
        told = self.facts.get("simulated_time_s")
        running = self.facts.get("status") == "running"  # run.json is of its start
        return float(self.history["time_s"][-1] if told is None or running else told)

    @property
    def last_state(self) -> str:
        """When the last state of the run is, and how the run ended if not by itself, as "19.5 s (stopped)"."""
        status = str(self.facts.get("status", "done")).replace("running", "still running")
        return f"{self.last_time:.4g} s" + ("" if self.ended else f" ({status})")

    @property
    def end_note(self) -> str:
        """A sentence for figures of a run that did not come to its end, "" for one that did."""
        if self.ended:
            return ""
        verb = {"running": "was still running", "failed": "went bad"}.get(self.facts["status"], "was stopped")
        wanted = self.section("time").get("end")
        return f"The run {verb} at {self.last_time:.4g} s" + (f" of {wanted:g} s. " if wanted else ". ")

    @cached_property
    def snapshot_files(self) -> list[Path]:
        """The snapshot files in order of their numbers."""
        return sorted(
            (path for path in (self.folder / "snapshots").glob("*.vtkhdf") if path.stem.isdigit()),
            key=lambda path: int(path.stem),
        )

    @cached_property
    def times(self) -> Numbers:
        """The time [s] of every snapshot, shape (snapshots,)."""
        times = []
        for path in self.snapshot_files:
            with _open_snapshot(path) as file:
                times.append(float(_snapshot_group(file, path).attrs["time"]))
        return np.array(times, dtype=np.float64)

    def snapshot(
        self, index: int | None = None, *, time: float | None = None, fields: Collection[str] | None = None
    ) -> Snapshot:
        """Read one snapshot by its place in `times` (negative: from the end), or the one nearest to a time [s].

        Without `fields` all fields are read.
        """
        if (index is None) == (time is None):
            raise ValueError("give either an index or a time")
        if not self.snapshot_files:
            raise NotInRunError(f"{self.folder}: no snapshots; set [time] output_interval and run again")
        if time is not None:
            index = int(np.argmin(np.abs(self.times - time)))
        assert index is not None
        if not -len(self.snapshot_files) <= index < len(self.snapshot_files):
            raise ReportError(f"{self.folder}: no snapshot {index}; there are {len(self.snapshot_files)}")
        return Snapshot(self.snapshot_files[index], fields)


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _open_snapshot(path: Path) -> h5py.File:
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise ReportError(f"{path}: cannot be read as HDF5 ({error}); remove it or run the case again") from error


def _snapshot_group(file: h5py.File, path: Path) -> h5py.Group:
    group = file.get("VTKHDF")
    if group is None or "time" not in group.attrs:
        raise ReportError(f"{path}: not a snapshot, it has no group VTKHDF with an attribute time")
    return group


def _number(text: str, path: Path, line: int) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise ReportError(f"{path}:{line}: expected a number, found '{text}'") from error


def _read_table(path: Path, needed: tuple[str, ...]) -> list[tuple[int, dict[str, str]]]:
    """Read a CSV file with a header, lines starting with # left out, as (line number, row) pairs."""
    lines = path.read_text(encoding="utf-8").splitlines()
    kept = [(number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if not kept:
        raise ReportError(f"{path}: empty; expected the columns {', '.join(needed)}")
    header = [name.strip() for name in next(csv.reader([kept[0][1]]))]
    for name in needed:
        if name not in header:
            raise ReportError(f"{path}:{kept[0][0]}: no column {name}; found {', '.join(header)}")
    rows = []
    for number, line in kept[1:]:
        cells = [cell.strip() for cell in next(csv.reader([line]))]
        if len(cells) != len(header):
            raise ReportError(f"{path}:{number}: {len(cells)} values for {len(header)} columns")
        rows.append((number, dict(zip(header, cells, strict=True))))
    return rows


def _read_history(path: Path, warnings: list[str]) -> History:
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    if lines and not text.endswith("\n"):  # a row is one write: without its end it was cut off
        lines.pop()
        warnings.append(f"{path}: the last row was cut off and is left out")
    if not lines:
        raise ReportError(f"{path}: empty; the run has not written its first row")
    names = lines[0].split(",")
    if "time_s" not in names:
        raise ReportError(f"{path}:1: no column time_s; this is not the history of a run")
    if len(lines) == 1:
        raise ReportError(f"{path}: no rows after the header; the run has not written its first row")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        cells = line.split(",")
        if len(cells) != len(names):
            raise ReportError(f"{path}:{number}: {len(cells)} values for {len(names)} columns")
        rows.append([_number(cell, path, number) for cell in cells])
    table = np.array(rows, dtype=np.float64)
    return History(path.name, {name: table[:, place] for place, name in enumerate(names)})
