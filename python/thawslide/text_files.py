"""Text files: encodings, line ends, sizes, and tables of comma-separated cells with line numbers."""

from __future__ import annotations

import codecs
import csv
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError, nearest, quoted

MEGABYTE = 1024 * 1024
_DEEPEST = 32  # levels of a JSON or TOML file
_OTHER_ENCODINGS = {
    codecs.BOM_UTF32_LE: "UTF-32",
    codecs.BOM_UTF32_BE: "UTF-32",
    codecs.BOM_UTF16_LE: "UTF-16",
    codecs.BOM_UTF16_BE: "UTF-16",
}


def is_file(path: Path) -> bool:
    """Return whether a file exists; ReportError if that cannot be determined, e.g. for a name that is too long."""
    try:
        return path.is_file()
    except OSError as error:
        raise ReportError(f"{path}: cannot be read: {error.strerror}") from error


def read_text(path: Path, max_bytes: int) -> str:
    """Read UTF-8 with or without a byte order mark; line ends become newlines.

    ReportError for another encoding, zero bytes, or a file that does not exist, cannot be read or is too large.
    """
    if not is_file(path):
        raise ReportError(f"{path}: {'not a file' if path.exists() else 'no such file'}")
    try:
        with path.open("rb") as file:
            data = file.read(max_bytes + 1)
    except OSError as error:
        raise ReportError(f"{path}: cannot be read: {error.strerror or error}") from error
    if len(data) > max_bytes:
        raise ReportError(f"{path}: too large (allowed {max_bytes / MEGABYTE:g} MB). Select the correct file.")
    for mark, name in _OTHER_ENCODINGS.items():
        if data.startswith(mark):
            raise ReportError(f"{path}: encoded as {name}; save it as UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ReportError(
            f"{path}:{line}: byte 0x{data[error.start]:02x} is not UTF-8; save the file as UTF-8"
        ) from error
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise ReportError(f"{path}:{line}: a zero byte; this is not a text file, or it is damaged")
    return text


def read_json(path: Path, max_bytes: int) -> dict[str, Any]:
    """Read a JSON object; ReportError for other values and for excessive nesting."""
    try:
        found = json.loads(read_text(path, max_bytes))
    except (ValueError, RecursionError) as error:  # an integer of too many digits is a ValueError
        raise ReportError(f"{path}: not valid JSON ({error}). Select the correct file, or repeat the run.") from error
    if not isinstance(found, dict):
        raise ReportError(f"{path}: not a JSON object. Select the correct file, or repeat the run.")
    check_depth(found, path)
    return found


def check_depth(value: Any, path: Path) -> None:
    """Raise ReportError if tables and lists are nested more deeply than in any file of a run."""
    level = [value]
    for _ in range(_DEEPEST):
        level = [
            part
            for parts in level
            if isinstance(parts, dict | list)
            for part in (parts.values() if isinstance(parts, dict) else parts)
            if isinstance(part, dict | list)
        ]
    if level:
        raise ReportError(f"{path}: too deeply nested (allowed {_DEEPEST} levels). Select the file of a run.")


def is_number(value: object) -> bool:
    """Return whether a value of a JSON or TOML file is a finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer beyond the range of floats
        return False


def number(text: str, where: str) -> float:
    """Return the number in a cell, including nan and infinities; the ReportError states file and line."""
    try:
        if "_" in text:
            raise ValueError
        return float(text)
    except ValueError as error:
        point = "; write the decimals behind a point" if text.count(",") == 1 else ""
        raise ReportError(f"{where}: expected a number, found {quoted(text)}{point}") from error


def finite_number(text: str, where: str) -> float:
    """Return the finite number in a cell; the ReportError states file and line."""
    value = number(text, where)
    if not math.isfinite(value):
        raise ReportError(f"{where}: expected a finite number, found {quoted(text)}")
    return value


@dataclass(frozen=True)
class Table:
    """A CSV file: columns, the line of the header, and rows by column, each with its line."""

    columns: list[str]
    line: int
    rows: list[tuple[int, dict[str, str]]]


def read_table(
    path: Path, needed: tuple[str, ...], optional: tuple[str, ...] | None = None, max_bytes: int = 64 * MEGABYTE
) -> Table:
    """Read a CSV file with a header; empty lines and those starting with # are ignored.

    Columns beyond `needed` must be in `optional`; None allows all.
    """
    lines = read_text(path, max_bytes).split("\n")
    kept = [(place, line) for place, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if not kept:
        raise ReportError(f"{path}: empty; expected the columns {', '.join(needed)}")
    first = kept[0][0]
    header = _cells(kept[0][1], f"{path}:{first}")
    for name in needed:
        if name not in header:
            by_semicolons = len(header) == 1 and ";" in header[0]
            hint = ". Columns are parted by commas: write , in place of ;" if by_semicolons else ""
            raise ReportError(f"{path}:{first}: no column {name}; found {_some(header)}{hint}")
    for place, name in enumerate(header):
        if name in header[:place]:
            raise ReportError(f"{path}:{first}: two columns {quoted(name)}")
        if optional is not None and name not in needed + optional:
            allowed = f"allowed are {', '.join(needed + optional)}"
            raise ReportError(
                f"{path}:{first}: no column is called {quoted(name)}{nearest(name, needed + optional)} {allowed}"
            )
    rows = []
    for line, text in kept[1:]:
        cells = _cells(text, f"{path}:{line}")
        if len(cells) != len(header):
            raise ReportError(f"{path}:{line}: {len(cells)} values for {len(header)} columns")
        rows.append((line, dict(zip(header, cells, strict=True))))
    return Table(header, first, rows)


def _some(names: list[str]) -> str:
    return ", ".join(map(quoted, names[:12])) + (", ..." if len(names) > 12 else "")


def _cells(line: str, where: str) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], strict=True))]
    except csv.Error as error:
        raise ReportError(f"{where}: not a row of comma-separated cells: {error}") from error
