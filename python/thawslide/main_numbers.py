"""Main numbers of a run: release, mobility, peak values, affected area, deposit and arrival."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from thawslide.errors import ReportError
from thawslide.maps import on_map
from thawslide.mobility import Mobility, mobility_of
from thawslide.number_text import area_text, exact_text, number_text, quantity_text, volume_text
from thawslide.run_folder import Run
from thawslide.section_thickness import peak_thickness

_ARRIVAL_KEY = "arrival_time_s"
ARRIVED = 0.99  # fraction of the runout distance of a 2D run


@dataclass(frozen=True)
class KeyNumber:
    """One row of the table: label, value as text with its unit, and a remark (can be empty).

    `key` is the name of `number`, and ends with its unit as columns of the history do. A number without a value is nan.
    """

    words: str
    value: str
    remark: str = ""
    key: str = ""
    number: float = math.nan


@dataclass(frozen=True)
class Arrival:
    """A point probe: its name, the time of the run [s] at which the mass arrives, and its maximum thickness [m].

    nan if the mass does not reach it.
    """

    probe: str
    time: float
    thickness: float


def main_numbers(run: Run) -> list[KeyNumber]:
    """Return the rows for which the run has data."""
    mobility = mobility_of(run)
    rows = []
    if mobility.volume is not None:
        remark, volume = "volume of the sliding mass at t = 0", mobility.volume
        rows.append(KeyNumber("Release volume", volume_text(volume), remark, "release_volume_m3", volume))
    rows += _distances(run, mobility)
    rows += _map_peaks(run) if on_map(run) else _section_peaks(run)
    rows += _areas(run)
    rows += _arrivals(run)
    return rows


def metres(value: float) -> str:
    """Return a length [m] with its unit."""
    return quantity_text(float(value), "m")


def _distances(run: Run, mobility: Mobility) -> list[KeyNumber]:
    rows = []
    if mobility.height is not None:
        remark = "from the highest point of the release to the terrain at the front"
        rows.append(KeyNumber("Drop height H", metres(mobility.height), remark, "drop_height_m", mobility.height))
    if _has_travel_distance(run) and mobility.length is not None:
        where = "along the flow path" if run.dimension == 3 else "perpendicular to gravity"
        remark = f"{where}: front at {run.last_state} minus initial rear"
        value, length = metres(mobility.length), mobility.length
        rows.append(KeyNumber("Travel distance L", value, remark, "travel_distance_m", length))
    rows += _front_numbers(run)
    if mobility.ratio is not None:
        angle = f"reach angle {np.degrees(np.arctan(mobility.ratio)):.1f}°"
        distance = "travel distance" if _has_travel_distance(run) else "runout distance"
        remark = f"drop height over {distance}, {angle}: lower values mean higher mobility"
        rows.append(KeyNumber("H/L", number_text(mobility.ratio, 2), remark, "h_over_l", mobility.ratio))
    return rows


def _has_travel_distance(run: Run) -> bool:
    """Return whether L differs from the runout distance along x: in 3D, and in a section with tilted gravity."""
    return run.dimension == 3 or run.gravity_tilt != 0.0


def _front_numbers(run: Run) -> list[KeyNumber]:
    """Return runout distance and front travel distance; without maps.path a 3D run has neither before it moves.

    If run.json has the travel distance, which equals the runout distance, `_distances` returns it instead.
    """
    rows = []
    if "runout_m" in run.series:
        runout = run.series["runout_m"]
        initial = f"; initial length {metres(runout[0])}" if np.isfinite(runout[0]) else ""
        remark = f"front at {run.last_state} minus initial rear{initial}"
        if run.facts.get("travel_distance_m") is None:
            is_tilted = run.dimension == 2 and run.gravity_tilt != 0.0
            words, where = ("Runout distance", "along x: ") if is_tilted else ("Runout distance L", "")
            rows.append(_along_path(words, runout[-1], where + remark, "runout_distance_m"))
        first = int(np.argmax(np.isfinite(runout)))  # 0 if all are unknown
        since = (
            "the start" if first == 0 else f"{quantity_text(float(run.series['time_s'][first]), 's')}, the first known"
        )
        remark = f"front at {run.last_state} minus front at {since}"
        rows.append(_along_path("Front travel distance", runout[-1] - runout[first], remark, "front_travel_distance_m"))
    return rows


def _along_path(words: str, value: float, remark: str, key: str) -> KeyNumber:
    if np.isfinite(value):
        return KeyNumber(words, metres(value), remark, key, float(value))
    reason = "no flow path: maps.path is not specified, and the mass has barely moved"
    return KeyNumber(words, "not available", reason, key)


def maximum_of_map(run: Run, name: str) -> float | None:
    """Return the maximum of a map, None if the map is missing, damaged or without data."""
    try:
        values = run.maps[name].values
    except ReportError:
        return None
    return float(np.nanmax(values)) if np.isfinite(values).any() else None


def _map_peaks(run: Run) -> list[KeyNumber]:
    rows = []
    speed, thickness = "maximum of the depth-averaged speed", "vertical, maximum"
    for words, name, unit, remark, key in (
        ("Peak speed", "max_speed", "m/s", f"{speed} of any map cell and time", "peak_speed_m_s"),
        ("Peak flow thickness", "max_thickness", "m", f"{thickness} of any map cell and time", "peak_thickness_m"),
    ):
        value = maximum_of_map(run, name)
        if value is not None:
            rows.append(KeyNumber(words, quantity_text(value, unit), remark, key, value))
    return rows


def peak_particle_speed(run: Run) -> tuple[float, int] | None:
    """Return the maximum speed [m/s] of any particle before rest, and its row of the history; None without one."""
    if "max_velocity_m_s" not in run.series:
        return None
    speed = np.where(run.series["time_s"] <= run.rest_since, run.series["max_velocity_m_s"], np.nan)
    if not np.isfinite(speed).any():
        return None
    row = int(np.nanargmax(speed))
    return float(speed[row]), row


def _section_peaks(run: Run) -> list[KeyNumber]:
    rows = []
    if (fastest := peak_particle_speed(run)) is not None:
        speed, row = fastest
        when = f"at {quantity_text(float(run.series['time_s'][row]), 's')}"
        rows.append(
            KeyNumber("Peak speed", quantity_text(speed, "m/s"), f"of any particle, {when}", "peak_speed_m_s", speed)
        )
    found = peak_thickness(run) if run.dimension == 2 else None
    if found is not None:
        thickness, time = found
        when = f"at {quantity_text(time, 's')}"
        direction = "normal to x" if run.gravity_tilt else "vertical"
        remark = f"{direction}, mean over a grid cell along the section, maximum of the snapshots ({when})"
        rows.append(KeyNumber("Peak flow thickness", metres(thickness), remark, "peak_thickness_m", thickness))
    return rows


def _areas(run: Run) -> list[KeyNumber]:
    """Return the areas and volumes of a 3D run in run.json."""
    rows = []
    what, when = ("Deposit", "") if run.facts.get("at_rest") else ("Covered", f" at {run.last_state}")
    maps = run.section("maps")
    least, thick = (f"{exact_text(float(maps.get(key, 0.0)))} m" for key in ("arrival_thickness", "area_thickness"))
    texts: tuple[tuple[str, str, Callable[[float], str], str], ...] = (
        ("Affected area", "affected_area_m2", area_text, f"horizontal, cells ever thicker than {least}"),
        (f"{what} volume{when}", "covered_volume_m3", volume_text, f"cells thicker than {least}"),
        (f"{what} area{when}", "deposit_area_m2", area_text, f"horizontal, map cells thicker than {thick}"),
        ("Inundated area", "inundated_area_m2", area_text, f"horizontal, map cells ever thicker than {thick}"),
    )
    for words, key, text, remark in texts:
        value = run.facts.get(key)
        if isinstance(value, int | float):
            rows.append(KeyNumber(words, text(float(value)), remark, key, float(value)))
    return rows


def _arrivals(run: Run) -> list[KeyNumber]:
    """Return arrival times: at the last point reached and at probes in 3D, near the final front in 2D."""
    if on_map(run):
        latest = maximum_of_map(run, "arrival_time")
        rows = []
        if latest is not None:
            remark = "time at which the last map cell of the affected area is reached"
            rows.append(KeyNumber("Latest arrival time", quantity_text(latest, "s"), remark, _ARRIVAL_KEY, latest))
        return rows + _probe_arrivals(run)
    if "runout_m" not in run.series or not run.series["runout_m"][-1] > 0.0:
        return []
    runout = run.series["runout_m"]
    at = int(np.argmax(runout >= ARRIVED * runout[-1]))
    remark = f"time at which the front attains {number_text(100.0 * ARRIVED)} % of its final runout distance"
    time = float(run.series["time_s"][at])
    return [KeyNumber("Arrival time", quantity_text(time, "s"), remark, _ARRIVAL_KEY, time)]


def _probe_arrivals(run: Run) -> list[KeyNumber]:
    rows = []
    for each in arrivals(run):
        value = quantity_text(each.time, "s") if np.isfinite(each.time) else "not reached"
        words, key = f"Arrival time at probe {each.probe}", f"{each.probe}_{_ARRIVAL_KEY}"
        rows.append(KeyNumber(words, value, "first row of probes.csv above that thickness", key, each.time))
    return rows


def arrivals(run: Run) -> list[Arrival]:
    """Return the arrival at each point probe."""
    found: list[Arrival] = []
    probes = run.probe_series
    if probes is None:
        return found
    threshold = float(run.section("maps").get("arrival_thickness", 0.0))
    for column, values in probes.items():
        probe = column.removesuffix("_thickness_m")
        if probe == column or probe.endswith("_max"):
            continue
        reached = np.flatnonzero(values > threshold)
        if reached.size:
            found.append(Arrival(probe, float(probes["time_s"][reached[0]]), float(np.nanmax(values))))
        else:
            found.append(Arrival(probe, math.nan, math.nan))
    return found
