"""Texts of a two-page summary for non-experts: scenario, five numbers, arrival times, limits of the results."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thawslide.main_numbers import arrivals, maximum_of_map
from thawslide.mobility import mobility_of
from thawslide.number_text import area_text, exact_text, number_text, volume_text
from thawslide.run_folder import Run

_KMH = 3.6


@dataclass(frozen=True)
class PlainNumber:
    """One number: its value with a unit, its name, and a sentence that explains it."""

    value: str
    name: str
    meaning: str


def scenario(run: Run) -> list[str]:
    """Return sentences on the simulated event."""
    mobility = mobility_of(run)
    volume = f"A mass of {volume_text(mobility.volume)}" if mobility.volume is not None else "A mass"
    end = f"{number_text(run.last_time)} s{_minutes(run.last_time)}"
    sentences = [f"{volume} is released and moves down the terrain.", f"The simulation covers {end} after the release."]
    if run.is_at_rest:
        since = "" if not np.isfinite(run.rest_since) else f" from {number_text(run.rest_since)} s on"
        sentences.append(f"The mass is at rest{since}.")
    else:
        sentences.append("The mass was still moving at the end: the affected area can become larger.")
    cell = run.section("grid").get("cell")
    if cell:
        size = exact_text(float(cell))
        sentences.append(f"The cell size is {size} m. Smaller features of the terrain and the slide are not resolved.")
    return sentences


def plain_numbers(run: Run) -> list[PlainNumber]:
    """Return up to five numbers in plain words."""
    mobility = mobility_of(run)
    numbers = []
    if mobility.volume is not None:
        numbers.append(PlainNumber(volume_text(mobility.volume), "released volume", "Rock and ice that start to move."))
    if mobility.length is not None and mobility.length > 0.0:
        height = (
            f"It falls {number_text(mobility.height)} m over this distance."
            if mobility.height is not None and mobility.height > 0.0
            else "From the top of the release to the front."
        )
        numbers.append(PlainNumber(_distance(mobility.length), "travel distance", height))
    area = run.facts.get("affected_area_m2")
    if isinstance(area, int | float):
        least = exact_text(float(run.section("maps").get("arrival_thickness", 0.0)))
        numbers.append(
            PlainNumber(area_text(float(area)), "affected area", f"Covered by more than {least} m at any time.")
        )
    thickness = maximum_of_map(run, "max_thickness")
    if thickness is not None:
        numbers.append(
            PlainNumber(
                f"{number_text(thickness, 2)} m",
                "maximum thickness",
                "Thickest place at any time, measured vertically.",
            )
        )
    speed = maximum_of_map(run, "max_speed")
    if speed is not None:
        value = f"{number_text(_KMH * speed, 2)} km/h"
        numbers.append(PlainNumber(value, "maximum speed", f"Fastest place at any time ({number_text(speed, 2)} m/s)."))
    return numbers


def arrival_rows(run: Run) -> list[tuple[str, str, str]]:
    """Return place, arrival after the start, and maximum thickness of each point probe."""
    return [
        (
            each.probe.replace("_", " "),
            f"{number_text(each.time)} s" if np.isfinite(each.time) else "not reached",
            f"{number_text(each.thickness, 2)} m" if np.isfinite(each.time) else "–",
        )
        for each in arrivals(run)
    ]


def limits(run: Run) -> list[str]:
    """Return sentences on questions that the numbers do not answer."""
    sentences = [
        "This is one scenario. The summary does not state how likely it is, or when it could occur.",
        "Volume, place and ice content of the release are assumptions. Another release affects another area.",
        "Friction below an avalanche cannot be measured before the event. The mass can travel farther or less far.",
        "Ground outside the outline is not necessarily safe.",
        "Air blast, dust, single falling blocks, waves in lakes, floods and later debris flows are not included.",
        "Buildings, forest and protection works are not included.",
        "The map is no hazard map. Hazard zones need several scenarios and the judgement of experts.",
    ]
    if warnings := run.facts.get("warnings"):
        count = "a warning" if len(warnings) == 1 else f"{len(warnings)} warnings"
        sentences.append(f"The program reported {count} on this run, listed in the full report (report.html).")
    return sentences


def origin(run: Run) -> list[str]:
    """Return lines on program and run, and on the case file with its SHA-256."""
    facts = run.facts
    case = next(
        (
            str(each.get("sha256", ""))
            for each in (facts["inputs"] if isinstance(facts.get("inputs"), list) else [])
            if isinstance(each, dict) and str(each.get("path", "")).endswith(".toml")
        ),
        "",
    )
    parts = [
        f"Thawslide {facts.get('version', '')}".strip(),
        f"run {run.folder.resolve().name}",
        f"started {str(facts['started'])[:10]}" if facts.get("started") else "",
    ]
    return [", ".join(part for part in parts if part), *([f"Case file: SHA-256 {case}"] if case else [])]


def _distance(length: float) -> str:
    return f"{number_text(length / 1000.0, 2)} km" if length >= 1000.0 else f"{number_text(length, 2)} m"


def _minutes(seconds: float) -> str:
    """Return a time in minutes in brackets, "" for less than one."""
    return f" ({number_text(seconds / 60.0, 2)} min)" if seconds >= 60.0 else ""
