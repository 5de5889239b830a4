"""Warnings of a run, each once, about basal temperatures that are not physical."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import Program, sets

# A block at 100 m/s whose friction pore pressure does not reduce: a band of 1 mm boils dry within half a second.
FAST = sets(
    grid__max="[220.0, 10.0]",
    body__block__velocity="[100.0, 0.0]",
    basal__friction="coefficient",
    basal__friction_coefficient=0.8,
    band__thickness=0.001,
    time__end=0.5,
)

RunWarnings = Callable[..., list[str]]


def notes(stdout: str) -> list[str]:
    return re.findall(r"^warning: at .*$", stdout, flags=re.MULTILINE)


@pytest.fixture
def warnings_of_run(thawslide: Program, small_case: Path, tmp_path: Path) -> RunWarnings:
    def run(*more: str) -> list[str]:
        case = small_case / "case.toml"
        case.write_text(case.read_text().replace("friction_angle = 10.0\n", ""))
        outcome = thawslide("run", case, "--output", tmp_path / "run", "--overwrite", *more)
        assert outcome.returncode == 0, outcome.stderr
        return notes(outcome.stdout)

    return run


def limits(notes: list[str]) -> list[int]:
    """Return the temperature limits in warnings, which must increase."""
    found = [int(re.search(r"passes ([\d,]+) C", note)[1].replace(",", "")) for note in notes]  # type: ignore[index]
    assert found == sorted(set(found))
    return found


def test_columns_that_boil_dry_are_reported_once(warnings_of_run: RunWarnings) -> None:
    note, *later = warnings_of_run(*FAST)
    found = re.match(r"warning: at [\d.]+ s (\d+ columns|a column) .*boiled dry, and the hottest is at (\d+) C", note)
    assert found, note
    assert 100 < int(found[2]) < 5000
    assert set(limits(later)) <= {500, 1000, 2000}
    assert "no longer limits temperature and friction" in note


def test_columns_without_steam_do_not_boil(warnings_of_run: RunWarnings) -> None:
    notes = warnings_of_run(*FAST, *sets(heat__steam="false"))
    assert limits(notes)[-1] >= 1000
    for note in notes:
        assert "Nothing boils, as heat.steam is false: temperatures above 100 C are not physical" in note


def test_particles_of_the_scaled_band_do_not_boil(warnings_of_run: RunWarnings) -> None:
    notes = warnings_of_run(*FAST, *sets(band__model="scaled", band__thickness=0.01))
    assert limits(notes)
    assert "Nothing in the model boils: temperatures above 100 C are not physical" in notes[0]


def test_a_cold_base_has_no_warning(warnings_of_run: RunWarnings) -> None:
    assert warnings_of_run(*sets(basal__friction_angle=10, band__thickness=0.1)) == []
