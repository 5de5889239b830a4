"""Resolved case of a run, case.toml, with checks of the types and sizes of the values that figures use."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError
from thawslide.text_files import MEGABYTE, check_depth, is_number, read_text

Case = dict[str, Any]

_REPEAT = "Repeat the run."

_MOST_CELLS = 1e7  # along an axis of the domain


def _is_numbers(value: object) -> bool:
    return isinstance(value, list) and all(map(is_number, value))


def _is_corner(value: object) -> bool:
    return isinstance(value, list) and _is_numbers(value) and len(value) in (2, 3)


def _is_periods(value: object) -> bool:
    return isinstance(value, list) and _is_numbers(value) and len(value) == 2 and 0 < value[0] < value[1]


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_flag(value: object) -> bool:
    return isinstance(value, bool)


def _is_positive(value: object) -> bool:
    return is_number(value) and isinstance(value, int | float) and value > 0


def _is_width(value: object) -> bool:
    if not isinstance(value, dict):
        return is_number(value)
    places, widths = value.get("x"), value.get("value")
    if not (isinstance(places, list) and isinstance(widths, list) and _is_numbers(places)):
        return False
    return 0 < len(places) == len(widths) and places == sorted(places) and all(map(_is_positive, widths))


Kind = tuple[Callable[[object], bool], str]
_NUMBER: Kind = (is_number, "a finite number")
_TEXT: Kind = (_is_text, "a text")
_FLAG: Kind = (_is_flag, "true or false")
_WIDTH: Kind = (_is_width, "a finite number, or as many ascending x as values above 0")
_CORNER: Kind = (_is_corner, "a list of 2 or 3 finite numbers")

_KINDS: dict[str, dict[str, Kind]] = {
    "case": {"title": _TEXT, "dimension": (lambda value: value in (2, 3), "2 or 3"), "width": _WIDTH},
    "grid": {"cell": (_is_positive, "a number above 0"), "min": _CORNER, "max": _CORNER},
    "time": {"end": _NUMBER},
    "heat": {"enabled": _FLAG, "latent": _FLAG, "steam": _FLAG},
    "maps": {"arrival_thickness": _NUMBER, "path": _TEXT},
    "terrain": {"type": _TEXT},
    "report": {
        "times": (_is_numbers, "a list of finite numbers"),
        "targets": _TEXT,
        "force_record": _TEXT,
        "force_periods": (_is_periods, "two numbers above 0, the smaller one first"),
        "force_source": _TEXT,
    },
}
_TABLES = ("basal", "bed", "body", "material", "mechanisms", "probe", "substrate")
_PROBE: dict[str, Kind] = {"point": (lambda value: value == [] or _is_corner(value), _CORNER[1])}


def read_case(path: Path) -> Case:
    """Read the case; ReportError for a value of a different type than the simulator writes."""
    try:
        case = tomllib.loads(read_text(path, 16 * MEGABYTE))
    except (ValueError, RecursionError) as error:  # an integer of too many digits is a ValueError
        raise ReportError(f"{path}: not valid TOML ({error}). {_REPEAT}") from error
    check_depth(case, path)
    for name in (*_KINDS, *_TABLES):
        if not isinstance(case.get(name, {}), dict):
            raise ReportError(f"{path}: {name}: not a table. {_REPEAT}")
    for name, kinds in _KINDS.items():
        _check(case.get(name, {}), kinds, name, path)
    for name, probe in case.get("probe", {}).items():
        if not isinstance(probe, dict):
            raise ReportError(f"{path}: probe.{name}: not a table. {_REPEAT}")
        _check(probe, _PROBE, f"probe.{name}", path)
    _check_domain(case.get("grid", {}), path)
    return case


def _check(table: dict[str, Any], kinds: dict[str, Kind], name: str, path: Path) -> None:
    for key, (is_valid, words) in kinds.items():
        if key in table and not is_valid(table[key]):
            found = str(table[key])[:60]
            raise ReportError(f"{path}: {name}.{key}: invalid value (found {found}; allowed {words}). {_REPEAT}")


def _check_domain(grid: dict[str, Any], path: Path) -> None:
    if not {"cell", "min", "max"} <= set(grid):
        return
    if len(grid["min"]) != len(grid["max"]):
        lengths = f"{len(grid['min'])} and {len(grid['max'])}"
        raise ReportError(f"{path}: grid: different lengths of min and max (found {lengths}). {_REPEAT}")
    for low, high in zip(grid["min"], grid["max"], strict=True):
        if not 0.0 < (high - low) / grid["cell"] <= _MOST_CELLS:
            raise ReportError(
                f"{path}: grid: invalid domain (found {low:g} to {high:g} with cells of {grid['cell']:g}; allowed more "
                f"than 0 and at most {_MOST_CELLS:,.0f} cells). {_REPEAT}"
            )
