"""The file observed.toml: observations of an event. Each error states file, line, found and allowed values."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError, nearest, quoted
from thawslide.force_record import ForceRecord, read_force_record
from thawslide.scores.quantities import COORDINATES, OPTIONAL, QUANTITIES, TABLES, THICKNESS, Quantity
from thawslide.scores.toml_lines import Keys, line_of, lines_of
from thawslide.targets import Band
from thawslide.text_files import MEGABYTE, check_depth, is_number, read_text


@dataclass(frozen=True)
class Observation:
    """An observed number; value and uncertainty (0: not stated) in the first unit of its quantity."""

    name: str
    words: str
    quantity: Quantity
    value: float
    uncertainty: float
    unit: str  # of the file
    source: str
    point: tuple[float, float] = (0.0, 0.0)  # m, of a thickness
    is_deposit: bool = True  # of a thickness: false for its maximum over time

    @property
    def factor(self) -> float:
        """The unit of the file, in the first unit of the quantity."""
        return self.quantity.units[self.unit][0]


@dataclass(frozen=True)
class Outline:
    """A mapped outline of the affected area or the deposit, and the thickness [m] from which cells count."""

    file: Path
    is_deposit: bool
    threshold: float | None  # None: that of the runs


@dataclass(frozen=True)
class Observed:
    """All observations of a file; `event` has the texts of its table by key."""

    file: Path
    event: dict[str, str]
    numbers: list[Observation]
    outline: Outline | None
    record: ForceRecord | None


def read_observed(file: Path) -> Observed:
    """Read a file of observations; ReportError for a mistake, or if it has no observation."""
    reader = _Reader(file)
    found = {name: reader.table((name,), table) for name, table in reader.tables.items() if name != "thickness"}
    numbers = [
        reader.observation((name,), found[name], each, each.words) for name, each in QUANTITIES.items() if name in found
    ]
    numbers += reader.points()
    if not numbers and not found.keys() & {"outline", "force_record"}:
        names = ", ".join(name for name in TABLES if name != "event")
        raise ReportError(f"{file}: no observation (allowed tables: {names}). Add at least one.")
    outline = record = None
    if (table := found.get("outline")) is not None:
        outline = Outline(reader.path("outline", table), table.get("area") == "deposit", table.get("threshold"))
    if (table := found.get("force_record")) is not None:
        band = Band(*table["periods"])
        record = read_force_record(reader.path("force_record", table), band, table.get("source", ""))
    return Observed(file, found.get("event", {}), numbers, outline, record)


class _Reader:
    """Values of a file, checked by the declared keys."""

    def __init__(self, file: Path) -> None:
        text = read_text(file, MEGABYTE)
        self.file, self._lines = file, lines_of(text)
        try:
            self.tables = tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError) as error:
            line = re.search(r"at line (\d+)", str(error))
            raise ReportError(f"{file}:{line[1] if line else 1}: not valid TOML ({error}). Correct it.") from error
        check_depth(self.tables, file)
        for name in self.tables:
            if name not in TABLES:
                raise self._error((name,), f"unknown table{nearest(name, TABLES)} Allowed: {', '.join(TABLES)}")

    def _error(self, keys: Keys, problem: str) -> ReportError:
        name = quoted(".".join(str(key) for key in keys if isinstance(key, str)))[1:-1]
        return ReportError(f"{self.file}:{line_of(self._lines, keys)}: {name}: {problem}. Correct it.")

    def table(self, keys: Keys, found: object) -> dict[str, Any]:
        """Return the checked values of a table."""
        allowed = TABLES[str(keys[0])]
        if not isinstance(found, dict):
            raise self._error(keys, f"not a table (found {quoted(str(found))}; allowed keys: {', '.join(allowed)})")
        for name in found:
            if name not in allowed:
                raise self._error((*keys, name), f"unknown key{nearest(name, allowed)} Allowed: {', '.join(allowed)}")
        for name in allowed:
            if name not in found and name not in OPTIONAL:
                raise self._error(keys, f"no key {name} (found {', '.join(found) or 'none'})")
        return {name: self._value((*keys, name), allowed[name], value) for name, value in found.items()}

    def _value(self, keys: Keys, kind: type | tuple[str, ...], value: Any) -> Any:
        text, low = quoted(str(value)), float("-inf") if keys[-1] in COORDINATES else 0.0
        if kind is float:
            if not is_number(value) or value < low:
                least = "" if keys[-1] in COORDINATES else " of at least 0"
                raise self._error(keys, f"invalid (found {text}; allowed: finite numbers{least})")
            return float(value)
        if kind is list:
            if not (isinstance(value, list) and len(value) == 2 and all(map(is_number, value))
                    and 0.0 < value[0] < value[1]):  # fmt: skip
                raise self._error(keys, f"invalid (found {text}; allowed: two positive numbers [s], the shorter first)")
            return tuple(map(float, value))
        allowed = kind if isinstance(kind, tuple) else ("a text",)
        if not isinstance(value, str) or not value or (isinstance(kind, tuple) and value not in kind):
            raise self._error(keys, f"invalid (found {text}; allowed: {', '.join(allowed)})")
        return value

    def observation(self, keys: Keys, table: dict[str, Any], quantity: Quantity, words: str) -> Observation:
        """Return the number of a table in the first unit of its quantity."""
        unit, value = table["unit"], table["value"]
        if unit not in quantity.units:
            allowed = ", ".join(filter(None, quantity.units))
            raise self._error((*keys, "unit"), f"unknown unit (found {quoted(unit)}; allowed: {allowed})")
        if value == 0.0 and quantity is not THICKNESS:
            raise self._error((*keys, "value"), "invalid (found 0; allowed: positive numbers)")
        factor = quantity.units[unit][0]
        if not is_number(factor * value) or not is_number(factor * table.get("uncertainty", 0.0)):
            raise self._error((*keys, "value"), f"too large to be converted (found {value:g} {unit})")
        return Observation(
            str(keys[0]), words, quantity, factor * value, factor * table.get("uncertainty", 0.0), unit,
            table.get("source", ""), (table.get("x", 0.0), table.get("y", 0.0)), table.get("of") != "maximum",
        )  # fmt: skip

    def points(self) -> list[Observation]:
        """Return the thickness at points."""
        tables, found = self.tables.get("thickness", []), list[Observation]()
        if not isinstance(tables, list):
            raise self._error(("thickness",), "not an array of tables (allowed: [[thickness]])")
        for index, each in enumerate(tables):
            table = self.table(("thickness", index), each)
            words = f"thickness at {table['name']}"
            if any(other.words == words for other in found):
                raise self._error(("thickness", index, "name"), f"two points have the name {quoted(table['name'])}")
            found.append(self.observation(("thickness", index), table, THICKNESS, words))
        return found

    def path(self, name: str, table: dict[str, Any]) -> Path:
        """Return the file of a table, whose path is relative to the file of observations."""
        path = self.file.parent / str(table["file"])
        if not path.is_file():
            raise self._error((name, "file"), f"no such file (found {quoted(str(path))})")
        return path
