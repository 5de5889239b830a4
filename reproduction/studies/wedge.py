"""Apparent friction of a slide on a DEM, next to the wedge factor of the ground below it.

On a column of the slide that moves with speed v along the horizontal direction t over ground z(x, y), let
s = grad z . t be the slope along the motion and k = t . H t / (1 + s^2)^(3/2) its curvature, with the second
derivatives H of z. The load across the ground per mass, in the vertical plane of the motion, is
l = g / sqrt(1 + s^2) + k v^2. Walls at the side carry it by their normals: with a pressure that depends on the depth
alone, the sum of the pressure over the ground is larger than the load by the wedge factor

    w = sqrt((1 + |grad z|^2) / (1 + s^2)),

which is 1 on a plane and 1 / sin(half angle) in a V channel, whatever its slope. Over an interval of time

    load path   L = integral of sum(m l v) dt           (sums over particles)
    wedge factor  = integral of sum(m l w v) dt / L
    apparent friction = (energy lost to the ground) / (mu L),   mu: the coefficient of friction of the case.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from thawslide.maps import Map
from thawslide.run_folder import Numbers, Run

GRAVITY = 9.81  # m/s2


@dataclass(frozen=True)
class Ground:
    """First and second derivatives of the elevation on the points of a DEM."""

    slopes: tuple[Map, Map]  # along x and y
    bends: tuple[Map, Map, Map]  # xx, xy, yy [1/m]


@dataclass(frozen=True)
class Interval:
    """Apparent friction and wedge factor over an interval of time."""

    start: float  # [s]
    end: float
    wedge: float
    ground: float  # apparent friction over the coefficient: friction and impacts on the ground
    inside: float  # the same measure of the dissipation by yielding and viscosity


def gradient(field: Map) -> tuple[Map, Map]:
    """Return the derivatives of a map along x and y."""
    along_y, along_x = np.gradient(field.values, field.grid.cell_y, field.grid.cell_x)
    return Map(field.grid, np.asarray(along_x)), Map(field.grid, np.asarray(along_y))


def derivatives(terrain: Map) -> Ground:
    """Return the derivatives of a terrain [m]."""
    along_x, along_y = gradient(terrain)
    bend_xx, bend_xy = gradient(along_x)
    return Ground((along_x, along_y), (bend_xx, bend_xy, gradient(along_y)[1]))


def rates(ground: Ground, points: Numbers, velocity: Numbers, mass: Numbers) -> tuple[float, float]:
    """Return sum(m l v) and sum(m l w v) [W] of particles at points [m] with velocities [m/s]."""
    x, y = points[:, 0], points[:, 1]
    level = np.hypot(velocity[:, 0], velocity[:, 1])
    moving = level > 1e-6
    tx, ty = (np.divide(velocity[:, axis], level, out=np.zeros_like(level), where=moving) for axis in (0, 1))
    slope_x, slope_y = (field.at(x, y) for field in ground.slopes)
    bend_xx, bend_xy, bend_yy = (field.at(x, y) for field in ground.bends)
    along = 1.0 + (slope_x * tx + slope_y * ty) ** 2
    curvature = (bend_xx * tx**2 + 2.0 * bend_xy * tx * ty + bend_yy * ty**2) / along**1.5
    speed = level * np.sqrt(along)
    load = GRAVITY / np.sqrt(along) + curvature * speed**2  # bumps cancel out in the sum
    wedge = np.sqrt((1.0 + slope_x**2 + slope_y**2) / along)
    known = moving & np.isfinite(load) & np.isfinite(wedge)
    power = (mass * load * speed)[known]
    return float(power.sum()), float((power * wedge[known]).sum())


def intervals(run: Run, terrain: Map, coefficient: float, length: float) -> list[Interval]:
    """Return intervals of about a length [s], from the snapshots and the history of a run."""
    ground = derivatives(terrain)
    fields = ("velocity", "mass")
    times, found = [], []
    for index in range(len(run.snapshot_files)):
        snapshot = run.snapshot(index, fields=fields)
        times.append(snapshot.time)
        found.append(rates(ground, snapshot.points, snapshot["velocity"], snapshot["mass"]))
    paths = cumulative(np.array(times), np.array(found))
    history = run.series
    lost = {
        "ground": history["friction_work_J"] + history["contact_loss_J"],
        "inside": history["plastic_J"] + history["viscous_J"],
    }
    at = {name: np.interp(times, history["time_s"], values) for name, values in lost.items()}
    ends = [0]
    for index, time in enumerate(times):
        if time >= times[ends[-1]] + length - 1e-6:
            ends.append(index)
    result = []
    for first, last in pairwise(ends):
        load, wedged = paths[last] - paths[first]
        result.append(
            Interval(
                times[first],
                times[last],
                float(wedged / load),
                *(float((at[name][last] - at[name][first]) / (coefficient * load)) for name in ("ground", "inside")),
            )
        )
    return result


def cumulative(times: Numbers, values: Numbers) -> Numbers:
    """Return integrals over time from the first time on, by the trapezoidal rule."""
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(times)[:, None]
    return np.vstack([np.zeros((1, values.shape[1])), np.cumsum(steps, axis=0)])
