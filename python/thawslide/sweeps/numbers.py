"""Key numbers of a member as columns of the table, and its thinned time series."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError
from thawslide.figures.force import seismic_force
from thawslide.key_numbers import stop_time
from thawslide.main_numbers import maximum_of_map, peak_particle_speed
from thawslide.maps import on_map
from thawslide.mobility import mobility_of
from thawslide.run_folder import Run
from thawslide.section_thickness import peak_thickness
from thawslide.sweeps.expressions import Expression

_MOST_ROWS = 400  # of the time series of a member
_ROUNDING = 1e-9  # of times
_PEAKS = (
    ("mean_velocity_m_s", "peak_mean_velocity_m_s"),
    ("band_temperature_C", "max_band_temperature_C"),
    ("band_max_temperature_C", "max_column_temperature_C"),
    ("band_pore_pressure_Pa", "max_band_pore_pressure_Pa"),
    ("band_max_pressure_ratio", "max_pressure_ratio"),
)  # column of the history, and the name of its maximum
_LAST = ("mean_displacement_m", "runout_m", "entrained_volume_m3", "left_mass_kg", "dilation_fraction")
_FACTS = (
    "affected_area_m2",
    "covered_area_m2",
    "deposit_area_m2",
    "inundated_area_m2",
    "covered_volume_m3",
    "reach_angle_degrees",
)


def numbers_of_run(run: Run, expressions: Sequence[Expression]) -> dict[str, float]:
    """Return the key numbers of a run; nan if not available."""
    history, mobility = run.series, mobility_of(run)
    numbers: dict[str, float | None] = {
        "simulated_time_s": float(history["time_s"][-1]),
        "release_volume_m3": mobility.volume,
        "drop_height_m": mobility.height,
        "travel_distance_m": mobility.length,
        "h_over_l": mobility.ratio,
    }
    if on_map(run):
        numbers["peak_speed_m_s"] = maximum_of_map(run, "max_speed")
        numbers["peak_thickness_m"] = maximum_of_map(run, "max_thickness")
        numbers["latest_arrival_s"] = maximum_of_map(run, "arrival_time")
    else:
        fastest, thickest = peak_particle_speed(run), peak_thickness(run)
        numbers["peak_speed_m_s"] = fastest[0] if fastest else None
        numbers["peak_thickness_m"] = thickest[0] if thickest else None
    numbers |= {name: float(history[name][-1]) for name in _LAST if name in history}
    numbers |= {name: _peak(history[column]) for column, name in _PEAKS if column in history}
    if "mean_velocity_m_s" in history:
        since = run.facts.get("rest_since_s")
        numbers["stop_time_s"] = stop_time(run) if since is None else float(since)
    with suppress(NotInRunError):
        numbers["max_seismic_force_N"] = _peak(seismic_force(run)[1])
    numbers |= {name: float(run.facts[name]) for name in _FACTS if isinstance(run.facts.get(name), int | float)}
    numbers |= _probe_numbers(run)
    return _complete(numbers, history, expressions)


def numbers_of_block(
    rows: Mapping[str, Numbers], expressions: Sequence[Expression], end: float = 0.0
) -> dict[str, float]:
    """Return the key numbers of a rigid block from the columns of its rows; end: of the case [s]."""
    height, length = float(rows["drop_height_m"][-1]), float(rows["travel_distance_m"][-1])
    numbers: dict[str, float | None] = {
        "simulated_time_s": float(rows["time_s"][-1]),
        "left_path_at_s": float(rows["time_s"][-1]) if rows["time_s"][-1] < end * (1.0 - _ROUNDING) else None,
        "drop_height_m": height,
        "travel_distance_m": length,
        "h_over_l": height / length if length > 0.0 and height > 0.0 else None,
        "peak_speed_m_s": _peak(rows["velocity_m_s"]),
        "displacement_m": float(rows["displacement_m"][-1]),
        "runout_m": float(rows["front_position_m"][-1] - rows["front_position_m"][0]),
        "max_band_temperature_C": _peak(rows["band_temperature_C"]),
        "max_band_pore_pressure_Pa": _peak(rows["band_pore_pressure_Pa"]),
    }
    return _complete(numbers, rows, expressions)


def series_of(columns: Mapping[str, Numbers]) -> dict[str, Numbers]:
    """Return time, mean speed and distance of a history or of the rows of a block, at most 400 rows."""
    time = columns["time_s"]
    names = {
        "speed_m_s": ("mean_velocity_m_s", "velocity_m_s"),
        "runout_m": ("runout_m", "displacement_m"),
    }
    rows = np.unique(np.linspace(0, len(time) - 1, min(len(time), _MOST_ROWS)).round().astype(int))
    found = {"time_s": time[rows]}
    for name, candidates in names.items():
        if column := next((each for each in candidates if each in columns), None):
            found[name] = columns[column][rows]
    return found


def _complete(
    numbers: dict[str, float | None], columns: Mapping[str, Numbers], expressions: Sequence[Expression]
) -> dict[str, float]:
    found = {name: float("nan") if value is None else float(value) for name, value in numbers.items()}
    return found | {each.name: each.value(columns) for each in expressions}


def _peak(values: Numbers) -> float | None:
    return float(np.nanmax(values)) if np.isfinite(values).any() else None


def _probe_numbers(run: Run) -> dict[str, float | None]:
    """Return maxima at probes, and the volume that passed each cross section."""
    if run.probe_series is None:
        return {}
    numbers: dict[str, float | None] = {}
    for column, values in run.probe_series.items():
        if column.endswith(("_thickness_m", "_speed_m_s")):
            numbers[f"probe_{column}"] = _peak(values)
        elif column.endswith("_discharge_m3_s"):
            name = column.removesuffix("_discharge_m3_s")
            passed = np.trapezoid(np.nan_to_num(values), run.probe_series["time_s"])
            numbers[f"probe_{name}_passed_volume_m3"] = float(passed)
    return numbers
