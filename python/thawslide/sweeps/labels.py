"""Names and units of keys and results, for axes and tables."""

from __future__ import annotations

from thawslide.number_text import unit_text
from thawslide.sweeps.declared import unit_of_key

# Columns of the table of members that no history has: name and unit.
NUMBERS = {
    "simulated_time_s": ("simulated time", "s"),
    "release_volume_m3": ("release volume", "m³"),
    "drop_height_m": ("drop height H", "m"),
    "travel_distance_m": ("travel distance L", "m"),
    "h_over_l": ("H/L", ""),
    "reach_angle_degrees": ("reach angle", "degrees"),
    "peak_speed_m_s": ("peak speed", "m/s"),
    "peak_thickness_m": ("peak flow thickness", "m"),
    "latest_arrival_s": ("latest arrival time", "s"),
    "peak_mean_velocity_m_s": ("peak mean velocity", "m/s"),
    "max_band_temperature_C": ("maximum band temperature", "°C"),
    "max_column_temperature_C": ("maximum column temperature", "°C"),
    "max_band_pore_pressure_Pa": ("maximum band pore pressure", "Pa"),
    "max_pressure_ratio": ("maximum pore pressure ratio P/N", ""),
    "mean_displacement_m": ("mean displacement", "m"),
    "displacement_m": ("displacement", "m"),
    "runout_m": ("runout distance", "m"),
    "left_path_at_s": ("time of leaving the path", "s"),
    "entrained_volume_m3": ("entrained volume", "m³"),
    "left_mass_kg": ("mass that left", "kg"),
    "dilation_fraction": ("relative volume change", ""),
    "stop_time_s": ("stop time", "s"),
    "max_seismic_force_N": ("maximum seismic force", "N"),
    "affected_area_m2": ("affected area", "m²"),
    "covered_area_m2": ("covered area", "m²"),
    "deposit_area_m2": ("deposit area", "m²"),
    "inundated_area_m2": ("inundated area", "m²"),
    "covered_volume_m3": ("covered volume", "m³"),
}
_UNITS_OF_PROBES = {"_thickness_m": "m", "_speed_m_s": "m/s", "_passed_volume_m3": "m3"}


def name_and_unit(column: str) -> tuple[str, str]:
    """Return name and unit of a result; a column of the user has its own name and no unit."""
    if column in NUMBERS:
        return NUMBERS[column]
    if column.startswith("probe_"):
        for end, unit in _UNITS_OF_PROBES.items():
            if column.endswith(end):
                return f"{column.removesuffix(end).replace('_', ' ')}{_name_of(end, unit)}", unit_text(unit)
    return column, ""


def label(name: str, unit: str) -> str:
    """Return a name with its unit, for an axis."""
    return f"{name} ({unit})" if unit else name


def label_of_result(column: str) -> str:
    """Return the label of a result."""
    return label(*name_and_unit(column))


def label_of_key(key: str) -> str:
    """Return the label of a varied key."""
    return label(key, unit_of_key(key))


def _name_of(end: str, unit: str) -> str:
    """Return the name of the end of a column, without its unit."""
    return end.removesuffix(f"_{unit.replace('/', '_')}").replace("_", " ")
