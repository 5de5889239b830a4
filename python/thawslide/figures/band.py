"""Temperature, pore pressure, saturation and friction of the shear band over time (paper Fig. 20).

For band columns: basal stresses, temperatures and the boiling temperature.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.boiling import boiling_temperature
from thawslide.figures.load import load_on_band
from thawslide.figures.motion import plot_targets
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
    draw_reference,
    explain_empty,
    mark_level,
    note_below,
    reserve_top,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
    warn,
)
from thawslide.number_text import prefixed
from thawslide.run_folder import Run
from thawslide.unphysical import too_hot, too_much_for_overburden, too_much_pressure

_ABOVE_AXIS = 3.0  # order of lines that can be zero throughout
_LEGEND_ROW, _LEGEND_EDGE = 0.155, 0.1  # inches
# Column, label, unit, colour, names of the reported quantity.
_PANELS = (
    ("band_temperature_C", "temperature", "°C", RED, ("band_temperature",)),
    ("band_pore_pressure_Pa", "pore pressure", "Pa", BLUE, ("band_pore_pressure",)),
    ("band_saturation", "liquid saturation", "", GREEN, ("band_SL", "band_saturation")),
    ("band_friction_coefficient", "friction coefficient", "", PURPLE, ("band_friction_coefficient",)),
)


@styled
def band(run: Run) -> Figure:
    """Plot mass-weighted means over the band, or means over band columns; a panel without data states the reason."""
    return _plot_columns(run) if run.has_band_columns else _plot_particles(run)


def _plot_particles(run: Run) -> Figure:
    time = run.series["time_s"]
    figure = Figure(figsize=(COLUMN_WIDTH, 5.1), layout="constrained")
    title_figure(figure, run.titled("shear band"))
    panels: list[Axes] = list(figure.subplots(2, 2, sharex=True).flat)
    notes: list[str] = []
    for axes, (column, words, unit, colour, quantities) in zip(panels, _PANELS, strict=True):
        axes.set_ylabel(words)
        time_axis(axes, time, TIME_LABEL if axes in panels[2:] else "")
        if column not in run.series:
            explain_empty(axes, f"no column {column} in history.csv")
            continue
        values = run.series[column]
        if not np.isfinite(values).any():
            explain_empty(axes, "no contact" if "friction" in column else "no particles in the band")
            continue
        is_pressure = unit == "Pa"
        when, load = load_on_band(run) if is_pressure else (time[:0], time[:0])
        divisor, shown = prefixed([*values, *load], unit) if is_pressure else (1.0, unit)
        axes.set_ylabel(f"{words} ({shown or '–'})")
        time_line(axes, time, values / divisor, color=colour, label=_pressure_words(run) if is_pressure else "run")
        if np.isfinite(load).any():
            time_line(axes, when, load / divisor, color=BLACK, linestyle="--", label="static normal pressure N")
            warn(axes, too_much_for_overburden(np.interp(when, time, values) / load))
        notes += [f"{words}: {note}" for note in plot_targets(axes, run, quantities, divisor, colour)]
        if len(axes.get_legend_handles_labels()[1]) > 1 or is_pressure:
            warned = any(text.get_gid() == "warning" for text in axes.texts)
            # A warning is at the top; P is then much larger than N, and the legend fits between them.
            axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.08), handlelength=1.2) if warned else axes.legend(
                loc="best"
            )
        _finish(axes, column, values / divisor)
        if column == "band_temperature_C" and "band_pore_pressure_Pa" in run.series:
            warn(axes, too_hot(run, values, run.series["band_pore_pressure_Pa"]))
    title_panels(panels, [words for _, words, *_ in _PANELS])
    _note_targets(figure, notes)
    return figure


def _pressure_words(run: Run) -> str:
    """Return the label of the pore pressure, and that it has no effect if the case excludes it."""
    if run.section("mechanisms").get("pressurization", True):
        return "pore pressure P"
    return "pore pressure P, computed but not applied\n(mechanisms.pressurization = false)"


def _plot_columns(run: Run) -> Figure:
    figure = Figure(figsize=(COLUMN_WIDTH, 6.9), layout="constrained")
    title_figure(figure, run.titled("shear band, means over the base"))
    panels: list[Axes] = list(figure.subplots(3, 2, sharex=True).flat)
    pressure, heat, saturation, thickness, ratio, friction = panels
    notes = [f"pore pressure: {note}" for note in _plot_stresses(pressure, run)]
    notes += [f"temperature: {note}" for note in _plot_temperatures(heat, run)]
    found = _plot_mean(
        saturation, run, "band_saturation", "liquid saturation (–)", GREEN, ("band_SL", "band_saturation")
    )
    notes += [f"liquid saturation: {note}" for note in found]
    saturation.set_ylim(0.0, 1.02)
    _plot_mean(thickness, run, "band_thickness_m", "thickness (m)", ORANGE)
    _plot_mean(ratio, run, "band_max_pressure_ratio", "maximum P/N (–)", BLUE)
    _plot_mean(friction, run, "band_friction_coefficient", "friction coefficient (–)", PURPLE)
    for axes in (thickness, ratio, friction):
        highest = axes.dataLim.y1  # -inf without values
        axes.set_ylim(0.0, max(1.08 * highest, 1e-3) if highest > 0.0 else 1.0)
    draw_reference(ratio, 1.0)
    warn(ratio, too_much_pressure(run.series["band_max_pressure_ratio"]))
    for axes in panels:
        time_axis(axes, run.series["time_s"], TIME_LABEL if axes in panels[4:] else "")
    title_panels(
        panels,
        (
            "basal stresses",
            "temperature",
            "liquid saturation",
            "thickness",
            "maximum pore pressure ratio P/N",
            "friction coefficient",
        ),
    )
    _note_targets(figure, notes)
    return figure


def _plot_mean(
    axes: Axes, run: Run, column: str, words: str, colour: str, quantities: tuple[str, ...] = ()
) -> list[str]:
    """Plot one column of the history, or state why it is empty; return notes on reported values."""
    axes.set_ylabel(words)
    values = run.series[column]
    if not np.isfinite(values).any():
        explain_empty(axes, "no contact")
        return []
    time_line(axes, run.series["time_s"], values, color=colour, label="run", zorder=_ABOVE_AXIS)
    notes = plot_targets(axes, run, quantities, 1.0, colour)
    if len(axes.get_legend_handles_labels()[1]) > 1:
        axes.legend(loc="best")
    return notes


def _note_targets(figure: Figure, notes: list[str]) -> None:
    """Write notes on reported values below the panels."""
    if notes:
        note_below(figure, " ".join(f"{note[:1].upper()}{note[1:]}." for note in notes))


def _plot_stresses(axes: Axes, run: Run) -> list[str]:
    """Plot N, P, the effective stress and the shear traction; return notes on reported values."""
    load, pore_pressure = run.series["band_normal_pressure_Pa"], run.series["band_pore_pressure_Pa"]
    lines = (
        (load, "normal pressure N", {"color": BLACK, "linewidth": 3.0}),
        (pore_pressure, "pore pressure P", {"color": BLUE}),
        (load - pore_pressure, "effective stress N − P", {"color": GREEN, "linestyle": (0.0, (3.0, 1.5))}),
        (run.series["band_shear_Pa"], "shear traction", {"color": RED}),
    )
    divisor, unit = prefixed(np.concatenate([values for values, *_ in lines]), "Pa")
    axes.set_ylabel(f"stress ({unit})")
    # N is wide and the effective stress dashed: both are visible without pore pressure.
    for values, words, style in lines:
        time_line(axes, run.series["time_s"], values / divisor, label=words, zorder=_ABOVE_AXIS, **style)
    notes = plot_targets(axes, run, ("band_pore_pressure",), divisor, BLUE)
    legend = axes.legend(loc="upper center", ncols=2, columnspacing=0.7, handlelength=1.2, handletextpad=0.4)
    rows = (len(legend.get_texts()) + 1) // 2
    highest = axes.dataLim.y1 if np.isfinite(axes.dataLim.y1) else 1.0  # no values before the first contact
    axes.set_ylim(0.0, highest / (1.0 - 0.06 - 0.13 * rows))  # the lines end below the legend
    return notes


def _plot_temperatures(axes: Axes, run: Run) -> list[str]:
    """Plot mean, maximum and boiling temperature; return notes on reported values."""
    time = run.series["time_s"]
    boiling = boiling_temperature(run.series["band_normal_pressure_Pa"])
    axes.set_ylabel("temperature (°C)")
    time_line(axes, time, run.series["band_max_temperature_C"], color=PURPLE, label="maximum of all columns")
    time_line(axes, time, run.series["band_temperature_C"], color=RED, label="mean")
    notes = plot_targets(axes, run, ("band_temperature",), 1.0, RED)
    words = "boiling temperature at mean N"
    if float(np.min(boiling, where=np.isfinite(boiling), initial=np.inf)) > axes.get_ylim()[1]:
        words += " (above the panel)"
    draw_reference(axes, boiling, time, color=SKY, linestyle="--", label=words)
    draw_reference(axes, 0.0)
    legend = axes.legend(loc="upper right")
    space = _LEGEND_EDGE + _LEGEND_ROW * len(legend.get_texts())
    words = too_hot(run, run.series["band_max_temperature_C"], run.series["band_pore_pressure_Pa"])
    if words:
        warn(axes, words, below=space)
    else:
        reserve_top(axes, space)
    return notes


def _finish(axes: Axes, column: str, values: np.ndarray) -> None:
    """Set the limits of a panel, and mark the melting and the boiling point."""
    if column == "band_saturation":
        axes.set_ylim(0.0, 1.02)
    elif column == "band_friction_coefficient":
        axes.set_ylim(0.0, 1.08 * np.nanmax(values))
    elif column == "band_temperature_C":
        low, high = np.nanmin(values), np.nanmax(values)
        for level, words in ((0.0, "melting point"), (100.0, "boiling point")):
            if low < level < high:
                mark_level(axes, values, level, words)
