"""Tables of run.json: inputs with their SHA-256, and all other facts."""

from __future__ import annotations

from typing import Any

from thawslide.number_text import integer_text
from thawslide.pages.markup import details, table


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


def facts_of(facts: dict[str, Any]) -> list[str]:
    """Return run.json as a table of its single values and one collapsed table for each value with parts."""
    if not facts:
        return ["<p>No run.json: the run was interrupted before it was written.</p>"]
    single = [(_words(key), _value(value)) for key, value in facts.items() if not _has_parts(value)]
    parts = [table(single, "facts")]
    for key, value in facts.items():
        if isinstance(value, dict) and value:
            rows: Any = [(_words(name), _value(part)) for name, part in value.items()]
        elif _has_parts(value):
            rows = [(number, _value(part)) for number, part in enumerate(value, 1)]
        else:
            continue
        parts.append(details(_words(key), table(rows, "facts")))
    return parts


def _has_parts(value: Any) -> bool:
    """Return whether a value has a separate table: a non-empty object, or a list of objects or long texts."""
    if isinstance(value, dict):
        return bool(value)
    return isinstance(value, list) and any(isinstance(part, dict) or len(str(part)) > 40 for part in value)


def _words(key: str) -> str:
    return key.replace("_", " ")


def _value(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    if isinstance(value, float):
        return integer_text(value)
    if isinstance(value, int):
        return f"{value:,}"
    if isinstance(value, dict):
        return ", ".join(f"{_words(key)}: {_value(part)}" for key, part in value.items()) or "none"
    if isinstance(value, list):
        return ", ".join(_value(part) for part in value) or "none"
    return str(value) or "none"
