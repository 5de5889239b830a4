"""Which colours a field's values become: ranges, scales and the ticks of their bars."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize, PowerNorm, SymLogNorm, TwoSlopeNorm
from matplotlib.ticker import MaxNLocator, NullLocator

from thawslide.relief import round_number
from thawslide.run import Numbers, Snapshot


@dataclass(frozen=True)
class Painting:
    """What a snapshot figure paints: the field's name in the file, words for it, its unit and colour map."""

    field: str
    words: str
    unit: str
    colours: str


VELOCITY = Painting("velocity", "velocity", "m/s", "viridis")
PLASTIC_STRAIN = Painting("plastic_strain", "equivalent plastic strain", "1", "cividis")
TEMPERATURE = Painting("temperature", "temperature", "°C", "plasma")
THICKNESS = Painting("thickness", "thickness", "m", "YlOrRd")
PORE_PRESSURE = Painting("pore_pressure", "pore pressure", "Pa", "viridis")

BOILING = 100.0  # °C: beyond it a scale of equal steps would show the hottest particles alone
THIN = "#6BAED6"  # of thicknesses below the scale
_THIN_SHARE = 0.02  # of the thickest: what is thinner has that colour
_TICKS_APART = 0.09  # of the length of a bar
EVEN = 10.0  # °C: on the scale of decades, steps are equal between this much below and above 0 °C


def painted_values(snapshot: Snapshot, field: str) -> Numbers:
    """Return the field of each particle as one number, vectors by their magnitude."""
    values = np.asarray(snapshot[field], dtype=np.float64)
    return np.linalg.norm(values, axis=1) if values.ndim == 2 else values


def number_text(value: float) -> str:
    """Return a number in three digits, large ones with a comma between thousands."""
    return (f"{value:,.0f}" if abs(value) >= 1000.0 else f"{value:.3g}").replace("-", "−")


def colour_range(values: Numbers, from_zero: bool) -> tuple[float, float, str]:
    """Return (low, high, colourbar extend) without the outermost 0.2 % of values, or from 0 where a magnitude."""
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


def normalisation(values: Numbers, painting: Painting) -> tuple[Normalize, str]:
    """Return how values become colours, and which ends of the colourbar are open.

    Temperatures change pace where ice melts; where they pass 100 °C they go by decades, to the hottest particle.
    """
    if painting.field == THICKNESS.field:
        return thickness_norm(values)
    low, high, extend = colour_range(values, painting.field in ("velocity", "plastic_strain"))
    if painting.field != TEMPERATURE.field:
        return Normalize(low, high), extend
    if high > BOILING:
        hottest = float(values[np.isfinite(values)].max())
        open_end = "min" if extend in ("min", "both") else "neither"
        return SymLogNorm(EVEN, vmin=min(low, 0.0), vmax=hottest, base=10), open_end
    return (TwoSlopeNorm(0.0, low, high) if low < 0.0 < high else Normalize(low, high)), extend


def thickness_norm(values: Numbers) -> tuple[PowerNorm, str]:
    """Return a square-root scale of thicknesses, so that thin margins show, above a class of the thinnest of all."""
    _, high, extend = colour_range(values, from_zero=True)
    return PowerNorm(0.5, round_number(_THIN_SHARE * high), high), "both" if extend == "max" else "min"


def thickness_words(norm: Normalize) -> str:
    """Say on the bar how thicknesses are drawn."""
    return f"thickness (m), square-root scale; blue: below {number_text(float(norm.vmin or 0.0))} m"


def _apart(norm: Normalize, low: float, high: float) -> list[float]:
    """Return the low end of a scale and round numbers up to its high end that have room for their labels."""
    found = [low]
    for tick in (digit * 10.0**power for power in range(-3, 6) for digit in (1.0, 2.0, 5.0)):
        if low < tick <= high and float(norm(tick)) - float(norm(found[-1])) > _TICKS_APART:
            found.append(tick)
    return found


def label_bar(bar: Colorbar, norm: Normalize) -> None:
    """Give a bar ticks that its scale needs: both halves of a broken one; decades and ends of a logarithmic one."""
    low, high = float(norm.vmin or 0.0), float(norm.vmax or 0.0)
    if isinstance(norm, TwoSlopeNorm):
        # Each half has its own scale, and so its own round steps.
        below, above = (MaxNLocator(count, steps=[1, 2, 2.5, 5, 10]) for count in (2, 4))
        ticks = {float(tick) for tick in (*below.tick_values(low, 0.0), *above.tick_values(0.0, high))}
        bar.set_ticks(sorted(tick for tick in ticks if low <= tick <= high))
        bar.ax.xaxis.set_major_formatter(lambda value, _: f"{value:.10g}".replace("-", "−"))
    elif isinstance(norm, PowerNorm):
        shown = _apart(norm, low, high)
        bar.set_ticks(shown, labels=[number_text(tick) for tick in shown])
        bar.minorticks_off()
    elif isinstance(norm, SymLogNorm):
        # The end has its own label; a decade less than half of one below it would stand in its way.
        decades = [10.0**power for power in range(1, 7) if 3.0 * 10.0**power < high]
        bar.set_ticks([low, *([0.0] if low < 0.0 else []), *decades, high])
        bar.ax.xaxis.set_major_formatter(lambda value, _: number_text(value) + (" (highest)" if value == high else ""))
        bar.ax.xaxis.set_minor_locator(NullLocator())
