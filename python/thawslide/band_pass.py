"""A zero-phase band-pass filter: what an inversion of long-period seismic waves sees of a history."""

from __future__ import annotations

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError

ORDER = 4  # of the Butterworth filter
SAMPLES = 40  # at least, of the shortest period
MOST_SAMPLES = 2e7  # that a history may take


def response(frequency: Numbers, shortest: float, longest: float) -> Numbers:
    """Return the factor on amplitudes at frequencies [Hz], for a band between two periods [s].

    That of a Butterworth filter of fourth order, high pass and low pass, run forwards and backwards: no phase, 1/2 at
    either end of the band, 0 at frequency 0.
    """
    high = 1.0 / (1.0 + (frequency * shortest) ** (2 * ORDER))
    slow = (frequency * longest) ** (2 * ORDER)
    return np.asarray(high * slow / (1.0 + slow))


def even_times(start: float, end: float, step: float, shortest: float, longest: float) -> Numbers:
    """Return times a step [s] apart, on which a history is filtered; ReportError where these are too many."""
    samples = (end - start + 4.0 * longest) / step
    if not samples <= MOST_SAMPLES:
        raise ReportError(
            f"a force between periods of {shortest:g} and {longest:g} s over {end - start:g} s takes "
            f"{samples:.3g} samples, above {MOST_SAMPLES:g}; specify longer periods"
        )
    return np.arange(start, end + 0.5 * step, step)


def band_passed(time: Numbers, values: Numbers, shortest: float, longest: float, at: Numbers | None = None) -> Numbers:
    """Return what is left of a history between two periods [s], at its own times [s], ascending, or at others.

    A row without a number, as the first one of a force, before any step, counts as 0. The history is taken to keep its
    first value before its start and its last one after its end. These are held for the longest period each, and the
    last goes over into the first along half a cosine of twice that length, which makes the record periodic without a
    jump; so a constant leaves nothing. The rest is `response` in the frequency domain.
    """
    if not 0.0 < shortest < longest:
        raise ValueError(f"a band from {shortest:g} to {longest:g} s; the first period must be the shorter one")
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
