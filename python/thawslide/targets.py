"""Reported values to compare a run with: the quantities there are, their units, and the CSV file that holds them.

Columns: quantity, time_s (or time_min, time_h), value, unit, and source and kind, which may be left out.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from thawslide.errors import ReportError, nearest, quoted
from thawslide.text_files import MEGABYTE, finite_number, read_table

Units = Mapping[str, tuple[float, float]]  # by the unit's name: (factor, offset) of first unit = factor * x + offset

_LENGTH: Units = {"m": (1.0, 0.0), "km": (1e3, 0.0), "cm": (1e-2, 0.0)}
_SPEED: Units = {"m/s": (1.0, 0.0), "km/h": (1.0 / 3.6, 0.0)}
_TEMPERATURE: Units = {"C": (1.0, 0.0), "degC": (1.0, 0.0), "°C": (1.0, 0.0), "K": (1.0, -273.15)}
_FORCE: Units = {"N": (1.0, 0.0), "kN": (1e3, 0.0), "MN": (1e6, 0.0), "GN": (1e9, 0.0), "TN": (1e12, 0.0)}
_PRESSURE: Units = {"Pa": (1.0, 0.0), "kPa": (1e3, 0.0), "MPa": (1e6, 0.0), "GPa": (1e9, 0.0)}
_AREA: Units = {"m2": (1.0, 0.0), "m²": (1.0, 0.0), "ha": (1e4, 0.0), "km2": (1e6, 0.0), "km²": (1e6, 0.0)}
_VOLUME: Units = {
    "m3": (1.0, 0.0),
    "m³": (1.0, 0.0),
    "million m3": (1e6, 0.0),
    "million m³": (1e6, 0.0),
    "km3": (1e9, 0.0),
    "km³": (1e9, 0.0),
}
_ANGLE: Units = {"degrees": (1.0, 0.0), "deg": (1.0, 0.0), "°": (1.0, 0.0), "rad": (math.degrees(1.0), 0.0)}
_SHARE: Units = {"-": (1.0, 0.0), "1": (1.0, 0.0), "": (1.0, 0.0), "%": (1e-2, 0.0)}
_TIMES = {"time_s": 1.0, "time_min": 60.0, "time_h": 3600.0}  # the column's name: seconds

# What a value may be, the adjective for it in figures, and what such values are called. Without a column it is "".
KINDS: Mapping[str, tuple[str, str]] = {
    "observation": ("observed", "Observations"),
    "model": ("modelled", "Results of other models"),
    "assumption": ("assumed", "Assumptions"),
    "": ("reported", "Reported values"),
}
ABSOLUTE_ZERO = -273.15  # C
FORCE = "max_seismic_force"
SETS_CLOCK = "start_velocity"  # the quantity whose time and value [m/s] set the clock of the others
SOURCE_VOLUME = "source_volume"


@dataclass(frozen=True)
class Quantity:
    """What can be reported: its units, the range it may lie in (in the first unit), and what of a run it is.

    `column` is one of the history, at the time of the report; `fact` a number of run.json, of the end of the run. What
    is not compared is shown beside the run without a number of its own.
    """

    units: Units
    low: float = 0.0
    high: float = float("inf")
    column: str = ""
    fact: str = ""
    is_compared: bool = True


QUANTITIES: Mapping[str, Quantity] = {
    SETS_CLOCK: Quantity(_SPEED),
    "mean_velocity": Quantity(_SPEED, column="mean_velocity_m_s"),
    "mean_displacement": Quantity(_LENGTH, column="mean_displacement_m"),
    "front_distance": Quantity(_LENGTH, column="runout_m"),
    "band_SL": Quantity(_SHARE, high=1.0, column="band_saturation"),
    "band_saturation": Quantity(_SHARE, high=1.0, column="band_saturation"),
    "band_temperature": Quantity(_TEMPERATURE, low=ABSOLUTE_ZERO, column="band_temperature_C"),
    "band_pore_pressure": Quantity(_PRESSURE, low=float("-inf"), column="band_pore_pressure_Pa"),
    "band_friction_coefficient": Quantity(_SHARE, column="band_friction_coefficient"),
    FORCE: Quantity(_FORCE),
    SOURCE_VOLUME: Quantity(_VOLUME),
    "source_mean_thickness": Quantity(_LENGTH, is_compared=False),  # of which area, reports rarely say
    "deposit_volume": Quantity(_VOLUME, fact="covered_volume_m3"),
    "deposit_area": Quantity(_AREA, fact="covered_area_m2"),
    "travel_distance": Quantity(_LENGTH, fact="travel_distance_m"),
    "drop_height": Quantity(_LENGTH, low=float("-inf"), fact="drop_height_m"),
    "angle_of_reach": Quantity(_ANGLE, low=-90.0, high=90.0, fact="angle_of_reach_degrees"),
}
_IN_BAND = re.compile(FORCE + r"_(\d+(?:\.\d+)?)_(\d+(?:\.\d+)?)_s", re.ASCII)
_PERIODS = (1e-3, 1e5)  # s, that a band may lie between


@dataclass(frozen=True)
class Band:
    """Periods [s] between which a force was inverted from seismic waves."""

    shortest: float
    longest: float

    @property
    def words(self) -> str:
        """The band as texts have it."""
        return f"{self.shortest:g} to {self.longest:g} s"


@dataclass(frozen=True)
class Target:
    """One reported value, from the CSV file named in [report] targets."""

    quantity: str
    time: float  # s
    value: float  # in the first unit of its quantity: m, m/s, C, N, Pa, m2, m3, degrees, 1
    unit: str  # as the file has it
    source: str
    kind: str = ""  # of KINDS

    @property
    def adjective(self) -> str:
        """What kind of value it is, as figures have it."""
        return KINDS[self.kind][0]

    @property
    def unit_words(self) -> str:
        """The unit that the file gives the value in, "" for a plain number."""
        return "" if self.unit in ("-", "1") else self.unit

    def in_its_unit(self, value: float) -> float:
        """Return a value of the quantity in the unit that the file gives this one in."""
        factor, offset = quantity_of(self.quantity).units[self.unit]
        return (value - offset) / factor


def band_of(target: Target) -> Band | None:
    """Return the band of a reported largest force, max_seismic_force_35_150_s, say; None for a target without one."""
    found = _IN_BAND.fullmatch(target.quantity)
    return Band(float(found[1]), float(found[2])) if found else None


def read_targets(path: Path) -> list[Target]:
    """Read the file; ReportError names the line, what was found there and what is allowed."""
    table = read_table(path, ("quantity", "value", "unit"), (*_TIMES, "source", "kind"), MEGABYTE)
    times = [name for name in _TIMES if name in table.columns]
    if len(times) != 1:
        found = " and ".join(times) or "none"
        raise ReportError(f"{path}:{table.line}: give one column of times, {', '.join(_TIMES)}; found {found}")
    targets: list[Target] = []
    lines: dict[tuple[str, float, str], int] = {}
    clock = 0
    for line, row in table.rows:
        target = _target(row, times[0], f"{path}:{line}")
        key = (target.quantity, target.time, target.source)
        if key in lines:
            raise ReportError(
                f"{path}:{line}: {target.quantity} at this time from this source is in line {lines[key]} already; "
                "keep one of the two, or give them different sources"
            )
        if target.quantity == SETS_CLOCK:
            if clock:
                raise ReportError(f"{path}:{line}: {SETS_CLOCK} is in line {clock} already; one row sets the clock")
            clock = line
        lines[key] = line
        targets.append(target)
    return targets


def quantity_of(name: str) -> Quantity:
    """Return a quantity by its name; KeyError where there is none."""
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
