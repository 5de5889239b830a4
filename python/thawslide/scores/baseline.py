"""Baseline of a forecast: published events of similar volume."""

from __future__ import annotations

import numpy as np

from thawslide.arrays import Numbers
from thawslide.pages.events import KINDS, Event, published_events

VOLUME_FACTOR = 2.5  # largest ratio of two similar volumes
LEAST_EVENTS = 5
WITH_EVENTS = ("travel_distance", "h_over_l")  # quantities


def comparable_kinds() -> tuple[str, ...]:
    """Return the kinds that have enough events of similar volume for a comparison."""

    def is_comparable(kind: str) -> bool:
        volumes = sorted(event.volume for event in published_events() if event.kind == kind)
        pairs = zip(volumes, volumes[LEAST_EVENTS - 1 :], strict=False)
        return any(largest / smallest <= VOLUME_FACTOR**2 for smallest, largest in pairs)

    return tuple(filter(is_comparable, KINDS))


def similar_events(volume: float, kind: str, but: str = "") -> list[Event]:
    """Return the published events of a kind ("" for all) whose volume [m3] is similar; fewer than 5 count as none.

    The event itself, by its name, is left out.
    """
    found = [
        event
        for event in published_events()
        if 1.0 / VOLUME_FACTOR <= event.volume / volume <= VOLUME_FACTOR
        and kind in ("", event.kind)
        and event.name.casefold() != but.casefold()
    ]
    return found if len(found) >= LEAST_EVENTS else []


def baseline_values(name: str, events: list[Event], height: float) -> Numbers | None:
    """Return a quantity of the events, None if they have none.

    H/L is that of each event. The travel distance L = H / (H/L) has the drop height [m] of the forecast, because the
    slope limits it.
    """
    if not events or name not in WITH_EVENTS:
        return None
    ratios = np.array([event.ratio for event in events])
    if name == "h_over_l":
        return ratios
    return height / ratios if np.isfinite(height) else None
