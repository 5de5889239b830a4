"""Water budget of band columns: content, gains, losses and residual."""

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
    TIME_LABEL,
    explain_empty,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.run_folder import Numbers, Run

CONTENT = {"column_water_kg": ("ice and water in columns", BLUE), "column_intake_kg": ("gained from the body", BLACK)}
LOSSES = {
    "column_drained_kg": ("drained", GREEN),
    "column_steam_kg": ("steam", RED),
    "column_left_kg": ("removed with segments", PURPLE),
}
VOIDS = {"column_opening_m3": ("openings along the base", SKY), "column_void_m3": ("gas in pores", ORANGE)}
RESIDUAL = "column_water_residual_kg"


def relative_water_residual(run: Run) -> Numbers | None:
    """Return |residual| over the maximum of any term, or None if all are zero."""
    largest = max(float(np.nanmax(np.abs(run.series[name]))) for name in CONTENT | LOSSES)
    return np.abs(run.series[RESIDUAL]) / largest if largest > 0.0 else None


def scaled(largest: float, steps: tuple[tuple[float, str], ...]) -> tuple[float, str]:
    """Return (divisor, unit) of the first step that a value attains, or of the last."""
    return next((step for step in steps if largest >= step[0]), steps[-1])


MASSES = ((1e9, "million t"), (1e6, "thousand t"), (1e3, "t"), (1.0, "kg"))
VOLUMES = ((1e6, "million m³"), (1e3, "thousand m³"), (1.0, "m³"))


def _plot_terms(
    axes: Axes, run: Run, terms: dict[str, tuple[str, str]], quantity: str, steps: tuple[tuple[float, str], ...]
) -> None:
    """Plot terms over time in a unit that suits the largest of them."""
    largest = max(float(np.nanmax(np.abs(run.series[name]))) for name in terms)
    divisor, unit = scaled(largest, steps)
    axes.set_ylabel(f"{quantity} ({unit}{'/m of width' if run.per_metre else ''})")
    if not largest > 0.0:
        explain_empty(axes, "all terms are zero")
        return
    for number, (name, (words, colour)) in enumerate(terms.items()):
        # Later lines are dashed, because they can coincide with earlier ones.
        style = {"color": colour, "linestyle": (0, (4, 2)) if number and terms is CONTENT else "-", "label": words}
        time_line(axes, run.series["time_s"], run.series[name] / divisor, **style)
    axes.axhline(0.0, color="#BBBBBB", linewidth=0.8, zorder=0)
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


@styled
def water(run: Run) -> Figure:
    """Plot (a) content and gain of columns, (b) losses, (c) openings and gas in pores, (d) the residual."""
    if not run.has_band_columns:
        raise NotInRunError("history.csv: no water budget (found no band columns).")
    time = run.series["time_s"]
    figure = Figure(figsize=(COLUMN_WIDTH, 7.2), layout="constrained")
    title_figure(figure, run.titled("water budget of the band"))
    panels = list(figure.subplots(4, 1, sharex=True, height_ratios=(1.2, 1.0, 1.0, 0.7)))
    content, losses, voids, residual = panels
    _plot_terms(content, run, CONTENT, "mass", MASSES)
    _plot_terms(losses, run, LOSSES, "mass", MASSES)
    _plot_terms(voids, run, VOIDS, "volume", VOLUMES)
    relative = relative_water_residual(run)
    residual.set_ylabel("relative residual (–)")
    if relative is not None and np.any(relative > 0.0):
        time_line(residual, time, np.where(relative > 0.0, relative, np.nan), color=BLUE, linewidth=0.8, markersize=2)
        residual.set_yscale("log")
    else:
        explain_empty(residual, "residual is zero")
    for axes in panels:
        time_axis(axes, time, TIME_LABEL if axes is residual else "")
    title_panels(
        panels,
        ("water content and gain", "losses", "openings along the base (P = N) and gas in pores", "residual"),
    )
    return figure
