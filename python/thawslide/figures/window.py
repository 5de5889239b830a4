"""Visible part of a section, and terrain and particles in it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from thawslide.figures.style import GROUND, GROUND_LINE
from thawslide.number_text import exact_text, length_unit
from thawslide.run_folder import Numbers

_EXAGGERATIONS = (1, 2, 3, 5, 10, 20, 50, 100)
_SMALLEST_DRAWN = 0.8 / 72.0  # inches: smaller particles would vanish between pixels


@dataclass(frozen=True)
class Window:
    """A rectangle of the section [m] with a vertical exaggeration."""

    left: float
    right: float
    bottom: float
    top: float
    exaggeration: int

    def note(self) -> str:
        """Return the vertical exaggeration in words."""
        return "true scale" if self.exaggeration == 1 else f"vertical exaggeration {self.exaggeration}×"

    def apply(self, axes: Axes, vertical: str = "elevation") -> None:
        """Set the limits, the tick labels in m or km and their names, `vertical` for that of the vertical axis."""
        axes.set_xlim(self.left, self.right)
        axes.set_ylim(self.bottom, self.top)
        for axis, span, name in (
            (axes.xaxis, self.right - self.left, "distance"),
            (axes.yaxis, self.top - self.bottom, vertical),
        ):
            divisor, unit = length_unit(span)
            axis.set_major_formatter(_divided_by(divisor))
            axis.set_label_text(f"{name} ({unit})")


def _divided_by(divisor: float) -> Callable[[float, float], str]:
    return lambda value, place: exact_text(value / divisor)


def extent(values: Numbers) -> tuple[float, float]:
    """Return the range of values without the outermost 0.1 % on either side."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 0.0, 1.0
    low, high = np.quantile(finite, [0.001, 0.999], method="nearest")
    return float(low), float(high)


def fit(
    x: tuple[float, float],
    z: tuple[float, float],
    box: float,
    domain: tuple[float, float] | None,
    margins: tuple[float, float] = (1.16, 1.3),
) -> Window:
    """Return the window of width : height `box` on the page that contains x and z [m], each widened by its margin.

    The vertical exaggeration is above 1 only for sections too long and flat to be visible at true scale. A window
    that extends past an end of the domain is shifted into it.
    """
    width = max(x[1] - x[0], 1e-9) * margins[0]
    height = max(z[1] - z[0], 0.02 * width) * margins[1]
    flatness = width / (height * box)
    exaggeration = max([1] + [e for e in _EXAGGERATIONS if e <= flatness * (1 + 1e-9)])
    if flatness >= 1.0:
        height = width / (box * exaggeration)
    else:
        width = height * box
    left = 0.5 * (x[0] + x[1] - width)
    if domain is not None:
        left = max(domain[0], min(left, domain[1] - width))
    bottom = 0.5 * (z[0] + z[1] - height)
    return Window(left, left + width, bottom, bottom + height, exaggeration)


def fill_terrain(axes: Axes, terrain: tuple[Numbers, Numbers] | None, floor: float) -> None:
    """Fill the terrain from its surface down to `floor` [m]; nothing without terrain."""
    if terrain is None:
        return
    x, z = terrain
    axes.fill_between(x, z, np.minimum(z, floor), color=GROUND, linewidth=0, zorder=1)
    axes.plot(x, z, color=GROUND_LINE, linewidth=0.9, zorder=4)


def squares(
    x: Numbers, z: Numbers, size: Numbers, window: Window, inches: tuple[float, float], widest_gap: float = 0.0
) -> PolyCollection:
    """Return particles as squares of their size [m], enlarged if necessary to be visible on `inches` of page.

    Their minimum width is `widest_gap` [m]: narrower gaps between them would look like cracks.
    """
    size_across = np.maximum(size, widest_gap)
    half_width = 0.5 * np.maximum(size_across, _SMALLEST_DRAWN * (window.right - window.left) / inches[0])
    half_height = 0.5 * np.maximum(size, _SMALLEST_DRAWN * (window.top - window.bottom) / inches[1])
    corners = np.stack(
        [
            np.stack([x + a * half_width, z + b * half_height], axis=-1)
            for a, b in ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
        ],
        axis=1,
    )
    return PolyCollection(cast(Any, corners), linewidths=0, antialiaseds=False, rasterized=True, zorder=3)
