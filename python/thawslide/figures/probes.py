"""Probes of a 3D run over time: thickness and speed at points, flow through cross sections."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
from thawslide.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    TIME_LABEL,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.number_text import exact_text
from thawslide.run_folder import Run

_COLOURS = (BLUE, RED, GREEN, PURPLE, ORANGE, SKY, BLACK)
_OF_SECTION = {"_max": "maximum", "_mean": "mean"}  # before the ending: statistics over a cross section
_DASHES = ("-", "--", ":")


@dataclass(frozen=True)
class Quantity:
    """One quantity of probes: the ending of its columns in probes.csv, its label and unit."""

    ending: str
    words: str
    unit: str


QUANTITIES = (
    Quantity("_thickness_m", "flow thickness", "m"),
    Quantity("_speed_m_s", "speed", "m/s"),
    Quantity("_flow_area_m2", "flow area", "m²"),
    Quantity("_discharge_m3_s", "discharge", "m³/s"),
)


@styled
def probes(run: Run) -> Figure:
    """Plot a panel for each quantity, with a line for each probe."""
    columns = run.probe_series
    if columns is None:
        raise NotInRunError(f"{run.folder / 'probes.csv'}: no such file. Specify [probe.NAME] in the case.")
    time = columns["time_s"]
    found = {
        quantity: {
            name.removesuffix(quantity.ending): values
            for name, values in columns.items()
            if name.endswith(quantity.ending)
        }
        for quantity in QUANTITIES
    }
    found = {quantity: lines for quantity, lines in found.items() if lines}
    if not found:
        endings = ", ".join(quantity.ending for quantity in QUANTITIES)
        raise NotInRunError(f"probes.csv: no column of a probe (allowed endings: {endings}).")
    names = list(dict.fromkeys(_probe(name)[0] for lines in found.values() for name in lines))
    rows = -(-len(found) // 2)
    across = min(len(found), 2)
    figure = Figure(figsize=(COLUMN_WIDTH if across == 2 else 4.5, 0.9 + 2.2 * rows), layout="constrained")
    title_figure(figure, run.titled("probes"))
    panels = list(figure.subplots(rows, across, squeeze=False, sharex=True).flat)
    for axes, (quantity, lines) in zip(panels, found.items(), strict=False):
        for name, values in lines.items():
            probe, label = _probe(name)
            number = names.index(probe)
            time_line(
                axes, time, values, color=_COLOURS[number % len(_COLOURS)],
                linestyle=_DASHES[number // len(_COLOURS) % len(_DASHES)], label=label,
            )  # fmt: skip
        axes.set_ylabel(f"{quantity.words} ({quantity.unit})")
        low = min(float(np.nanmin(values, initial=0.0)) for values in lines.values())
        high = max(float(np.nanmax(values, initial=0.0)) for values in lines.values())
        # Discharge towards the left of a section is negative.
        axes.set_ylim(None if low < 0.0 else 0.0, None if high > 0.0 else 1.0 if low == 0.0 else 0.0)
        axes.yaxis.set_major_formatter(lambda value, _: exact_text(value))
        axes.legend(loc="best")
        time_axis(axes, time, TIME_LABEL)
    for axes in panels[len(found) :]:
        axes.remove()
    title_panels(panels[: len(found)], [quantity.words for quantity in found])
    return figure


def _probe(name: str) -> tuple[str, str]:
    """Return the name of a probe and its label in the legend, from a column without its ending."""
    for ending, words in _OF_SECTION.items():
        if name.endswith(ending):
            probe = name.removesuffix(ending)
            return probe, f"{probe} ({words})"
    return name, name
