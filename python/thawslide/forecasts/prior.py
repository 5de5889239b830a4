"""Prior check: H/L of rigid blocks of all members beside that of published events of similar volume."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thawslide.arrays import Numbers
from thawslide.case import toml_text
from thawslide.errors import ReportError
from thawslide.forecasts.weights import member_weights
from thawslide.number_text import volume_text
from thawslide.program import find_program
from thawslide.scores.baseline import LEAST_EVENTS, VOLUME_FACTOR, similar_events
from thawslide.scores.ensemble import quantiles
from thawslide.scores.forecast import MOVES, Forecast, moving_note
from thawslide.sweeps.sensitivity import effective_number

LEAST_MEMBERS = 10  # with H/L
LEFT = "left_path_at_s"  # column of blocks that leave the DEM or reach the end of their path
_LEAVES = 1.0  # m: displacement from which a block has left
_TIMEOUT = 600.0  # seconds


@dataclass(frozen=True)
class Prior:
    """H/L of the blocks with the numbers of their members, events of similar volume, and weights of all members."""

    volume: float  # m3
    kind: str  # of the events, "" for all
    members: list[int]
    ratios: Numbers
    is_limit: NDArray[np.bool_]  # blocks whose ratio is an upper limit, because they still move
    events: dict[str, float]  # H/L by name
    weights: Numbers | None  # of the blocks, sum 1; None: equally probable members
    notes: list[str] = field(default_factory=list)

    def rows(self) -> list[tuple[str, int, float, float, float]]:
        """Return words, number (effective for weighted members), P5, P50 and P95 of each distribution of H/L."""

        def row(words: str, values: Numbers, weights: Numbers) -> tuple[str, int, float, float, float]:
            low, median, high = quantiles(values, weights)
            return words, round(effective_number(weights)), low, median, high

        found = [row("rigid blocks of the members", self.ratios, np.ones(len(self.ratios)))]
        if self.weights is not None:
            found.append(row("rigid blocks, weighted (effective number)", self.ratios, self.weights))
        if self.events:
            values = np.array(list(self.events.values()))
            what = f"published events of {1.0 / VOLUME_FACTOR:g} to {VOLUME_FACTOR:g} times the volume"
            found.append(row(what, values, np.ones(len(values))))
        return found

    def as_table(self) -> dict[str, Any]:
        """Return the check as values of a JSON file."""
        weights = None if self.weights is None else dict(zip(self.members, map(float, self.weights), strict=True))
        limits = self.ratios[self.is_limit]
        return {
            "volume_m3": self.volume,
            "kind": self.kind,
            "rows": self.rows(),
            "limit": float(limits.max()) if limits.size else None,
            "notes": self.notes,
            "events": self.events,
            "h_over_l": dict(zip(self.members, map(float, self.ratios), strict=True)),
            "is_limit": [number for number, is_limit in zip(self.members, self.is_limit, strict=True) if is_limit],
            "weights": weights,
        }


def check_prior(blocks: Forecast, volume: float, kind: str, is_weighted: bool, but: str = "") -> Prior:
    """Compare the blocks with events of a volume [m3] and kind ("" for all), without the event of a name.

    H/L of a block that still moves at the end of its path or of its time is an upper limit. ReportError if no block
    leaves or too few have H/L; with weights, also if the members do not cover the events.
    """
    ratios = blocks.columns.get("h_over_l", np.full(len(blocks.members), math.nan))
    known = np.isfinite(ratios)
    if known.sum() < LEAST_MEMBERS:
        raise ReportError(
            f"{blocks.folder}: too few members with H/L of a rigid block (found {known.sum()} of "
            f"{len(blocks.members)}; needed {LEAST_MEMBERS}). Increase sweep.sample in sweep.toml, e.g. lhs:32."
        )
    stays = blocks.columns["displacement_m"][known] < _LEAVES
    if stays.all():
        raise ReportError(
            f"{blocks.folder}: no member leaves (found {len(stays)} rigid blocks at rest). Lower the friction or the "
            "cohesion in sweep.toml."
        )
    notes = [note for note in blocks.notes if note != moving_note(blocks)]  # the note of limits counts blocks
    if stays.any():
        what = "they have no weight, because every event left" if is_weighted else "their H/L is that of the release"
        notes.append(f"{stays.sum()} of {len(stays)} blocks do not leave: {what}")
    if is_weighted:
        known[np.flatnonzero(known)[stays]] = False
    events = similar_events(volume, kind, but)
    if not events:
        what = f"fewer than {LEAST_EVENTS} published events with a volume similar to {volume_text(volume)}"
        if is_weighted:
            raise ReportError(f"--prior events: {what}. Use --prior sweep, or another --kind.")
        notes.append(f"no comparison: {what}")
    ratio_of = {event.name: event.ratio for event in events}
    has_left = np.isfinite(blocks.columns.get(LEFT, np.full(len(known), math.nan)))
    is_limit = ((blocks.columns[MOVES] > 0.0) | has_left)[known]
    ratios, left = ratios[known], int(has_left[known].sum())
    weights = member_weights(ratios, np.array(list(ratio_of.values())), is_limit) if is_weighted else None
    if is_limit.any():
        notes.append(_note_of_limits(ratios, is_limit, left, weights))
    members = [number for number, is_known in zip(blocks.members, known, strict=True) if is_known]
    return Prior(volume, kind, members, ratios, is_limit, ratio_of, weights, notes)


def _note_of_limits(ratios: Numbers, is_limit: NDArray[np.bool_], left: int, weights: Numbers | None) -> str:
    """Return the number of blocks with an upper limit of H/L, its largest value, and their weight."""
    limits = ratios[is_limit]
    others = f", {len(limits) - left} still move at time.end" if len(limits) > left else ""
    text = (
        f"{left} of {len(ratios)} blocks leave the DEM or reach the end of their path{others}. Their H/L is an upper "
        f"limit, at most {limits.max():.2f}"
    )
    if weights is None:
        return text
    return f"{text}; they have {100.0 * weights[is_limit].sum():.0f} % of the weight, that of events of lower H/L"


def release_volume(case_file: str, changes: Mapping[str, Any]) -> float:
    """Return the volume of all bodies [m3], by `thawslide check`; its error for an invalid case."""
    program = find_program()
    if program is None:
        raise ReportError("the program thawslide was not found. Install the package again, or put it on PATH.")
    sets = [part for key, value in changes.items() for part in ("--set", f"{key}={toml_text(value)}")]
    try:
        done = subprocess.run(
            [program, "check", case_file, "--json", *sets],
            capture_output=True,
            text=True,
            timeout=_TIMEOUT,
            check=False,
        )
        bodies: Sequence[Mapping[str, Any]] = json.loads(done.stdout or "{}").get("bodies", [])
    except (OSError, ValueError, subprocess.TimeoutExpired) as error:
        raise ReportError(f"thawslide check {case_file}: failed ({error}). Run it.") from error
    if done.returncode != 0:
        raise ReportError(done.stderr.strip().removeprefix("error: "))
    return float(sum(body["volume_m3"] for body in bodies))
