"""Columns of a history and keys of a case, as the program declares them (`thawslide describe`)."""

from __future__ import annotations

import json
import math
import re
import subprocess
from functools import cache
from typing import Any

from thawslide import _core
from thawslide.number_text import unit_text
from thawslide.program import find_program

_HISTORY, _BLOCK = "history.csv", "Table of the rigid block"  # sections of the output
_ROW = re.compile(r"^\| (`[^|]*`) \|")
_NAME = re.compile(r"`(\w+)`")
_UNIT = re.compile(r"\[([^]]*)\]$")
_TIMEOUT = 600.0  # seconds; longer is a hang


def declared_columns(is_block: bool) -> list[str]:
    """Return all columns that a history, or the table of a rigid block, can have; empty without the program."""
    path = find_program()
    return _columns(path, _BLOCK if is_block else _HISTORY) if path else []


def unit_of_key(key: str) -> str:
    """Return the unit of a key such as body.slide.temperature; "" without unit."""
    unit = _UNIT.search(_schema_of(key).get("description", ""))
    return "" if unit is None else unit_text(unit[1])


def limits_of_key(key: str) -> tuple[float, float]:
    """Return the lowest and the highest number that a key allows; infinite without a limit."""
    schema = _schema_of(key)
    schema = schema.get("anyOf", [schema])[0]
    low, high = schema.get("minimum", -math.inf), schema.get("maximum", math.inf)
    if "exclusiveMinimum" in schema:
        low = math.nextafter(schema["exclusiveMinimum"], math.inf)
    if "exclusiveMaximum" in schema:
        high = math.nextafter(schema["exclusiveMaximum"], -math.inf)
    return low, high


@cache
def _schema_of(key: str) -> dict[str, Any]:
    """Return the JSON schema of a key; empty for an unknown one."""
    found: Any = json.loads(_core.schema_json())
    for part in key.split("."):
        inner = found.get("properties", {}).get(part, found.get("additionalProperties"))
        found = inner if isinstance(inner, dict) else {}
    return dict(found)


@cache
def _columns(path: str, section: str) -> list[str]:
    found: list[str] = []
    is_inside = False
    for line in _printed(path).splitlines():
        if line.startswith("## "):
            is_inside = line == f"## {section}"
        elif is_inside and (row := _ROW.match(line)):
            found += _NAME.findall(row[1])
    return found


def _printed(path: str) -> str:
    """Return the output of `thawslide describe --outputs`; "" if it fails."""
    command = [path, "describe", "--outputs"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_TIMEOUT, check=False)
    except (OSError, subprocess.TimeoutExpired, ValueError):
        return ""
    return done.stdout
