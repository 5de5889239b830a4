"""Every parameter of a case, broken in turn: told with file, line, key, what was found and what is allowed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import Program
from wrong_cases import FAULTS, case_with, faults, faults_of_answer, wrong_cases, wrong_cases_by_table


@pytest.fixture(scope="module")
def tables(thawslide: Program) -> list[dict[str, Any]]:
    described: list[dict[str, Any]] = json.loads(thawslide("describe", "--json").stdout)
    return described


def test_there_are_hundreds_of_wrong_cases(tables: list[dict[str, Any]]) -> None:
    """Each kind of fault, for every parameter that can have it; none is left out."""
    kinds = [fault.kind for fault in faults(tables)]
    parameters = sum(len(table["keys"]) for table in tables)
    counts = {kind: kinds.count(kind) for kind in FAULTS}
    assert counts["wrong type"] == counts["misspelt key"] == parameters
    assert counts["out of range"] > 90 and counts["unknown word"] > 30
    assert len(list(wrong_cases(tables))) == len(kinds)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_case_that_is_broken_is_sound(
    thawslide: Program, tmp_path: Path, tables: list[dict[str, Any]], dimension: int
) -> None:
    first = next(fault for fault in faults(tables) if fault.dimension == dimension)
    (tmp_path / "case.toml").write_text(case_with([first], "").text.replace(first.line + "\n", ""))
    checked = thawslide("check", tmp_path)
    assert checked.returncode == 0, checked.stderr


def test_each_wrong_parameter_is_named(thawslide: Program, tmp_path: Path, tables: list[dict[str, Any]]) -> None:
    """Those of a table and a kind in one file, all of which are told at once."""
    wrong = [each for case in wrong_cases_by_table(tables) for each in faults_of_answer(thawslide, tmp_path, case)]
    assert not wrong, "\n".join(wrong)


@pytest.mark.long
def test_each_wrong_case_is_named(thawslide: Program, tmp_path: Path, tables: list[dict[str, Any]]) -> None:
    """One fault a file."""
    wrong = [each for case in wrong_cases(tables) for each in faults_of_answer(thawslide, tmp_path, case)]
    assert not wrong, "\n".join(wrong)
