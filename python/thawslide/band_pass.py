"""Zero-phase band-pass filter, for comparison of a history with an inversion of long-period seismic waves."""

from __future__ import annotations

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError

ORDER = 4  # of the Butterworth filter
SAMPLES = 40  # minimum number in the shortest period
MOST_SAMPLES = 2e7


def response(frequency: Numbers, shortest: float, longest: float) -> Numbers:
    """Return the factor on amplitudes at frequencies [Hz], for a band between two periods [s].

    It is that of a Butterworth filter of fourth order, high pass and low pass, applied forwards and backwards. It has
    no phase, and is 1/2 at either end of the band and 0 at frequency 0.
    """
    high = 1.0 / (1.0 + (frequency * shortest) ** (2 * ORDER))
    slow = (frequency * longest) ** (2 * ORDER)
    return np.asarray(high * slow / (1.0 + slow))


def even_times(start: float, end: float, step: float, shortest: float, longest: float) -> Numbers:
    """Return evenly spaced times [s] for filtering a history; ReportError if there are too many."""
    samples = (end - start + 4.0 * longest) / step
    if not samples <= MOST_SAMPLES:
        raise ReportError(
            f"band-pass {shortest:g} to {longest:g} s over {end - start:g} s: too many samples (found {samples:.3g}; "
            f"allowed {MOST_SAMPLES:,.0f}). Specify longer periods."
        )
    return np.arange(start, end + 0.5 * step, step)


def band_passed(time: Numbers, values: Numbers, shortest: float, longest: float, at: Numbers | None = None) -> Numbers:
    """Return a history filtered to a band between two periods [s], at its own ascending times [s] or at others.

    A missing number, as in the first row of a force, counts as 0. The history is extended by its first and its last
    value, each for the longest period. Half a cosine of twice that length then leads from the last value to the first.
    The record is therefore periodic without a jump, and a constant gives zero. `response` is applied in the frequency
    domain.
    """
    if not 0.0 < shortest < longest:
        raise ValueError(f"band from {shortest:g} to {longest:g} s: the first period must be the shorter one")
    wanted = time if at is None else at
    if len(time) < 2:
        return np.zeros_like(wanted)
    start, end = min(float(time[0]), float(wanted[0])), max(float(time[-1]), float(wanted[-1]))
    step = min(float(np.median(np.diff(time))), shortest / SAMPLES)
    even = even_times(start, end, step, shortest, longest)
    record = np.interp(even, time, np.nan_to_num(values))
    held = int(np.ceil(longest / step))
    turn = 0.5 - 0.5 * np.cos(np.pi * np.arange(1, 2 * held) / (2 * held))
    back = record[-1] + (record[0] - record[-1]) * turn
    whole = np.concatenate((record, np.full(held, record[-1]), back, np.full(held, record[0])))
    frequency = np.asarray(np.fft.rfftfreq(len(whole), step), dtype=np.float64)
    spectrum = np.fft.rfft(whole) * response(frequency, shortest, longest)
    return np.asarray(np.interp(wanted, even, np.fft.irfft(spectrum, len(whole))[: len(even)]))
