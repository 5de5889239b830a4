"""The file sweep.toml: the design of a sweep in its table [sweep]."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError, nearest, quoted
from thawslide.sweeps.api import absolute_case
from thawslide.sweeps.design import FACTORIAL, Design, parse_correlation, parse_sample
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.variables import Variable, distribution, levels, parse_levels
from thawslide.text_files import MEGABYTE, is_number, read_text

DISTRIBUTIONS = ("range", "normal", "lognormal")
_KEYS = (
    "cases",
    "sample",
    "seed",
    "block",
    "set",
    "vary",
    *DISTRIBUTIONS,
    "tie",
    "correlate",
    "column",
)  # of the table [sweep]


@dataclass(frozen=True)
class SweepFile:
    """Values of a sweep file."""

    design: Design
    is_block: bool
    expressions: tuple[Expression, ...]


def is_sweep_file(path: Path) -> bool:
    """Return whether a path is a TOML file with a table [sweep]."""
    try:
        return path.is_file() and "sweep" in tomllib.loads(read_text(path, MEGABYTE))
    except (tomllib.TOMLDecodeError, ReportError):
        return False  # read as a case, which reports a better message


def read_sweep_file(path: Path, seed: int | None = None) -> SweepFile:
    """Read the design; paths in it are relative to the file. `seed` replaces that of the file."""
    try:
        table = tomllib.loads(read_text(path, MEGABYTE)).get("sweep")
    except tomllib.TOMLDecodeError as error:
        raise ReportError(f"{path}: not valid TOML ({error}). Correct it.") from error
    if not isinstance(table, dict):
        raise ReportError(f"{path}: no table [sweep]. Add it, with cases and at least one varied key.")
    for key in table:
        if key not in _KEYS:
            raise ReportError(f"{path}: sweep.{key}: unknown key{nearest(key, _KEYS)} Allowed: {', '.join(_KEYS)}.")
    cases = _of_type(path, table, "cases", list, [])
    if not cases or not all(isinstance(case, str) for case in cases):
        raise ReportError(f"{path}: sweep.cases: missing or not a list of texts. Specify at least one case.")
    variables: list[Variable] = []
    for key, values in _of_type(path, table, "vary", dict, {}).items():
        if not isinstance(values, str | list):
            raise ReportError(
                f"{path}: sweep.vary.{quoted(key)}: not a list (found {quoted(str(values))}). Correct it."
            )
        variables.append(parse_levels(f"{key}={values}") if isinstance(values, str) else levels(key, values))
    variables += [levels(key, [value]) for key, value in _of_type(path, table, "set", dict, {}).items()]
    for kind in DISTRIBUTIONS:
        for key, pair in _of_type(path, table, kind, dict, {}).items():
            if not isinstance(pair, list) or len(pair) != 2 or not all(map(is_number, pair)):
                raise ReportError(f"{path}: sweep.{kind}.{quoted(key)}: not a pair of numbers. Correct it.")
            variables.append(distribution(kind, key, float(pair[0]), float(pair[1])))
    sample = _of_type(path, table, "sample", str, "")
    method, count = parse_sample(sample) if sample else (FACTORIAL, 0)
    seed = seed if seed is not None else _of_type(path, table, "seed", int, 0)
    files = tuple(absolute_case(path.parent / case) for case in cases)
    expressions = [Expression(name, str(text)) for name, text in _of_type(path, table, "column", dict, {}).items()]
    ties = tuple(Expression(key, str(text), "--tie") for key, text in _of_type(path, table, "tie", dict, {}).items())
    pairs = _of_type(path, table, "correlate", dict, {})
    correlations = tuple(parse_correlation(f"{keys}={number}") for keys, number in pairs.items())
    design = Design(files, tuple(variables), method, count, seed or 0, ties, correlations)
    return SweepFile(design, _of_type(path, table, "block", bool, False), tuple(expressions))


def _of_type(path: Path, table: dict[str, Any], key: str, kind: type, default: Any) -> Any:
    value = table.get(key, default)
    if not isinstance(value, kind):
        raise ReportError(f"{path}: sweep.{key}: wrong type (found {quoted(str(value))}). Correct it.")
    return value
