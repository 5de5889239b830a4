"""Mistakes in a case: exit code 2, a message with location, value and remedy, and no output files."""

from pathlib import Path
from typing import Any

import pytest
from conftest import SMALL_CASE, Program
from mistakes import CASES, Mistake
from wrong_cases import FAULTS, case_with, faults, wrong_cases, wrong_cases_by_table, wrong_messages

Tables = list[dict[str, Any]]


@pytest.mark.parametrize("mistake", CASES, ids=lambda mistake: mistake.name)
def test_mistakes_have_their_message(thawslide: Program, small_case: Path, mistake: Mistake) -> None:
    mistake.write(SMALL_CASE, small_case)
    run = small_case.parent / "run"
    message = thawslide.error("run", small_case, "--output", run, *mistake.words, quiet=True)
    assert message == mistake.message(small_case) and not run.exists()


@pytest.fixture(scope="module")
def tables(thawslide: Program) -> Tables:
    described: Tables = thawslide.json("describe")
    return described


def test_there_are_hundreds_of_wrong_cases(tables: Tables) -> None:
    """Each kind of fault occurs for every parameter that can have it."""
    kinds = [fault.kind for fault in faults(tables)]
    counts = {kind: kinds.count(kind) for kind in FAULTS}
    parameters = sum(len(table["keys"]) for table in tables)
    assert counts["wrong type"] == counts["misspelt key"] == parameters
    assert counts["out of range"] > 90 and counts["unknown word"] > 30
    assert len(list(wrong_cases(tables))) == len(kinds)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_case_without_changes_is_valid(thawslide: Program, tmp_path: Path, tables: Tables, dimension: int) -> None:
    first = next(fault for fault in faults(tables) if fault.dimension == dimension)
    (tmp_path / "case.toml").write_text(case_with([first], "").text.replace(first.line + "\n", ""))
    thawslide.ok("check", tmp_path)


def test_each_wrong_parameter_is_reported(thawslide: Program, tmp_path: Path, tables: Tables) -> None:
    """A file contains all faults of a table and a kind, which are reported at once; scripts/pages tries each alone."""
    wrong = [each for case in wrong_cases_by_table(tables) for each in wrong_messages(thawslide, tmp_path, case)]
    assert not wrong, "\n".join(wrong)
