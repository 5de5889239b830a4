"""The pages on output files describe the files that the program writes."""

import csv
import re
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, Program, Ran, Slope, datasets, run_facts, sets, snapshot_files

REFERENCE = ROOT / "docs" / "reference"
NAME = re.compile(r"`([^`\n]+)`")


def names_in(text: str) -> set[str]:
    """Return the names in the first column of the tables of a text."""
    return {name for row in re.findall(r"^\|([^|]*)\|", text, re.MULTILINE) for name in NAME.findall(row)}


def section(title: str) -> str:
    """Return a section of the page on output files."""
    text = (REFERENCE / "outputs.md").read_text()
    level = re.search(rf"^(#+) {re.escape(title)}$", text, re.MULTILINE)
    assert level
    return re.split(rf"^#{{1,{len(level[1])}}} ", text[level.end() :], maxsplit=1, flags=re.MULTILINE)[0]


def keys_in(value: Any) -> set[str]:
    """Return all keys of a JSON value and of the values in it."""
    if isinstance(value, list):
        return set().union(*map(keys_in, value))
    return set(value).union(*map(keys_in, value.values())) if isinstance(value, dict) else set()


@pytest.fixture
def case_on_dem(slope: Slope) -> Path:
    slope.ok("--cell", 10, thickness=20)
    return slope.case


def test_columns_fields_and_maps_are_listed(ran: Ran, thawslide: Program, small_case: Path, case_on_dem: Path) -> None:
    described = names_in(thawslide.ok("describe", "--outputs"))
    for case in (small_case, case_on_dem):
        run = ran(*sets(time__end=0.02), case=case, name=f"run-{case.name}")
        with (run / "history.csv").open(newline="") as file:
            columns = next(csv.reader(file))
        names = [Path(name).name for name in datasets(snapshot_files(run)[-1]) if re.search("PointData|^base", name)]
        maps = [path.stem for path in run.glob("maps/*.tif")]
        assert len(columns) > 60 and len(names) >= 18 and bool(maps) == (case is case_on_dem)
        assert {*columns, *names, *maps} - described == set()


def test_keys_of_run_json_are_described(ran: Ran, case_on_dem: Path) -> None:
    run = ran(*sets(time__end=0.01), case=case_on_dem)
    facts = run_facts(run)
    main, parts, roughness = re.split(r"^Keys of `\w+`:$", section("run.json"), flags=re.MULTILINE)
    assert names_in(main) == set(facts)
    assert names_in(parts) == set(facts["parts"][0])
    assert names_in(roughness) == set(facts["roughness"])
    assert set(facts["inputs"][0]) | set(facts["removed_particles"]) <= set(NAME.findall(main))


def test_keys_of_json_of_commands_are_described(thawslide: Program, case_on_dem: Path, done: Path) -> None:
    checked = thawslide.json("check", case_on_dem)
    text = section("check --json")
    assert names_in(text) == set(checked)
    roughness = set(checked.pop("roughness"))
    assert keys_in(checked) <= set(NAME.findall(text)) | roughness
    assert names_in(section("status --json")) == set(thawslide.json("status", done))
