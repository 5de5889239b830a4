"""Runs of one case that differ in one parameter each: execution, results and table."""

from __future__ import annotations

import csv
import hashlib
import json
import os
import re
import signal
import subprocess
import textwrap
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from thawslide.key_numbers import stop_time
from thawslide.run_folder import Run
from thawslide.time_reference import time_of_speed

Report = Callable[[str], None]
REST = 10.0  # s: duration of no motion for rest
REST_FRACTION, REST_SPEED = 0.002, 0.02  # of the peak; m/s
NEVER_MOVED = 100.0  # s: time without 1 m/s after which the mass will not start
STARTED = 8.0  # m/s
MOVED = 1.0  # m/s: below this maximum the mass has only settled


@dataclass(frozen=True)
class Row:
    """One run: key (its folder), words for the table, changes by --set, case file."""

    key: str
    words: str
    sets: tuple[str, ...] = ()
    case: str = "case.toml"


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


def command_line(program: Path, case: Path, folder: Path, sets: Iterable[str]) -> list[str]:
    """Return the command line of a run on one thread."""
    words = [str(program), "run", str(case), "--output", str(folder), "--overwrite", "--threads", "1"]
    return words + [word for key in sets for word in ("--set", key)]


def at_rest(times: Sequence[float], speeds: Sequence[float]) -> bool:
    """Return whether a mass that moved has been at rest for REST seconds, or has not moved by NEVER_MOVED."""
    if not times or times[-1] <= REST:
        return False
    peak = max(speeds)
    if peak < MOVED:
        return times[-1] >= NEVER_MOVED
    low = max(REST_FRACTION * peak, REST_SPEED)
    return all(speed < low for when, speed in zip(times, speeds, strict=True) if when > times[-1] - REST)


def _speeds(history: Path) -> tuple[list[float], list[float]]:
    try:
        with history.open(newline="") as file:
            rows = [(float(row["time_s"]), float(row["mean_velocity_m_s"])) for row in csv.DictReader(file)]
    except (OSError, ValueError, KeyError, TypeError):  # missing, or its last row is being written
        return [], []
    return [when for when, _ in rows], [speed for _, speed in rows]


def _facts(folder: Path) -> dict[str, Any]:
    try:
        return dict(json.loads((folder / "run.json").read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return {}


def _stopped_at_rest(folder: Path, facts: Mapping[str, Any]) -> bool:
    return facts.get("status") == "stopped" and at_rest(*_speeds(folder / "history.csv"))


def is_current(folder: Path, words: Sequence[str], inputs: Iterable[Path]) -> bool:
    """Return whether a folder contains an ended run of this command that is newer than the program and its inputs."""
    facts = _facts(folder)
    ended = facts.get("status") in ("done", "failed") or _stopped_at_rest(folder, facts)
    if facts.get("command") != " ".join(words) or not ended:
        return False
    written = (folder / "run.json").stat().st_mtime
    return all(path.stat().st_mtime < written for path in inputs)


def commit_of(program: Path) -> str:
    """Return the commit of a program."""
    output = subprocess.run([program, "version"], stdout=subprocess.PIPE, text=True, check=True).stdout
    found = re.search(r"commit ([^,\s)]+)", output)
    return found[1] if found else ""


def is_of_commit(folder: Path, words: Sequence[str], commit: str) -> bool:
    """Return whether a folder contains an ended run of this command, the present inputs and this commit."""
    facts = _facts(folder)
    ended = facts.get("status") in ("done", "failed") or _stopped_at_rest(folder, facts)
    if not ended or facts.get("command") != " ".join(words) or facts.get("commit") != commit:
        return False
    return not commit.endswith("-dirty") and all(_is_unchanged(each) for each in facts.get("inputs", ()))


def _is_unchanged(file: Mapping[str, Any]) -> bool:
    path = Path(file["path"])
    return path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == file["sha256"]


def refusal(folder: Path) -> Path:
    """Return the file next to a run folder with the error of a run that did not start."""
    return folder.parent / f"{folder.name}.refused.txt"


def run_one(words: Sequence[str], folder: Path, until_rest: bool = True) -> str:
    """Run to the end, or only until rest; return "" or the error of the program."""
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    pipe = subprocess.PIPE
    with subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=pipe, text=True) as process:
        while True:
            try:
                _, errors = process.communicate(timeout=2.0)
                break
            except subprocess.TimeoutExpired:
                if until_rest and at_rest(*_speeds(folder / "history.csv")):
                    process.send_signal(signal.SIGTERM)
    return "" if process.returncode == 0 or at_rest(*_speeds(folder / "history.csv")) else errors.strip()


def run_rows(
    rows: Sequence[Row], program: Path, cases: Path, output: Path, common: Sequence[str], jobs: int, report: Report,
    *, commit: str = "", until_rest: bool = True,
) -> None:  # fmt: skip
    """Execute the missing runs, `jobs` at a time; report each with the remaining time. Failures stay in their folders.

    Existing runs are those of the `commit`, or without one those that are newer than program and inputs.
    """
    inputs = [program, *cases.glob("*.csv")]
    waiting = []
    for row in rows:
        words = command_line(program, cases / row.case, output / row.key, (*common, *row.sets))
        folder = output / row.key
        exists = is_of_commit(folder, words, commit) or (
            not commit and is_current(folder, words, [*inputs, cases / row.case])
        )
        if not exists:
            waiting.append((row, words))
    report(f"{len(rows)} runs, {len(rows) - len(waiting)} of them complete")
    output.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        futures = {pool.submit(run_one, words, output / row.key, until_rest): row for row, words in waiting}
        for done, future in enumerate(as_completed(futures), 1):
            row, failure = futures[future], future.result()
            if not (output / row.key / "history.csv").is_file():
                refusal(output / row.key).write_text(failure, encoding="utf-8")
            left = (time.monotonic() - started) / done * (len(waiting) - done)
            why = f": {failure}" if failure else ""
            report(f"{done} of {len(waiting)}, about {left / 60:.0f} min left: {row.key}{why}")


def incompleteness(folder: Path) -> str:
    """Return the reason for an incomplete run, "" for one that ended or came to rest."""
    facts = _facts(folder)
    if facts.get("status") == "done" or _stopped_at_rest(folder, facts):
        return ""
    if facts.get("status") == "stopped":
        return "stopped before its end"
    return str(facts.get("message") or "not at its end yet")


def outcome(folder: Path) -> Outcome:
    """Return the results of a run folder, with the reason if it is missing or incomplete."""
    if not (folder / "history.csv").is_file():
        note = refusal(folder)
        return Outcome(failure=note.read_text(encoding="utf-8") if note.is_file() else "not run")
    failure = incompleteness(folder)
    run = Run(folder)
    time_s, speed = run.history["time_s"], run.history["mean_velocity_m_s"]
    peak = int(np.nanargmax(speed))
    stopped = stop_time(run) if speed[peak] >= MOVED else None
    band = run.history["band_temperature_C"]
    shot = run.snapshot(-1)
    order = np.argsort(shot.points[:, 0])
    volume = np.cumsum(np.asarray(shot["volume"], dtype=np.float64)[order])
    low, high = np.searchsorted(volume, (0.005 * volume[-1], 0.995 * volume[-1]))
    x = shot.points[order, 0]
    return Outcome(
        failure=failure,
        peak=float(speed[peak]),
        peak_time=float(time_s[peak]),
        start_time=time_of_speed(run, STARTED),
        stop_time=stopped if stopped is not None else float("nan"),
        displacement=float(run.history["mean_displacement_m"][-1]),
        runout=float(run.history["runout_m"][-1]),
        front=float(np.ptp(run.history["front_position_m"][[0, -1]])),
        length=float(x[high] - x[low]),
        temperature=float(np.nanmax(band)) if np.isfinite(band).any() and not failure else float("nan"),
        end_time=float(time_s[-1]),
        end_speed=float(speed[-1]),
    )


HEADER = (
    "| run | peak [m/s] | at [s] | 8 m/s at [s] | stops at [s] | mean displacement [m] | runout [m] "
    "| front travel [m] | deposit [m] | band at most [°C] | set |\n|---|---|---|---|---|---|---|---|---|---|---|\n"
)


def table_row(row: Row, found: Outcome, hidden: Sequence[str] = ()) -> str:
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


def table(rows: Sequence[Row], found: Mapping[str, Outcome], hidden: Sequence[str] = ()) -> str:
    """Return the whole table of some rows, with the messages of failed runs below."""
    lines = [table_row(row, found[row.key], hidden) for row in rows]
    broken = [
        textwrap.fill(f"- {row.words}: `{' '.join(found[row.key].failure.split())}`", 120, subsequent_indent="  ")
        for row in rows
        if found[row.key].failure and not np.isnan(found[row.key].peak)
    ]
    return HEADER + "\n".join(lines) + "\n" + ("\n" + "\n".join(broken) + "\n" if broken else "")


def rewrapped(text: str) -> str:
    """Return a document with paragraphs and list items wrapped at 120 columns; tables and headings are unchanged."""
    blocks = []
    for block in text.strip().split("\n\n"):
        if block.lstrip().startswith(("|", "#", "!", "```")):
            blocks.append(block.rstrip())
            continue
        items = re.split(r"\n(?=- )", block)
        blocks.append(
            "\n".join(
                textwrap.fill(
                    " ".join(item.split()),
                    120,
                    subsequent_indent="  " if item.startswith("- ") else "",
                    break_long_words=False,
                    break_on_hyphens=False,
                )
                for item in items
            )
        )
    return "\n\n".join(blocks) + "\n"
