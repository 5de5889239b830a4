"""The energy budget: every mechanical and thermal term since the start, and the residuals."""

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
    NOTE,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    YELLOW,
    give_title,
    letters,
    prefixed,
    say,
    styled,
    time_axis,
    time_line,
)
from thawslide.run import Numbers, Run

MECHANICAL = {
    "potential_J": ("potential", BLACK),
    "kinetic_J": ("kinetic", BLUE),
    "strain_J": ("elastic strain", SKY),
    "plastic_J": ("plastic work", ORANGE),
    "viscous_J": ("viscous work", YELLOW),
    "damping_J": ("damping", "#8C564B"),
    "pore_work_J": ("work on pore water", "#BCBD22"),
    "friction_work_J": ("basal friction", RED),
    "contact_loss_J": ("impact on the ground", PURPLE),
    "entrained_work_J": ("lost to bed taken up", "#17BECF"),
    "frame_work_J": ("work of frames", GREEN),
    "numerical_J": ("numerical", "#999999"),
}
THERMAL = {
    "sensible_J": ("sensible heat", RED),
    "latent_J": ("latent heat (melt)", BLUE),
    "friction_heat_J": ("friction heat in", BLACK),
    "boundary_heat_J": ("through boundaries", GREEN),
    "band_rescale_J": ("band rescaling", ORANGE),
    "advection_J": ("advection", PURPLE),
    "capacity_heat_J": ("made by the old capacity", YELLOW),
    "porosity_heat_J": ("made by changed masses", "#999999"),
    "drained_heat_J": ("out with drained water", SKY),
}
# Of band columns: their own heat, and what came into them and left besides friction heat.
COLUMNS = {
    "column_heat_J": ("heat in band columns", "#8C564B"),
    "column_intake_J": ("laid and taken in by columns", SKY),
    "column_vented_J": ("out with water, columns", "#17BECF"),
    "column_steam_J": ("out with steam, columns", "#E377C2"),
    "column_left_J": ("left with columns", "#7F7F7F"),
}
RESIDUALS = {"mechanical_residual_J": (MECHANICAL, BLUE), "thermal_residual_J": (THERMAL | COLUMNS, RED)}


def changes(run: Run, accounts: dict[str, tuple[str, str]]) -> dict[str, Numbers]:
    """Return each account [J, or J per metre of width] less its first value, those the history has."""
    return {name: run.history[name] - run.history[name][0] for name in accounts if name in run.history}


def relative_residual(run: Run, column: str) -> Numbers | None:
    """Return |residual| over the largest change of any account of its ledger, or None where nothing changes."""
    if column not in run.history:
        return None
    accounts = changes(run, RESIDUALS[column][0])
    largest = max((float(np.nanmax(np.abs(values))) for values in accounts.values()), default=0.0)
    return np.abs(run.history[column]) / largest if largest > 0.0 else None


@styled
def energy(run: Run) -> Figure:
    """Draw (a) mechanical and (b) thermal accounts as changes since the start, (c) the residuals on a log axis."""
    if not any(name in run.history for name in (*MECHANICAL, *THERMAL)):
        raise NotInRunError("history.csv has no columns of the energy ledger")
    time = run.shown_time
    figure = Figure(figsize=(COLUMN_WIDTH, 7.2), layout="constrained")
    give_title(figure, run.titled("energy ledger"))
    mechanical, thermal, residual = figure.subplots(3, 1, sharex=True, height_ratios=(1.3, 1.0, 0.8))
    _draw_accounts(mechanical, run, MECHANICAL)
    _draw_accounts(thermal, run, THERMAL | COLUMNS)
    _draw_residuals(residual, run)
    for axes in (mechanical, thermal, residual):
        time_axis(axes, time, run.clock.label if axes is residual else "")
    letters(
        (mechanical, thermal, residual),
        (
            "mechanical accounts, change since the start",
            "thermal accounts, change since the start",
            "residual, relative to the largest change of any account",
        ),
    )
    return figure


def _draw_accounts(axes: Axes, run: Run, accounts: dict[str, tuple[str, str]]) -> None:
    found = changes(run, accounts)
    moving = {name: values for name, values in found.items() if np.nanmax(np.abs(values)) > 0.0}
    still = [accounts[name][0] for name in found if name not in moving]
    divisor, unit = prefixed([np.nanmax(np.abs(values)) for values in moving.values()] or [0.0], "J")
    axes.set_ylabel(f"energy ({unit}{'/m of width' if run.per_metre else ''})")
    if not moving:
        say(axes, "no account changes" if found else "history.csv has none of these columns")
        return
    for name, values in moving.items():
        words, colour = accounts[name]
        time_line(axes, run.shown_time, values / divisor, color=colour, label=words)
    axes.axhline(0.0, color="#BBBBBB", linewidth=0.8, zorder=0)
    title = "zero throughout:\n" + "\n".join(still) if still else ""
    legend = axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    if title:
        # Below the legend, so that an account that stays empty is named and not missed.
        figure = axes.get_figure()
        rows = len(legend.get_texts())
        assert figure is not None
        axes.annotate(
            title, (1.0, 1.0), xycoords="axes fraction", xytext=(10, -12.5 * rows - 14), textcoords="offset points",
            va="top", size=7.5, color=NOTE,
        )  # fmt: skip


def _draw_residuals(axes: Axes, run: Run) -> None:
    axes.set_ylabel("|residual| / largest change")
    drawn = False
    for column, (_, colour) in RESIDUALS.items():
        values = relative_residual(run, column)
        if values is None or not np.any(values > 0.0):
            continue
        time_line(
            axes,
            run.shown_time,
            np.where(values > 0.0, values, np.nan),
            color=colour,
            label=column.split("_")[0],
        )
        drawn = True
    if drawn:
        axes.set_yscale("log")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    else:
        say(axes, "no residual: nothing has changed yet, or it is exactly zero")
