"""Errors of the user; their messages state subject, problem and remedy."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable


class ReportError(Exception):
    """Run that cannot be read or plotted; the command line prints the message and exits with 2."""


class NotInRunError(ReportError):
    """Data missing in a run, for example snapshots or a column; the report then lacks the figure."""


_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_SHOWN = 60  # characters of a found text


def quoted(text: str) -> str:
    """Return a found text as messages show it: in quotes, on one line, truncated."""
    shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
    return "'" + "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in shown) + "'"


def printable(text: str) -> str:
    """Return a text with "?" in place of control characters, changes of reading direction and surrogates."""
    return _CONTROL.sub("?", text)


def nearest(found: str, known: Iterable[str]) -> str:
    """Return "; did you mean NAME?" with the known name nearest to the found one, "." if none is near."""
    near = difflib.get_close_matches(found[:_SHOWN], list(known), 1)
    return f"; did you mean {near[0]}?" if near else "."
