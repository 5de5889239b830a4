"""What seismometers would feel, and the mean plastic strain (paper Fig. 17)."""

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
    give_title,
    letters,
    prefixed,
    styled,
    time_axis,
    time_line,
)
from thawslide.run import Numbers, Run
from thawslide.targets import FORCE, Band, Target, band_of


def reported_forces(run: Run) -> list[Target]:
    """Return the reported largest forces, with a band or without."""
    return [target for target in run.targets if target.quantity == FORCE or band_of(target) is not None]


def reported_bands(run: Run) -> list[Band]:
    """Return the bands that reported forces have, each once."""
    bands = (band_of(target) for target in reported_forces(run))
    return list(dict.fromkeys(band for band in bands if band is not None))


def seismic_force(run: Run) -> tuple[dict[str, Numbers], Numbers]:
    """Return the components by axis and the magnitude [N, or N per metre of width], each of shape (rows,)."""
    parts = {axis: run.history[name] for axis in "xyz" if (name := f"seismic_force_{axis}_N") in run.history}
    if not parts:
        raise NotInRunError("history.csv has no column seismic_force_x_N")
    return parts, np.sqrt(sum(np.square(values) for values in parts.values()))


def force_in_band(run: Run, band: Band) -> Numbers:
    """Return the magnitude [N, or N per metre of width] of the force with its components band-passed, shape (rows,)."""
    parts, _ = seismic_force(run)
    passed = (band_passed(run.history["time_s"], part, band.shortest, band.longest) for part in parts.values())
    return np.asarray(np.sqrt(sum(np.square(part) for part in passed)))


def _mark_start(axes: Axes, time: Numbers, magnitude: Numbers) -> None:
    """Label the force of the initial stress adjustment, if it is of the size of the rest."""
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
    """Draw the force on the ground less the static weight, (a) its size, (b) its components; (c) plastic strain."""
    time = run.shown_time
    parts, magnitude = seismic_force(run)
    reported = reported_forces(run)
    comparable = [] if run.per_metre else reported
    divisor, unit = prefixed([np.nanmax(np.abs(magnitude)), *(t.value for t in comparable)], "N")
    unit += "/m of width" if run.per_metre else ""

    figure = Figure(figsize=(COLUMN_WIDTH, 6.1), layout="constrained")
    give_title(figure, run.titled("seismic force and internal deformation"))
    size, components, strain = panels = list(figure.subplots(3, 1, sharex=True, height_ratios=(1.2, 1.2, 1.0)))
    time_line(size, time, magnitude / divisor, color=BLACK, linewidth=1.1, label="run")
    bands = reported_bands(run)
    colours = dict(zip(bands, (BLUE, GREEN, PURPLE, ORANGE), strict=False))
    for band, colour in colours.items():
        words = f"run, band-passed {band.words}"
        time_line(size, time, force_in_band(run, band) / divisor, color=colour, linewidth=1.3, label=words)
    for number, target in enumerate(comparable):
        found = band_of(target)
        of_band = f" ({found.words})" if found else ""
        # In the colour of what it is compared with; dashes of equal values fall between one another.
        look = {"color": colours.get(found, RED) if found else RED, "linestyle": (4.0 * number, (4.0, 4.0))}
        label = f"{target.adjective} maximum {target.value / divisor:g} {unit}{of_band}: {target.source}"
        size.axhline(target.value / divisor, linewidth=1.4, label=label, **look)
    if reported and run.per_metre:
        note = "reported force not drawn: the case states no width"
        size.text(0.01, 0.96, note, transform=size.transAxes, va="top", size=8, color=NOTE)
    _mark_start(size, time, magnitude / divisor)
    size.set_ylim(0.0, (1.25 + 0.15 * len(bands)) * size.get_ylim()[1])  # room for the legend

    vertical = "xyz"[run.vertical]
    for (axis, values), colour in zip(parts.items(), (BLUE, ORANGE, PURPLE), strict=False):
        direction = "up" if axis == vertical else "along" if axis == "x" else "across"
        time_line(components, time, values / divisor, color=colour, linewidth=0.9, label=f"{axis} ({direction})")
    for axes in (size, components):
        axes.set_ylabel(f"force ({unit})")
        axes.legend(loc="upper right")

    time_line(strain, time, run.history["mean_plastic_strain"], color=GREEN)
    strain.set_ylabel("mean plastic strain")
    strain.set_ylim(bottom=0.0)
    for axes in panels:
        time_axis(axes, time, run.clock.label if axes is strain else "")
    letters(
        panels,
        (
            "force on the ground less the static weight, magnitude",
            "its components, positive along the axis",
            "equivalent plastic strain, mean of mass",
        ),
    )
    return figure
