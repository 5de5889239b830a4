"""The force of members against one inverted from seismic waves."""

from __future__ import annotations

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError
from thawslide.figures.force_record import Comparison, Curves, compared
from thawslide.force_record import ForceRecord, extreme_times
from thawslide.run_folder import Run
from thawslide.scores.forecast import Forecast
from thawslide.scores.observed import Observation
from thawslide.scores.quantities import FORCE, FORCE_TIMES, REVERSAL

MOST_SHIFT, STEP = 40.0, 0.25  # s


def compare_forces(
    forecast: Forecast, record: ForceRecord
) -> tuple[list[tuple[Observation, Numbers]], dict[str, Numbers]]:
    """Return numbers of the record with those of the members, and columns of the table of members.

    The columns are the best correlation of each member with the record, and its shift [s]. Times of extremes are those
    of the record, with the shift of each member. NotInRunError if a member has no force of the total mass.
    """
    absent = next((folder for folder in forecast.run_folders if not (folder / "history.csv").is_file()), None)
    if absent is not None:
        raise NotInRunError(f"no history.csv in {absent}. Rigid blocks have no force.")
    found = [compared(Run(folder, skip_damaged=True), record) for folder in forecast.run_folders]
    curves, nan = found[0].record, float("nan")
    words = f"{FORCE.words}, periods {record.band.words}"
    observed = float(np.max(np.abs(curves.up)))
    force = Observation("force_record", words, FORCE, observed, 0.0, "N", record.source)
    pairs = [(force, np.array([np.max(np.abs(each.run.up)) for each in found]))]
    if curves.reversal is not None:
        duration = curves.reversal.duration
        reversal = Observation("force_record", REVERSAL.words, REVERSAL, duration, 0.0, "s", record.source)
        members = [each.run.reversal.duration if each.run.reversal else nan for each in found]
        pairs.append((reversal, np.array(members)))
    aligned = [best_alignment(each) for each in found]
    shifts, correlations = np.array(aligned).T
    times = extreme_times(curves.time - found[0].shift, curves.up, curves.along)
    of_members = [times_in_record(each, shift) for each, shift in zip(found, shifts, strict=True)]
    for name, quantity in FORCE_TIMES.items():
        if np.isfinite(times[name]):
            value = Observation("force_record", quantity.words, quantity, times[name], 0.0, "s", record.source)
            pairs.append((value, np.array([each[name] for each in of_members])))
    return pairs, {"force_correlation": correlations, "force_shift_s": shifts}


def times_in_record(found: Comparison, shift: float) -> dict[str, float]:
    """Return the times [s] of the run's extremes within the record, as times of the record: `shift` less."""
    at = found.record.time - found.shift
    up, along = (np.interp(at + shift, found.run.time, part, 0.0, 0.0) for part in (found.run.up, found.run.along))
    return extreme_times(at, up, along)


def best_alignment(found: Comparison) -> tuple[float, float]:
    """Return the shift [s] added to times of the record for the best correlation, and that correlation.

    The shift is within MOST_SHIFT of that of the figure. Without a correlation it is that of the figure, and nan.
    """
    shifts = np.arange(-MOST_SHIFT, MOST_SHIFT + 0.5 * STEP, STEP)
    all_found = np.array([correlation(found.run, found.record, shift) for shift in shifts])
    if not np.isfinite(all_found).any():
        return found.shift, float("nan")
    best = int(np.nanargmax(all_found))
    return found.shift + float(shifts[best]), float(all_found[best])


def correlation(run: Curves, record: Curves, shift: float = 0.0) -> float:
    """Return the correlation of both components, vertical and in the direction of travel, at the record's times.

    r = sum(a b) / sqrt(sum(a a) sum(b b)) over both components of run a and record b, both band-passed. The record's
    times are shifted by `shift` [s]. The run is 0 beyond its ends. nan if one of them is 0 throughout.
    """
    at = record.time + shift
    of_run = np.concatenate([np.interp(at, run.time, part, 0.0, 0.0) for part in (run.up, run.along)])
    of_record = np.concatenate([record.up, record.along])
    norm = float(np.sqrt(np.sum(of_run**2) * np.sum(of_record**2)))
    return float(np.sum(of_run * of_record)) / norm if norm > 0.0 else float("nan")
