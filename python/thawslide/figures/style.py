"""What all figures share: type sizes, colours, units with prefixes, a line that one row can draw."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec, cast

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text
from numpy.typing import ArrayLike

from thawslide.run import Numbers

Arguments = ParamSpec("Arguments")

# Okabe and Ito's colours, told apart by colour-blind readers.
BLUE, ORANGE, GREEN, RED, PURPLE, SKY, YELLOW, BLACK = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#B8A800",
    "#222222",
)
COLUMN_WIDTH = 7.1  # inches: 180 mm, both columns of a journal's page; type keeps its size in print
_TITLE_CHARACTER = 0.085  # inches, mean width at 10 points
GROUND = "#D9D4CB"
GROUND_LINE = "#6B6459"
NOTE = "#555555"

STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#444444",
    "axes.linewidth": 0.8,
    "axes.grid": False,
    "axes.formatter.useoffset": False,
    "grid.color": "#E4E4E4",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "legend.borderpad": 0.2,
    "legend.fontsize": 7.5,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "figure.facecolor": "white",
}


def styled(draw: Callable[Arguments, Figure]) -> Callable[Arguments, Figure]:
    """Draw a figure in the common style, texts as they are, without touching matplotlib's settings outside."""

    @wraps(draw)
    def inside(*arguments: Arguments.args, **named: Arguments.kwargs) -> Figure:
        with mpl.rc_context(cast(Any, STYLE)):
            figure = draw(*arguments, **named)
            write_plainly(figure)
            return figure

    return inside


def write_plainly(artist: Artist) -> None:
    """Write names and titles as they are: a pair of dollar signs in them is no formula. Labels of ticks may be one."""
    for part in [artist.label] if isinstance(artist, Axis) else artist.get_children():
        if isinstance(part, Text):
            part.set_parse_math(False)
        else:
            write_plainly(part)


_PREFIXES = ((1e15, "P"), (1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"))


def prefixed(values: ArrayLike, unit: str) -> tuple[float, str]:
    """Return (divisor, unit with its SI prefix) that bring the largest finite value below 1000."""
    numbers = np.abs(np.asarray(values, dtype=np.float64)).ravel()
    numbers = numbers[np.isfinite(numbers)]
    largest = float(numbers.max()) if numbers.size else 0.0
    for size, prefix in _PREFIXES:
        if largest >= size:
            return size, prefix + unit
    return 1.0, unit


def volume_text(value: float) -> str:
    """Return a volume [m3] in words."""
    return f"{value / 1e6:.3g} million m³" if value >= 1e6 else f"{value:,.0f} m³"


def area_text(value: float) -> str:
    """Return an area [m2] in words."""
    return f"{value / 1e6:.3g} km²" if value >= 1e5 else f"{value:,.0f} m²"


def length_unit(span: float) -> tuple[float, str]:
    """Return (divisor, unit) for an axis over `span` metres: km from 3 km up."""
    return (1000.0, "km") if span >= 3000.0 else (1.0, "m")


def time_line(axes: Axes, time: Numbers, values: ArrayLike, **style: Any) -> None:
    """Draw values over time; a history of one row, or a value between gaps, gets a marker and so stays visible."""
    numbers = np.asarray(values, dtype=np.float64)
    finite = np.concatenate(([False], np.isfinite(numbers), [False]))
    alone = finite[1:-1] & ~finite[:-2] & ~finite[2:]
    style.setdefault("markersize", 4)
    style.setdefault("clip_on", not alone.any())
    axes.plot(
        time, numbers, marker="o" if alone.any() else "", markevery=[int(i) for i in np.flatnonzero(alone)], **style
    )


def time_axis(axes: Axes, time: Numbers, label: str = "") -> None:
    """Set the time axis to the run's span and label it."""
    start, end = float(time[0]), float(time[-1])
    axes.set_xlim(start, end if end > start else start + 1.0)
    axes.grid(True)
    if label:
        axes.set_xlabel(label)


def say(axes: Axes, text: str) -> None:
    """Write why a panel is empty in its middle."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=NOTE, wrap=True)


def give_title(figure: Figure, words: str) -> None:
    """Set the title of a figure with constrained layout, wrapped to its width."""
    characters = int(figure.get_figwidth() / _TITLE_CHARACTER)
    figure.suptitle("\n".join(textwrap.wrap(words, characters)), x=0.01, ha="left", size=10)


def without_title(figure: Figure) -> Figure:
    """Return a figure without its title, which the caption of the page repeats, as journals require."""
    figure.suptitle("")
    return figure


def stretch(axes: Axes, unit: float = 1.0) -> float:
    """Return how many times heights [m] are larger on the page than distances, in units of `unit` [m]."""
    figure = axes.get_figure()
    assert isinstance(figure, Figure)
    width, height = figure.get_size_inches() * axes.get_position().size
    (left, right), (low, top) = axes.get_xlim(), axes.get_ylim()
    return float((right - left) * unit / width / ((top - low) / height))


_WARNING = 0.3  # of the height of curves: room for a warning above them


def warn(axes: Axes, words: str, high: bool = True) -> None:
    """Write a warning across the top, or the bottom, of a panel, inside it; nothing for no words.

    Above curves there is room made for it.
    """
    if words:
        low, top = axes.get_ylim()
        axes.set_ylim(low, low + (1.0 + _WARNING * high) * (top - low))
        axes.text(
            0.5, 0.97 if high else 0.04, textwrap.fill(f"⚠ {words}", 46), transform=axes.transAxes, ha="center", size=8,
            va="top" if high else "bottom", color="#B00020", zorder=12, gid="warning",
            bbox={"facecolor": "white", "edgecolor": "#B00020", "alpha": 0.92, "linewidth": 0.8, "pad": 2.5},
        )  # fmt: skip


def letters(axes: Sequence[Axes], titles: Sequence[str]) -> None:
    """Title panels (a), (b), ... at their left."""
    for letter, (panel, title) in zip("abcdefghijkl", zip(axes, titles, strict=True), strict=False):
        panel.set_title(f"({letter}) {title}", loc="left")
