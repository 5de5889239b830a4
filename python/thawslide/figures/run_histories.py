"""Histories of several runs in one figure."""

from __future__ import annotations

from collections.abc import Mapping

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
    styled,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.number_text import prefixed
from thawslide.run_folder import Run

_COLOURS = (BLUE, RED, GREEN, BLACK, PURPLE, ORANGE, SKY)
_DASHES = ("-", "--", "-.", ":")
_PANELS = {
    "mean_velocity_m_s": ("mean velocity", "m/s"),
    "mean_displacement_m": ("mean displacement", "m"),
    "runout_m": ("runout distance", "m"),
    "band_temperature_C": ("mean band temperature", "°C"),
    "band_pore_pressure_Pa": ("mean band pore pressure", "Pa"),
    "band_friction_coefficient": ("friction coefficient of the band", "–"),
}
_ROW = 2.2  # inches


@styled
def run_histories(runs: Mapping[str, Run]) -> Figure:
    """Plot columns of the histories of runs, by their names; a panel for each column that any run has."""
    columns = [name for name in _PANELS if any(_has_values(run, name) for run in runs.values())]
    if not columns:
        raise NotInRunError("history.csv: no column to compare in any run.")
    rows = -(-len(columns) // 2)
    figure = Figure(figsize=(COLUMN_WIDTH, 0.7 + _ROW * rows), layout="constrained")
    title_figure(figure, "Histories")
    panels = figure.subplots(rows, 2, squeeze=False).ravel()
    for axes in panels[len(columns) :]:
        axes.remove()
    for axes, column in zip(panels, columns, strict=False):
        words, unit = _PANELS[column]
        found = [run.series[column] for run in runs.values() if column in run.series]
        divisor, unit = prefixed(np.concatenate(found), unit) if unit == "Pa" else (1.0, unit)
        for number, (name, run) in enumerate(runs.items()):
            if column in run.series:
                time_line(
                    axes,
                    run.series["time_s"],
                    run.series[column] / divisor,
                    color=_COLOURS[number % len(_COLOURS)],
                    linestyle=_DASHES[number % len(_DASHES)],
                    label=name,
                )
        axes.set_ylabel(f"{words} ({unit})".replace("friction coefficient of the band", "friction coefficient"))
        axes.set_xlabel("time (s)")
        axes.grid(True)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    title_panels(list(panels[: len(columns)]), [_PANELS[column][0] for column in columns])
    return figure


def _has_values(run: Run, column: str) -> bool:
    return column in run.series and bool(np.isfinite(run.series[column]).any())
