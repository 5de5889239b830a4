"""Mistakes in a case: exit code 2, a message with location, value and remedy, and no output files."""

from pathlib import Path
from typing import Any

import pytest
from conftest import LAMPLUGH, SMALL_CASE, Program, sets
from mistakes import COMMON_MISTAKES, FURTHER_MISTAKES, Mistake
from wrong_cases import FAULTS, case_with, faults, wrong_cases, wrong_cases_by_table, wrong_messages

Tables = list[dict[str, Any]]


def refused(thawslide: Program, case: Path, *words: str) -> str:
    run = case.parent / "run-of-a-mistake"
    message = thawslide.error("run", case, "--output", run, *words, quiet=True)
    assert not run.exists()
    return message


@pytest.mark.parametrize("mistake", COMMON_MISTAKES + FURTHER_MISTAKES, ids=lambda mistake: mistake.name)
def test_mistakes_have_their_message(thawslide: Program, small_case: Path, mistake: Mistake) -> None:
    mistake.write(SMALL_CASE, small_case)
    assert refused(thawslide, small_case, *mistake.words) == mistake.message(small_case)


def test_there_are_twenty_common_mistakes() -> None:
    assert len({mistake.name for mistake in COMMON_MISTAKES}) == 20


def test_absent_cases_and_empty_files_are_refused(thawslide: Program, small_case: Path) -> None:
    suggestion = "smal: there is no such file or folder; did you mean 'small'?"
    assert suggestion in refused(thawslide, small_case.parent / "smal")
    (small_case / "case.toml").rename(small_case / "first.toml")
    assert "the folder has no case.toml. Give one of its case files: first.toml." in refused(thawslide, small_case)
    (small_case / "case.toml").write_text("")
    minimum = "the file is empty; a case has at least [time], [grid], [material.NAME] and [body.NAME]"
    assert f"case.toml:1:1: {minimum}" in refused(thawslide, small_case)


def test_a_former_key_is_accepted_with_a_note(thawslide: Program, small_case: Path) -> None:
    file = small_case / "case.toml"
    text = SMALL_CASE + '[mechanics]\ntransfer = "blend"\npic_share = 0.25\n'
    file.write_text(text)
    line = text.splitlines().index("pic_share = 0.25") + 1
    note = f"note: {file}:{line}:13: key 'mechanics.pic_share' is called 'mechanics.pic_fraction' now\n"
    assert note in thawslide.ok("check", small_case)


@pytest.mark.parametrize(
    ("key", "value", "reason"),
    [
        ("grid.follows_terrain", "false", "cells always follow the terrain"),
        ("terrain.representation", '"rigid_points"', "the ground is always a line or surface"),
        ("terrain.layers", "3", "the ground is always a line or surface"),
        ("band.cut_cells", '"equal_thickness"', "the ground no longer cuts cells"),
    ],
)
def test_a_removed_key_is_refused_with_the_reason(
    thawslide: Program, small_case: Path, key: str, value: str, reason: str
) -> None:
    table = key.split(".", maxsplit=1)[0]
    message = f"key '{key}' is not known in [{table}]; it was removed, because {reason}. Allowed here: "
    assert message in thawslide.error("check", small_case, "--set", f"{key}={value}")


def test_lamplugh_in_a_domain_that_ends_inside_the_body_is_refused(thawslide: Program, tmp_path: Path) -> None:
    message = thawslide.error("run", LAMPLUGH, "--output", tmp_path / "run", *sets(grid__max="[1000.0,2400.0]"))
    assert "body.slide reaches from" in message and "outside the domain" in message


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


@pytest.mark.parametrize(
    "generate", [wrong_cases_by_table, pytest.param(wrong_cases, marks=pytest.mark.long)], ids=["by table", "alone"]
)
def test_each_wrong_parameter_is_reported(thawslide: Program, tmp_path: Path, tables: Tables, generate: Any) -> None:
    """A file contains all faults of a table and a kind, which are reported at once, or one fault."""
    wrong = [each for case in generate(tables) for each in wrong_messages(thawslide, tmp_path, case)]
    assert not wrong, "\n".join(wrong)
