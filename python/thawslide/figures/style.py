"""Common style of figures: type sizes, colours, titles, ticks with commas, lines over time, warnings."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from os import PathLike
from typing import IO, Any, ParamSpec, cast

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import ScalarFormatter
from numpy.typing import ArrayLike

from thawslide.run_folder import Numbers

Arguments = ParamSpec("Arguments")

# Colours of Okabe and Ito, which colour-blind readers can distinguish.
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
_NOTE_CHARACTER = 0.06  # inches, mean width at 7.5 points
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


@contextmanager
def common_style() -> Iterator[None]:
    """Apply the common style in place of all settings of the user, and restore these at the end."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(cast(Any, STYLE))
        yield


def save_figure(figure: Figure, file: str | PathLike[str] | IO[bytes], **named: Any) -> None:
    """Write a figure in the common style, which also determines what is rendered at this time."""
    with common_style():
        figure.savefig(file, **named)


def styled(draw: Callable[Arguments, Figure]) -> Callable[Arguments, Figure]:
    """Return a function that plots in the common style and leaves matplotlib's own settings as they are."""

    @wraps(draw)
    def inside(*arguments: Arguments.args, **named: Arguments.kwargs) -> Figure:
        with common_style():
            figure = draw(*arguments, **named)
            disable_formulas(figure)
            for axes in figure.axes:
                set_comma_ticks(axes)
            return figure

    return inside


class CommaFormatter(ScalarFormatter):
    """Format ticks with commas between thousands."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return the label of a tick."""
        text = str(super().__call__(x, pos))
        return re.sub(r"^(\D*)(\d{4,})", lambda found: f"{found[1]}{int(found[2]):,}", text)


def set_comma_ticks(axes: Axes) -> None:
    """Put commas between thousands on the linear axes that have matplotlib's own ticks."""
    for axis in (axes.xaxis, axes.yaxis):
        if type(axis.get_major_formatter()) is ScalarFormatter:
            axis.set_major_formatter(CommaFormatter(useOffset=False))


def disable_formulas(artist: Artist) -> None:
    """Show a pair of dollar signs in names and titles as such, not as a formula. Labels of ticks may be formulas."""
    for part in [artist.label] if isinstance(artist, Axis) else artist.get_children():
        if isinstance(part, Text):
            part.set_parse_math(False)
        else:
            disable_formulas(part)


def time_line(axes: Axes, time: Numbers, values: ArrayLike, **style: Any) -> None:
    """Plot values over time; a history of one row, or a value between gaps, has a marker to be visible."""
    numbers = np.asarray(values, dtype=np.float64)
    finite = np.concatenate(([False], np.isfinite(numbers), [False]))
    alone = finite[1:-1] & ~finite[:-2] & ~finite[2:]
    style.setdefault("markersize", 4)
    style.setdefault("clip_on", not alone.any())
    axes.plot(
        time, numbers, marker="o" if alone.any() else "", markevery=[int(i) for i in np.flatnonzero(alone)], **style
    )


TIME_LABEL = "time since the start (s)"


def time_axis(axes: Axes, time: Numbers, label: str = "") -> None:
    """Set the time axis to the run's span and label it."""
    start, end = float(time[0]), float(time[-1])
    axes.set_xlim(start, end if end > start else start + 1.0)
    axes.grid(True)
    if label:
        axes.set_xlabel(label)


def explain_empty(axes: Axes, text: str) -> None:
    """Write in the middle of a panel why it is empty."""
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=NOTE, wrap=True)


def wrapped(words: str, characters: float) -> list[str]:
    """Return lines of at most so many characters; a number is not separated from what follows it."""
    joined = re.sub(r"(?<=\d) (?=\S)", "\N{NO-BREAK SPACE}", words)
    lines = textwrap.wrap(joined, int(characters), break_on_hyphens=False)
    return [line.replace("\N{NO-BREAK SPACE}", " ") for line in lines]


def title_figure(figure: Figure, words: str) -> None:
    """Set the title of a figure with constrained layout, wrapped to its width."""
    lines = wrapped(words, figure.get_figwidth() / _TITLE_CHARACTER)
    figure.suptitle("\n".join(lines), x=0.01, ha="left", size=10)


def mark_level(axes: Axes, values: Numbers, level: float, words: str) -> None:
    """Draw a level as a dotted line with words at the end at which the values are farther from it."""
    axes.axhline(level, color=NOTE, linewidth=0.8, linestyle=":")
    span = max(int(_LABEL_SPAN * len(values)), 1)
    left, right = (
        float(np.min(np.abs(part - level), initial=np.inf, where=np.isfinite(part)))
        for part in (values[:span], values[-span:])
    )
    axes.annotate(
        words, (0.0 if left > right else 1.0, level), xycoords=("axes fraction", "data"), size=7.5, color=NOTE,
        xytext=(4 if left > right else -4, 3), textcoords="offset points", ha="left" if left > right else "right",
    )  # fmt: skip


def draw_reference(axes: Axes, values: ArrayLike, x: Numbers | None = None, **style: Any) -> None:
    """Draw a level, or values at `x`, as a reference line; the limits of the panel remain those of its data."""
    limits = axes.get_ylim()
    if x is None:
        axes.axhline(float(np.asarray(values)), color=NOTE, linewidth=0.8, linestyle=":")
    else:
        axes.plot(x, values, **style)
    axes.set_ylim(limits)


def note_below(figure: Figure, words: str) -> None:
    """Write a note below the panels of a figure with constrained layout, wrapped to its width."""
    lines = wrapped(words, figure.get_figwidth() / _NOTE_CHARACTER)
    figure.supxlabel("\n".join(lines), x=0.01, ha="left", size=7.5, color=NOTE)


def without_title(figure: Figure) -> Figure:
    """Return a figure without its title, which the caption of the page repeats, as journals require."""
    figure.suptitle("")
    return figure


def vertical_exaggeration(axes: Axes, unit: float = 1.0) -> float:
    """Return the scale of heights [m] on the page over that of distances, which are in units of `unit` [m]."""
    figure = axes.get_figure()
    assert isinstance(figure, Figure)
    width, height = figure.get_size_inches() * axes.get_position().size
    (left, right), (low, top) = axes.get_xlim(), axes.get_ylim()
    return float((right - left) * unit / width / ((top - low) / height))


_LABEL_SPAN = 0.35  # of a panel, for the label of a level
_WARNING_LINE, _WARNING_EDGE = 0.14, 0.14  # inches: a line of a warning, and the space around all of them
NOTE_LINE = 0.13  # inches: a note above a panel
_OVER_NOTE = 72.0 * NOTE_LINE + 4.0  # points from a panel to the title over its note
_MOST_RESERVED = 0.7  # of the height of a panel


def reserve_top(axes: Axes, inches: float) -> float:
    """Widen the limits of a panel: its curves end so far below the top. Return that fraction of its height."""
    figure = axes.get_figure()
    assert isinstance(figure, Figure)
    part = min(inches / float(figure.get_figheight() * axes.get_position().height), _MOST_RESERVED)
    low, top = axes.get_ylim()
    axes.set_ylim(low, low + (top - low) / (1.0 - part))
    return part


def warn(axes: Axes, words: str, high: bool = True, below: float = 0.0) -> None:
    """Write a warning across the top or the bottom inside a panel; nothing for no words.

    At the top, the curves end below the warning, which is `below` [inches] under the top, for example of a legend.
    """
    if words:
        lines = wrapped(f"⚠ {words}", 46)
        place = 0.04
        if high:
            inches = below + _WARNING_EDGE + _WARNING_LINE * len(lines)
            part = reserve_top(axes, inches)
            place = 1.0 - part * (below + 0.3 * _WARNING_EDGE) / inches
        text = "\n".join(lines)
        axes.text(
            0.5, place, text, transform=axes.transAxes, ha="center", size=8,
            va="top" if high else "bottom", color="#B00020", zorder=12, gid="warning",
            bbox={"facecolor": "white", "edgecolor": "#B00020", "alpha": 0.92, "linewidth": 0.8, "pad": 2.5},
        )  # fmt: skip


def note_above(axes: Axes, words: str) -> None:
    """Write a note above the right end of a panel, outside its data."""
    axes.annotate(words, (1.0, 1.0), xycoords="axes fraction", xytext=(0.0, 2.0), textcoords="offset points",
                  ha="right", va="bottom", size=7, color=NOTE)  # fmt: skip


def title_over_note(axes: Axes, title: str, note: str, remark: str = "") -> None:
    """Give a panel a note above its right end, and above the note a title and a remark at its right."""
    note_above(axes, note)
    axes.set_title(title, loc="left", pad=_OVER_NOTE)
    axes.set_title(remark, loc="right", color=NOTE, size=8, pad=_OVER_NOTE)


def title_panels(axes: Sequence[Axes], titles: Sequence[str]) -> None:
    """Give panels titles that begin with (a), (b), ..."""
    for letter, (panel, title) in zip("abcdefghijkl", zip(axes, titles, strict=True), strict=False):
        panel.set_title(f"({letter}) {title}", loc="left")
