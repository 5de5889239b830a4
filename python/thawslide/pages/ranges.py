"""Ranges of the results of a run from the ensemble or the pair of runs that it belongs to."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path

from thawslide.errors import ReportError
from thawslide.pairs.output import JSON
from thawslide.run_folder import Run
from thawslide.scores.ensemble import quantiles
from thawslide.text_files import MEGABYTE, is_file, read_json

_QUANTILES = (0.05, 0.95)
_FEWEST = 5  # members with a range
_FINEST = "h"  # folder of a pair's run on the smallest cells


@dataclass(frozen=True)
class Ranges:
    """Lowest and highest value of results by key, and the key of the message that explains them.

    `count`: number of members, 0 for a pair. `own`: results of the member itself, also those whose files are removed.
    """

    message: str
    count: int
    values: dict[str, tuple[float, float]]
    own: dict[str, float] = field(default_factory=dict)


def ranges_of(run: Run) -> Ranges | None:
    """Return the ranges of an ensemble's member or of a pair's finest run, None for another run."""
    folder = run.folder.resolve()
    if folder.parent.name == "members" and is_file(folder.parents[1] / "members.parquet"):
        return _of_members(folder.parents[1], folder)
    if folder.name == _FINEST and is_file(folder.parent / JSON):
        return _of_pair(folder.parent / JSON)
    return None


def _of_members(folder: Path, run: Path) -> Ranges | None:
    """Return P5 and P95 of the members of an ensemble, and the results of one of them.

    None if the members are too few or cannot be read.
    """
    from thawslide.scores.forecast import read_forecast  # which imports pandas
    from thawslide.sweeps.results import WEIGHT

    try:
        forecast = read_forecast(folder)
    except ReportError:
        return None
    if len(forecast.members) < _FEWEST:
        return None
    found = {name: quantiles(values, forecast.weights, _QUANTILES) for name, values in forecast.columns.items()}
    message = "range_weighted" if WEIGHT in forecast.columns else "range_members"
    number = int(run.name) if run.name.isdigit() else -1
    row = forecast.members.index(number) if number in forecast.members else None
    own = {} if row is None else {name: float(values[row]) for name, values in forecast.columns.items()}
    limits = {name: (low, high) for name, (low, high) in found.items() if isfinite(low)}
    return Ranges(message, len(forecast.members), limits, {name: one for name, one in own.items() if isfinite(one)})


def _of_pair(path: Path) -> Ranges | None:
    """Return the results of a pair minus and plus their errors; None for a file that cannot be read."""
    try:
        results = read_json(path, MEGABYTE)["results"]
        pairs = {name: (each["value"], each["error"]) for name, each in results.items()}
        found = {name: (value - error, value + error) for name, (value, error) in pairs.items() if error is not None}
    except (ReportError, KeyError, TypeError, AttributeError):
        return None
    return Ranges("range_pair", 0, found)
