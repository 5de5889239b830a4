"""Tables of a run: inputs with their SHA-256, keys of the case, program, machine and effort."""

from __future__ import annotations

import re
from typing import Any

from thawslide.number_text import integer_text, unit_text
from thawslide.pages.markup import details, table
from thawslide.run_folder import Run
from thawslide.text_files import MEGABYTE, read_text


def inputs_of(facts: dict[str, Any]) -> str:
    """Return a table of the input files of a run with size and SHA-256, "" without any in run.json."""
    inputs = facts.get("inputs")
    rows = [
        (
            str(each.get("path", "")).rpartition("/")[2] or "no name",
            _bytes_text(each.get("bytes")),
            str(each.get("sha256", "not known")),
        )
        for each in (inputs if isinstance(inputs, list) else [])
        if isinstance(each, dict)
    ]
    return table(rows, "facts", ("file", "size", "SHA-256")) if rows else ""


def _bytes_text(value: Any) -> str:
    return f"{value:,} bytes" if isinstance(value, int) else "not known"


def settings_of(run: Run) -> str:
    """Return a table of the keys that the case specifies, "" without any; defaults are marked in the resolved case."""
    rows, section = [], ""
    for line in read_text(run.folder / "case.toml", MEGABYTE).splitlines():
        if heading := re.fullmatch(r"\[+([^\[\]]+)\]+", line.strip()):
            section = heading[1]
        elif entry := re.fullmatch(r"([\w-]+) = (.*?)(?:  # ([^\"]*))?", line):
            key, value, remark = entry.groups()
            if "not given" not in (remark or ""):
                rows.append((f"{section}.{key}", _without_folders(value), unit_text(remark or "")))
    return table(rows, "facts", ("key", "value", "unit")) if rows else ""


def _without_folders(value: str) -> str:
    """Return a value of a case file, an absolute path without its folders."""
    return re.sub(r'"/[^"]*/', '"', value)


def facts_of(facts: dict[str, Any]) -> list[str]:
    """Return program, machine and effort of a run as a table, and a collapsed table of the time of each stage."""
    if not facts:
        return ["<p>No run.json: the run was interrupted before it was written.</p>"]
    rows = [(words, _value(facts[key])) for key, words in _FACTS.items() if facts.get(key) not in (None, "")]
    parts = [table(rows, "facts")]
    stages = facts.get("seconds_per_stage")
    if isinstance(stages, dict) and stages:
        rows = [(_words(name), _value(value)) for name, value in stages.items()]
        parts.append(details("Seconds per stage", table(rows, "facts")))
    return parts


_FACTS = {
    "version": "Thawslide", "commit": "commit", "started": "started", "status": "status", "device": "device",
    "processor": "processor", "threads": "threads", "wall_s": "wall-clock time (s)", "steps": "time steps",
    "particles": "particles at the end", "particle_steps_per_second": "particle steps per second",
    "crs": "reference system", "at_rest": "at rest at the end",
}  # fmt: skip


def _words(key: str) -> str:
    return key.replace("_", " ")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return integer_text(value)
    return f"{value:,}" if isinstance(value, int) else str(value)
