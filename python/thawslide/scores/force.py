"""The force of members against one inverted from seismic waves."""

from __future__ import annotations

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError
from thawslide.figures.force_record import Comparison, compared
from thawslide.force_record import ForceRecord
from thawslide.run_folder import Run
from thawslide.scores.forecast import Forecast
from thawslide.scores.observed import Observation
from thawslide.scores.quantities import FORCE, REVERSAL


def compare_forces(forecast: Forecast, record: ForceRecord) -> tuple[list[tuple[Observation, Numbers]], Numbers]:
    """Return numbers of the record with those of the members, and the correlation of each member with it.

    NotInRunError if a member has no force of the total mass.
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
    return pairs, np.array([correlation(each) for each in found])


def correlation(found: Comparison) -> float:
    """Return the correlation of both components, vertical and in the direction of travel, at the record's times.

    r = sum(a b) / sqrt(sum(a a) sum(b b)) over both components of run a and record b, both band-passed and aligned.
    The run is 0 beyond its ends. nan if one of them is 0 throughout.
    """
    run, record = (
        np.concatenate(
            [np.interp(found.record.time, curves.time, part, 0.0, 0.0) for part in (curves.up, curves.along)]
        )
        for curves in (found.run, found.record)
    )
    norm = float(np.sqrt(np.sum(run**2) * np.sum(record**2)))
    return float(np.sum(run * record)) / norm if norm > 0.0 else float("nan")
