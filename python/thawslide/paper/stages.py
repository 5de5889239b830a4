"""Sec. 4.2, stage by stage: before and after 75 s; and the ground as rigid points."""

from __future__ import annotations

import numpy as np

from thawslide.paper.block import at
from thawslide.run import Run

START, PEAK, END = 40.0, 75.0, 200.0  # s: the stages of the text


def heating(run: Run, start: float, end: float) -> float:
    """Return the mean power of friction heat [GW] between two times [s]; nan where the run is shorter."""
    return (at(run, "friction_heat_J", end) - at(run, "friction_heat_J", start)) / (end - start) / 1e9


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return speeds and heating of the stages, and what Lamplugh does on rigid points."""
    run = runs["lamplugh"]
    found = {
        "lamplugh_speed_75s": at(run, "mean_velocity_m_s", PEAK),
        "lamplugh_speed_end": at(run, "mean_velocity_m_s", END),
        "lamplugh_heating_before": heating(run, START, PEAK),
        "lamplugh_heating_after": heating(run, PEAK, END),
        "lamplugh_displacement_60s": at(run, "mean_displacement_m", 60.0),
    }
    for name in ("points", "points_540"):
        history = runs[f"lamplugh-{name.replace('_', '-')}"].history
        found[f"lamplugh_{name}_displacement"] = float(history["mean_displacement_m"][-1])
        found[f"lamplugh_{name}_peak"] = float(np.max(history["mean_velocity_m_s"]))
    return found
