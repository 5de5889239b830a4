"""Lines of keys in a TOML file, for messages."""

from __future__ import annotations

import re
from collections import Counter

Keys = tuple[str | int, ...]  # names of tables and of a key; an integer counts the tables of an array
_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"\s*([\w.\"' -]+?)\s*=")


def lines_of(text: str) -> dict[Keys, int]:
    """Return the first line of each table and of each key that begins a line."""
    found: dict[Keys, int] = {}
    table: Keys = ()
    counts: Counter[Keys] = Counter()
    for number, line in enumerate(text.split("\n"), 1):
        if header := _HEADER.match(line):
            table = _names(header[2])
            if header[1] == "[[":
                counts[table] += 1
                table = (*table, counts[table] - 1)
            found.setdefault(table, number)
        elif key := _KEY.match(line):
            keys = (*table, *_names(key[1]))
            for end in range(len(table) + 1, len(keys) + 1):
                found.setdefault(keys[:end], number)
    return found


def line_of(lines: dict[Keys, int], keys: Keys) -> int:
    """Return the line of a key, otherwise that of the innermost table around it; 1 if there is none."""
    return next((lines[keys[:end]] for end in range(len(keys), 0, -1) if keys[:end] in lines), 1)


def _names(text: str) -> Keys:
    return tuple(part.strip(" \"'") for part in text.split("."))
