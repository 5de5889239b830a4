"""Energy budget: mechanical and thermal terms since the start, and residuals."""

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
    YELLOW,
    explain_empty,
    note_below,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.number_text import number_text, prefixed
from thawslide.run_folder import Numbers, Run

MECHANICAL = {
    "potential_J": ("potential", BLACK),
    "kinetic_J": ("kinetic", BLUE),
    "strain_J": ("elastic strain", SKY),
    "plastic_J": ("plastic work", ORANGE),
    "viscous_J": ("viscous work", YELLOW),
    "damping_J": ("damping", "#8C564B"),
    "pore_work_J": ("work on pore water", "#BCBD22"),
    "friction_work_J": ("basal friction", RED),
    "contact_loss_J": ("impact on the terrain", PURPLE),
    "entrained_work_J": ("entrainment", "#17BECF"),
    "frame_work_J": ("work of frames", GREEN),
    "numerical_J": ("numerical energy", "#999999"),
}
THERMAL = {
    "sensible_J": ("sensible heat", RED),
    "latent_J": ("latent heat (melt)", BLUE),
    "friction_heat_J": ("friction heat", BLACK),
    "boundary_heat_J": ("boundary heat flow", GREEN),
    "band_rescale_J": ("band rescaling", ORANGE),
    "advection_J": ("advection", PURPLE),
    "capacity_heat_J": ("capacity error", YELLOW),
    "drained_heat_J": ("advected by drainage", SKY),
}
# Band columns; friction heat is a term of THERMAL. Heat is zero for frozen material at 0 °C: that of the material which
# joins and leaves columns depends on this reference state, and is not a term.
_WARMING = "warming of columns"
COLUMNS = {
    _WARMING: ("warming and melting of columns", "#8C564B"),
    "column_drained_J": ("lost with drained water", "#17BECF"),
    "column_steam_J": ("lost with steam", "#E377C2"),
}
_LEAST_SHOWN = 0.005  # of the maximum change of any term of a budget
RESIDUALS = {"mechanical_residual_J": (MECHANICAL, BLUE), "thermal_residual_J": (THERMAL | COLUMNS, RED)}


def term_changes(run: Run, terms: dict[str, tuple[str, str]]) -> dict[str, Numbers]:
    """Return each term [J, or J per metre of width] minus its first value, if the history has it."""
    found = {name: run.series[name] for name in terms if name in run.series}
    parts = ("column_heat_J", "column_intake_J", "column_left_J")
    if _WARMING in terms and all(name in run.series for name in parts):
        heat, joined, left = (run.series[name] for name in parts)
        found[_WARMING] = heat - joined + left
    return {name: found[name] - found[name][0] for name in terms if name in found}


def relative_residual(run: Run, column: str) -> Numbers | None:
    """Return |residual| over the maximum change of any term of its budget, or None if nothing changes."""
    if column not in run.series:
        return None
    changes = term_changes(run, RESIDUALS[column][0])
    largest = max((float(np.nanmax(np.abs(values))) for values in changes.values()), default=0.0)
    return np.abs(run.series[column]) / largest if largest > 0.0 else None


@styled
def energy(run: Run) -> Figure:
    """Plot changes of (a) mechanical and (b) thermal terms since the start, (c) residuals on a logarithmic axis."""
    if not any(name in run.series for name in (*MECHANICAL, *THERMAL)):
        raise NotInRunError("history.csv: no columns of the energy budget.")
    time = run.series["time_s"]
    figure = Figure(figsize=(COLUMN_WIDTH, 7.2), layout="constrained")
    title_figure(figure, run.titled("energy budget"))
    mechanical, thermal, residual = figure.subplots(3, 1, sharex=True, height_ratios=(1.3, 1.0, 0.8))
    omitted = [*_plot_terms(mechanical, run, MECHANICAL), *_plot_terms(thermal, run, THERMAL | COLUMNS)]
    _plot_residuals(residual, run)
    for axes in (mechanical, thermal, residual):
        time_axis(axes, time, TIME_LABEL if axes is residual else "")
    title_panels((mechanical, thermal, residual), ("mechanical energy budget", "thermal energy budget", "residual"))
    if omitted:
        words = f"below {number_text(100.0 * _LEAST_SHOWN)} % of the largest of their budget"
        note_below(figure, f"Terms not shown, {words}: {', '.join(omitted)}.")
    return figure


def _plot_terms(axes: Axes, run: Run, terms: dict[str, tuple[str, str]]) -> list[str]:
    """Plot the terms that are visible next to the largest one; return the names of the others."""
    found = term_changes(run, terms)
    peaks = {name: float(np.nanmax(np.abs(values))) for name, values in found.items()}
    least = _LEAST_SHOWN * max(peaks.values(), default=0.0)
    changing = {name: values for name, values in found.items() if peaks[name] > 0.0 and not peaks[name] < least}
    divisor, unit = prefixed([np.nanmax(np.abs(values)) for values in changing.values()] or [0.0], "J")
    axes.set_ylabel(f"energy change ({unit}{'/m of width' if run.per_metre else ''})")
    if changing:
        for name, values in changing.items():
            words, colour = terms[name]
            dashes = "--" if name == _WARMING else "-"  # often equal to friction heat
            time_line(axes, run.series["time_s"], values / divisor, color=colour, label=words, linestyle=dashes)
        axes.axhline(0.0, color="#BBBBBB", linewidth=0.8, zorder=0)
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    else:
        explain_empty(axes, "no change of any term" if found else "no columns of this budget in history.csv")
    return [terms[name][0] for name in found if name not in changing]


def _plot_residuals(axes: Axes, run: Run) -> None:
    axes.set_ylabel("relative residual (–)")
    has_values = False
    for column, (_, colour) in RESIDUALS.items():
        values = relative_residual(run, column)
        if values is None or not np.any(values > 0.0):
            continue
        shown = np.where(values > 0.0, values, np.nan)
        time_line(axes, run.series["time_s"], shown, color=colour, label=column.split("_")[0])
        has_values = True
    if has_values:
        axes.set_yscale("log")
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    else:
        explain_empty(axes, "residual is zero")
