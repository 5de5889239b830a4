"""Score of a forecast: each observation against the members and against published events of similar volume."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError, ReportError
from thawslide.pages.events import Event
from thawslide.scores.baseline import LEAST_EVENTS, VOLUME_FACTOR, WITH_EVENTS, baseline_values, similar_events
from thawslide.scores.ensemble import Distribution, compare, quantiles
from thawslide.scores.force import compare_forces
from thawslide.scores.forecast import Forecast
from thawslide.scores.maps import jaccard, overlap_areas, thickness_at
from thawslide.scores.observed import Observation, Observed
from thawslide.scores.quantities import QUANTITIES, THICKNESS


@dataclass
class Score:
    """Each observation with the distributions of members and events; values of members by column; notes."""

    forecast: Forecast
    observed: Observed
    rows: list[tuple[Observation, Distribution, Distribution | None]] = field(default_factory=list)
    overlap: Numbers | None = None  # hit, missed and false area [m2] of the probable area
    threshold: float = float("nan")  # m, of the outline
    columns: dict[str, Numbers] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)


def compute_score(forecast: Forecast, observed: Observed) -> Score:
    """Compare a forecast with all observations; ReportError if it has nothing to compare."""
    score = Score(forecast, observed, notes=list(forecast.notes))
    events, height = _similar_events(score), _median(forecast, "drop_height")
    has_weight = forecast.weights > 0.0
    if not has_weight.all():
        score.notes.append(f"{len(has_weight) - has_weight.sum()} of {len(has_weight)} members have no weight")
    for observation, values in _pairs(score):
        known = np.isfinite(values) & has_weight
        if known.sum() < has_weight.sum():
            score.notes.append(f"{observation.words}: {known.sum()} of {has_weight.sum()} members have a value")
        if not known.any():
            continue
        members = compare(values[known], forecast.weights[known], observation.value, observation.uncertainty)
        others = baseline_values(observation.name, events, height)
        baseline = None
        if others is not None:
            baseline = compare(others, np.ones(len(others)), observation.value, observation.uncertainty)
        score.rows.append((observation, members, baseline))
        score.columns[observation.words] = values
    _add_overlap(score)
    if not score.rows and score.overlap is None:
        reasons = "; ".join(score.notes)
        raise ReportError(
            f"{observed.file}: nothing to compare with {forecast.folder} ({reasons}). Add an observation."
        )
    if any(baseline for _, _, baseline in score.rows):
        score.notes.append(
            f"events: {len(events)} published ones with {1.0 / VOLUME_FACTOR:g} to {VOLUME_FACTOR:g} times the volume; "
            "their travel distance is the median drop height of the members over their H/L"
        )
    return score


def _median(forecast: Forecast, name: str) -> float:
    values = forecast.columns.get(QUANTITIES[name].column)
    return float("nan") if values is None else quantiles(values, forecast.weights)[1]


def _similar_events(score: Score) -> list[Event]:
    """Return the published events whose volume is similar to the observed one, otherwise to that of the members."""
    observed, event = score.observed.numbers, score.observed.event
    if not any(each.name in WITH_EVENTS for each in observed):
        return []
    volume = next((each.value for each in observed if each.name == "release_volume"), None)
    volume = _median(score.forecast, "release_volume") if volume is None else volume
    events = similar_events(volume, event.get("kind", ""), event.get("name", "")) if np.isfinite(volume) else []
    if not events:
        reason = f"fewer than {LEAST_EVENTS} published ones of similar volume"
        score.notes.append(f"events: {reason if np.isfinite(volume) else 'no table [release_volume] to select them'}")
    return events


def _pairs(score: Score) -> list[tuple[Observation, Numbers]]:
    """Return each observation with the values of the members; a note for each without."""
    found = []
    for observation in score.observed.numbers:
        try:
            if observation.quantity is THICKNESS:
                found.append((observation, thickness_at(score.forecast, observation)))
            else:
                found.append((observation, score.forecast.column(observation.quantity)))
        except NotInRunError as error:
            score.notes.append(f"{observation.words}: {error}")
    if score.observed.record is not None:
        try:
            pairs, columns = compare_forces(score.forecast, score.observed.record)
            found += pairs
            score.columns |= columns
        except NotInRunError as error:
            score.notes.append(f"force record: {error}")
    return found


def _add_overlap(score: Score) -> None:
    if score.observed.outline is None:
        return
    try:
        areas, score.threshold = overlap_areas(score.forecast, score.observed.outline, score.notes)
    except NotInRunError as error:
        score.notes.append(f"outline: {error}")
        return
    score.overlap = areas[0]
    score.columns["outline_jaccard"] = jaccard(areas[1:])
    score.columns |= {f"outline_{name}_m2": areas[1:, k] for k, name in enumerate(("hit", "missed", "false"))}
