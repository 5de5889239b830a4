"""Relief of a terrain on maps: hillshade, and round numbers for contour lines and scale bars.

Hillshade (Horn 1981, "Hill shading and the reflectance map", Proceedings of the IEEE 69(1), 14-47): the
brightness of a matt surface is the cosine of the angle between its normal n and the direction of the light l,

    shade = max(0, n . l),   n = (-k dz/dx, -k dz/dy, 1) / |...|,   l = (sin a cos h, cos a cos h, sin h)

with the azimuth a of the light clockwise from north, its height h above the horizon, and heights z exaggerated k times.
Slopes are Horn's weighted differences over the 8 neighbours,

    dz/dx = [(z_ne + 2 z_e + z_se) - (z_nw + 2 z_w + z_sw)] / (8 cell)
"""

from __future__ import annotations

import numpy as np

from thawslide.run_folder import Numbers

NORTH_WEST = 315.0  # degrees, the conventional azimuth of the light on maps
ALTITUDE = 45.0  # degrees above the horizon


def slopes(heights: Numbers, cell_x: float, cell_y: float) -> tuple[Numbers, Numbers]:
    """Return dz/dx and dz/dy of heights [m], shape (rows, columns), rows from south to north.

    The surface is extrapolated linearly at the edge. Next to a no-data cell (nan) the slope is nan.
    """
    if min(heights.shape) < 2:
        raise ValueError(f"slopes need at least 2 x 2 heights (found {heights.shape})")
    z = np.pad(heights, 1, mode="reflect", reflect_type="odd")
    east, west = z[:, 2:], z[:, :-2]
    north, south = z[2:, :], z[:-2, :]
    across = east - west
    along = north - south
    slope_x = (across[:-2] + 2.0 * across[1:-1] + across[2:]) / (8.0 * cell_x)
    slope_y = (along[:, :-2] + 2.0 * along[:, 1:-1] + along[:, 2:]) / (8.0 * cell_y)
    return slope_x, slope_y


def hillshade(
    heights: Numbers,
    cell_x: float,
    cell_y: float,
    exaggeration: float = 1.0,
    azimuth: float = NORTH_WEST,
    altitude: float = ALTITUDE,
) -> Numbers:
    """Return the brightness 0..1 of heights [m], shape (rows, columns), rows from south to north (Horn 1981)."""
    slope_x, slope_y = slopes(heights, cell_x, cell_y)
    slope_x, slope_y = exaggeration * slope_x, exaggeration * slope_y
    a, h = np.radians(azimuth), np.radians(altitude)
    light = (np.sin(a) * np.cos(h), np.cos(a) * np.cos(h), np.sin(h))
    facing = -slope_x * light[0] - slope_y * light[1] + light[2]
    shade: Numbers = np.maximum(facing / np.sqrt(slope_x**2 + slope_y**2 + 1.0), 0.0)
    return shade


def round_number(value: float) -> float:
    """Return the maximum of 1, 2, 5, 10, 20, 50, ... (and their tenths) not above a positive value."""
    if not value > 0.0:
        raise ValueError(f"expected a positive number, found {value}")
    power = 10.0 ** np.floor(np.log10(value))
    for step in (5.0, 2.0, 1.0):
        if step * power <= value * (1 + 1e-12):
            return float(step * power)
    return float(power)


def contour_levels(heights: Numbers, most: int) -> Numbers:
    """Return at most `most` levels at a round interval within the heights [m]; empty for level terrain."""
    finite = heights[np.isfinite(heights)]
    if not finite.size or finite.max() - finite.min() < 1e-6:
        return np.zeros(0)
    low, high = float(finite.min()), float(finite.max())
    interval = round_number((high - low) / most)
    while True:
        first, last = np.ceil(low / interval), np.floor(high / interval)
        if last - first + 1 <= most:
            return interval * np.arange(first, last + 1)
        interval = round_number(2.5 * interval)
