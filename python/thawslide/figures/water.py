"""The water balance of band columns: what they hold, took in and lost, and what does not add up."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
from thawslide.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    letters,
    say,
    styled,
    time_axis,
    time_line,
)
from thawslide.run import Numbers, Run

ACCOUNTS = {
    "column_water_kg": ("ice and water in columns", BLUE),
    "column_intake_kg": ("taken in", BLACK),
    "column_vented_kg": ("vented", GREEN),
    "column_steam_kg": ("gone as steam", RED),
    "column_left_kg": ("left with columns", PURPLE),
}
SPACES = {"column_opening_m3": ("opened along the base", SKY), "column_void_m3": ("gas in pores", ORANGE)}
RESIDUAL = "column_water_residual_kg"


def relative_water_residual(run: Run) -> Numbers | None:
    """Return |residual| over the largest amount of any account, or None where nothing is in any."""
    largest = max(float(np.nanmax(np.abs(run.history[name]))) for name in ACCOUNTS)
    return np.abs(run.history[RESIDUAL]) / largest if largest > 0.0 else None


def _mass_unit(values: list[Numbers], per_metre: bool) -> tuple[float, str]:
    """Return (divisor, unit) for masses: tonnes from a thousand of them up are shown in thousands."""
    largest = max((float(np.nanmax(np.abs(each))) for each in values), default=0.0)
    for size, words in ((1e9, "million t"), (1e6, "thousand t"), (1e3, "t")):
        if largest >= size:
            return size, words + ("/m of width" if per_metre else "")
    return 1.0, "kg" + ("/m of width" if per_metre else "")


@styled
def water(run: Run) -> Figure:
    """Draw (a) the accounts as changes since the start, (b) openings and voids, (c) the residual on a log axis."""
    if not run.has_band_columns:
        raise NotInRunError("the band is not of columns: history.csv has no account of its water")
    history, time = run.history, run.history["time_s"]
    figure = Figure(figsize=(10.0, 8.0), layout="constrained")
    figure.suptitle(f"{run.title}: water of the band", x=0.01, ha="left", size=12)
    masses, spaces, residual = panels = list(figure.subplots(3, 1, sharex=True, height_ratios=(1.3, 1.0, 0.7)))
    changes = {name: history[name] - history[name][0] for name in ACCOUNTS}
    divisor, unit = _mass_unit(list(changes.values()), run.per_metre)
    for name, values in changes.items():
        words, colour = ACCOUNTS[name]
        time_line(masses, time, values / divisor, color=colour, label=words)
    masses.set_ylabel(f"mass ({unit})")
    for name, (words, colour) in SPACES.items():
        time_line(spaces, time, history[name], color=colour, label=words)
    spaces.set_ylabel("volume (m³/m of width)" if run.per_metre else "volume (m³)")
    for axes in (masses, spaces):
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    relative = relative_water_residual(run)
    residual.set_ylabel("|residual| / largest account")
    if relative is not None and np.any(relative > 0.0):
        time_line(residual, time, np.where(relative > 0.0, relative, np.nan), color=BLUE)
        residual.set_yscale("log")
    else:
        say(residual, "no residual: no water yet, or it is exactly zero")
    for axes in panels:
        time_axis(axes, time, label=axes is residual)
    letters(
        panels,
        (
            "accounts, change since the start",
            "space beside full pores: openings where P = N, voids that water has left",
            "what does not add up, over the largest account",
        ),
    )
    return figure
