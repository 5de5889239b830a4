"""Seismic force and mean plastic strain (paper Fig. 17)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.band_pass import band_passed
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
    TIME_LABEL,
    styled,
    time_axis,
    time_line,
    title_figure,
    title_panels,
)
from thawslide.maps import on_map
from thawslide.number_text import number_text, prefixed
from thawslide.run_folder import Numbers, Run
from thawslide.targets import FORCE, Band, Target, band_of

_LEGEND_ROW = 0.16  # inches


def reported_forces(run: Run) -> list[Target]:
    """Return the reported maximum forces, with or without a band."""
    return [target for target in run.targets if target.quantity == FORCE or band_of(target) is not None]


def reported_bands(run: Run) -> list[Band]:
    """Return the bands of the reported forces, each once."""
    bands = (band_of(target) for target in reported_forces(run))
    return list(dict.fromkeys(band for band in bands if band is not None))


def seismic_force(run: Run) -> tuple[dict[str, Numbers], Numbers]:
    """Return the components by axis and the magnitude [N, or N per metre of width], each of shape (rows,)."""
    parts = {axis: run.series[name] for axis in "xyz" if (name := f"seismic_force_{axis}_N") in run.series}
    if not parts:
        raise NotInRunError("history.csv has no column seismic_force_x_N")
    return parts, np.sqrt(sum(np.square(values) for values in parts.values()))


def force_in_band(run: Run, band: Band) -> Numbers:
    """Return the magnitude [N, or N per metre of width] of the band-passed force, shape (rows,)."""
    parts, _ = seismic_force(run)
    passed = (band_passed(run.series["time_s"], part, band.shortest, band.longest) for part in parts.values())
    return np.asarray(np.sqrt(sum(np.square(part) for part in passed)))


def _mark_start(axes: Axes, time: Numbers, magnitude: Numbers) -> None:
    """Label the force of the initial stress adjustment if it exceeds half of the maximum."""
    start = time <= time[0] + 0.01 * (time[-1] - time[0])
    if not np.isfinite(magnitude[start]).any() or np.nanmax(magnitude[start]) < 0.5 * np.nanmax(magnitude):
        return
    first = int(np.nanargmax(np.where(start, magnitude, -np.inf)))
    axes.annotate(
        "initial stress adjustment", (time[first], magnitude[first]), xytext=(0.01, 0.96), textcoords="axes fraction",
        va="top", size=8, color=NOTE, arrowprops={"arrowstyle": "-", "color": NOTE, "linewidth": 0.6},
    )  # fmt: skip


@styled
def force(run: Run) -> Figure:
    """Plot the force on the terrain minus the static weight, (a) magnitude, (b) components; (c) plastic strain."""
    time = run.series["time_s"]
    parts, magnitude = seismic_force(run)
    reported = reported_forces(run)
    comparable = [] if run.per_metre else reported
    divisor, unit = prefixed([np.nanmax(np.abs(magnitude)), *(t.value for t in comparable)], "N")
    unit += "/m of width" if run.per_metre else ""

    rows = 1 + len(reported_bands(run)) + len(comparable)
    figure = Figure(figsize=(COLUMN_WIDTH, 6.1 + _LEGEND_ROW * rows), layout="constrained")
    title_figure(figure, run.titled("seismic force and plastic strain"))
    size, components, strain = panels = list(figure.subplots(3, 1, sharex=True, height_ratios=(1.2, 1.2, 1.0)))
    time_line(size, time, magnitude / divisor, color=BLACK, linewidth=1.1, label="run")
    bands = reported_bands(run)
    colours = dict(zip(bands, (BLUE, GREEN, PURPLE, ORANGE), strict=False))
    for band, colour in colours.items():
        words = f"run, band-pass {band.words}"
        time_line(size, time, force_in_band(run, band) / divisor, color=colour, linewidth=1.3, label=words)
    for number, target in enumerate(comparable):
        found = band_of(target)
        of_band = f" ({found.words})" if found else ""
        # The colour is that of the compared curve; dashes of equal values do not coincide.
        style = {"color": colours.get(found, RED) if found else RED, "linestyle": (4.0 * number, (4.0, 4.0))}
        label = f"{target.adjective} maximum {number_text(target.value / divisor)} {unit}{of_band}: {target.source}"
        size.axhline(target.value / divisor, linewidth=1.4, label=label, **style)
    if reported and run.per_metre:
        note = "reported force not shown: no case.width"
        size.text(0.01, 0.96, note, transform=size.transAxes, va="top", size=8, color=NOTE)
    _mark_start(size, time, magnitude / divisor)
    size.set_ylim(0.0, 1.15 * size.get_ylim()[1])  # space for notes

    directions = ("east", "north") if on_map(run) else ("along", "across")
    names = dict(zip("xy", directions, strict=True)) | {"xyz"[run.vertical]: "up"}
    for (axis, values), colour in zip(parts.items(), (BLUE, ORANGE, PURPLE), strict=False):
        time_line(components, time, values / divisor, color=colour, linewidth=0.9, label=f"{axis} ({names[axis]})")
    for axes in (size, components):
        axes.set_ylabel(f"force ({unit})")
    # Legends below the panels do not cover curves.
    size.legend(loc="upper left", bbox_to_anchor=(0.0, -0.03))
    components.legend(loc="upper left", bbox_to_anchor=(0.0, -0.03), ncols=3)

    time_line(strain, time, run.series["mean_plastic_strain"], color=GREEN)
    strain.set_ylabel("mean plastic strain (–)")
    strain.set_ylim(bottom=0.0)
    for axes in panels:
        time_axis(axes, time, TIME_LABEL if axes is strain else "")
    title_panels(
        panels,
        (
            "magnitude of the force on the terrain minus static weight",
            "components, positive along the axes",
            "equivalent plastic strain, mass-weighted mean",
        ),
    )
    return figure
