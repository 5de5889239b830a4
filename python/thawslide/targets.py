"""Reported values for comparison with a run: quantities, units, and their CSV file.

Columns: quantity, time_s (or time_min, time_h), value, unit, and optionally source and kind.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from thawslide.errors import ReportError, nearest, quoted
from thawslide.text_files import MEGABYTE, finite_number, read_table
from thawslide.units import (
    ANGLES,
    AREAS,
    FORCES,
    LENGTHS,
    PRESSURES,
    RATIOS,
    SPEEDS,
    TEMPERATURES,
    VOLUMES,
    Units,
)

_TIMES = {"time_s": 1.0, "time_min": 60.0, "time_h": 3600.0}  # name of the column: seconds

# Kind of a value: its adjective in figures, and the heading of such values. It is "" without a column.
KINDS: Mapping[str, tuple[str, str]] = {
    "observation": ("observed", "Observations"),
    "model": ("modelled", "Results of other models"),
    "assumption": ("assumed", "Assumptions"),
    "": ("reported", "Reported values"),
}
ABSOLUTE_ZERO = -273.15  # C
FORCE = "max_seismic_force"
REFERENCE = "start_velocity"  # the quantity whose time and value [m/s] shift the times of the others
SOURCE_VOLUME = "source_volume"


@dataclass(frozen=True)
class Quantity:
    """A quantity: its name on pages, its units, allowed range (in the first unit), and source in a run.

    `column` is a column of the history, at the time of the report; `fact` is a number of run.json, at the end of the
    run. A quantity that is not compared is shown without a value of the run.
    """

    words: str
    units: Units
    low: float = 0.0
    high: float = float("inf")
    column: str = ""
    fact: str = ""
    is_compared: bool = True


QUANTITIES: Mapping[str, Quantity] = {
    REFERENCE: Quantity("mean velocity that sets the times", SPEEDS),
    "mean_velocity": Quantity("mean velocity", SPEEDS, column="mean_velocity_m_s"),
    "mean_displacement": Quantity("mean displacement", LENGTHS, column="mean_displacement_m"),
    "front_distance": Quantity("runout distance", LENGTHS, column="runout_m"),
    "band_SL": Quantity("liquid saturation of the band", RATIOS, high=1.0, column="band_saturation"),
    "band_saturation": Quantity("liquid saturation of the band", RATIOS, high=1.0, column="band_saturation"),
    "band_temperature": Quantity("mean band temperature", TEMPERATURES, low=ABSOLUTE_ZERO, column="band_temperature_C"),
    "band_pore_pressure": Quantity(
        "mean band pore pressure", PRESSURES, low=float("-inf"), column="band_pore_pressure_Pa"
    ),
    "band_friction_coefficient": Quantity(
        "friction coefficient of the band", RATIOS, column="band_friction_coefficient"
    ),
    FORCE: Quantity("maximum seismic force", FORCES),
    SOURCE_VOLUME: Quantity("source volume", VOLUMES),
    "source_mean_thickness": Quantity(
        "mean source thickness", LENGTHS, is_compared=False
    ),  # reports rarely state the area
    "deposit_volume": Quantity("deposit volume", VOLUMES, fact="covered_volume_m3"),
    "deposit_area": Quantity("deposit area", AREAS, fact="deposit_area_m2"),
    "travel_distance": Quantity("travel distance", LENGTHS, fact="travel_distance_m"),
    "drop_height": Quantity("drop height", LENGTHS, low=float("-inf"), fact="drop_height_m"),
    "angle_of_reach": Quantity("reach angle", ANGLES, low=-90.0, high=90.0, fact="reach_angle_degrees"),
}
_IN_BAND = re.compile(FORCE + r"_(\d+(?:\.\d+)?)_(\d+(?:\.\d+)?)_s", re.ASCII)
_PERIODS = (1e-3, 1e5)  # s, allowed range


@dataclass(frozen=True)
class Band:
    """Band of periods [s] of a force inverted from seismic waves."""

    shortest: float
    longest: float

    @property
    def words(self) -> str:
        """The band in texts."""
        return f"{self.shortest:g} to {self.longest:g} s"


@dataclass(frozen=True)
class Target:
    """One reported value, from the CSV file named in [report] targets."""

    quantity: str
    time: float  # s
    value: float  # in the first unit of its quantity: m, m/s, C, N, Pa, m2, m3, degrees, 1
    unit: str  # of the file
    source: str
    kind: str = ""  # of KINDS

    @property
    def adjective(self) -> str:
        """The kind of the value in figures."""
        return KINDS[self.kind][0]

    @property
    def words(self) -> str:
        """The name of the quantity on pages."""
        band = band_of(self)
        return quantity_of(self.quantity).words + (f", band-pass {band.words}" if band else "")

    @property
    def unit_words(self) -> str:
        """The unit in the file, "" for a plain number."""
        return "" if self.unit in ("-", "1") else self.unit

    def in_its_unit(self, value: float) -> float:
        """Return a value of the quantity in the unit of the file.

        Parameters
        ----------
        value : float
            The value, in the unit of `value`.

        """
        factor, offset = quantity_of(self.quantity).units[self.unit]
        return (value - offset) / factor


def band_of(target: Target) -> Band | None:
    """Return the band of a reported maximum force, e.g. max_seismic_force_35_150_s; None for others."""
    found = _IN_BAND.fullmatch(target.quantity)
    return Band(float(found[1]), float(found[2])) if found else None


def read_targets(path: Path) -> list[Target]:
    """Read the file; the ReportError states the line, the found and the allowed value."""
    table = read_table(path, ("quantity", "value", "unit"), (*_TIMES, "source", "kind"), MEGABYTE)
    times = [name for name in _TIMES if name in table.columns]
    if len(times) != 1:
        found = " and ".join(times) or "none"
        raise ReportError(f"{path}:{table.line}: give one column of times, {', '.join(_TIMES)}; found {found}")
    targets: list[Target] = []
    lines: dict[tuple[str, float, str], int] = {}
    reference_line = 0
    for line, row in table.rows:
        target = _target(row, times[0], f"{path}:{line}")
        key = (target.quantity, target.time, target.source)
        if key in lines:
            raise ReportError(
                f"{path}:{line}: {target.quantity} at this time from this source is in line {lines[key]} already; "
                "keep one of the two, or give them different sources"
            )
        if target.quantity == REFERENCE:
            if reference_line:
                raise ReportError(
                    f"{path}:{line}: {REFERENCE} is in line {reference_line} already; one row sets the clock"
                )
            reference_line = line
        lines[key] = line
        targets.append(target)
    return targets


def quantity_of(name: str) -> Quantity:
    """Return a quantity by its name; KeyError if it does not exist."""
    return QUANTITIES[FORCE if _IN_BAND.fullmatch(name) else name]


def _target(row: dict[str, str], time_column: str, where: str) -> Target:
    name, unit, source = row["quantity"], row["unit"], row.get("source", "")
    _check_band(name, where)
    try:
        quantity = quantity_of(name)
    except KeyError:
        raise ReportError(
            f"{where}: no quantity is called {quoted(name)}{nearest(name, QUANTITIES)} There are: "
            f"{', '.join(QUANTITIES)}; and {FORCE}_35_150_s for a force between periods of 35 and 150 s"
        ) from None
    if unit not in quantity.units:
        found = f"the unit {quoted(unit)}" if unit else "no unit"
        raise ReportError(f"{where}: {found} for {name}; allowed: {', '.join(filter(None, quantity.units))}")
    kind = row.get("kind", "")
    if "kind" in row and kind not in tuple(filter(None, KINDS)):
        found = f"the kind {quoted(kind)}" if kind else "no kind"
        raise ReportError(f"{where}: {found} for {name}; allowed: {', '.join(filter(None, KINDS))}")
    given = finite_number(row["value"], where)
    factor, offset = quantity.units[unit]
    time = _TIMES[time_column] * finite_number(row[time_column], where)
    target = Target(name, time, factor * given + offset, unit, source, kind)
    if not (math.isfinite(target.value) and math.isfinite(target.time)):
        raise ReportError(f"{where}: {name}: a number that large cannot be converted")
    if not quantity.low <= target.value <= quantity.high:
        raise ReportError(f"{where}: {name} is {given:g} {target.unit_words}".rstrip() + f"; {_range(quantity)}")
    return target


def _range(quantity: Quantity) -> str:
    unit = next(iter(quantity.units)).strip("-")
    ends = {"at least": quantity.low, "at most": quantity.high}
    return "allowed: " + ", ".join(f"{word} {end:g} {unit}".strip() for word, end in ends.items() if math.isfinite(end))


def _check_band(name: str, where: str) -> None:
    found = _IN_BAND.fullmatch(name)
    if found and not _PERIODS[0] <= float(found[1]) < float(found[2]) <= _PERIODS[1]:
        raise ReportError(
            f"{where}: {name}: give the shorter period first, both from {_PERIODS[0]:g} to {_PERIODS[1]:g} s"
        )
