"""Runs of one case that differ in one parameter each: results and table."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from reproduction.engine import MOVED, failure, is_at_rest
from reproduction.study import Job
from thawslide.key_numbers import stop_time
from thawslide.run_folder import Run
from thawslide.time_reference import time_of_speed

STARTED = 8.0  # m/s


@dataclass(frozen=True)
class Outcome:
    """Results of a run; nan if not attained. Speeds in m/s, times in s, lengths in m."""

    failure: str = ""
    peak: float = float("nan")
    peak_time: float = float("nan")
    start_time: float = float("nan")  # first at STARTED
    stop_time: float = float("nan")
    displacement: float = float("nan")
    runout: float = float("nan")  # front minus initial rear
    front: float = float("nan")  # travel distance of the front
    length: float = float("nan")  # of the deposit: x between 0.5 % and 99.5 % of the volume
    temperature: float = float("nan")  # C, highest mean of the band
    end_time: float = float("nan")
    end_speed: float = float("nan")


def end_of(found: Outcome) -> str:
    """Return the ending of a run: "stopped", "going", "never" (started), "broken" or "missing"."""
    if np.isnan(found.peak):
        return "missing"
    if found.failure:
        return "broken"
    if found.peak < MOVED:
        return "never"
    return "going" if np.isnan(found.stop_time) else "stopped"


def incompleteness(folder: Path) -> str:
    """Return the reason for an incomplete run, "" for one that ended or came to rest."""
    try:
        facts = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        facts = {}
    if facts.get("status") == "done" or (facts.get("status") == "stopped" and is_at_rest(folder)):
        return ""
    if facts.get("status") == "stopped":
        return "stopped before its end"
    return str(facts.get("message") or "not at its end yet")


def outcome(folder: Path) -> Outcome:
    """Return the results of a run folder, with the reason if it is missing or incomplete."""
    if not (folder / "history.csv").is_file():
        return Outcome(failure=failure(folder))
    why = incompleteness(folder)
    run = Run(folder)
    time_s, speed = run.series["time_s"], run.series["mean_velocity_m_s"]
    peak = int(np.nanargmax(speed))
    stopped = stop_time(run) if speed[peak] >= MOVED else None
    band = run.series["band_temperature_C"]
    shot = run.snapshot(-1)
    order = np.argsort(shot.points[:, 0])
    volume = np.cumsum(np.asarray(shot["volume"], dtype=np.float64)[order])
    low, high = np.searchsorted(volume, (0.005 * volume[-1], 0.995 * volume[-1]))
    x = shot.points[order, 0]
    return Outcome(
        failure=why,
        peak=float(speed[peak]),
        peak_time=float(time_s[peak]),
        start_time=time_of_speed(run, STARTED),
        stop_time=stopped if stopped is not None else float("nan"),
        displacement=float(run.series["mean_displacement_m"][-1]),
        runout=float(run.series["runout_m"][-1]),
        front=float(np.ptp(run.series["front_position_m"][[0, -1]])),
        length=float(x[high] - x[low]),
        temperature=float(np.nanmax(band)) if np.isfinite(band).any() and not why else float("nan"),
        end_time=float(time_s[-1]),
        end_speed=float(speed[-1]),
    )


HEADER = (
    "| run | peak [m/s] | at [s] | 8 m/s at [s] | stops at [s] | mean displacement [m] | runout [m] "
    "| front travel [m] | deposit [m] | band at most [°C] | set |\n|---|---|---|---|---|---|---|---|---|---|---|\n"
)


def table_row(row: Job, found: Outcome, hidden: Sequence[str] = ()) -> str:
    """Return a line of the table under HEADER; `hidden` settings are those of every line."""
    shown = [f"`{key}`" for key in row.sets if key not in hidden]
    if row.case != "case.toml":
        shown.insert(0, f"[{row.case}]({row.case})")
    if np.isnan(found.peak):
        return f"| {row.words} | {found.failure or 'no numbers'} | | | | | | | | | {' '.join(shown)} |"
    stop = f"{found.stop_time:.0f}"
    if found.failure:
        stop = f"failed at {found.end_time:.0f}"
    elif found.peak < MOVED:
        stop = "does not start"
    elif np.isnan(found.stop_time):
        stop = f"not: {found.end_speed:.0f} m/s at {found.end_time:.0f}"
    cells = (
        row.words,
        f"{found.peak:.1f}",
        f"{found.peak_time:.0f}",
        f"{found.start_time:.0f}" if np.isfinite(found.start_time) else "never",
        stop,
        f"{found.displacement:,.0f}",
        f"{found.runout:,.0f}",
        f"{found.front:,.0f}",
        f"{found.length:,.0f}",
        f"{found.temperature:,.0f}" if np.isfinite(found.temperature) else "",
        " ".join(shown),
    )
    return "| " + " | ".join(cells) + " |"


def table(rows: Sequence[Job], found: Mapping[str, Outcome], hidden: Sequence[str] = ()) -> str:
    """Return the whole table of some rows, with the messages of failed runs below."""
    lines = [table_row(row, found[row.key], hidden) for row in rows]
    broken = [
        textwrap.fill(f"- {row.words}: `{' '.join(found[row.key].failure.split())}`", 120, subsequent_indent="  ")
        for row in rows
        if found[row.key].failure and not np.isnan(found[row.key].peak)
    ]
    return HEADER + "\n".join(lines) + "\n" + ("\n" + "\n".join(broken) + "\n" if broken else "")
