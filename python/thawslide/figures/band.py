"""Temperature, pore pressure, saturation and friction of the shear band over time (paper Fig. 20)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.figures.motion import draw_targets
from thawslide.figures.style import BLUE, GREEN, NOTE, PURPLE, RED, letters, prefixed, say, styled, time_axis, time_line
from thawslide.run import Run

# Column, words, unit, colour, names of the reported quantity.
_PANELS = (
    ("band_temperature_C", "temperature", "°C", RED, ("band_temperature",)),
    ("band_pore_pressure_Pa", "pore pressure", "Pa", BLUE, ("band_pore_pressure",)),
    ("band_saturation", "liquid saturation", "", GREEN, ("band_SL", "band_saturation")),
    ("band_friction_coefficient", "friction coefficient", "", PURPLE, ("band_friction_coefficient",)),
)


@styled
def band(run: Run) -> Figure:
    """Draw the four mass means over the band; a panel without data says why."""
    time = run.history["time_s"]
    figure = Figure(figsize=(10.0, 6.4), layout="constrained")
    figure.suptitle(f"{run.title}: the shear band", x=0.01, ha="left", size=12)
    panels: list[Axes] = list(figure.subplots(2, 2, sharex=True).flat)
    for axes, (column, words, unit, colour, quantities) in zip(panels, _PANELS, strict=True):
        axes.set_ylabel(words)
        time_axis(axes, time, label=axes in panels[2:])
        if column not in run.history:
            say(axes, f"history.csv has no column {column}")
            continue
        values = run.history[column]
        if not np.isfinite(values).any():
            say(axes, "never in contact" if "friction" in column else "no particle was ever in the band")
            continue
        divisor, shown = prefixed(values, unit) if unit == "Pa" else (1.0, unit)
        axes.set_ylabel(words + (f" ({shown})" if shown else ""))
        time_line(axes, time, values / divisor, color=colour, label="run")
        if draw_targets(axes, run, quantities, divisor, colour):
            axes.legend(loc="best")
        _finish(axes, column, values / divisor)
    letters(panels, [words for _, words, *_ in _PANELS])
    return figure


def _finish(axes: Axes, column: str, values: np.ndarray) -> None:
    """Give each panel its natural limits, and the temperatures that mean something their lines."""
    if column == "band_saturation":
        axes.set_ylim(0.0, 1.02)
    elif column == "band_friction_coefficient":
        axes.set_ylim(0.0, 1.08 * np.nanmax(values))
    elif column == "band_temperature_C":
        low, high = np.nanmin(values), np.nanmax(values)
        for level, words in ((0.0, "ice melts"), (100.0, "boiling is not modelled")):
            if low < level < high:
                axes.axhline(level, color=NOTE, linewidth=0.8, linestyle=":")
                axes.annotate(
                    words, (1.0, level), xycoords=("axes fraction", "data"), xytext=(-4, 3), textcoords="offset points",
                    ha="right", size=7.5, color=NOTE,
                )  # fmt: skip
