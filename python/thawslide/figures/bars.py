"""Runs that differ in one thing each, as bars about the run they differ from."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from thawslide.figures.style import BLUE, NOTE, ORANGE, styled

Quantity = tuple[str, Sequence[float]]  # axis label, one value a run, the first of them the run to compare with


@styled
def bars(names: Sequence[str], quantities: Sequence[Quantity]) -> Figure:
    """Draw a panel a quantity: from the first run's value to each other's. A missing value leaves a cross."""
    figure = Figure(figsize=(11.0, 1.0 + 0.21 * len(names)), layout="constrained")
    panels = figure.subplots(1, len(quantities), sharey=True, squeeze=False)[0]
    places = -np.arange(len(names), dtype=np.float64)
    for axes, (label, values) in zip(panels, quantities, strict=True):
        numbers = np.asarray(values, dtype=np.float64)
        base = float(numbers[0]) if np.isfinite(numbers[0]) else 0.0
        known = np.isfinite(numbers)
        change = np.where(known, numbers - base, 0.0)
        axes.barh(places, change, left=base, height=0.7, color=np.where(change < 0.0, BLUE, ORANGE).tolist())
        axes.axvline(base, color=NOTE, linewidth=0.8)
        axes.plot(np.full(int((~known).sum()), base), places[~known], "x", color=NOTE, markersize=4)
        axes.set_xlabel(label)
        axes.set_xlim(left=0.0)
        axes.grid(True, axis="x")
        axes.set_axisbelow(True)
    panels[0].set_yticks(places, names)
    panels[0].set_ylim(places[-1] - 0.7, 0.7)
    return figure
