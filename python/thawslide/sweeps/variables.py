"""Varied keys of a sweep: lists of values, and probability distributions."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import date, time
from statistics import NormalDist
from typing import Any

from thawslide.case import toml_text
from thawslide.errors import ReportError, quoted

TRUNCATION = 3.0  # standard deviations, on both sides of normal distributions
_MARGIN = 1e-6  # of the span of a distribution, between a limit and the truncated end
_MOST_LEVELS = 100_000
CASE = "case"  # the name of the variable that selects one of several cases


@dataclass(frozen=True)
class Levels:
    """Values of a key; in a sample, each is equally probable."""

    key: str
    values: tuple[Any, ...]

    def at(self, probability: float) -> Any:
        """Return the value at a cumulative probability."""
        return self.values[min(int(probability * len(self.values)), len(self.values) - 1)]

    def as_table(self) -> dict[str, Any]:
        """Return the variable as values of a JSON file."""
        return {"key": self.key, "values": list(self.values)}


@dataclass(frozen=True)
class Uniform:
    """Uniform distribution of a number."""

    key: str
    low: float
    high: float

    def at(self, probability: float) -> float:
        """Return the quantile of a probability."""
        return self.low + (self.high - self.low) * probability

    def as_table(self) -> dict[str, Any]:
        """Return the variable as values of a JSON file."""
        return {"key": self.key, "range": [self.low, self.high]}


@dataclass(frozen=True)
class Normal:
    """Normal distribution of a number, or of its natural logarithm; truncated at 3 standard deviations."""

    key: str
    centre: float  # mean; of a lognormal distribution the median
    deviation: float
    is_logarithmic: bool = False
    limits: tuple[float, float] | None = None  # further truncation

    def at(self, probability: float) -> float:
        """Return the quantile of a probability."""
        low, high = (-TRUNCATION, TRUNCATION) if self.limits is None else map(self._score, self.limits)
        first, last = NormalDist().cdf(low), 1.0 - NormalDist().cdf(-high)
        truncated = first + (last - first) * probability
        scaled = NormalDist().inv_cdf(min(max(truncated, first), last)) * self.deviation
        return self.centre * math.exp(scaled) if self.is_logarithmic else self.centre + scaled

    def _score(self, value: float) -> float:
        """Return the distance of a value from the centre in standard deviations."""
        distance = math.log(value / self.centre) if self.is_logarithmic else value - self.centre
        return min(max(distance / self.deviation, -TRUNCATION), TRUNCATION)

    def as_table(self) -> dict[str, Any]:
        """Return the variable as values of a JSON file."""
        numbers = {"lognormal" if self.is_logarithmic else "normal": [self.centre, self.deviation]}
        return {"key": self.key, **numbers, **({"limits": list(self.limits)} if self.limits else {})}


Variable = Levels | Uniform | Normal


def parse_levels(text: str) -> Levels:
    """Read KEY=A,B,C or KEY=LOW:HIGH:STEP."""
    key, values = _split(text, "--vary", "KEY=A,B,C or KEY=LOW:HIGH:STEP")
    parts = values.split(":")
    if len(parts) == 3 and all(_is_number(part) for part in parts):
        return Levels(key, tuple(_steps(key, *parts)))
    return levels(key, [toml_value(part) for part in _items(values)])


def levels(key: str, values: Sequence[Any]) -> Levels:
    """Return the levels of a key; ReportError if there are none, or two of them are equal."""
    if not values:
        raise ReportError(f"--vary {key}: no values. Specify at least one.")
    try:  # numbers of NumPy, paths and others as values of TOML
        values = [tomllib.loads(f"value = {toml_text(value)}")["value"] for value in values]
    except TypeError as error:
        raise ReportError(f"{key}: {error}") from error
    for index, value in enumerate(values):
        if value in values[:index]:
            raise ReportError(f"--vary {key}: the same value twice (found {value}). Remove one.")
    return Levels(key, tuple(values))


def parse_distribution(kind: str, text: str) -> Variable:
    """Read KEY=LOW:HIGH of a range, KEY=MEAN:SD, or KEY=MEDIAN:SIGMA; `kind` is range, normal or lognormal."""
    form = {"range": "KEY=LOW:HIGH", "normal": "KEY=MEAN:SD", "lognormal": "KEY=MEDIAN:SIGMA"}[kind]
    key, values = _split(text, f"--{kind}", form)
    parts = values.split(":")
    if len(parts) != 2 or not all(_is_number(part) for part in parts):
        raise ReportError(f"--{kind}: invalid (found {quoted(text)}). Specify {form}.")
    return distribution(kind, key, float(parts[0]), float(parts[1]))


def distribution(kind: str, key: str, first: float, second: float) -> Variable:
    """Return a distribution from its two numbers; ReportError if they are out of range."""
    if not math.isfinite(first) or not math.isfinite(second):
        raise ReportError(f"--{kind} {key}: not finite (found {first:g}:{second:g}). Specify finite numbers.")
    if kind == "range":
        if not first < second:
            raise ReportError(f"--range {key}: low must be below high (found {first:g}:{second:g}). Correct the range.")
        return Uniform(key, first, second)
    if not second > 0.0:
        raise ReportError(f"--{kind} {key}: the deviation must be above 0 (found {second:g}). Correct it.")
    if kind == "lognormal" and not first > 0.0:
        raise ReportError(f"--lognormal {key}: the median must be above 0 (found {first:g}). Correct it.")
    return Normal(key, first, second, kind == "lognormal")


def truncated(variable: Variable, low: float, high: float) -> Variable:
    """Return a distribution without the values below and above two limits; ReportError if none is left."""
    if isinstance(variable, Levels):
        return variable
    first, last = variable.at(0.0), variable.at(1.0)
    if low <= first and last <= high:
        return variable
    margin = _MARGIN * (last - first)
    left = (low + margin if first < low else first, high - margin if last > high else last)
    if not left[0] < left[1]:
        raise ReportError(
            f"{variable.key}: no value of the distribution is allowed (found {first:g} to {last:g}; allowed {low:g} to "
            f"{high:g}). Correct the distribution."
        )
    return Uniform(variable.key, *left) if isinstance(variable, Uniform) else replace(variable, limits=left)


def toml_value(text: str) -> Any:
    """Return a value of a command line: TOML, or text without quotation marks."""
    try:
        value = tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text
    return text if isinstance(value, date | time) else value  # no key has a date or time as its value


def _split(text: str, option: str, form: str) -> tuple[str, str]:
    key, equals, values = text.partition("=")
    if not equals or not key.strip() or not values.strip():
        raise ReportError(f"{option}: invalid (found {quoted(text)}). Specify {form}.")
    return key.strip(), values.strip()


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text)) and "_" not in text
    except ValueError:
        return False


def _steps(key: str, low: str, high: str, step: str) -> list[float | int]:
    """Return low, low + step, ... up to and including high; whole numbers if all three are."""
    numbers = [toml_value(part) for part in (low, high, step)]
    first, last, size = map(float, numbers)
    if not size > 0.0 or last < first:
        raise ReportError(f"--vary {key}: invalid steps (found {low}:{high}:{step}). Specify LOW:HIGH:STEP, STEP > 0.")
    count = math.floor((last - first) / size + 1e-9) + 1
    if count > _MOST_LEVELS:
        raise ReportError(
            f"--vary {key}: too many values (found {count:,}; allowed {_MOST_LEVELS:,}). Use a larger step."
        )
    if all(isinstance(number, int) for number in numbers):
        return [numbers[0] + index * numbers[2] for index in range(count)]
    return [float(f"{first + index * size:.12g}") for index in range(count)]


def _items(text: str) -> list[str]:
    """Split at commas outside brackets and quotation marks."""
    items, depth, mark, start = [], 0, "", 0
    for index, letter in enumerate(text):
        if mark:
            mark = "" if letter == mark else mark
        elif letter in "\"'":
            mark = letter
        elif letter in "[{":
            depth += 1
        elif letter in "]}":
            depth -= 1
        elif letter == "," and depth == 0:
            items.append(text[start:index].strip())
            start = index + 1
    return [item for item in (*items, text[start:].strip()) if item]
