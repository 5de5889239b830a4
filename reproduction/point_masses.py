"""Point masses on a profile with friction that falls with slip: null models of a force on the ground.

A point moves along the profile with a_t = -g sin(theta) - mu (g cos(theta) + kappa v^2), theta being the slope angle,
positive uphill along x, and kappa the curvature. It stops where it would turn back. The force on the ground minus the
static weight is -m a. Points move alone, or those of a part together as a chain that does not stretch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers

GRAVITY = 9.81  # m/s2


@dataclass(frozen=True)
class Profile:
    """Elevation, slope angle and curvature over the arc length [m] of a smooth profile."""

    arc: Numbers
    x: Numbers
    z: Numbers
    angle: Numbers  # rad
    curvature: Numbers  # 1/m


def smooth_profile(x: Numbers, z: Numbers, spacing: float = 2.0, width: float = 60.0) -> Profile:
    """Return a profile on even x, averaged with a Hann window of a width [m], because kinks have no curvature."""
    even = np.arange(x[0], x[-1], spacing)
    half = round(0.5 * width / spacing)
    window = np.hanning(2 * half + 3)[1:-1]
    padded = np.pad(np.interp(even, x, z), half, mode="reflect", reflect_type="odd")
    height = np.convolve(padded, window / window.sum(), "valid")
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(even), np.diff(height)))))
    angle = np.arctan2(np.gradient(height), np.gradient(even))
    return Profile(arc, even, height, angle, np.gradient(angle, arc))


@dataclass(frozen=True)
class Friction:
    """Coefficients of each sample, shape (samples, 1): first, after slip [m] over a length, and beyond an x [m]."""

    first: Numbers
    later: Numbers
    length: Numbers
    glacier: Numbers
    glacier_x: float


@dataclass(frozen=True)
class Motion:
    """Forces on the ground per mass [N/kg] over time [s], upwards and along x, shape (samples, times)."""

    time: Numbers
    up: Numbers
    along: Numbers


def move(
    profile: Profile, start_x: Numbers, starts: Numbers, friction: Friction, end: float, step: float, chained: bool
) -> Motion:
    """Return the mean force of points of equal mass.

    start_x [m]: shape (points,); starts [s]: times until which points are held, shape (samples, points). `chained`:
    the points with the same time of start form a chain.
    """
    arc = np.broadcast_to(np.interp(start_x, profile.x, profile.arc), starts.shape).copy()
    initial, speed = arc.copy(), np.zeros_like(arc)
    time = np.arange(0.0, end, step)
    centre = np.empty((2, len(time), len(arc)))
    last = starts > starts.min(axis=1, keepdims=True)
    parts = (last, ~last)
    for row, now in enumerate(time):
        angle, curvature, x = (
            np.interp(arc, profile.arc, each) for each in (profile.angle, profile.curvature, profile.x)
        )
        on_rock = friction.later + (friction.first - friction.later) * np.exp(-(arc - initial) / friction.length)
        coefficient = np.where(x > friction.glacier_x, friction.glacier, on_rock)
        normal = np.maximum(GRAVITY * np.cos(angle) + curvature * speed**2, 0.0)
        acceleration = -GRAVITY * np.sin(angle) - coefficient * normal
        if chained:
            acceleration = sum(
                np.where(part, np.sum(acceleration * part, 1, keepdims=True) / np.maximum(part.sum(1), 1)[:, None], 0.0)
                for part in parts
            )
        speed = np.where(now >= starts, np.maximum(speed + step * acceleration, 0.0), 0.0)
        arc += step * speed
        centre[0, row], centre[1, row] = x.mean(axis=1), np.interp(arc, profile.arc, profile.z).mean(axis=1)
    along, up = (-np.gradient(np.gradient(each, step, axis=0), step, axis=0).T for each in centre)
    return Motion(time, up, along)
