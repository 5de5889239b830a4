"""Errors of the user; their messages state subject, problem and remedy."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager


class ReportError(Exception):
    """Run that cannot be read or plotted; the command line prints the message and exits with 2."""


class NotInRunError(ReportError):
    """Data missing in a run, for example snapshots or a column; the report then lacks the figure."""


_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff]")
_SHOWN = 60  # characters of a found text
_OPTION = re.compile(r"(?<![\w/.-])--((?:set |end (?=T\b))|[a-z]+(?:-[a-z]+)*(?![\w-]))")
_COMMAND = re.compile(r"(\./run(?: --[a-z]+)+|thawslide .*)")
_PARAMETERS = {
    "set ": "",
    "end ": "time.end=",
    "end": "time.end",
    "overwrite": "overwrite=True",
    "cut": "cut=True",
    "brief": "brief=True",
}


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


def with_parameters(text: str) -> str:
    """Return a message with keys and parameters of Python in place of options, except those in commands."""
    lines = []
    for line in text.split("\n"):
        parts = _COMMAND.split(line)  # texts, and commands between them
        parts[::2] = [
            _OPTION.sub(lambda option: _PARAMETERS.get(option[1], option[1].replace("-", "_")), text)
            for text in parts[::2]
        ]
        lines.append("".join(parts))
    return "\n".join(lines)


@contextmanager
def errors_with_parameters() -> Iterator[None]:
    """Let errors name parameters of Python in place of options of the command line."""
    try:
        yield
    except Exception as error:
        error.args = tuple(with_parameters(each) if isinstance(each, str) else each for each in error.args)
        raise
