"""Table of the sentences of the paper, with results of the runs and verdicts.

claims/*.toml contain all sentences of the abstract and of Secs. 3.1 to 4.2 that claim a number or an ordering. Input of
cases (cells, steps, material data, gradients of the terrain) is not repeated. reported: the claimed number or ordering.
result: result of the runs; {name} is a measure. tests: comparisons that must all hold for "true":
[left, "<" or ">", right], [left, "<" or ">", right, factor on the right side], or [left, "within", right, tolerance].
A row without tests, or with a missing measure (nan), is undetermined.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# Numerical meaning of the words of the paper, the same for all sentences and independent of the results.
MEANINGS = (
    "a number, about, approximately, around, accurately: within 10 % of it (a saturation: within 0.1)",
    "higher, lower, faster, decreases, increases: the ordering, at the times the text names or at the end",
    "slightly, marginally: the ordering, and less than 10 % of the value compared with",
    "much, significant, substantial, sharp, rapid, dominant, largely: by a factor of two at least, or more than "
    "half of the whole",
    "comparable: within a factor of two",
    "close match, good agreement, negligible, constant, parallel, equilibrium: within 5 % of the range. Ranges: 10 K "
    "(from the start to melting), saturation 1, pressure 1,012 kPa (normal stress). distinct: more than that",
    "melted, complete: saturation above 0.99; at rest: below 1 % of the peak speed",
)
VERDICTS = {True: "true", False: "false", None: "undetermined"}


@dataclass(frozen=True)
class Sentence:
    """One row: section, text, claim, result of the runs, and the verdict (None: undetermined)."""

    section: str
    text: str
    reported: str
    result: str
    verdict: bool | None


class _Number(float):
    """Measure in texts: "none" if missing, with a minus sign."""

    def __format__(self, form: str) -> str:
        return "none" if math.isnan(self) else super().__format__(form).replace("-", "−")


def filled(text: str, measures: Mapping[str, float]) -> str:
    """Return a text with its {measures} inserted; KeyError for a missing one."""
    return text.format_map({name: _Number(value) for name, value in measures.items()})


def _value(side: str | float, measures: Mapping[str, float]) -> float:
    return measures[side] if isinstance(side, str) else float(side)


def holds(test: list[Any], measures: Mapping[str, float]) -> bool | None:
    """Return whether one comparison holds, None if a measure is missing (nan)."""
    left, right = _value(test[0], measures), _value(test[2], measures)
    if math.isnan(left) or math.isnan(right):
        return None
    if test[1] == "within":
        return abs(left - right) <= float(test[3])
    right *= float(test[3]) if len(test) > 3 else 1.0
    if test[1] not in ("<", ">"):
        raise ValueError(f"unknown comparison {test[1]}")
    return left < right if test[1] == "<" else left > right


def verdict(tests: list[list[Any]], measures: Mapping[str, float]) -> bool | None:
    """Return False if any comparison fails, None if any is undetermined or there is none, else True."""
    results = [holds(test, measures) for test in tests]
    if False in results:
        return False
    return True if results and None not in results else None


CLAIMS = tuple(
    f"claims/{name}" for name in ("abstract", *(f"section-{n}" for n in ("3.1", "3.2", "3.3", "4.1", "4.2")))
)


def table(name: str) -> list[dict[str, Any]]:
    """Return the rows of one of the data files of this package."""
    text = (Path(__file__).parent / f"{name}.toml").read_text(encoding="utf-8")
    (rows,) = tomllib.loads(text).values()
    return list(rows)


def claims() -> list[dict[str, Any]]:
    """Return the rows of all sections, in the order of the paper."""
    return [row for name in CLAIMS for row in table(name)]


def sentences(measures: Mapping[str, float]) -> list[Sentence]:
    """Return every sentence with its verdict."""
    return [
        Sentence(
            row["section"],
            row["text"],
            row["reported"],
            filled(row["result"], measures),
            verdict(row.get("tests", []), measures),
        )
        for row in claims()
    ]
