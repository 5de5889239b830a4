"""Notes at the top of a page: how a run ended, warnings on its results, damage found when it resumed."""

from __future__ import annotations

import shlex

from thawslide.run_facts import Ending, last_write_age
from thawslide.run_folder import Run


def ending_note(run: Run) -> str:
    """Return a sentence if the run is incomplete or ended early, "" otherwise."""
    message = str(run.facts.get("message") or "")
    command = f"`thawslide resume {shlex.quote(str(run.folder))}`"
    advice = f"To continue from its last checkpoint: {command}."
    if run.ending is Ending.DONE:
        return message[:1].upper() + message[1:]
    if run.ending is Ending.UNKNOWN:
        return "There is no run.json: it is unknown whether this run is complete."
    if run.ending is Ending.KILLED:
        return (
            "This run terminated unexpectedly: its status in run.json is running, but no process holds run.lock. "
            f"{advice} The figures show the results so far."
        )
    if run.ending is Ending.UNDETERMINED:
        return (
            "The status of this run in run.json is running. It cannot be checked, because the file system has no "
            f"locks. The last file was written {_age(last_write_age(run.folder))} before this page. If the run has "
            f"terminated, {command} continues from its last checkpoint. The figures show the results so far."
        )
    words = "was still running when this page was written" if run.ending is Ending.RUNNING else run.ending.value
    note = f"This run is incomplete ({words}){f': {message}' if message else ''}. The figures show the results so far."
    return f"{note} {advice}" if run.ending is Ending.STOPPED else note


def result_warnings(run: Run) -> list[str]:
    """Return the warnings of run.json on the results, for example if the mass is not at rest."""
    return [f"Warning: {warning[:1000]}" for warning in run.facts.get("warnings", [])[:20]]


def resume_notes(run: Run) -> list[str]:
    """Return the damage that parts of a run found when they resumed, for example lost rows."""
    parts = run.facts.get("parts")
    found = [part.get("warnings") for part in parts if isinstance(part, dict)] if isinstance(parts, list) else []
    return [str(text)[:1000] for texts in found if isinstance(texts, list) for text in texts[:100]]


def _age(seconds: float) -> str:
    for unit, length in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2.0 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{seconds:.0f} s"
