"""A run folder as Python sees it: the resolved case, the history, the terrain, the snapshots and the targets."""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from thawslide.arrays import Numbers
from thawslide.clock import Clock, clock_of
from thawslide.errors import NotInRunError, ReportError, printable, quoted
from thawslide.force_record import ForceRecord, read_force_record
from thawslide.history import History, read_history
from thawslide.resolved_case import Case, read_case
from thawslide.run_facts import Ending, ending_of, read_facts
from thawslide.snapshot import Snapshot, snapshot_time
from thawslide.targets import Band, Target, read_targets
from thawslide.text_files import finite_number, is_file, read_table

__all__ = ["History", "Numbers", "Run", "Snapshot", "Target"]

_HOW = {
    Ending.RUNNING: ("still running", "was still running"),
    Ending.KILLED: ("killed?", "stopped without a word"),
    Ending.UNTOLD: ("running or killed", "was running or killed"),
    Ending.STOPPED: ("stopped", "was stopped"),
    Ending.FAILED: ("failed", "failed"),
}  # in brackets behind a time, and as a verb


class Run:
    """A run folder; files are read when first asked for."""

    def __init__(self, folder: Path | str, leave_out_damaged: bool = False) -> None:
        """Open a run folder; ReportError when it is none.

        A damaged snapshot is an error, or left out with a warning.
        """
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise ReportError(f"{self.folder}: no such folder; give the folder a run has written, e.g. runs/lamplugh")
        absent = [name for name in ("case.toml", "history.csv") if not is_file(self.folder / name)]
        if absent:
            raise ReportError(f"{self.folder}: not a run folder, {' and '.join(absent)} not found there")
        self.warnings: list[str] = []
        self._leave_out_damaged = leave_out_damaged

    @cached_property
    def case(self) -> Case:
        """The resolved case file, as nested dictionaries."""
        return read_case(self.folder / "case.toml")

    @property
    def title(self) -> str:
        """The title of the case, or the folder's name."""
        return printable(str(self.section("case").get("title") or self.folder.resolve().name))

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
        return self.dimension == 2 and not self.width

    @property
    def width(self) -> float:
        """The width [m] of a 2D case that extensive columns are multiplied by; 0: none. Volumes are per metre of it."""
        width = self.section("case").get("width", 0.0)
        return float(width["value"][0] if isinstance(width, dict) else width)

    def section_areas(self, shot: Snapshot) -> Numbers:
        """Return the area [m2] of each particle of a 2D run in the section: its volume over the width there."""
        volume = np.asarray(shot["volume"], dtype=np.float64)
        return np.asarray(volume / self.relative_width(shot.points[:, 0]))

    def relative_width(self, x: Numbers) -> Numbers:
        """Return the width of the section at places x [m] over `width`, 1 where it does not vary."""
        width = self.section("case").get("width", 0.0)
        if not isinstance(width, dict):
            return np.ones_like(x)
        return np.asarray(np.interp(x, width["x"], width["value"]) / width["value"][0])

    @property
    def report_times(self) -> list[float]:
        """The times [s] the case asks snapshot figures for; empty when it names none."""
        return [float(time) for time in self.section("report").get("times", [])]

    def section(self, name: str) -> dict[str, Any]:
        """Return one table of the case file, empty when it is not there."""
        return dict(self.case.get(name, {}))

    @cached_property
    def history(self) -> History:
        """The history; a last row cut off while it was written is left out, with a warning."""
        return read_history(self.folder / "history.csv", self.warnings)

    @cached_property
    def clock(self) -> Clock:
        """The clock of all figures."""
        return clock_of(self)

    @property
    def shown_time(self) -> Numbers:
        """The time [s] of each row of the history on the clock of all figures."""
        return self.history["time_s"] + self.clock.shift

    @property
    def has_band_columns(self) -> bool:
        """Whether the band is of columns: its figures are then means over the base by area."""
        return "band_normal_pressure_Pa" in self.history

    @cached_property
    def probes(self) -> History | None:
        """What probes saw through time, None for a run without any."""
        path = self.folder / "probes.csv"
        if not is_file(path):
            return None
        return read_history(path, self.warnings)

    @cached_property
    def terrain(self) -> tuple[Numbers, Numbers] | None:
        """Distance and elevation [m] of the ground, or None for a run without terrain."""
        path = self.folder / "terrain.csv"
        if not is_file(path):
            return None
        rows = read_table(path, ("distance_m", "terrain_elevation_m")).rows
        if not rows:
            raise ReportError(f"{path}: no rows after the header")
        distance, height = (
            np.array([finite_number(row[name], f"{path}:{line}") for line, row in rows])
            for name in ("distance_m", "terrain_elevation_m")
        )
        back = np.flatnonzero(np.diff(distance) <= 0.0)
        if back.size:
            raise ReportError(f"{path}:{rows[int(back[0]) + 1][0]}: distance_m must rise from row to row")
        return distance, height

    @cached_property
    def targets(self) -> list[Target]:
        """The reported values to compare with; empty when the case names none."""
        path = self._report_file("targets")
        return read_targets(path) if path else []

    @cached_property
    def force_record(self) -> ForceRecord | None:
        """The force inverted from seismic waves to compare with, None when the case names none."""
        path, report = self._report_file("force_record"), self.section("report")
        if path is None:
            return None
        if "force_periods" not in report:
            case = self.folder / "case.toml"
            raise ReportError(f"{case}: [report] force_record needs force_periods. Add the periods of its waves [s].")
        return read_force_record(path, Band(*map(float, report["force_periods"])), str(report.get("force_source", "")))

    def _report_file(self, key: str) -> Path | None:
        """Return the file in the run folder that a key of [report] names, None for no file."""
        name = str(self.section("report").get(key, ""))
        if not name:
            return None
        path, case = self.folder / name, self.folder / "case.toml"
        try:
            within, there = path.resolve().is_relative_to(self.folder.resolve()), path.is_file()
        except (OSError, RuntimeError, ValueError) as error:  # too long; links that lead round in a circle; a zero byte
            raise ReportError(f"{case}: [report] {key} {quoted(name)} cannot be read") from error
        if not within:
            raise ReportError(f"{case}: [report] {key} names {path}, outside the run folder")
        if not there:
            raise ReportError(f"{path}: no such file; [report] {key} in {case} names it")
        return path

    @cached_property
    def facts(self) -> dict[str, Any]:
        """What run.json says of version, machine and speed; empty when it is not there."""
        return read_facts(self.folder / "run.json")

    @cached_property
    def ending(self) -> Ending:
        """How the run ended, if it has."""
        return ending_of(self.folder, self.facts)

    @property
    def ended(self) -> bool:
        """Whether the run came to its end; one that no run.json tells of is taken to have, and its page says so."""
        return self.ending in (Ending.DONE, Ending.UNKNOWN)

    @property
    def last_time(self) -> float:
        """The time [s] that the run has come to."""
        told = self.facts.get("simulated_time_s")
        of_its_start = self.ending in (Ending.RUNNING, Ending.KILLED, Ending.UNTOLD)  # run.json is
        return float(self.history["time_s"][-1] if told is None or of_its_start else told)

    @property
    def moves_at_end(self) -> bool:
        """Whether the slide was not at rest at the end of the run, as run.json has it."""
        return self.facts.get("at_rest") is False

    @property
    def rest_since(self) -> float:
        """Time of the run since which the slide has been at rest [s]; inf if it is not."""
        since = self.facts.get("rest_since_s")
        return float(since) if self.facts.get("at_rest") is True and since is not None else float("inf")

    def titled(self, words: str) -> str:
        """Return the title of a figure of the whole run, which names the time if the slide is not at rest."""
        return f"{self.title}: {words}" + (f", up to {self.last_state}" if self.ended and self.moves_at_end else "")

    @property
    def last_state(self) -> str:
        """When the last state of the run is, and what keeps it from being a deposit, as "19.5 s (stopped)"."""
        how = _HOW[self.ending][0] if not self.ended else "not at rest" if self.moves_at_end else ""
        return f"{self.last_time + self.clock.shift:.4g} s{f' ({how})' if how else ''}"

    @property
    def end_note(self) -> str:
        """A sentence for figures of a run that did not come to its end, or not to rest; "" for others."""
        last = self.last_time + self.clock.shift
        if self.ended:
            return f"The slide is not at rest at {last:.4g} s. " if self.moves_at_end else ""
        wanted = self.section("time").get("end")
        of_wanted = f" of {wanted + self.clock.shift:.4g} s" if wanted else ""
        return f"The run {_HOW[self.ending][1]} at {last:.4g} s{of_wanted}. "

    @cached_property
    def snapshot_files(self) -> list[Path]:
        """The snapshot files in order of their numbers; a gap between these is told in a warning."""
        folder = self.folder / "snapshots"
        numbered = {
            int(path.stem): path
            for path in folder.glob("*.vtkhdf")
            if path.stem.isascii() and path.stem.isdigit() and len(path.stem) < 18
        }
        missing = next((number for number in range(len(numbered)) if number not in numbered), None)
        if missing is not None:
            self.warnings.append(f"{folder / f'{missing:06d}.vtkhdf'}: not there; the figures have the others")
        return [path for _, path in sorted(numbered.items()) if not self._leave_out_damaged or self._is_whole(path)]

    @cached_property
    def times(self) -> Numbers:
        """The time [s] of every snapshot, shape (snapshots,)."""
        return np.array([snapshot_time(path) for path in self.snapshot_files], dtype=np.float64)

    def _is_whole(self, path: Path) -> bool:
        """Return whether a snapshot can be opened; one that cannot is told in a warning."""
        try:
            snapshot_time(path)
        except ReportError as error:
            self.warnings.append(f"{error}; the figures have the others")
            return False
        return True

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
