"""Parts of the figures of a run."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage

from thawslide import Run
from thawslide.figures import FIGURES


def plotted(name: str, folder: Path) -> Figure:
    """Plot a figure of a run by its name."""
    figure = FIGURES[name].plot(Run(folder))
    assert isinstance(figure, Figure)
    return figure


def maps_of(figure: Figure) -> list[Axes]:
    """Return the panels that have a letter."""
    return [axes for axes in figure.axes if axes.get_title(loc="left").startswith("(")]


def field(axes: Axes) -> AxesImage:
    """Return the field over the shaded terrain."""
    shade, *fields = [image for image in axes.images if isinstance(image, AxesImage)]
    assert shade.get_zorder() < fields[-1].get_zorder()
    return fields[-1]


def labels(figure: Figure) -> set[str]:
    """Return the labels of the axes."""
    return {label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label}


def notes(figure: Figure) -> str:
    """Return the notes of the figure in one line."""
    return " ".join(" ".join(text.get_text().split()) for text in figure.texts)


def titled(figure: Figure, start: str) -> Axes:
    """Return the one panel whose title begins so."""
    (found,) = [axes for axes in figure.axes if axes.get_title(loc="left").startswith(start)]
    return found


def line(axes: Axes, label: str) -> np.ndarray:
    """Return x and y of the one line with this label, shape (2, n)."""
    (found,) = [line for line in axes.lines if line.get_label() == label]
    return np.array(found.get_data(), dtype=float)


def texts(axes: Axes) -> list[str]:
    """Return the texts inside a panel."""
    return [text.get_text() for text in axes.texts]
