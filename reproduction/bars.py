"""Runs that differ in one parameter each, as bars relative to the reference run."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, NOTE, ORANGE, RED, styled

Quantity = tuple[str, Sequence[float]]  # axis label, one value per run, the reference run first


# Ending of a run: marker, colour and words.
MARKERS = {
    "stopped": ("", NOTE, ""),
    "going": (">", BLACK, "not at rest at the end: value at the end, no stop time"),
    "never": ("s", NOTE, "no start"),
    "broken": ("x", RED, "failed run: no value"),
    "missing": ("+", NOTE, "not run"),
}


@styled
def bars(names: Sequence[str], quantities: Sequence[Quantity], ends: Sequence[str]) -> Figure:
    """Plot one panel per quantity, with bars from the value of the first run; `ends` are the endings (MARKERS).

    Each run that did not stop has a marker in each panel, at the end of its bar or at the reference line.
    """
    figure = Figure(figsize=(COLUMN_WIDTH, 1.5 + 0.21 * len(names)), layout="constrained")
    panels = figure.subplots(1, len(quantities), sharey=True, squeeze=False)[0]
    places = -np.arange(len(names), dtype=np.float64)
    kinds = np.asarray(ends)
    for axes, (label, values) in zip(panels, quantities, strict=True):
        numbers = np.asarray(values, dtype=np.float64)
        base = float(numbers[0]) if np.isfinite(numbers[0]) else 0.0
        known = np.isfinite(numbers)
        change = np.where(known, numbers - base, 0.0)
        axes.barh(places, change, left=base, height=0.7, color=np.where(change < 0.0, BLUE, ORANGE).tolist())
        axes.axvline(base, color=NOTE, linewidth=0.8)
        for kind, (marker, colour, _) in MARKERS.items():
            if marker and (kinds == kind).any():
                at = kinds == kind
                style: dict[str, Any] = {"color": colour, "markersize": 4.5, "linestyle": "", "clip_on": False}
                axes.plot(base + change[at], places[at], marker, **style)
        axes.set_xlabel(textwrap.fill(label, 14))
        axes.set_xlim(left=0.0)
        axes.grid(True, axis="x")
        axes.set_axisbelow(True)
    panels[0].set_yticks(places, names)
    panels[0].set_ylim(places[-1] - 0.7, 0.7)
    shown: list[Artist] = [Line2D([], [], marker=marker, color=colour, markersize=5, linestyle="", label=words)
             for kind, (marker, colour, words) in MARKERS.items() if marker and (kinds == kind).any()]  # fmt: skip
    shown += [Patch(color=colour, label=words) for colour, words in ((BLUE, "lower than the case"), (ORANGE, "higher"))]
    figure.legend(handles=shown, loc="outside lower center", ncols=3)
    return figure
