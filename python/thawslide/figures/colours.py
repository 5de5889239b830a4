"""Colours of the values of a field: ranges, scales and ticks of colour bars."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize, PowerNorm, SymLogNorm, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, MaxNLocator

from thawslide.number_text import exact_text, number_text
from thawslide.relief import round_number
from thawslide.run_folder import Numbers, Snapshot


@dataclass(frozen=True)
class Painting:
    """Field of a snapshot figure: its name in the file, its label, unit and colour map."""

    field: str
    words: str
    unit: str
    colours: str


SPEED = Painting("velocity", "speed", "m/s", "viridis")
PLASTIC_STRAIN = Painting("plastic_strain", "equivalent plastic strain", "1", "cividis")
TEMPERATURE = Painting("temperature", "temperature", "°C", "plasma")
THICKNESS = Painting("thickness", "thickness", "m", "YlOrRd")
PORE_PRESSURE = Painting("pore_pressure", "pore pressure", "Pa", "viridis")

PROBABILITY_LIMITS = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)  # of the classes of a probability
BOILING = 100.0  # °C: beyond it a linear scale would only resolve the hottest particles
THIN = "#6BAED6"  # of thicknesses below the scale
_THIN_FRACTION = 0.02  # of the maximum: smaller thicknesses have that colour
_TICKS_APART = 0.09  # of the length of a bar
_TICK_LINE = 0.14  # inches, height of a label of ticks
LINEAR = 10.0  # °C: the logarithmic scale is linear within this distance of 0 °C
_CHARACTER = 0.075  # inches, of a label of ticks


def painted_values(snapshot: Snapshot, field: str) -> Numbers:
    """Return the field of each particle as one number, the magnitude for vectors."""
    values = np.asarray(snapshot[field], dtype=np.float64)
    return np.linalg.norm(values, axis=1) if values.ndim == 2 else values


def colour_range(values: Numbers, from_zero: bool) -> tuple[float, float, str]:
    """Return (low, high, colourbar extend) without the outermost 0.2 % of values; low is 0 if `from_zero`."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 0.0, 1.0, "neither"
    low, high = (float(value) for value in np.quantile(finite, [0.002, 0.998]))
    if from_zero:
        low = 0.0
    if high - low <= 1e-9 * max(abs(low), abs(high), 1e-300):
        pad = 0.05 * abs(high) or 0.5
        return (0.0 if from_zero else low - pad), high + pad, "neither"
    below, above = finite.min() < low - 0.01 * (high - low), finite.max() > high + 0.01 * (high - low)
    return low, high, {(0, 0): "neither", (0, 1): "max", (1, 0): "min", (1, 1): "both"}[(int(below), int(above))]


def normalization(values: Numbers, painting: Painting) -> tuple[Normalize, str]:
    """Return the scale of colours, and the open ends of the colour bar.

    The scale of temperatures has a break at 0 °C. If they exceed 100 °C it is logarithmic, up to the maximum.
    """
    if painting.field == THICKNESS.field:
        return thickness_norm(values)
    low, high, extend = colour_range(values, painting.field in ("velocity", "plastic_strain"))
    if painting.field != TEMPERATURE.field:
        return Normalize(low, high), extend
    if high > BOILING:
        hottest = float(values[np.isfinite(values)].max())
        open_end = "min" if extend in ("min", "both") else "neither"
        return SymLogNorm(LINEAR, vmin=min(low, 0.0), vmax=hottest, base=10), open_end
    return (TwoSlopeNorm(0.0, low, high) if low < 0.0 < high else Normalize(low, high)), extend


def scale_words(norm: Normalize) -> str:
    """Return the scale of temperatures in words for a label, "" for a linear one."""
    return f", logarithmic scale above {LINEAR:g} °C" if isinstance(norm, SymLogNorm) else ""


def thickness_norm(values: Numbers) -> tuple[PowerNorm, str]:
    """Return a square-root scale of thicknesses, which resolves thin margins, above a class of the smallest ones."""
    _, high, extend = colour_range(values, from_zero=True)
    return PowerNorm(0.5, round_number(_THIN_FRACTION * high), high), "both" if extend == "max" else "min"


def thickness_words(norm: Normalize) -> str:
    """Return the label of a colour bar of thicknesses."""
    return f"flow thickness (m), square-root scale; blue: below {number_text(float(norm.vmin or 0.0))} m"


def _apart(norm: Normalize, low: float, high: float, least: float) -> list[float]:
    """Return the low end of a scale and round numbers up to its high end, `least` of the bar's length apart."""
    found = [low]
    for tick in (digit * 10.0**power for power in range(-3, 6) for digit in (1.0, 2.0, 5.0)):
        if low < tick <= high and float(norm(tick)) - float(norm(found[-1])) > least:
            found.append(tick)
    return found


def _inches(bar: Colorbar) -> tuple[float, float]:
    """Return width and height of a bar."""
    figure = bar.ax.get_figure()
    assert isinstance(figure, Figure)
    width, height = figure.get_size_inches() * bar.ax.get_position().size
    return float(width), float(height)


def label_bar(bar: Colorbar, norm: Normalize) -> None:
    """Set the ticks that a scale needs: in both halves of a broken one; decades and ends of a logarithmic one."""
    low, high = float(norm.vmin or 0.0), float(norm.vmax or 0.0)
    if isinstance(norm, TwoSlopeNorm):
        # Each half has its own scale and therefore its own round steps.
        below, above = (MaxNLocator(count, steps=[1, 2, 2.5, 5, 10]) for count in (2, 4))
        ticks = {float(tick) for tick in (*below.tick_values(low, 0.0), *above.tick_values(0.0, high))}
        bar.set_ticks(sorted(tick for tick in ticks if low <= tick <= high))
        bar.ax.xaxis.set_major_formatter(lambda value, _: exact_text(value))
    elif isinstance(norm, PowerNorm):
        width, height = _inches(bar)
        shown = _apart(norm, low, high, _TICKS_APART if width > height else max(_TICKS_APART, _TICK_LINE / height))
        bar.set_ticks(shown, labels=[number_text(tick) for tick in shown])
        bar.minorticks_off()
    elif isinstance(norm, SymLogNorm):
        # Decades are omitted if their labels would overlap that of the maximum.
        inches = _inches(bar)[0]
        decades = [10.0**power for power in range(1, 7) if 10.0**power < high]
        half_widths = {value: 0.5 * _CHARACTER * (1 + len(number_text(value))) for value in (*decades, high)}
        kept = [
            value for value in decades if inches * (1.0 - float(norm(value))) > half_widths[value] + half_widths[high]
        ]
        zero = [0.0] if low < 0.0 and inches * float(norm(0.0)) > 2.0 * half_widths[high] else []
        bar.set_ticks([low, *zero, *kept, high])
        bar.ax.xaxis.set_major_formatter(lambda value, _: number_text(value))
        steps = [digit * 10.0**power for power in range(1, 7) for digit in range(2, 10)]
        bar.ax.xaxis.set_minor_locator(FixedLocator([step for step in steps if step < high]))
