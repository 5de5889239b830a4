"""Messages for a wrong value of every parameter: file, line, key, found and allowed values."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import Program
from wrong_cases import FAULTS, case_with, faults, wrong_cases, wrong_cases_by_table, wrong_messages


@pytest.fixture(scope="module")
def tables(thawslide: Program) -> list[dict[str, Any]]:
    described: list[dict[str, Any]] = json.loads(thawslide("describe", "--json").stdout)
    return described


def test_there_are_hundreds_of_wrong_cases(tables: list[dict[str, Any]]) -> None:
    """Each kind of fault occurs for every parameter that can have it."""
    kinds = [fault.kind for fault in faults(tables)]
    parameters = sum(len(table["keys"]) for table in tables)
    counts = {kind: kinds.count(kind) for kind in FAULTS}
    assert counts["wrong type"] == counts["misspelt key"] == parameters
    assert counts["out of range"] > 90 and counts["unknown word"] > 30
    assert len(list(wrong_cases(tables))) == len(kinds)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_case_before_its_changes_is_valid(
    thawslide: Program, tmp_path: Path, tables: list[dict[str, Any]], dimension: int
) -> None:
    first = next(fault for fault in faults(tables) if fault.dimension == dimension)
    (tmp_path / "case.toml").write_text(case_with([first], "").text.replace(first.line + "\n", ""))
    checked = thawslide("check", tmp_path)
    assert checked.returncode == 0, checked.stderr


def test_each_wrong_parameter_of_a_table_is_reported(
    thawslide: Program, tmp_path: Path, tables: list[dict[str, Any]]
) -> None:
    """A file contains all faults of a table and a kind, which are reported at once."""
    wrong = [each for case in wrong_cases_by_table(tables) for each in wrong_messages(thawslide, tmp_path, case)]
    assert not wrong, "\n".join(wrong)


@pytest.mark.long
def test_each_wrong_parameter_alone_is_reported(
    thawslide: Program, tmp_path: Path, tables: list[dict[str, Any]]
) -> None:
    """A file contains one fault."""
    wrong = [each for case in wrong_cases(tables) for each in wrong_messages(thawslide, tmp_path, case)]
    assert not wrong, "\n".join(wrong)
