"""Snapshots that figures show, and velocities of particles from their displacement."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from thawslide.errors import NotInRunError
from thawslide.run import Numbers, Run, Snapshot

LETTERS = "abcdefghijklmnopqrstuvwxyz"
SHARES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)  # of the final mean displacement


def moments(run: Run) -> list[float]:
    """Return times [s] at which the slide reaches shares of its final mean displacement, even ones if it never moves.

    They are those of the run's own clock.
    """
    if "mean_displacement_m" in run.history:
        gone, time = run.history["mean_displacement_m"], run.history["time_s"]
        if np.isfinite(gone[-1]) and gone[-1] > 0.0:
            return [float(time[int(np.argmax(gone >= share * gone[-1]))]) for share in SHARES]
    return [float(time) for time in np.linspace(run.times[0], run.times[-1], len(SHARES))]


def chosen_snapshots(run: Run, fields: Collection[str] | None = None) -> list[Snapshot]:
    """Return the snapshots nearest to the report times of the case, or to moments of the motion, each once.

    Report times are on the clock of the figures. The last state of a run that did not come to its end is one of them.
    Velocities are those of displacement.
    """
    if not len(run.times):
        raise NotInRunError(f"{run.folder}: no snapshots; set [time] output_interval and run again")
    wanted = [time - run.clock.shift for time in run.report_times] or moments(run)
    found = {int(np.argmin(np.abs(run.times - time))) for time in wanted}
    indices = sorted(found if run.ended else found | {len(run.times) - 1})[: len(LETTERS)]
    return [shown_snapshot(run, index, fields) for index in indices]


def shown_snapshot(run: Run, index: int, fields: Collection[str] | None = None) -> Snapshot:
    """Return a snapshot, its velocities (if requested) replaced by those from displacement."""
    shot = run.snapshot(index, fields=fields if fields is None else {*fields, "id"})
    return shot.with_velocity(displacement_velocity(run, index, shot)) if "velocity" in shot else shot


def displacement_velocity(run: Run, index: int, shot: Snapshot) -> Numbers:
    """Return the mean velocity [m/s] of each particle between the snapshots before and after, shape (n, 3).

    The vibration of a body at rest has none. The first snapshot, a particle that neither neighbour has, and a run of
    one snapshot have the velocity of the file.
    """
    velocity = np.array(shot["velocity"], dtype=np.float64)
    if index == 0 or "id" not in shot:
        return velocity
    ends = []
    for neighbour in (index - 1, min(index + 1, len(run.times) - 1)):
        other = run.snapshot(neighbour, fields=("id",))
        place, time = shot.points.copy(), np.full(len(velocity), shot.time)
        _, mine, theirs = np.intersect1d(shot["id"], other["id"], return_indices=True)
        place[mine], time[mine] = other.points[theirs], other.time
        ends.append((place, time))
    (before, start), (after, end) = ends
    moved = end > start
    velocity[moved] = (after - before)[moved] / (end - start)[moved, None]
    return velocity


def window_words(run: Run) -> str:
    """Say over which time velocities are means, "" for a run of one snapshot."""
    if len(run.times) < 2:
        return ""
    return f"mean over {2.0 * float(np.median(np.diff(run.times))):.3g} s about each time"
