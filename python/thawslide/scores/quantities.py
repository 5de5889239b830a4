"""Observations of an event: quantities with units, column and meaning, and the keys of observed.toml.

They are declared here only.
"""

from __future__ import annotations

from dataclasses import dataclass

from thawslide.scores.baseline import comparable_kinds
from thawslide.units import AREAS, FORCES, LENGTHS, RATIOS, SPEEDS, TIMES, VOLUMES, Units


@dataclass(frozen=True)
class Quantity:
    """A quantity: its name on pages, units, column of the table of members ("" for other data), and meaning."""

    words: str
    units: Units
    column: str
    meaning: str


QUANTITIES = {
    "release_volume": Quantity("release volume", VOLUMES, "release_volume_m3", "at the start"),
    "travel_distance": Quantity("travel distance L", LENGTHS, "travel_distance_m", "initial rear to final front"),
    "drop_height": Quantity("drop height H", LENGTHS, "drop_height_m", "highest point of the release to final front"),
    "h_over_l": Quantity("H/L", RATIOS, "h_over_l", "drop height over travel distance"),
    "duration": Quantity("duration", TIMES, "duration_s", "until the front attains 99 % of its final distance"),
    "mean_velocity": Quantity("mean velocity", SPEEDS, "mean_speed_m_s", "travel distance over duration"),
    "peak_mean_velocity": Quantity("peak mean velocity", SPEEDS, "peak_mean_velocity_m_s", "of the whole mass"),
    "peak_speed": Quantity("peak speed", SPEEDS, "peak_speed_m_s", "at any place; depth-averaged in 3D"),
    "affected_area": Quantity("affected area", AREAS, "affected_area_m2", "horizontal, ever reached"),
    "deposit_area": Quantity(
        "deposit area", AREAS, "deposit_area_m2", "horizontal, thicker than maps.area_thickness at the end"
    ),
    "inundated_area": Quantity(
        "inundated area", AREAS, "inundated_area_m2", "horizontal, ever thicker than maps.area_thickness"
    ),
    "deposit_volume": Quantity(
        "deposit volume", VOLUMES, "covered_volume_m3", "at the end, thicker than maps.arrival_thickness"
    ),
}
THICKNESS = Quantity("thickness", LENGTHS, "", "vertical, in the map cell that contains the point")
FORCE = Quantity("maximum vertical force", FORCES, "", "maximum magnitude in the band of the record")
REVERSAL = Quantity("time between the extremes of the vertical force", TIMES, "", "from upward to downward maximum")
FORCE_TIMES = {
    "dip": Quantity("time of the dip of the upward force", TIMES, "", "minimum before its last maximum"),
    "upward": Quantity("time of the last upward force", TIMES, "", "last maximum before the largest downward force"),
    "downward": Quantity("time of the largest downward force", TIMES, "", "at the shift of best correlation"),
    "along": Quantity("time of the largest horizontal force", TIMES, "", "in the direction of travel"),
}

# Tables of observed.toml, and the type or the allowed texts of each key. Numbers are at least 0, except coordinates.
_VALUE = {"value": float, "unit": str, "uncertainty": float, "source": str}
TABLES: dict[str, dict[str, type | tuple[str, ...]]] = {
    "event": {"name": str, "source": str, "kind": comparable_kinds()},
    **{name: dict(_VALUE) for name in QUANTITIES},
    "thickness": {"name": str, "x": float, "y": float, "of": ("deposit", "maximum"), **_VALUE},
    "outline": {"file": str, "area": ("affected", "deposit"), "threshold": float, "source": str},
    "force_record": {"file": str, "periods": list, "source": str},
}
OPTIONAL = ("source", "kind", "uncertainty", "of", "area", "threshold")
COORDINATES = ("x", "y")
