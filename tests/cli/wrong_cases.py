"""Case files with one error each, generated from the declarations, and the expected message for each.

`wrong_cases` yields them for tests and for the page of reliability: every parameter that `thawslide describe --json`
knows with a value of the wrong type, one out of its range, an unknown keyword, and its key misspelt.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from conftest import Program

# A valid case in 2D, and one in 3D: tables and their keys.
VALID_2D: dict[str, dict[str, str]] = {
    "time": {"end": "0.2", "step": "0.001"},
    "grid": {"cell": "1.0", "min": "[0.0, -2.0]", "max": "[20.0, 10.0]"},
    "terrain": {"type": '"flat"'},
    "material.rock": {"youngs_modulus": "1e8", "poisson_ratio": "0.2", "friction_angle": "35.0", "cohesion": "1e5"},
    "body.block": {"material": '"rock"', "min": "[10.0, 0.0]", "max": "[14.0, 3.0]", "porosity": "0.3"},
    "basal": {"friction_angle": "10.0"},
}
VALID_3D: dict[str, dict[str, str]] = VALID_2D | {
    "case": {"dimension": "3"},
    "grid": {"cell": "1.0", "min": "[0.0, 0.0, -2.0]", "max": "[20.0, 10.0, 10.0]"},
    "body.block": {"material": '"rock"', "min": "[10.0, 2.0, 0.0]", "max": "[14.0, 6.0, 3.0]", "porosity": "0.3"},
}
# Keys that further tables need to be valid.
NEEDED: dict[str, dict[str, str]] = {
    "frame.lid": {"min": "[1.0, 5.0]", "max": "[2.0, 6.0]", "axis": '"x"', "velocity": "0.0"},
    "substrate.ice": {"x_min": "12.0", "friction": '"coefficient"', "friction_coefficient": "0.1"},
    "bed": {"law": '"momentum"', "depth": "0.5", "strength": "1e3", "depth_per_slip": "0.1", "material": '"rock"'},
    "contact_pair.touch": {"bodies": '["block", "other"]', "contact": '"frictional"', "friction_angle": "20.0"},
    "band": {"thickness": "0.2"},
    "probe.bridge": {"point": "[15.0, 4.0]"},
}
# Names of tables of the case.
NAMES = {
    "material": "rock", "body": "block", "frame": "lid", "substrate": "ice", "probe": "bridge", "contact_pair": "touch",
}  # fmt: skip
# The other body of the pair.
OTHER_BODY = {"material": '"rock"', "min": "[16.0, 0.0]", "max": "[18.0, 3.0]", "porosity": "0.3"}

WRONG_TYPE, OUT_OF_RANGE, UNKNOWN_WORD, MISSPELT = "wrong type", "out of range", "unknown word", "misspelt key"
FAULTS = (WRONG_TYPE, OUT_OF_RANGE, UNKNOWN_WORD, MISSPELT)


@dataclass(frozen=True)
class Fault:
    """One wrong line of a case: its table, the line, and the expected message."""

    table: str
    key: str
    dimension: int  # of a case in which the key has a meaning
    kind: str
    line: str
    message: str  # after FILE:LINE:COLUMN and a colon


@dataclass(frozen=True)
class WrongCase:
    """A case file with faults, and the expected message of each by line number."""

    name: str
    text: str
    message: dict[int, str]


def wrong_cases(tables: list[dict[str, Any]]) -> Iterator[WrongCase]:
    """Yield every wrong case, each with one fault; `tables`: the output of `describe --json`."""
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
            message = f"key '{table}.{wrong}' is not known in [{table}]; did you mean '{key['key']}'? Allowed here: "
            yield Fault(table, key["key"], dimension, MISSPELT, f"{wrong} = 1", message)


def faults_of_value(table: str, key: dict[str, Any]) -> Iterator[Fault]:
    """Yield the possible errors in the value of a key."""
    name, dotted, dimension = key["key"], f"{table}.{key['key']}", key["dimension"] or 2
    value, found = wrong_type(key["type"])
    yield Fault(table, name, dimension, WRONG_TYPE, f"{name} = {value}", f"{dotted} is {found}; allowed: {key['type']}")
    outside = out_of_range(key)
    if outside is not None:
        unit = f" {key['unit']}" if key["unit"] else ""
        message = f"{dotted} is {outside}; allowed: {key['allowed']}{unit} ({key['text']})"
        written = f"[{outside}]" if key["type"].startswith("an array") else outside
        yield Fault(table, name, dimension, OUT_OF_RANGE, f"{name} = {written}", message)
    if key["keywords"]:
        words = [word["name"] for word in key["keywords"]]
        wrong = words[-1] + "s"
        listed = ", ".join(f'"{word}"' for word in words)
        hint = f"; did you mean '{words[-1]}'? Allowed" if len(words[-1]) > 1 else "; allowed"
        message = f'{dotted} is "{wrong}"{hint}: {listed}'
        yield Fault(table, name, dimension, UNKNOWN_WORD, f'{name} = "{wrong}"', message)


def wrong_type(declared: str) -> tuple[str, str]:
    """Return a value of a wrong type for a key, and its name in the message."""
    if declared.startswith(("one of", "a text", "the path", '"')):
        return "7", "7"
    return '"so"', 'the text "so"'


def out_of_range(key: dict[str, Any]) -> str | None:
    """Return a number outside the range; None for a key without a range."""
    allowed = key["allowed"]
    if not allowed:
        return None
    low = re.match(r"(>=?|between) ([^ ,]+)", allowed)
    assert low, allowed
    edge = float(low[2])
    outside = edge if low[1] == ">" or "excluded" in allowed else edge - 1.0
    return f"{outside:.10g}"


def misspelt(key: str, keys: list[str]) -> str:
    """Return the key with a typing error, which is no other key of the table."""
    slips = [key[:k] + key[k] + key[k:] for k in range(len(key) - 1, 0, -1)]
    return next(slip for slip in slips if slip not in keys)


def case_with(group: list[Fault], name: str) -> WrongCase:
    """Write the valid case with wrong lines in one of its tables."""
    table = group[0].table
    valid = VALID_3D if group[0].dimension == 3 else VALID_2D
    tables = {title: dict(keys) for title, keys in valid.items()}
    tables.setdefault(table, dict(NEEDED.get(table, {})))
    if table == "contact_pair.touch":
        tables["body.other"] = dict(OTHER_BODY)
    lines: list[str] = []
    message: dict[int, str] = {}
    replaced = {fault.key for fault in group}
    # [case] comes first, because it sets the dimension of the others.
    for title, keys in sorted(tables.items(), key=lambda entry: entry[0] != "case"):
        lines.append(f"[{title}]")
        lines += [f"{key} = {value}" for key, value in keys.items() if title != table or key not in replaced]
        for fault in group if title == table else []:
            lines.append(fault.line)
            message[len(lines)] = fault.message
    return WrongCase(name, "\n".join(lines) + "\n", message)


def wrong_messages(thawslide: Program, folder: Path, case: WrongCase) -> list[str]:
    """Return the errors in the program's message about a wrong case."""
    file = folder / "case.toml"
    file.write_text(case.text)
    outcome = thawslide("run", file, "--output", folder / "run")
    wrong = []
    if outcome.returncode != 2 or outcome.stdout != "":
        wrong.append(f"exit code {outcome.returncode}, output {outcome.stdout!r}")
    if sorted(each.name for each in folder.iterdir()) != ["case.toml"]:
        wrong.append("something was written")
    for line, message in case.message.items():
        if not re.search(rf"^(error: )?{re.escape(str(file))}:{line}:\d+: {re.escape(message)}", outcome.stderr, re.M):
            wrong.append(f"line {line} ({case.text.splitlines()[line - 1]}) is not reported as: {message}")
    return [f"{case.name}: {each}\n{outcome.stderr}" for each in wrong]
