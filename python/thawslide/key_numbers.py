"""Key numbers of a report, with units and remarks."""

from __future__ import annotations

import numpy as np

from thawslide.figures.force import force_in_band, reported_bands, reported_forces, seismic_force
from thawslide.main_numbers import KeyNumber, main_numbers, metres
from thawslide.mobility import release_volume
from thawslide.number_text import number_text, quantity_text, volume_text
from thawslide.run_folder import Run
from thawslide.targets import REFERENCE, SOURCE_VOLUME, Target, band_of, quantity_of
from thawslide.time_reference import has_time_reference, time_of_speed

STOPPED_FRACTION = 0.01  # of the peak mean velocity
BOILING = 100.0  # C, at one atmosphere


def stop_time(run: Run, below: float | None = None) -> float | None:
    """Return the time [s] from which on the mean velocity is below a value [m/s], by default 1 % of its peak.

    None if it never exceeds the value, or exceeds it at the end.
    """
    speed = run.series["mean_velocity_m_s"]
    if not np.isfinite(speed).any() or np.nanmax(speed) <= 0.0:
        return None
    moving = np.flatnonzero(~(speed < (STOPPED_FRACTION * np.nanmax(speed) if below is None else below)))
    if not moving.size:
        return None
    last = int(moving[-1])
    return float(run.series["time_s"][last + 1]) if last + 1 < len(speed) else None


def key_numbers(run: Run) -> list[KeyNumber]:
    """Return the rows for which the run has columns."""
    history = run.series
    time = run.series["time_s"]
    rows = main_numbers(run)
    end = float(history["time_s"][-1])
    rows.append(KeyNumber("Simulated time", quantity_text(end, "s"), "", "simulated_time_s", end))
    if "mean_velocity_m_s" in history:
        speed = history["mean_velocity_m_s"]
        if np.isfinite(speed).any():
            at = int(np.nanargmax(speed))
            peak, when = float(speed[at]), f"at {quantity_text(float(time[at]), 's')}"
            value = quantity_text(peak, "m/s")
            rows.append(KeyNumber("Peak mean velocity", value, when, "peak_mean_velocity_m_s", peak))
            rows.append(_stop_number(run))
    if "mean_displacement_m" in history:
        moved, remark = float(history["mean_displacement_m"][-1]), "path length, mass-weighted mean"
        rows.append(KeyNumber("Mean displacement", metres(moved), remark, "mean_displacement_m", moved))
    if "entrained_volume_m3" in history:
        per = "/m of width" if run.per_metre else ""
        fraction = 100.0 * float(history["entrained_mass_kg"][-1] / history["mass_kg"][0])
        volume = float(history["entrained_volume_m3"][-1])
        value, remark = f"{volume_text(volume)}{per}", f"{number_text(fraction)} % of the initial mass"
        rows.append(KeyNumber("Entrained bed volume", value, remark, "entrained_volume_m3", volume))
    rows += _volume_numbers(run)
    rows += _band_numbers(run)
    if "seismic_force_x_N" in history:
        rows += _force_numbers(run)
    return rows


def found_for(run: Run, target: Target) -> str:
    """Return the value of a run for a reported value, with its unit, or the reason for its absence."""
    if target.quantity == REFERENCE:
        start = time_of_speed(run, target.value)
        return f"{quantity_text(start, 's')} after the start" if np.isfinite(start) else "never"
    if not quantity_of(target.quantity).is_compared:
        return "not compared"
    if quantity_of(target.quantity).column in run.series:
        first, last = (float(run.series["time_s"][end]) for end in (0, -1))
        if has_time_reference(run) and not first <= target.time <= last:
            return f"not compared: time outside the run ({number_text(first)} to {number_text(last)} s)"
    value = _found(run, target)
    if value is None:
        return _why_not(run, target)
    when = f" at {run.last_state}" if quantity_of(target.quantity).fact and run.is_moving_at_end else ""
    return quantity_text(target.in_its_unit(value), target.unit_words) + when


def _why_not(run: Run, target: Target) -> str:
    """Return the reason why a run has no value for a reported one."""
    if quantity_of(target.quantity).column in run.series:
        return "not compared: the run never attains start_velocity"
    if quantity_of(target.quantity).fact:
        return "not available: incomplete run" if run.dimension == 3 else "not available in 2D"
    if run.per_metre:
        return "not available: no case.width"
    return "not available in the files of this run"


def _found(run: Run, target: Target) -> float | None:
    """Return the value of a run for a reported value within its times, in the first unit of its quantity, or None."""
    history, quantity = run.series, quantity_of(target.quantity)
    if quantity.column in history:
        if not has_time_reference(run):
            return None
        return float(np.interp(target.time, run.series["time_s"], history[quantity.column]))
    if quantity.fact:
        fact = run.facts.get(quantity.fact)
        return None if fact is None else float(fact)
    if target.quantity == SOURCE_VOLUME:
        return release_volume(run)
    if target in reported_forces(run) and "seismic_force_x_N" in history and not run.per_metre:
        band = band_of(target)
        magnitude = seismic_force(run)[1] if band is None else force_in_band(run, band)
        return float(np.nanmax(magnitude)) if np.isfinite(magnitude).any() else None
    return None


def boiling_note(run: Run) -> str:
    """Return a sentence if a band without boiling exceeds 100 °C, "" otherwise."""
    if "band_temperature_C" not in run.series or (run.has_band_columns and run.section("heat").get("steam", True)):
        return ""
    values = run.series["band_temperature_C"]
    if not np.any(values > BOILING):
        return ""
    first = float(run.series["time_s"][int(np.argmax(values > BOILING))])
    highest = quantity_text(float(np.nanmax(values)), "°C")
    reason = "heat.steam is false" if run.has_band_columns else "the model has no boiling in particles"
    return (
        f"The mean band temperature exceeds 100 °C from {quantity_text(first, 's')} on and attains {highest}. Water "
        f"does not boil because {reason}. At low pressure, temperatures and pressures of the band are then unreliable."
    )


def _stop_number(run: Run) -> KeyNumber:
    """Return the time of rest, or without it in run.json the time from which on the mean velocity is low."""
    key, last = "stop_time_s", quantity_text(float(run.series["mean_velocity_m_s"][-1]), "m/s")
    since = run.facts.get("rest_since_s")
    remark = "mean velocity below 1 % of its peak afterwards" if since is None else "at rest afterwards"
    stopped = since if since is not None else None if run.is_moving_at_end else stop_time(run)
    if stopped is None:
        return KeyNumber("Stop time", "not reached", f"mean velocity at {run.last_state}: {last}", key)
    value = quantity_text(float(stopped), "s")
    return KeyNumber("Stop time", value, remark, key, float(stopped))


def _volume_numbers(run: Run) -> list[KeyNumber]:
    """Return the volume change by dilation, and the removed mass."""
    rows, history, per = [], run.series, "/m of width" if run.per_metre else ""
    if "dilation_volume_m3" in history:
        fraction, volume = (float(history[f"dilation_{each}"][-1]) for each in ("fraction", "volume_m3"))
        change = f"{100.0 * fraction:+.1f} %".replace("-", "−")
        remark = f"{volume_text(abs(volume))}{per}; without entrained bed material"
        rows.append(KeyNumber("Volume change by dilation", change, remark, "dilation_fraction", fraction))
    if "left_mass_kg" in history and history["left_mass_kg"][-1] > 0.0:
        mass = float(history["left_mass_kg"][-1])
        fraction = mass / (mass + float(history["mass_kg"][-1]))
        remark = f"{number_text(100.0 * fraction)} % of the mass: left the domain or the DEM, or removed by guards"
        rows.append(KeyNumber("Mass removed", quantity_text(mass / 1e3, f"t{per}"), remark, "left_mass_kg", mass))
    return rows


def _force_numbers(run: Run) -> list[KeyNumber]:
    """Return the maximum force on the terrain, unfiltered and in the bands of reported inversions."""
    unit = "N/m of width" if run.per_metre else "N"
    forces = {"": ("peak_seismic_force_N", seismic_force(run)[1])}
    forces |= {f", band-pass {band.words}": ("", force_in_band(run, band)) for band in reported_bands(run)}
    rows = []
    for words, (key, magnitude) in forces.items():
        if np.isfinite(magnitude).any():
            at = int(np.nanargmax(magnitude))
            when = f"at {quantity_text(float(run.series['time_s'][at]), 's')}"
            peak = float(magnitude[at])
            rows.append(KeyNumber(f"Maximum seismic force{words}", quantity_text(peak, unit), when, key, peak))
    return rows


def _band_numbers(run: Run) -> list[KeyNumber]:
    rows = []
    for words, column, unit, key in (
        ("Maximum mean band temperature", "band_temperature_C", "°C", "peak_band_temperature_C"),
        ("Maximum temperature of all columns", "band_max_temperature_C", "°C", "band_max_temperature_C"),
        ("Maximum mean band pore pressure", "band_pore_pressure_Pa", "Pa", "peak_band_pore_pressure_Pa"),
        ("Maximum pore pressure ratio P/N", "band_max_pressure_ratio", "", "band_max_pressure_ratio"),
    ):
        if column in run.series:
            values = run.series[column]
            if np.isfinite(values).any():
                at = int(np.nanargmax(values))
                peak, when = float(values[at]), f"at {quantity_text(float(run.series['time_s'][at]), 's')}"
                rows.append(KeyNumber(words, quantity_text(peak, unit), when, key, peak))
            else:
                rows.append(KeyNumber(words, "none", "no particles in the band", key))
    return rows + _water_numbers(run)


def _water_numbers(run: Run) -> list[KeyNumber]:
    """Return the water lost by band columns."""
    rows = []
    for words, column in (
        ("Water drained from the band", "column_drained_kg"),
        ("Water lost as steam", "column_steam_kg"),
    ):
        if column in run.series:
            unit, lost = "t/m of width" if run.per_metre else "t", float(run.series[column][-1])
            rows.append(KeyNumber(words, quantity_text(lost / 1e3, unit), "until the end", column, lost))
    return rows
