"""The few numbers a report opens with, each with its unit and what it means."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thawslide.clock import has_clock, time_of_speed
from thawslide.figures.energy import relative_residual
from thawslide.figures.force import force_in_band, reported_bands, reported_forces, seismic_force
from thawslide.figures.style import area_text, prefixed, volume_text
from thawslide.run import Run
from thawslide.targets import SETS_CLOCK, SOURCE_VOLUME, Target, band_of, quantity_of

STOPPED_SHARE = 0.01  # of the peak mean velocity
BOILING = 100.0  # C, at one atmosphere


@dataclass(frozen=True)
class KeyNumber:
    """One row of the table: words, the value as text with its unit, and a remark (may be empty)."""

    words: str
    value: str
    remark: str = ""


def shown(value: float, unit: str = "") -> str:
    """Write a number with four significant digits, an SI prefix where the unit takes one, and its unit."""
    if not np.isfinite(value):
        return "none"
    if unit in ("Pa", "N", "J", "m", "N/m of width") and abs(value) >= 1e4:
        divisor, unit = prefixed(value, unit)
        value /= divisor
    text = f"{value:.4g}".replace("e+0", "e").replace("e+", "e").replace("-", "−")
    return f"{text} {unit}".strip()


def stop_time(run: Run, below: float | None = None) -> float | None:
    """Return when [s] the mean velocity falls below a speed [m/s] for good, None where it does not or never passed it.

    Without `below` that is 1 % of its peak.
    """
    speed = run.history["mean_velocity_m_s"]
    if not np.isfinite(speed).any() or np.nanmax(speed) <= 0.0:
        return None
    moving = np.flatnonzero(~(speed < (STOPPED_SHARE * np.nanmax(speed) if below is None else below)))
    if not moving.size:
        return None
    last = int(moving[-1])
    return float(run.history["time_s"][last + 1]) if last + 1 < len(speed) else None


def key_numbers(run: Run) -> list[KeyNumber]:
    """Return the rows that this run has columns for."""
    history = run.history
    time = run.shown_time
    rows = [KeyNumber("Simulated time", shown(float(history["time_s"][-1]), "s"))]
    if "mean_velocity_m_s" in history:
        speed = history["mean_velocity_m_s"]
        if np.isfinite(speed).any():
            at = int(np.nanargmax(speed))
            rows.append(
                KeyNumber("Peak mean velocity", shown(float(speed[at]), "m/s"), f"at {shown(float(time[at]), 's')}")
            )
            rows.append(_stop_number(run))
    rows += _front_numbers(run)
    if "mean_displacement_m" in history:
        rows.append(
            KeyNumber("Mean displacement", _metres(history["mean_displacement_m"][-1]), "path length, mean of mass")
        )
    if "entrained_volume_m3" in history:
        per = "/m of width" if run.per_metre else ""
        share = float(history["entrained_mass_kg"][-1] / history["mass_kg"][0])
        volume = shown(float(history["entrained_volume_m3"][-1]), f"m³{per}")
        rows.append(KeyNumber("Bed taken up", volume, f"{shown(share)} of the slide's mass at the start"))
    rows += _volume_numbers(run)
    rows += _map_numbers(run)
    rows += _band_numbers(run)
    if "seismic_force_x_N" in history:
        rows += _force_numbers(run)
    for words, column in (("Mechanical", "mechanical_residual_J"), ("Thermal", "thermal_residual_J")):
        if column in history:
            residual = relative_residual(run, column)
            value = shown(float(np.nanmax(residual))) if residual is not None else "nothing changed"
            rows.append(KeyNumber(f"{words} energy residual", value, "largest, over the largest change of any account"))
    return rows


def found_for(run: Run, target: Target) -> str:
    """Return what a run has for a reported value, with its unit, or why it has nothing to compare."""
    if target.quantity == SETS_CLOCK:
        start = time_of_speed(run, target.value)
        return f"{shown(start, 's')} after its start" if np.isfinite(start) else "never"
    if not quantity_of(target.quantity).is_compared:
        return "not compared"
    if quantity_of(target.quantity).column in run.history:
        first, last = (float(run.shown_time[end]) for end in (0, -1))
        if has_clock(run) and not first <= target.time <= last:
            return f"not compared: the run is of {first:.4g} to {last:.4g} s"
    value = _found(run, target)
    if value is None:
        return _why_not(run, target)
    when = f" at {run.last_state}" if quantity_of(target.quantity).fact and run.moves_at_end else ""
    return shown(target.in_its_unit(value), target.unit_words) + when


def _why_not(run: Run, target: Target) -> str:
    """Return why a run has nothing for a reported value."""
    if quantity_of(target.quantity).column in run.history:
        return "not compared: the run never reaches the speed that sets the clock"
    if quantity_of(target.quantity).fact:
        return "not known: this takes a 3D run that came to its end" if run.dimension == 3 else "not known in 2D"
    if run.per_metre:
        return "not known: the case gives no width (case.width)"
    return "not in the files of this run"


def _found(run: Run, target: Target) -> float | None:
    """Return what a run has for a reported value within its times, in the first unit of its quantity.

    None for nothing to compare.
    """
    history, quantity = run.history, quantity_of(target.quantity)
    if quantity.column in history:
        if not has_clock(run):
            return None
        return float(np.interp(target.time, run.shown_time, history[quantity.column]))
    if quantity.fact:
        fact = run.facts.get(quantity.fact)
        return None if fact is None else float(fact)
    if target.quantity == SOURCE_VOLUME:
        return _source_volume(run)
    if target in reported_forces(run) and "seismic_force_x_N" in history and not run.per_metre:
        band = band_of(target)
        magnitude = seismic_force(run)[1] if band is None else force_in_band(run, band)
        return float(np.nanmax(magnitude)) if np.isfinite(magnitude).any() else None
    return None


def _source_volume(run: Run) -> float | None:
    """Return the volume [m3] of the slide at t = 0, None without a snapshot of it or a width."""
    if run.per_metre or not run.times.size or run.times[0] > 0.0:
        return None
    volume = float(np.sum(run.snapshot(0, fields=["volume"])["volume"]))
    return volume * run.width if run.dimension == 2 else volume


def boiling_note(run: Run) -> str:
    """Return a plain sentence where a band that does not boil passes 100 °C, "" otherwise."""
    if "band_temperature_C" not in run.history or (run.has_band_columns and run.section("heat").get("steam", True)):
        return ""
    values = run.history["band_temperature_C"]
    if not np.any(values > BOILING):
        return ""
    first = float(run.shown_time[int(np.argmax(values > BOILING))])
    highest = shown(float(np.nanmax(values)), "°C")
    nothing = "Nothing boils, as heat.steam is false" if run.has_band_columns else "Nothing in the model boils"
    return (
        f"The mean band temperature passes 100 °C at {shown(first, 's')} and reaches {highest}. {nothing}: where the "
        "pressure is low, read temperatures and pressures of the band beyond this with care."
    )


def _stop_number(run: Run) -> KeyNumber:
    """Return since when the slide is at rest; of a run whose run.json does not say, when its mean velocity fell."""
    last = shown(float(run.history["mean_velocity_m_s"][-1]), "m/s")
    since = run.facts.get("rest_since_s")
    if since is not None:
        return KeyNumber("Stop time", shown(float(since) + run.clock.shift, "s"), "at rest from here on")
    stopped = None if run.moves_at_end else stop_time(run)
    if stopped is None:
        return KeyNumber("Stop time", "not reached", f"mean velocity at {run.last_state}: {last}")
    return KeyNumber(
        "Stop time", shown(stopped + run.clock.shift, "s"), "mean velocity below 1 % of its peak from here on"
    )


def _volume_numbers(run: Run) -> list[KeyNumber]:
    """Return how the volume has changed by dilation, and what has left."""
    rows, history, per = [], run.history, "/m of width" if run.per_metre else ""
    if "dilation_volume_m3" in history:
        change = f"{float(history['dilation_share'][-1]):+.1%}".replace("-", "−").replace("%", " %")
        volume = volume_text(abs(float(history["dilation_volume_m3"][-1])))
        rows.append(KeyNumber("Volume change by dilation", change, f"{volume}{per}; without the bed taken up"))
    if "left_mass_kg" in history and history["left_mass_kg"][-1] > 0.0:
        mass = float(history["left_mass_kg"][-1])
        share = mass / (mass + float(history["mass_kg"][-1]))
        remark = f"{100.0 * share:.3g} % of the mass: left the domain or the terrain model, or removed by guards"
        rows.append(KeyNumber("Mass removed", shown(mass / 1e3, f"t{per}"), remark))
    return rows


def _metres(value: float) -> str:
    return f"{value:,.0f} m".replace("-", "−") if abs(value) >= 1000.0 else shown(float(value), "m")


def _front_numbers(run: Run) -> list[KeyNumber]:
    """Return runout and way of the front; without maps.path a 3D run knows neither before its slide has moved."""
    rows = []
    if "runout_m" in run.history:
        runout = run.history["runout_m"]
        own = f", {_metres(runout[0])} of it before anything moves" if np.isfinite(runout[0]) else ""
        rows.append(_along_path("Runout", runout[-1], f"front at {run.last_state} less rear at the start{own}"))
        first = int(np.argmax(np.isfinite(runout)))  # 0 where none is
        since = "the start" if first == 0 else f"{shown(float(run.shown_time[first]), 's')}, the first known"
        remark = f"front at {run.last_state} less front at {since}"
        rows.append(_along_path("Way of the front", runout[-1] - runout[first], remark))
    return rows


def _along_path(words: str, value: float, remark: str) -> KeyNumber:
    if np.isfinite(value):
        return KeyNumber(words, _metres(value), remark)
    return KeyNumber(
        words, "not known", "maps.path is not given, and the slide has hardly moved: no path to measure along"
    )


def _force_numbers(run: Run) -> list[KeyNumber]:
    """Return the largest force on the ground, as it is and as those who inverted seismic waves would have it."""
    unit = "N/m of width" if run.per_metre else "N"
    forces = {"": seismic_force(run)[1]}
    forces |= {f", band-passed {band.words}": force_in_band(run, band) for band in reported_bands(run)}
    rows = []
    for words, magnitude in forces.items():
        if np.isfinite(magnitude).any():
            at = int(np.nanargmax(magnitude))
            when = f"at {shown(float(run.shown_time[at]), 's')}"
            rows.append(KeyNumber(f"Largest seismic force{words}", shown(float(magnitude[at]), unit), when))
    return rows


def _map_numbers(run: Run) -> list[KeyNumber]:
    """Return what run.json says of a slide on a DEM."""
    rows = []
    what, when = ("Deposit", "") if run.facts.get("at_rest") else ("Slide", f" at {run.last_state}")
    for words, key, text, remark in (
        (f"{what} volume{when}", "covered_volume_m3", volume_text, "where thicker than maps.arrival_thickness"),
        (f"{what} area{when}", "covered_area_m2", area_text, "of the same, horizontal"),
        ("Affected area", "affected_area_m2", area_text, "ever thicker than maps.arrival_thickness, horizontal"),
        ("Travel distance", "travel_distance_m", _metres, "along the path, from the release's rear end to the front"),
        ("Drop height", "drop_height_m", _metres, "of the ground at the front below the highest point of the release"),
        ("Angle of reach", "angle_of_reach_degrees", lambda value: f"{value:.1f}°", "drop height over travel distance"),
    ):
        value = run.facts.get(key)
        if isinstance(value, int | float):
            rows.append(KeyNumber(words, text(float(value)), remark))
    return rows


def _band_numbers(run: Run) -> list[KeyNumber]:
    rows = []
    for words, column, unit in (
        ("Highest mean band temperature", "band_temperature_C", "°C"),
        ("Hottest column of the band", "band_hottest_C", "°C"),
        ("Highest mean band pore pressure", "band_pore_pressure_Pa", "Pa"),
        ("Largest pore pressure over its N", "band_largest_pressure_ratio", ""),
    ):
        if column in run.history:
            values = run.history[column]
            if np.isfinite(values).any():
                at = int(np.nanargmax(values))
                when = f"at {shown(float(run.shown_time[at]), 's')}"
                rows.append(KeyNumber(words, shown(float(values[at]), unit), when))
            else:
                rows.append(KeyNumber(words, "none", "no particle was ever in the band"))
    return rows + _water_numbers(run)


def _water_numbers(run: Run) -> list[KeyNumber]:
    """Return what water the columns of a band lost."""
    rows = []
    for words, column in (("Water vented by the band", "column_vented_kg"), ("Water gone as steam", "column_steam_kg")):
        if column in run.history:
            unit = "t/m of width" if run.per_metre else "t"
            rows.append(KeyNumber(words, shown(float(run.history[column][-1]) / 1e3, unit), "by the end"))
    return rows
