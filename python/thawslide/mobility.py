"""Mobility of an avalanche: release volume, drop height H, travel distance L and their ratio.

In 3D, H and L are those of run.json. In a 2D section, L is the horizontal distance from the initial rear to the front,
and H is the height from the highest particle at t = 0 to the terrain at the front. With tilted gravity, horizontal and
height refer to the direction of gravity; otherwise L is the runout distance of the history.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.run_folder import Run


@dataclass(frozen=True)
class Mobility:
    """Volume [m3], drop height H [m] and travel distance L [m] of a run; None if not available."""

    volume: float | None
    height: float | None
    length: float | None

    @property
    def ratio(self) -> float | None:
        """H/L, None unless both are positive."""
        if self.height is None or self.length is None or self.height <= 0.0 or self.length <= 0.0:
            return None
        return self.height / self.length


def mobility_of(run: Run) -> Mobility:
    """Return the mobility of a run."""
    if run.dimension == 3:
        height, length = (_fact(run, name) for name in ("drop_height_m", "travel_distance_m"))
    else:
        height, length = _in_section(run)
    return Mobility(release_volume(run), height, length)


def release_volume(run: Run) -> float | None:
    """Return the volume [m3] of the sliding mass at t = 0, None without a readable snapshot of it or a width."""
    try:
        if run.per_metre or not run.times.size or run.times[0] > 0.0:
            return None
        volume = float(np.sum(run.snapshot(0, fields=["volume"])["volume"]))
    except ReportError:
        return None
    return volume * run.width if run.dimension == 2 else volume


def _fact(run: Run, name: str) -> float | None:
    value = run.facts.get(name)
    return float(value) if isinstance(value, int | float) else None


def _in_section(run: Run) -> tuple[float | None, float | None]:
    """Return drop height and travel distance of a 2D run."""
    if "runout_m" not in run.series or not np.isfinite(run.series["runout_m"][-1]):
        return None, None
    runout = float(run.series["runout_m"][-1])
    tilt = math.radians(run.gravity_tilt)
    up, onward = np.array([-math.sin(tilt), math.cos(tilt)]), np.array([math.cos(tilt), math.sin(tilt)])
    untilted = runout if tilt == 0.0 else None
    try:
        if run.terrain is None or "front_position_m" not in run.series:
            return None, untilted
        x = float(run.series["front_position_m"][-1])
        front, rear = (_on_ground(run, each) for each in (x, x - _direction(run) * runout))
        length = untilted if tilt == 0.0 else _finite(abs(float(onward @ (front - rear))))
        if not run.times.size or run.times[0] > 0.0:
            return None, length
        points = run.snapshot(0, fields=()).points[:, [0, run.vertical]]
        return _finite(float(np.nanmax(points @ up) - up @ front)), length
    except (ReportError, ValueError):  # ValueError: no particles
        return None, untilted


def _direction(run: Run) -> float:
    """Return 1 for a run towards +x, -1 for one towards -x: the runout distance increases with the front."""
    front, runout = run.series["front_position_m"], run.series["runout_m"]
    return -1.0 if (front[-1] - front[0]) * (runout[-1] - runout[0]) < 0.0 else 1.0


def _on_ground(run: Run, x: float) -> Numbers:
    """Return the point of the terrain at x [m], nan outside it."""
    assert run.terrain is not None
    return np.array([x, np.interp(x, *run.terrain, left=np.nan, right=np.nan)])


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
