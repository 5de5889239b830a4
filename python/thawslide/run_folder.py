"""Python interface of a run folder: resolved case, history, terrain, snapshots and reported values."""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError, ReportError, printable, quoted
from thawslide.force_record import ForceRecord, read_force_record
from thawslide.history import History, read_history, read_terrain
from thawslide.number_text import integer_text
from thawslide.resolved_case import Case, read_case
from thawslide.run_facts import Ending, ending_of, read_facts
from thawslide.snapshot import Snapshot, snapshot_time
from thawslide.targets import Band, Target, read_targets
from thawslide.text_files import is_file
from thawslide.time_reference import shifted_targets

if TYPE_CHECKING:
    import pandas as pd

    from thawslide.geopackage import Feature
    from thawslide.maps import Maps

__all__ = ["History", "Numbers", "Run", "Snapshot", "Target"]

_ENDING_WORDS = {
    Ending.RUNNING: ("still running", "was still running"),
    Ending.KILLED: ("terminated?", "terminated unexpectedly"),
    Ending.UNDETERMINED: ("running or terminated", "was running or terminated unexpectedly"),
    Ending.STOPPED: ("stopped", "was stopped"),
    Ending.FAILED: ("failed", "failed"),
}  # in brackets after a time, and as a verb


class Run:
    """A run folder; each file is read at first use."""

    def __init__(self, folder: Path | str, skip_damaged: bool = False) -> None:
        """Open a run folder; ReportError if it is none.

        Parameters
        ----------
        folder : str or path
            The folder.
        skip_damaged : bool
            List damaged snapshots in `warnings` and skip them; by default, they raise ReportError.

        """
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise ReportError(f"{self.folder}: no such folder. Select the folder of a run, e.g. runs/lamplugh.")
        absent = [name for name in ("case.toml", "history.csv") if not is_file(self.folder / name)]
        if absent:
            raise ReportError(
                f"{self.folder}: not a run folder (found no {' and no '.join(absent)}). Select the folder of a run."
            )
        self.warnings: list[str] = []
        self._skip_damaged = skip_damaged

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"

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
        """The vertical axis of points: 1 (y) in 2D, 2 (z) in 3D."""
        return 1 if self.dimension == 2 else 2

    @property
    def gravity_tilt(self) -> float:
        """The angle [degrees] by which gravity is rotated from the vertical axis towards +x."""
        return float(self.section("case").get("gravity_tilt", 0.0))

    @property
    def per_metre(self) -> bool:
        """Whether extensive columns are per metre of width, in a 2D case without a width."""
        return self.dimension == 2 and not self.width

    @property
    def width(self) -> float:
        """The width [m] of a 2D case, a factor of extensive columns; 0: none. Particle volumes are per metre of it."""
        width = self.section("case").get("width", 0.0)
        return float(width["value"][0] if isinstance(width, dict) else width)

    def section_areas(self, shot: Snapshot) -> Numbers:
        """Return the area [m2] of each particle of a 2D run in the section: its volume over the width there.

        Parameters
        ----------
        shot : Snapshot
            A snapshot with the field `volume`.

        """
        volume = np.asarray(shot["volume"], dtype=np.float64)
        return np.asarray(volume / self.relative_width(shot.points[:, 0]))

    def relative_width(self, x: Numbers) -> Numbers:
        """Return the ratio of the width of the section to `width`, 1 if it is constant.

        Parameters
        ----------
        x : array
            Distances along the section [m].

        """
        width = self.section("case").get("width", 0.0)
        if not isinstance(width, dict):
            return np.ones_like(x)
        return np.asarray(np.interp(x, width["x"], width["value"]) / width["value"][0])

    @property
    def report_times(self) -> list[float]:
        """The times [s] of snapshot figures in the case; empty without any."""
        return [float(time) for time in self.section("report").get("times", [])]

    def section(self, name: str) -> dict[str, Any]:
        """Return one table of the case file, empty if it does not exist.

        Parameters
        ----------
        name : str
            The table, such as "grid".

        """
        return dict(self.case.get(name, {}))

    @property
    def history(self) -> pd.DataFrame:
        """The history with the columns of history.csv; an incomplete last row is skipped with a warning."""
        return self.series.to_pandas()

    @cached_property
    def series(self) -> History:
        """The same columns as arrays by name, without pandas."""
        return read_history(self.folder / "history.csv", self.warnings)

    @property
    def has_band_columns(self) -> bool:
        """Whether the run has band columns; figures of the band are then area-weighted means over the base."""
        return "band_normal_pressure_Pa" in self.series

    @property
    def probes(self) -> pd.DataFrame | None:
        """Thickness, speed and discharge at probes over time, None for a run without probes."""
        return None if self.probe_series is None else self.probe_series.to_pandas()

    @cached_property
    def probe_series(self) -> History | None:
        """The same columns as arrays by name."""
        path = self.folder / "probes.csv"
        return read_history(path, self.warnings) if is_file(path) else None

    @cached_property
    def maps(self) -> Maps:
        """The maps by name, for example `run.maps["max_thickness"]`; NotInRunError unless a 3D run on a DEM."""
        from thawslide.maps import Maps  # which imports this module

        return Maps(self)

    def features(self, layer: str) -> list[Feature]:
        """Return the features of a layer of maps/results.gpkg.

        Parameters
        ----------
        layer : str
            The layer, for example "affected_area" or "path".

        Returns
        -------
        list of Feature
            Geometry and attributes of each feature.

        Raises
        ------
        NotInRunError
            Without the layer.
        ReportError
            For a damaged file.

        """
        from thawslide.geopackage import read_layer  # which imports this module

        return read_layer(self.folder / "maps" / "results.gpkg", layer)

    @property
    def key_numbers(self) -> dict[str, float]:
        """The key numbers of the report by name, each in the unit its name ends with; nan if one is not attained.

        Times are those of the run. In a 2D case without a width, volumes, masses and forces are per metre of width.
        """
        from thawslide.key_numbers import key_numbers  # which imports this module, and matplotlib

        return {row.key: row.number for row in key_numbers(self) if row.key}

    @cached_property
    def terrain(self) -> tuple[Numbers, Numbers] | None:
        """Distance and elevation [m] of the terrain, or None for a run without terrain."""
        path = self.folder / "terrain.csv"
        return read_terrain(path) if is_file(path) else None

    @cached_property
    def targets(self) -> list[Target]:
        """The reported values, at times of the run (`shifted_targets`); empty if the case names none."""
        path = self._report_file("targets")
        return shifted_targets(self, read_targets(path)) if path else []

    @property
    def logo(self) -> Path | None:
        """The image at the top of reports, None if the case names none."""
        return self._report_file("logo")

    @cached_property
    def force_record(self) -> ForceRecord | None:
        """The force inverted from seismic waves, None if the case names none."""
        path, report = self._report_file("force_record"), self.section("report")
        if path is None:
            return None
        if "force_periods" not in report:
            case = self.folder / "case.toml"
            raise ReportError(
                f"{case}: report.force_periods: missing for report.force_record. Add the periods of its waves [s]."
            )
        return read_force_record(path, Band(*map(float, report["force_periods"])), str(report.get("force_source", "")))

    def _report_file(self, key: str) -> Path | None:
        """Return the file in the run folder named by a key of [report], None for no file."""
        name = str(self.section("report").get(key, ""))
        if not name:
            return None
        path, case = self.folder / name, self.folder / "case.toml"
        try:
            within, there = path.resolve().is_relative_to(self.folder.resolve()), path.is_file()
        except (OSError, RuntimeError, ValueError) as error:  # too long; circular links; a zero byte
            raise ReportError(
                f"{case}: report.{key}: cannot be read (found {quoted(name)}). Correct the name."
            ) from error
        if not within:
            raise ReportError(
                f"{case}: report.{key}: outside the run folder (found {path}). Copy the file into the run folder."
            )
        if not there:
            raise ReportError(f"{path}: no such file. Correct report.{key} in {case}.")
        return path

    @cached_property
    def facts(self) -> dict[str, Any]:
        """The contents of run.json; empty if it does not exist."""
        return read_facts(self.folder / "run.json")

    @cached_property
    def ending(self) -> Ending:
        """The ending of the run."""
        return ending_of(self.folder, self.facts)

    @property
    def is_complete(self) -> bool:
        """Whether the run is complete; assumed if run.json does not exist, with a note on the page."""
        return self.ending in (Ending.DONE, Ending.UNKNOWN)

    @property
    def last_time(self) -> float:
        """The simulated time [s]."""
        stated = self.facts.get("simulated_time_s")
        is_outdated = self.ending in (Ending.RUNNING, Ending.KILLED, Ending.UNDETERMINED)  # run.json
        return float(self.series["time_s"][-1] if stated is None or is_outdated else stated)

    @property
    def is_moving_at_end(self) -> bool:
        """Whether the sliding mass was not at rest at the end of the run, according to run.json."""
        return self.facts.get("at_rest") is False

    @property
    def is_at_rest(self) -> bool:
        """Whether the sliding mass was at rest at the end of the run, according to run.json."""
        return self.facts.get("at_rest") is True

    @property
    def rest_since(self) -> float:
        """The time of the run [s] at which the sliding mass came to rest; inf if it did not."""
        since = self.facts.get("rest_since_s")
        return float(since) if self.is_at_rest and since is not None else float("inf")

    def titled(self, words: str) -> str:
        """Return the title of a figure of the whole run, with its last time if the mass is not at rest.

        Parameters
        ----------
        words : str
            The content of the figure.

        """
        return f"{self.title}: {words}" + (
            f", up to {self.last_state}" if self.is_complete and self.is_moving_at_end else ""
        )

    @property
    def last_state(self) -> str:
        """The time of the last state, and the reason if it is not a deposit, for example "19.5 s (stopped)"."""
        reason = (
            _ENDING_WORDS[self.ending][0] if not self.is_complete else "not at rest" if self.is_moving_at_end else ""
        )
        return f"{integer_text(self.last_time)} s{f' ({reason})' if reason else ''}"

    @property
    def end_note(self) -> str:
        """A sentence for figures of a run that is incomplete or not at rest; "" for others."""
        last = integer_text(self.last_time)
        if self.is_complete:
            return f"The sliding mass is not at rest at {last} s. " if self.is_moving_at_end else ""
        end = self.section("time").get("end")
        of_end = f" of {integer_text(end)} s" if end else ""
        return f"The run {_ENDING_WORDS[self.ending][1]} at {last} s{of_end}. "

    @cached_property
    def snapshot_files(self) -> list[Path]:
        """The snapshot files in order of their numbers; a missing number is a warning."""
        folder = self.folder / "snapshots"
        numbered = {
            int(path.stem): path
            for path in folder.glob("*.vtkhdf")
            if path.stem.isascii() and path.stem.isdigit() and len(path.stem) < 18
        }
        missing = next((number for number in range(len(numbered)) if number not in numbered), None)
        if missing is not None:
            self.warnings.append(f"{folder / f'{missing:06d}.vtkhdf'}: missing. The figures use the other snapshots.")
        return [path for _, path in sorted(numbered.items()) if not self._skip_damaged or self._is_readable(path)]

    @cached_property
    def times(self) -> Numbers:
        """The time [s] of every snapshot, shape (snapshots,)."""
        return np.array([snapshot_time(path) for path in self.snapshot_files], dtype=np.float64)

    def _is_readable(self, path: Path) -> bool:
        """Return whether a snapshot can be opened; if it cannot, add a warning."""
        try:
            snapshot_time(path)
        except ReportError as error:
            self.warnings.append(f"{error} The figures use the other snapshots.")
            return False
        return True

    def snapshot(
        self, index: int | None = None, *, time: float | None = None, fields: Collection[str] | None = None
    ) -> Snapshot:
        """Read one snapshot by its index or time.

        Parameters
        ----------
        index : int, optional
            Index in `times`; negative: from the end.
        time : float, optional
            Time [s], in place of an index; the nearest snapshot is read.
        fields : collection of str, optional
            Fields to read, by default all.

        Raises
        ------
        NotInRunError
            For a run without snapshots.
        ReportError
            For an index that does not exist, and a damaged file.
        ValueError
            Unless exactly one of index and time is given.

        """
        if (index is None) == (time is None):
            raise ValueError("snapshot: either an index or a time is required")
        if not self.snapshot_files:
            raise NotInRunError(f"{self.folder}: no snapshots. Set time.output_interval and repeat the run.")
        if time is not None:
            index = int(np.argmin(np.abs(self.times - time)))
        assert index is not None
        if not -len(self.snapshot_files) <= index < len(self.snapshot_files):
            count = len(self.snapshot_files)
            raise ReportError(f"{self.folder}: no snapshot {index} (found {count} snapshots). Select an existing one.")
        return Snapshot(self.snapshot_files[index], fields)
