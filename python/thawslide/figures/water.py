"""The water budget of band columns: content, intake, losses and the residual."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
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
    give_title,
    letters,
    say,
    styled,
    time_axis,
    time_line,
)
from thawslide.run import Numbers, Run

HELD = {"column_intake_kg": ("laid and taken in", BLACK), "column_water_kg": ("ice and water in columns", BLUE)}
LOST = {
    "column_vented_kg": ("vented", GREEN),
    "column_steam_kg": ("gone as steam", RED),
    "column_left_kg": ("left with columns", PURPLE),
}
SPACES = {"column_opening_m3": ("opened along the base", SKY), "column_void_m3": ("gas in pores", ORANGE)}
RESIDUAL = "column_water_residual_kg"


def relative_water_residual(run: Run) -> Numbers | None:
    """Return |residual| over the largest amount of any account, or None where nothing is in any."""
    largest = max(float(np.nanmax(np.abs(run.history[name]))) for name in HELD | LOST)
    return np.abs(run.history[RESIDUAL]) / largest if largest > 0.0 else None


def scaled(largest: float, steps: tuple[tuple[float, str], ...]) -> tuple[float, str]:
    """Return (divisor, unit) of the first step that a value reaches, or of the last."""
    return next((step for step in steps if largest >= step[0]), steps[-1])


MASSES = ((1e9, "million t"), (1e6, "thousand t"), (1e3, "t"), (1.0, "kg"))
VOLUMES = ((1e6, "million m³"), (1e3, "thousand m³"), (1.0, "m³"))


def _draw(
    axes: Axes, run: Run, accounts: dict[str, tuple[str, str]], quantity: str, steps: tuple[tuple[float, str], ...]
) -> None:
    """Draw accounts over time, each in its colour, in a unit that suits the largest of them."""
    largest = max(float(np.nanmax(np.abs(run.history[name]))) for name in accounts)
    divisor, unit = scaled(largest, steps)
    for name, (words, colour) in accounts.items():
        time_line(axes, run.shown_time, run.history[name] / divisor, color=colour, label=words)
    axes.set_ylabel(f"{quantity} ({unit}{'/m of width' if run.per_metre else ''})")
    axes.axhline(0.0, color="#BBBBBB", linewidth=0.8, zorder=0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


@styled
def water(run: Run) -> Figure:
    """Draw (a) what columns hold and took in, (b) what they lost, (c) openings and voids, (d) the residual."""
    if not run.has_band_columns:
        raise NotInRunError("the band is not of columns: history.csv has no account of its water")
    time = run.shown_time
    figure = Figure(figsize=(COLUMN_WIDTH, 7.2), layout="constrained")
    give_title(figure, run.titled("water of the band"))
    held, lost, spaces, residual = panels = list(figure.subplots(4, 1, sharex=True, height_ratios=(1.2, 1.0, 1.0, 0.7)))
    _draw(held, run, HELD, "mass", MASSES)
    _draw(lost, run, LOST, "mass", MASSES)
    _draw(spaces, run, SPACES, "volume", VOLUMES)
    relative = relative_water_residual(run)
    residual.set_ylabel("|residual| / largest")
    if relative is not None and np.any(relative > 0.0):
        time_line(residual, time, np.where(relative > 0.0, relative, np.nan), color=BLUE, linewidth=0.8, markersize=2)
        residual.set_yscale("log")
    else:
        say(residual, "no residual: no water yet, or it is exactly zero")
    for axes in panels:
        time_axis(axes, time, run.clock.label if axes is residual else "")
    letters(
        panels,
        (
            "ice and water that columns hold, and what they took in",
            "what they lost",
            "openings along the base where P = N, and pores that water has left",
            "residual, relative to the largest account",
        ),
    )
    return figure
