"""The errors a user can cause: their text says what is wrong, where, and what to do."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable


class ReportError(Exception):
    """A run that cannot be read or drawn as asked; the command line prints it and exits with 2."""


class NotInRunError(ReportError):
    """A figure that this run has nothing for (no snapshots, a column that is not there): the report leaves it out."""


_STEERING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_SHOWN = 60  # characters of what was found


def quoted(text: str) -> str:
    """Return what was found as messages show it: in quotes, on one line, cut where it is long."""
    shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
    return "'" + "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in shown) + "'"


def printable(text: str) -> str:
    """Return a text with "?" for what would steer a terminal, turns the direction of reading, or is no letter."""
    return _STEERING.sub("?", text)


def nearest(found: str, known: Iterable[str]) -> str:
    """Return "; did you mean NAME?" with the known name nearest to what was found, "." where none is near."""
    near = difflib.get_close_matches(found[:_SHOWN], list(known), 1)
    return f"; did you mean {near[0]}?" if near else "."
