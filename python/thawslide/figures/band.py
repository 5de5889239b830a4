"""Temperature, pore pressure, saturation and friction of the shear band over time (paper Fig. 20).

For a band of columns: basal stresses, temperature, and how near it is to boiling.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.boiling import boiling_temperature
from thawslide.figures.load import load_on_band
from thawslide.figures.motion import draw_targets
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
    give_title,
    letters,
    prefixed,
    say,
    styled,
    time_axis,
    time_line,
    warn,
)
from thawslide.run import Run
from thawslide.unphysical import too_hot, too_much_for_weight, too_much_pressure

# Column, words, unit, colour, names of the reported quantity.
_PANELS = (
    ("band_temperature_C", "temperature", "°C", RED, ("band_temperature",)),
    ("band_pore_pressure_Pa", "pore pressure", "Pa", BLUE, ("band_pore_pressure",)),
    ("band_saturation", "liquid saturation", "", GREEN, ("band_SL", "band_saturation")),
    ("band_friction_coefficient", "friction coefficient", "", PURPLE, ("band_friction_coefficient",)),
)


@styled
def band(run: Run) -> Figure:
    """Draw the four mass means over the band, or the means over band columns; a panel without data says why."""
    return _of_columns(run) if run.has_band_columns else _of_particles(run)


def _of_particles(run: Run) -> Figure:
    time = run.shown_time
    figure = Figure(figsize=(COLUMN_WIDTH, 5.1), layout="constrained")
    give_title(figure, run.titled("the shear band"))
    panels: list[Axes] = list(figure.subplots(2, 2, sharex=True).flat)
    for axes, (column, words, unit, colour, quantities) in zip(panels, _PANELS, strict=True):
        axes.set_ylabel(words)
        time_axis(axes, time, run.clock.label if axes in panels[2:] else "")
        if column not in run.history:
            say(axes, f"history.csv has no column {column}")
            continue
        values = run.history[column]
        if not np.isfinite(values).any():
            say(axes, "never in contact" if "friction" in column else "no particle was ever in the band")
            continue
        is_pressure = unit == "Pa"
        when, load = load_on_band(run) if is_pressure else (time[:0], time[:0])
        divisor, shown = prefixed([*values, *load], unit) if is_pressure else (1.0, unit)
        axes.set_ylabel(words + (f" ({shown})" if shown else ""))
        time_line(axes, time, values / divisor, color=colour, label="pore pressure P" if is_pressure else "run")
        if np.isfinite(load).any():
            time_line(axes, when, load / divisor, color=BLACK, linestyle="--", label="normal pressure N, weight above")
            warn(axes, too_much_for_weight(np.interp(when, time, values) / load))
        if draw_targets(axes, run, quantities, divisor, colour) or is_pressure:
            warned = any(text.get_gid() == "warning" for text in axes.texts)
            # A warning lies at the top; P is then far above N, and there is room between them.
            axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.08)) if warned else axes.legend(loc="best")
        _finish(axes, column, values / divisor)
        if column == "band_temperature_C" and "band_pore_pressure_Pa" in run.history:
            warn(axes, too_hot(run, values, run.history["band_pore_pressure_Pa"]))
    letters(panels, [words for _, words, *_ in _PANELS])
    return figure


def _of_columns(run: Run) -> Figure:
    figure = Figure(figsize=(COLUMN_WIDTH, 6.9), layout="constrained")
    give_title(figure, run.titled("the band along the base"))
    panels: list[Axes] = list(figure.subplots(3, 2, sharex=True).flat)
    pressure, heat, saturation, thickness, ratio, friction = panels
    _draw_stresses(pressure, run)
    _draw_temperatures(heat, run)
    _draw_mean(saturation, run, "band_saturation", "liquid saturation", GREEN, ("band_SL", "band_saturation"))
    saturation.set_ylim(0.0, 1.02)
    _draw_mean(thickness, run, "band_thickness_m", "thickness (m)", ORANGE)
    _draw_mean(ratio, run, "band_largest_pressure_ratio", "largest P over N", BLUE)
    ratio.axhline(1.0, color=NOTE, linewidth=0.8, linestyle=":")
    _draw_mean(friction, run, "band_friction_coefficient", "friction coefficient", PURPLE)
    for axes in (thickness, ratio, friction):
        axes.set_ylim(0.0, max(1.08 * axes.dataLim.y1, 1e-3) if np.isfinite(axes.dataLim.y1) else 1.0)
    warn(ratio, too_much_pressure(run.history["band_largest_pressure_ratio"]))
    for axes in panels:
        time_axis(axes, run.shown_time, run.clock.label if axes in panels[4:] else "")
    letters(
        panels,
        (
            "basal stresses",
            "temperature",
            "liquid saturation",
            "thickness",
            "largest P of any column, over its N",
            "friction coefficient",
        ),
    )
    return figure


def _draw_mean(axes: Axes, run: Run, column: str, words: str, colour: str, quantities: tuple[str, ...] = ()) -> None:
    """Draw one column of the history, or say why there is nothing to draw."""
    axes.set_ylabel(words)
    values = run.history[column]
    if not np.isfinite(values).any():
        say(axes, "never in contact")
        return
    time_line(axes, run.shown_time, values, color=colour, label="run")
    if draw_targets(axes, run, quantities, 1.0, colour):
        axes.legend(loc="best")


def _draw_stresses(axes: Axes, run: Run) -> None:
    """Draw N, P, what is left between them, and the shear traction on one axis."""
    load, pore_pressure = run.history["band_normal_pressure_Pa"], run.history["band_pore_pressure_Pa"]
    lines = (
        (load, "normal pressure N", BLACK),
        (pore_pressure, "pore pressure P", BLUE),
        (load - pore_pressure, "effective stress N − P", GREEN),
        (run.history["band_shear_Pa"], "shear traction", RED),
    )
    divisor, unit = prefixed(np.concatenate([values for values, *_ in lines]), "Pa")
    axes.set_ylabel(f"stress ({unit})")
    for values, words, colour in lines:
        time_line(axes, run.shown_time, values / divisor, color=colour, label=words)
    draw_targets(axes, run, ("band_pore_pressure",), divisor, BLUE)
    legend = axes.legend(loc="upper center", ncols=2, columnspacing=0.7, handlelength=1.2, handletextpad=0.4)
    rows = (len(legend.get_texts()) + 1) // 2
    highest = axes.dataLim.y1 if np.isfinite(axes.dataLim.y1) else 1.0  # before any contact there is nothing
    axes.set_ylim(0.0, highest / (1.0 - 0.06 - 0.13 * rows))  # the lines end below the legend


def _draw_temperatures(axes: Axes, run: Run) -> None:
    time = run.shown_time
    boiling = boiling_temperature(run.history["band_normal_pressure_Pa"])
    axes.set_ylabel("temperature (°C)")
    time_line(axes, time, run.history["band_hottest_C"], color=ORANGE, label="hottest of any column")
    time_line(axes, time, run.history["band_temperature_C"], color=RED, label="mean")
    time_line(axes, time, boiling, color=SKY, linestyle="--", label="water boils at the mean N")
    axes.axhline(0.0, color=NOTE, linewidth=0.8, linestyle=":")
    draw_targets(axes, run, ("band_temperature",), 1.0, RED)
    low, top = axes.get_ylim()
    axes.set_ylim(top=top + 0.4 * (top - low))  # room for the legend
    warn(axes, too_hot(run, run.history["band_hottest_C"], run.history["band_pore_pressure_Pa"]), high=False)
    axes.legend(loc="upper right")


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
