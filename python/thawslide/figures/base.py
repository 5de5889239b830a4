"""Basal segments with their band columns at the report times: along the section, or on a map."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.binning import gather_base
from thawslide.boiling import boiling_temperature
from thawslide.errors import NotInRunError
from thawslide.figures.colours import TEMPERATURE, Painting
from thawslide.figures.moments import LETTERS, chosen_snapshots
from thawslide.figures.slide_on_map import cell_of, plot_on_map
from thawslide.figures.snapshots import time_text
from thawslide.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    PURPLE,
    RED,
    SKY,
    draw_reference,
    styled,
    title_figure,
    warn,
)
from thawslide.number_text import prefixed
from thawslide.run_folder import Run, Snapshot
from thawslide.unphysical import too_hot, too_much_pressure

_RATIO = Painting("pore_pressure", "pore pressure ratio P/N", "1", "viridis")
_HEAT = Painting("temperature", "mean band temperature of the columns", TEMPERATURE.unit, TEMPERATURE.colours)
_ROW = 1.4  # inches


@styled
def base_along(run: Run) -> Figure:
    """Plot N, P and N − P, and the temperatures of the band, of each basal segment over distance.

    Report times before the first contact are omitted.
    """
    shots = [shot for shot in chosen_snapshots(run, ()) if len(shot.base)]
    if not shots:
        raise NotInRunError(
            f"{run.folder}: no basal segments in the snapshots; only runs with band columns write them."
        )
    loads = [shot.base["normal_pressure_Pa"] for shot in shots]
    divisor, unit = prefixed(np.concatenate(loads), "Pa")
    figure = Figure(figsize=(COLUMN_WIDTH, 0.9 + _ROW * len(shots)), layout="constrained")
    title_figure(figure, run.titled("basal stresses and temperatures"))
    rows = figure.subplots(len(shots), 2, squeeze=False)
    for number, (row, shot) in enumerate(zip(rows, shots, strict=True)):
        _draw_row(row[0], row[1], shot, divisor)
        load, pressure = shot.base["normal_pressure_Pa"], shot.base["pore_pressure_Pa"]
        warn(row[0], too_much_pressure(pressure / np.maximum(load, 1.0)))
        warn(row[1], too_hot(run, shot.base["max_temperature_C"], pressure))
        row[0].set_title(f"({LETTERS[number]}) {time_text(run, shot)}", loc="left")
        row[0].set_ylabel(f"stress ({unit})")
        row[1].set_ylabel("temperature (°C)")
    for axes in rows[-1]:
        axes.set_xlabel("distance (m)")
    handles = [handle for axes in rows[0] for handle in axes.get_legend_handles_labels()[0]]
    figure.legend(handles=handles, loc="outside lower center", ncols=6, columnspacing=1.0, handlelength=1.4)
    return figure


def _draw_row(stress: Axes, heat: Axes, shot: Snapshot, divisor: float) -> None:
    order = np.argsort(shot.base["position_m"][:, 0], kind="stable")
    value = {name: numbers[order] for name, numbers in shot.base.items()}
    x = value["position_m"][:, 0]
    load, pressure = value["normal_pressure_Pa"] / divisor, value["pore_pressure_Pa"] / divisor
    stress.plot(x, load, color=BLACK, label="normal pressure N")
    stress.plot(x, pressure, color=BLUE, label="pore pressure P")
    stress.fill_between(x, pressure, load, where=load > pressure, color=GREEN, alpha=0.25, label="N − P", linewidth=0)
    stress.set_ylim(bottom=0.0)
    heat.plot(x, value["max_temperature_C"], color=PURPLE, label="maximum T")
    heat.plot(x, value["temperature_C"], color=RED, label="mean T")
    boiling = boiling_temperature(value["normal_pressure_Pa"])
    draw_reference(heat, boiling, x, color=SKY, linestyle="--", label="boiling T at N")
    draw_reference(heat, 0.0)


@styled
def base_pressure(run: Run) -> Figure:
    """Map the ratio of pore pressure to normal pressure of the band."""
    return plot_on_map(run, _RATIO, lambda grid, shot: gather_base(grid, shot, cell_of(run)).pressure_ratio)


@styled
def base_temperature(run: Run) -> Figure:
    """Map the mean temperature of the band."""
    return plot_on_map(run, _HEAT, lambda grid, shot: gather_base(grid, shot, cell_of(run)).temperature)
