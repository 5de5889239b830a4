"""Texts of results and summary for non-experts: scenario, key numbers, assumptions, arrival times, limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from thawslide.balance import balances
from thawslide.errors import printable
from thawslide.key_numbers import key_numbers
from thawslide.main_numbers import arrivals
from thawslide.maps import on_map
from thawslide.messages import Messages
from thawslide.mobility import mobility_of
from thawslide.number_text import exact_text
from thawslide.pages.ranges import Ranges, ranges_of
from thawslide.run_folder import Run
from thawslide.text_files import is_number

_KEYS = ("release_volume_m3", "travel_distance_m", "affected_area_m2", "peak_thickness_m", "peak_speed_m_s")
_DURATION = "stop_time_s"  # fifth number of a section
_SECTION_LENGTH = "runout_distance_m"  # of a section without tilted gravity, equal to the travel distance
_DASH = "–"


@dataclass(frozen=True)
class PlainNumber:
    """One number: its key in `Run.key_numbers`, value with a unit, name, a sentence that explains it, and its range.

    The range is "" without one.
    """

    key: str
    value: str
    name: str
    meaning: str
    spread: str = ""


@dataclass(frozen=True)
class ClientText:
    """All texts on a run for non-experts, in one language."""

    alerts: list[str]
    scenario: list[str]
    numbers: list[PlainNumber]
    ranges: str  # a sentence on the ranges of the numbers
    assumptions: list[str]
    arrivals: list[tuple[str, str, str]]
    limits: list[str]
    origin: list[str]
    computed: str  # author, date and program


def client_text(run: Run, say: Messages, place_of_warnings: str) -> ClientText:
    """Return the texts on a run; `place_of_warnings` is the message that states where its warnings are listed."""
    ranges = ranges_of(run)
    return ClientText(
        alerts(run, say),
        scenario(run, say, ranges),
        plain_numbers(run, say, ranges),
        say(ranges.message, count=ranges.count) if ranges else say("range_none"),
        assumptions(run, say),
        arrival_rows(run, say),
        limits(run, say, place_of_warnings),
        origin(run, say),
        _author(run) + say("computed", date=_date(run), version=run.facts.get("version", _DASH)),
    )


def _author(run: Run) -> str:
    author = str(run.section("report").get("author", ""))
    return f"{printable(author)}, " if author else ""


def alerts(run: Run, say: Messages) -> list[str]:
    """Return sentences on an incomplete run and on balances that do not close."""
    found = [] if run.is_complete else [say("alert_incomplete", time=say.time(run.last_time))]
    return found if all(each.closes for each in balances(run)) else [*found, say("alert_balance")]


def scenario(run: Run, say: Messages, ranges: Ranges | None = None) -> list[str]:
    """Return sentences on the simulated event."""
    volume = mobility_of(run).volume
    if volume is None and ranges:
        volume = ranges.own.get("release_volume_m3")
    stated = str(run.section("report").get("scenario", ""))
    sentences = [
        *([printable(stated)] if stated else []),
        say("release_unknown") if volume is None else say("release", volume=say.volume(volume)),
        say("covers", time=say.time(run.last_time)),
    ]
    if not run.is_at_rest:
        return [*sentences, say("moving")]
    since = run.rest_since
    return [*sentences, say("at_rest_since", time=say.time(since)) if np.isfinite(since) else say("at_rest")]


def plain_numbers(run: Run, say: Messages, ranges: Ranges | None = None) -> list[PlainNumber]:
    """Return up to five of the key numbers in plain words."""
    found = dict(ranges.own) if ranges else {}
    found |= {row.key: row.number for row in key_numbers(run) if np.isfinite(row.number)}
    if "travel_distance_m" not in found and _SECTION_LENGTH in found:
        found["travel_distance_m"] = found[_SECTION_LENGTH]
    keys = [key for key in _KEYS if key in found]
    keys += [_DURATION] if _DURATION in found and len(keys) < len(_KEYS) else []
    numbers = []
    for key in keys:
        text = _formats(say)[key]
        low, high = (text(each) for each in ranges.values.get(key, (0.0, 0.0))) if ranges else ("", "")
        numbers.append(
            PlainNumber(
                key,
                text(found[key]),
                say(key),
                _meaning(run, say, key, found),
                say("range", low=low, high=high) if low != high else "",
            )
        )
    return numbers


def _formats(say: Messages) -> dict[str, Callable[[float], str]]:
    """Return the function that writes each number with its unit."""

    def length(value: float) -> str:
        return say.quantity(value, "m")

    return {
        "release_volume_m3": say.volume, "travel_distance_m": length, "affected_area_m2": say.area,
        "peak_thickness_m": length, "peak_speed_m_s": say.speed, _DURATION: say.time,
    }  # fmt: skip


def _meaning(run: Run, say: Messages, key: str, found: dict[str, float]) -> str:
    if key == "travel_distance_m":
        height = found.get("drop_height_m", 0.0)
        return say(f"{key}_means", height=say.quantity(height, "m")) if height > 0.0 else say(f"{key}_plain")
    if key == "affected_area_m2":
        least = exact_text(float(run.section("maps").get("arrival_thickness", 0.0)))
        return say(f"{key}_means", least=say.localized(f"{least} m"))
    if key == "peak_speed_m_s":
        return say(f"{key}_means", speed=say.quantity(found[key], "m/s"))
    return say(f"{key}_means")


def assumptions(run: Run, say: Messages) -> list[str]:
    """Return sentences on friction, heat, ice, bed and cells of the case; those without a value are left out."""
    basal, heat = run.section("basal"), run.section("heat")
    found = []
    for key, name in (("friction_angle", "angle"), ("friction_coefficient", "coefficient")):
        if is_number(basal.get(key)):
            found.append(say(f"assume_{key}", **{name: say.number(basal[key])}))
            break
    if names := run.section("substrate"):
        found.append(say("assume_substrates", names=", ".join(name.replace("_", " ") for name in names)))
    melts = heat.get("enabled", True) and run.section("mechanisms").get("lubrication", True)
    found.append(say("assume_melt" if melts and basal.get("friction") == "lubricated" else "assume_no_melt"))
    bodies = run.section("body").values()
    if (temperature := _single(bodies, "temperature")) is not None:
        found.append(say("assume_temperature", temperature=say.number(temperature)))
    if (porosity := _single(bodies, "porosity")) is not None:
        found.append(say("assume_ice", percent=say.number(100.0 * porosity)))
    found.append(say("assume_no_bed" if run.section("bed").get("law", "none") == "none" else "assume_bed"))
    if cell := float(run.section("grid").get("cell", 0.0)):
        found.append(say("assume_cell", size=say.localized(f"{exact_text(cell)} m")))
    return found


def _single(bodies: Any, key: str) -> float | None:
    """Return the value of a key if it is one number for all bodies, None otherwise."""
    values = {float(body[key]) if is_number(body.get(key)) else None for body in bodies if isinstance(body, dict)}
    return values.pop() if len(values) == 1 else None


def arrival_rows(run: Run, say: Messages) -> list[tuple[str, str, str]]:
    """Return place, arrival after the start, and maximum thickness of each point probe."""
    return [
        (
            each.probe.replace("_", " "),
            say.quantity(each.time, "s") if np.isfinite(each.time) else say("not_reached"),
            say.quantity(each.thickness, "m") if np.isfinite(each.time) else _DASH,
        )
        for each in arrivals(run)
    ]


def limits(run: Run, say: Messages, place_of_warnings: str) -> list[str]:
    """Return sentences on questions that the numbers do not answer."""
    kind = "outline" if on_map(run) else "section"
    names = ("scenario", "release", "friction", kind, "hazards", "objects", "map")
    sentences = [say(f"limit_{name}") for name in names]
    if warnings := run.facts.get("warnings"):
        sentence = say("limit_warnings", count=len(warnings)) if len(warnings) > 1 else say("limit_warning")
        sentences.append(f"{sentence} {say(place_of_warnings)}")
    return sentences


def origin(run: Run, say: Messages) -> list[str]:
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
    line = say("origin", version=facts.get("version", _DASH), run=run.folder.resolve().name, date=_date(run))
    return [line, *([say("case_file", hash=case)] if case else [])]


def _date(run: Run) -> str:
    return str(run.facts.get("started") or _DASH)[:10]
