"""Columns of a history and keys of a case, as the program declares them (`thawslide describe`)."""

from __future__ import annotations

import json
import re
import subprocess
from functools import cache

from thawslide.program import find_program

_HISTORY, _BLOCK = "history.csv", "Table of the rigid block"  # sections of the output
_ROW = re.compile(r"^\| (`[^|]*`) \|")
_NAME = re.compile(r"`(\w+)`")
_ANY = "NAME"  # in the name of a table
_TIMEOUT = 60.0  # seconds


def declared_columns(is_block: bool) -> list[str]:
    """Return all columns that a history, or the table of a rigid block, can have; empty without the program."""
    path = find_program()
    return _columns(path, _BLOCK if is_block else _HISTORY) if path else []


def unit_of_key(key: str) -> str:
    """Return the unit of a key such as body.slide.temperature; "" without unit or program."""
    path = find_program()
    parts = key.split(".")
    for (table, name), unit in (_units(path) if path else {}).items():
        declared = [*table.split("."), name]
        if len(declared) == len(parts) and all(
            there in (part, _ANY) for part, there in zip(parts, declared, strict=True)
        ):
            return unit
    return ""


@cache
def _units(path: str) -> dict[tuple[str, str], str]:
    """Return the units by table and key."""
    try:
        tables = json.loads(_printed(path, "--json"))
        return {
            (table["table"].strip("[]"), key["key"]): "°C" if key["unit"] == "C" else str(key["unit"])
            for table in tables
            for key in table["keys"]
        }
    except (ValueError, KeyError, TypeError):
        return {}


@cache
def _columns(path: str, section: str) -> list[str]:
    found: list[str] = []
    is_inside = False
    for line in _printed(path, "--outputs").splitlines():
        if line.startswith("## "):
            is_inside = line == f"## {section}"
        elif is_inside and (row := _ROW.match(line)):
            found += _NAME.findall(row[1])
    return found


def _printed(path: str, form: str) -> str:
    """Return the output of `thawslide describe`; "" if it fails."""
    try:
        done = subprocess.run([path, "describe", form], capture_output=True, text=True, timeout=_TIMEOUT, check=False)
    except (OSError, subprocess.TimeoutExpired, ValueError):
        return ""
    return done.stdout
