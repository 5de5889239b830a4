"""The pieces of a slide's base, each with its band column, at chosen times: along the section, or from above."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.binning import gather_base
from thawslide.boiling import boiling_temperature
from thawslide.errors import NotInRunError
from thawslide.figures.colours import TEMPERATURE, Painting
from thawslide.figures.moments import LETTERS, chosen_snapshots
from thawslide.figures.slide_on_map import cell_of, draw_on_map
from thawslide.figures.snapshots import time_text
from thawslide.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    NOTE,
    ORANGE,
    RED,
    SKY,
    give_title,
    prefixed,
    styled,
    warn,
)
from thawslide.run import Run, Snapshot
from thawslide.unphysical import too_hot, too_much_pressure

_RATIO = Painting("pore_pressure", "pore pressure over normal pressure", "1", "viridis")
_HEAT = Painting("temperature", "temperature of the band", TEMPERATURE.unit, TEMPERATURE.colours)
_ROW = 1.4  # inches


@styled
def base_along(run: Run) -> Figure:
    """Draw N, P and what is left of N, and the band's temperatures, of each piece over its distance.

    At the run's chosen times, without those before the first contact.
    """
    shots = [shot for shot in chosen_snapshots(run, ()) if len(shot.base)]
    if not shots:
        raise NotInRunError(f"{run.folder}: no snapshot has pieces of base, as a run on band columns writes")
    loads = [shot.base["normal_pressure_Pa"] for shot in shots]
    divisor, unit = prefixed(np.concatenate(loads), "Pa")
    figure = Figure(figsize=(COLUMN_WIDTH, 0.9 + _ROW * len(shots)), layout="constrained")
    give_title(figure, run.titled("along the base"))
    rows = figure.subplots(len(shots), 2, squeeze=False)
    for number, (row, shot) in enumerate(zip(rows, shots, strict=True)):
        _draw_row(row[0], row[1], shot, divisor)
        load, pressure = shot.base["normal_pressure_Pa"], shot.base["pore_pressure_Pa"]
        warn(row[0], too_much_pressure(pressure / np.maximum(load, 1.0)))
        warn(row[1], too_hot(run, shot.base["hottest_C"], pressure))
        row[0].set_title(f"({LETTERS[number]}) {time_text(run, shot)}", loc="left")
        row[0].set_ylabel(f"stress ({unit})")
        row[1].set_ylabel("temp. (°C)")
    for axes in rows[-1]:
        axes.set_xlabel("distance (m)")
    rows[0][1].set_title(f"time: {run.clock.words}", loc="left", color=NOTE)
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
    heat.plot(x, value["hottest_C"], color=ORANGE, label="hottest")
    heat.plot(x, value["temperature_C"], color=RED, label="mean of the band")
    heat.plot(x, boiling_temperature(value["normal_pressure_Pa"]), color=SKY, linestyle="--", label="boils at N")
    heat.axhline(0.0, color=NOTE, linewidth=0.8, linestyle=":")


@styled
def base_pressure(run: Run) -> Figure:
    """Draw the pore pressure of the band over the normal pressure from above."""
    return draw_on_map(run, _RATIO, lambda grid, shot: gather_base(grid, shot, cell_of(run)).pressure_ratio)


@styled
def base_temperature(run: Run) -> Figure:
    """Draw the mean temperature of the band from above."""
    return draw_on_map(run, _HEAT, lambda grid, shot: gather_base(grid, shot, cell_of(run)).temperature)
