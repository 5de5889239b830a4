"""Resolutions offered by `thawslide new`: cells and cost of a run, in agreement with `check`."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest
from conftest import Program
from slope_files import THICKNESS, Slope, assert_refused, made

CELLS = {"quick": 8.0, "standard": 3.0, "fine": 1.5}  # m, for 24 m
DURATION = r"(?:\S+ (?:s|min|h|days))"


def cell_of(folder: Path) -> float:
    return float(tomllib.loads((folder / "case.toml").read_text())["grid"]["cell"])


@pytest.mark.parametrize("resolution", ["", "quick", "standard"])
def test_new_reports_the_cell_and_the_cost(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path, resolution: str
) -> None:
    folder = tmp_path / "slide"
    words = ["--resolution", resolution] if resolution else []
    outcome = made(thawslide, folder, slope(), release, "--thickness", THICKNESS, *words)
    assert outcome.returncode == 0, outcome.stderr
    chosen = resolution or "quick"
    assert cell_of(folder) == CELLS[chosen]
    found = re.search(
        rf"^resolution:  {chosen}, cells of {CELLS[chosen]:g} m; for [a-z ]+\n"
        rf" +about (\S+) particles, (\S+) steps to time\.end, and {DURATION} on \d+ threads?$",
        outcome.stdout,
        re.MULTILINE,
    )
    assert found, outcome.stdout
    checked = json.loads(thawslide("check", folder, "--json").stdout)
    assert float(found[1].replace(",", "")) == pytest.approx(checked["particles"], rel=0.1)
    assert float(found[2].replace(",", "")) == pytest.approx(checked["steps"], rel=0.05)
    others = dict(
        re.findall(
            rf"^ +--resolution (\w+): cells of (\S+) m, about {DURATION}; [a-z ]+$", outcome.stdout, re.MULTILINE
        )
    )
    assert {name: float(cell) for name, cell in others.items()} == {
        name: cell for name, cell in CELLS.items() if name != chosen
    }
    assert "warning: " not in outcome.stdout, "the text names the cells for maps"


def test_a_cell_given_by_the_user_has_no_resolution_name(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    outcome = made(thawslide, tmp_path / "own", slope(), release, "--thickness", THICKNESS, "--cell", 12)
    assert outcome.returncode == 0 and cell_of(tmp_path / "own") == 12.0, outcome.stderr
    assert "\nresolution:  cells of 12 m\n             about " in outcome.stdout
    assert outcome.stdout.count("--resolution ") == 3
    assert "warning: --cell: across the median thickness" in outcome.stdout
    both = made(thawslide, tmp_path / "slide", slope(), release, "--cell", 12, "--resolution", "fine")
    assert_refused(both, tmp_path, "--cell excludes --resolution. Run with --help for more information.")


def seconds_of(duration: str) -> float:
    """Return a duration such as "1.7 min" [s]."""
    number, unit = duration.split()
    return float(number) * {"s": 1.0, "min": 60.0, "h": 3600.0, "days": 86400.0}[unit]


def test_the_times_of_other_resolutions_follow_from_their_cells(
    thawslide: Program, tmp_path: Path, slope: Slope, release: Path
) -> None:
    """Cells half as large cost 16 times as much."""
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", THICKNESS)
    found = dict(re.findall(r"--resolution (\w+): cells of \S+ m, about ([^;]+);", outcome.stdout))
    assert seconds_of(found["fine"]) == pytest.approx(16.0 * seconds_of(found["standard"]), rel=0.08)


def test_an_unknown_resolution_is_refused(thawslide: Program, tmp_path: Path, slope: Slope, release: Path) -> None:
    outcome = made(thawslide, tmp_path / "slide", slope(), release, "--thickness", 24, "--resolution", "coarse")
    assert outcome.returncode == 2 and "--resolution" in outcome.stderr and "quick" in outcome.stderr
    assert not (tmp_path / "slide").exists()
