"""Case files that are wrong in one thing each, made from the declarations, and what must be said of each.

`wrong_cases` yields them for tests and for the page of reliability: every parameter that `thawslide describe --json`
knows with a value of the wrong type, one out of its range, a word that it does not take, and its key misspelt.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from conftest import Program

# A sound case in the plane, and one in space: table, its keys.
PLANE: dict[str, dict[str, str]] = {
    "time": {"end": "0.2", "step": "0.001"},
    "grid": {"cell": "1.0", "min": "[0.0, -2.0]", "max": "[20.0, 10.0]"},
    "terrain": {"type": '"flat"'},
    "material.rock": {
        "youngs_modulus": "1e8",
        "poisson_ratio": "0.2",
        "friction_angle": "35.0",
        "cohesion": "1e5",
    },
    "body.block": {"material": '"rock"', "min": "[10.0, 0.0]", "max": "[14.0, 3.0]", "porosity": "0.3"},
    "basal": {"friction_angle": "10.0"},
}
SPACE: dict[str, dict[str, str]] = PLANE | {
    "case": {"dimension": "3"},
    "grid": {"cell": "1.0", "min": "[0.0, 0.0, -2.0]", "max": "[20.0, 10.0, 10.0]"},
    "body.block": {"material": '"rock"', "min": "[10.0, 2.0, 0.0]", "max": "[14.0, 6.0, 3.0]", "porosity": "0.3"},
}
# What the tables that these lack need, for the table to be sound.
NEEDED: dict[str, dict[str, str]] = {
    "frame.lid": {"min": "[1.0, 5.0]", "max": "[2.0, 6.0]", "axis": '"x"', "velocity": "0.0"},
    "substrate.ice": {"x_min": "12.0", "friction": '"coefficient"', "friction_coefficient": "0.1"},
    "bed": {
        "law": '"momentum"',
        "depth": "0.5",
        "strength": "1e3",
        "depth_per_slip": "0.1",
        "material": '"rock"',
    },
    "contact_pair.touch": {"bodies": '["block", "other"]', "contact": '"frictional"', "friction_angle": "20.0"},
    "band": {"thickness": "0.2"},
    "probe.bridge": {"point": "[15.0, 4.0]"},
}
# The names that tables of the case have.
NAMES = {
    "material": "rock",
    "body": "block",
    "frame": "lid",
    "substrate": "ice",
    "probe": "bridge",
    "contact_pair": "touch",
}
# The other body of the pair.
OTHER_BODY = {"material": '"rock"', "min": "[16.0, 0.0]", "max": "[18.0, 3.0]", "porosity": "0.3"}

WRONG_TYPE, OUT_OF_RANGE, UNKNOWN_WORD, MISSPELT = "wrong type", "out of range", "unknown word", "misspelt key"
FAULTS = (WRONG_TYPE, OUT_OF_RANGE, UNKNOWN_WORD, MISSPELT)


@dataclass(frozen=True)
class Fault:
    """One wrong line of a case: its table, the line as written, and what must be said of it."""

    table: str
    key: str
    dimension: int  # of a case in which the key has a meaning
    kind: str
    line: str
    said: str  # after FILE:LINE:COLUMN and a colon


@dataclass(frozen=True)
class WrongCase:
    """A case file with faults, and by line number what must be said of each."""

    name: str
    text: str
    said: dict[int, str]


def wrong_cases(tables: list[dict[str, Any]]) -> Iterator[WrongCase]:
    """Yield every wrong case, each with one fault; `tables`: what `describe --json` tells."""
    for fault in faults(tables):
        yield case_with([fault], f"{fault.table}.{fault.key}: {fault.kind}")


def wrong_cases_by_table(tables: list[dict[str, Any]]) -> Iterator[WrongCase]:
    """Yield the same faults, those of a table and a kind together in one file."""
    groups: dict[tuple[str, int, str], list[Fault]] = {}
    for fault in faults(tables):
        groups.setdefault((fault.table, fault.dimension, fault.kind), []).append(fault)
    for (table, dimension, kind), group in groups.items():
        yield case_with(group, f"{table} in {dimension}D: {kind}")


def faults(tables: list[dict[str, Any]]) -> Iterator[Fault]:
    """Yield every fault that the declarations give."""
    for described in tables:
        title = described["table"].strip("[]")
        kind = title.removesuffix(".NAME")
        table = f"{kind}.{NAMES[kind]}" if title.endswith(".NAME") else title
        keys = [key["key"] for key in described["keys"]]
        for key in described["keys"]:
            dimension = key["dimension"] or 2
            yield from faults_of_value(table, key)
            wrong = misspelt(key["key"], keys)
            said = f"key '{table}.{wrong}' is not known in [{table}]; did you mean '{key['key']}'? Allowed here: "
            yield Fault(table, key["key"], dimension, MISSPELT, f"{wrong} = 1", said)


def faults_of_value(table: str, key: dict[str, Any]) -> Iterator[Fault]:
    """Yield what can be wrong with the value of a key."""
    name, dotted, dimension = key["key"], f"{table}.{key['key']}", key["dimension"] or 2
    value, found = wrong_type(key["type"])
    yield Fault(table, name, dimension, WRONG_TYPE, f"{name} = {value}", f"{dotted} is {found}; allowed: {key['type']}")
    outside = out_of_range(key)
    if outside is not None:
        unit = f" {key['unit']}" if key["unit"] else ""
        said = f"{dotted} is {outside}; allowed: {key['allowed']}{unit} ({key['text']})"
        written = f"[{outside}]" if key["type"].startswith("an array") else outside
        yield Fault(table, name, dimension, OUT_OF_RANGE, f"{name} = {written}", said)
    if key["keywords"]:
        words = [word["name"] for word in key["keywords"]]
        wrong = words[-1] + "s"
        listed = ", ".join(f'"{word}"' for word in words)
        hint = f"; did you mean '{words[-1]}'? Allowed" if len(words[-1]) > 1 else "; allowed"
        said = f'{dotted} is "{wrong}"{hint}: {listed}'
        yield Fault(table, name, dimension, UNKNOWN_WORD, f'{name} = "{wrong}"', said)


def wrong_type(declared: str) -> tuple[str, str]:
    """Return a value that is of no type that a key takes, and how it is called."""
    if declared.startswith(("one of", "a text", "the path", '"')):
        return "7", "7"
    return '"so"', 'the text "so"'


def out_of_range(key: dict[str, Any]) -> str | None:
    """Return a number outside the range; nothing for a key that takes any."""
    allowed = key["allowed"]
    if not allowed:
        return None
    low = re.match(r"(>=?|between) ([^ ,]+)", allowed)
    assert low, allowed
    edge = float(low[2])
    outside = edge if low[1] == ">" or "excluded" in allowed else edge - 1.0
    return f"{outside:.10g}"


def misspelt(key: str, keys: list[str]) -> str:
    """Return the key with a slip of the pen, which no other key of the table has."""
    slips = [key[:k] + key[k] + key[k:] for k in range(len(key) - 1, 0, -1)]
    return next(slip for slip in slips if slip not in keys)


def case_with(group: list[Fault], name: str) -> WrongCase:
    """Write the sound case with wrong lines in one of its tables."""
    table = group[0].table
    sound = SPACE if group[0].dimension == 3 else PLANE
    tables = {title: dict(keys) for title, keys in sound.items()}
    tables.setdefault(table, dict(NEEDED.get(table, {})))
    if table == "contact_pair.touch":
        tables["body.other"] = dict(OTHER_BODY)
    lines: list[str] = []
    said: dict[int, str] = {}
    replaced = {fault.key for fault in group}
    # [case] decides of what dimension the others are, and stands first.
    for title, keys in sorted(tables.items(), key=lambda entry: entry[0] != "case"):
        lines.append(f"[{title}]")
        lines += [f"{key} = {value}" for key, value in keys.items() if title != table or key not in replaced]
        for fault in group if title == table else []:
            lines.append(fault.line)
            said[len(lines)] = fault.said
    return WrongCase(name, "\n".join(lines) + "\n", said)


def faults_of_answer(thawslide: Program, folder: Path, case: WrongCase) -> list[str]:
    """Return what is wrong with the program's answer to a wrong case."""
    file = folder / "case.toml"
    file.write_text(case.text)
    outcome = thawslide("run", file, "--output", folder / "run")
    wrong = []
    if outcome.returncode != 2 or outcome.stdout != "":
        wrong.append(f"exit code {outcome.returncode}, output {outcome.stdout!r}")
    if sorted(each.name for each in folder.iterdir()) != ["case.toml"]:
        wrong.append("something was written")
    for line, said in case.said.items():
        if not re.search(rf"^(error: )?{re.escape(str(file))}:{line}:\d+: {re.escape(said)}", outcome.stderr, re.M):
            wrong.append(f"line {line} ({case.text.splitlines()[line - 1]}) is not told as: {said}")
    return [f"{case.name}: {each}\n{outcome.stderr}" for each in wrong]
