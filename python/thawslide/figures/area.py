"""A rectangle of a figure, in which a part of a page is drawn at its size in print."""

from __future__ import annotations

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure


@dataclass(frozen=True)
class Area:
    """A rectangle of a figure; lengths are in inches, from the top left corner."""

    figure: Figure
    left: float
    top: float
    width: float
    height: float

    def axes(self, left: float, top: float, width: float, height: float) -> Axes:
        """Return axes at a position in the rectangle."""
        x, y = self.point(left, top + height)
        whole_width, whole_height = self.figure.get_size_inches()
        return self.figure.add_axes((x, y, width / whole_width, height / whole_height))

    def point(self, left: float, top: float) -> tuple[float, float]:
        """Return a point of the rectangle as fractions of the figure, from the bottom left corner."""
        width, height = self.figure.get_size_inches()
        return float((self.left + left) / width), float(1.0 - (self.top + top) / height)


def whole_figure(width: float, height: float) -> Area:
    """Return a new figure as a rectangle."""
    return Area(Figure(figsize=(width, height)), 0.0, 0.0, width, height)
