"""Snapshots of figures, and velocities of particles from their displacement."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from thawslide.errors import NotInRunError
from thawslide.number_text import exact_text, number_text
from thawslide.run_folder import Numbers, Run, Snapshot
from thawslide.section_thickness import spaced

LETTERS = "abcdefghijklmnopqrstuvwxyz"
FRACTIONS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)  # of the final mean displacement


def moments(run: Run) -> list[float]:
    """Return times [s] of the run at which the mean displacement attains fractions of its final value.

    The times are evenly spaced if it is zero.
    """
    if "mean_displacement_m" in run.series:
        displacement, time = run.series["mean_displacement_m"], run.series["time_s"]
        if np.isfinite(displacement[-1]) and displacement[-1] > 0.0:
            return [float(time[int(np.argmax(displacement >= fraction * displacement[-1]))]) for fraction in FRACTIONS]
    return [float(time) for time in np.linspace(run.times[0], run.times[-1], len(FRACTIONS))]


def chosen_snapshots(run: Run, fields: Collection[str] | None = None, most: int = len(LETTERS)) -> list[Snapshot]:
    """Return the snapshots nearest to the report times of the case, or to `moments`, each once.

    The last state of an incomplete run is added. More than `most` are thinned evenly between the one nearest to the
    peak of the mean velocity and the last one. Velocities are those of displacement.
    """
    if not len(run.times):
        raise NotInRunError(f"{run.folder}: no snapshots. Set time.output_interval and repeat the run.")
    wanted = run.report_times or moments(run)
    found = {int(np.argmin(np.abs(run.times - time))) for time in wanted}
    indices = sorted(found if run.is_complete else found | {len(run.times) - 1})[: len(LETTERS)]
    if len(indices) > most:
        first = int(np.argmin(np.abs(run.times[indices] - _time_of_peak(run))))
        indices = indices[min(first, len(indices) - most) :]
        indices = [indices[place] for place in spaced(len(indices), most)]
    return [shown_snapshot(run, index, fields) for index in indices]


def _time_of_peak(run: Run) -> float:
    """Return the time [s] of the maximum mean velocity, 0 without one."""
    speed = run.series["mean_velocity_m_s"] if "mean_velocity_m_s" in run.series else np.zeros(0)
    return float(run.series["time_s"][int(np.nanargmax(speed))]) if np.isfinite(speed).any() else 0.0


def shown_snapshot(run: Run, index: int, fields: Collection[str] | None = None) -> Snapshot:
    """Return a snapshot, its velocities (if requested) replaced by those from displacement."""
    shot = run.snapshot(index, fields=fields if fields is None else {*fields, "id"})
    return shot.with_velocity(displacement_velocity(run, index, shot)) if "velocity" in shot else shot


def displacement_velocity(run: Run, index: int, shot: Snapshot) -> Numbers:
    """Return the mean velocity [m/s] of each particle between the snapshots before and after, shape (n, 3).

    The vibration of a body at rest contributes nothing. The velocity of the file is kept in the first snapshot, for a
    particle in no neighbouring snapshot, and in the last snapshot of a moving mass: the mean up to it would be that of
    an earlier time. Particles that are split change their places; a run that splits keeps all velocities of the file.
    """
    velocity = np.array(shot["velocity"], dtype=np.float64)
    if _splits(run) or index == 0 or "id" not in shot or (index == len(run.times) - 1 and not run.is_at_rest):
        return velocity
    ends = []
    for neighbour in (index - 1, min(index + 1, len(run.times) - 1)):
        other = run.snapshot(neighbour, fields=("id",))
        place, time = shot.points.copy(), np.full(len(velocity), shot.time)
        _, rows, other_rows = np.intersect1d(shot["id"], other["id"], return_indices=True)
        place[rows], time[rows] = other.points[other_rows], other.time
        ends.append((place, time))
    (before, start), (after, end) = ends
    moved = end > start
    velocity[moved] = (after - before)[moved] / (end - start)[moved, None]
    return velocity


def _splits(run: Run) -> bool:
    return bool(run.section("mechanics").get("split_stretched", False))


def window_words(run: Run, shots: Sequence[Snapshot]) -> str:
    """Return the averaging time of the velocities of snapshots in words, "" for a run of one snapshot."""
    if len(run.times) < 2 or _splits(run):
        return ""
    first, last = run.times[0], run.times[-1]
    ends = (first,) if run.is_at_rest else (first, last)
    instants = [shot.time for shot in shots if shot.time in ends]
    words = f"{number_text(2.0 * float(np.median(np.diff(run.times))))} s mean"
    if instants:
        words += f"; at {' and '.join(shown_time(run, time) for time in instants)} s: instantaneous"
    if run.is_at_rest and run.times[-2] < run.rest_since and any(shot.time == last for shot in shots):
        words += f"; at {shown_time(run, last)} s: mean of the last {number_text(float(last - run.times[-2]))} s"
    return words


def shown_time(run: Run, time: float) -> str:
    """Return a time [s] of the run as figures show it, without its unit."""
    return exact_text(round(time, 1))
