"""Plausibility warnings of `check` and `run` about valid cases, its advice and estimates, as text and as JSON."""

import json
import re
from pathlib import Path

import pytest
from conftest import ROOT, Outcome, Program, Ran, run_facts, sets, snapshot_files

# An addition to the small case that avoids all warnings.
BAND = '\n[band]\nmodel = "scaled"\nthickness = 0.2\n'


@pytest.fixture
def plain_case(small_case: Path) -> Path:
    file = small_case / "case.toml"
    text = file.read_text().replace("cohesion = 1.0e5", "cohesion = 1.0e5\nhydraulic_conductivity = 1e-7")
    file.write_text(text + BAND)
    return small_case


def warnings_of(thawslide: Program, case: Path, *words: str) -> list[str]:
    """Return the warnings of `check`; fail if text and JSON differ."""
    outcome = thawslide("check", case, *words)
    reported = thawslide("check", case, "--json", *words)
    assert outcome.returncode == reported.returncode == 0, outcome.stderr + reported.stderr
    notes = re.findall(r"^warning: (.*)$", outcome.stdout, re.MULTILINE)
    assert notes == json.loads(reported.stdout)["warnings"]
    return notes


SOFT = "material.rock.youngs_modulus"


# tests/cpp/config and tests/cpp/sim compare most of these warnings as a whole.
@pytest.mark.parametrize(
    ("words", "start"),
    [
        (sets(body__block__min="[10.0,2.0]", body__block__max="[14.0,5.0]"),
         "{case}:27:1: body.block floats: its underside is 2 m above what is below it, and it falls for 0.64 s "),
        (sets(material__rock__youngs_modulus=1e6, time__step=0.001),
         f"--set {SOFT}=1000000.0: {SOFT} is 1000000 Pa: the weight of body block, 65,000 Pa where it is thickest, "),
    ],
)  # fmt: skip
def test_unintended_values_have_a_warning(thawslide: Program, plain_case: Path, words: list[str], start: str) -> None:
    """Each appears once, with location, value and remedy; `run` has the same warning."""
    words = [*sets(grid__cell=0.5, time__step=0.0005), *words]
    (reported,) = warnings_of(thawslide, plain_case, *words)
    assert reported.startswith(start.format(case=plain_case / "case.toml"))
    run = thawslide.ok("run", plain_case, "--output", plain_case.parent / "run", *sets(time__end=0.001), *words)
    assert f"warning: {reported}\n" in run


def test_the_example_of_the_how_to_page_has_no_warnings(thawslide: Program, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "how-to" / "write-a-2d-case.md").read_text()
    example = re.search(r"```toml\n( *\[case\]\n *title = \"A block on a slope\".*?)```", page, re.DOTALL)
    assert example
    (tmp_path / "case.toml").write_text(example[1])
    assert warnings_of(thawslide, tmp_path) == []


def test_the_estimated_disk_space_is_that_of_the_files(thawslide: Program, plain_case: Path) -> None:
    words = [*sets(grid__cell=0.1), *sets(time__step=0.0001, time__end=0.001, time__output_interval=0.001)]
    disk = thawslide.json("check", plain_case, *words)["disk"]
    run = plain_case.parent / "run"
    thawslide.ok("run", plain_case, "--output", run, *words)
    snapshot = (run / "snapshots" / "000001.vtkhdf").stat().st_size
    assert disk["snapshot_bytes"] == pytest.approx(snapshot, rel=0.02)
    assert disk["checkpoint_bytes"] == pytest.approx((run / "checkpoint.bin").stat().st_size, rel=0.02)
    assert disk["snapshots"] == len(list((run / "snapshots").iterdir()))


def test_a_run_that_fills_the_disk_has_a_warning(thawslide: Program, plain_case: Path) -> None:
    words = sets(time__output_interval="1e-9", grid__cell=0.5, time__stepping="adaptive")
    notes = warnings_of(thawslide, plain_case, *words)
    assert re.fullmatch(
        r"--set time\.output_interval=1e-9: time\.output_interval is 1e-09 s: that is 200,000,001 snapshots of "
        r"0\.0(59|6) MB, 12,000 GB; with all else 12,000 GB, and \S+ GB are free where runs/small is\. Make it larger, "
        r"or write to another disk \(--output\)\.",
        notes[-1],
    ), notes


@pytest.mark.parametrize("command", ["check", "run"])
def test_a_case_larger_than_memory_is_refused_at_once(thawslide: Program, plain_case: Path, command: str) -> None:
    """The limit is like that of batch systems; the proposed cell fits."""

    def outcome(cell: str) -> Outcome:
        words = [command, plain_case, *sets(grid__cell=cell, time__step=1e-7, time__end=1e-7)]
        words += ["--output", plain_case.parent / "run", "--overwrite"] if command == "run" else []
        return thawslide.shell('ulimit -v 3000000; exec "$@"', *words)

    refused = outcome("0.001")
    assert refused.returncode == 2 and refused.stdout == "" and not (plain_case.parent / "run").exists()
    found = re.fullmatch(
        r"error: --set grid\.cell=0\.001: grid\.cell is 0\.001 m, which makes 48,000,000 particles: the run needs "
        r"about 69 GB of memory \(particles 30 GB, writing them 38 GB\), and (\S+) GB are left by the bound of "
        r"ulimit -v\. Make grid\.cell (\S+) m or more, or particles_per_axis smaller\.\n",
        refused.stderr,
    )
    assert found, refused.stderr
    assert float(found[1]) < 3.0 and 0.001 < float(found[2]) < 0.02
    coarser = 0.01 if float(found[2]) <= 0.01 else 0.02
    assert outcome(str(coarser)).returncode == 0


VALLEY = ROOT / "cases" / "valley3d"


@pytest.mark.parametrize("modulus", [1e7, 1.2e7])
def test_the_advised_modulus_is_sufficient(thawslide: Program, small_case: Path, modulus: float) -> None:
    tall = sets(grid__max="[60,40]", body__block__max="[34,30]")
    text = thawslide.ok("check", small_case, *tall, *sets(material__rock__youngs_modulus=modulus))
    reported = re.search(r"compresses it by \d % there\. Give it (\S+) Pa or more\.\n", text)
    assert reported and float(reported[1]) > modulus, text
    printed = thawslide.ok("check", small_case, *tall, *sets(material__rock__youngs_modulus=reported[1]))
    assert "compresses it" not in printed


@pytest.mark.parametrize(("end", "steps", "rows"), [(0.2005, 200, 5), (0.2006, 201, 6), (0.2503, 250, 6)])
def test_reported_steps_hold(ran: Ran, thawslide: Program, small_case: Path, end: float, steps: int, rows: int) -> None:
    """A fixed step that would end more than half a step after the end is omitted."""
    reported = thawslide.json("check", small_case, *sets(time__end=end))
    run = ran(*sets(time__end=end))
    assert reported["steps"] == run_facts(run)["steps"] == steps
    assert reported["disk"]["snapshots"] == len(snapshot_files(run)) == rows


def test_the_reported_checkpoint_size_includes_maps_and_columns(ran: Ran, thawslide: Program) -> None:
    """Cells are coarse, so that particles are few; the first step creates the columns."""
    words = sets(grid__cell=40, maps__cell=10, body__slide__particles_per_axis=1, time__end=0.1)
    case = VALLEY / "columns.toml"
    after_spreading = thawslide.json("check", case, *words)["disk"]["checkpoint_bytes"]
    run = ran(*words, case=case)
    assert after_spreading > 2.0 * (run / "checkpoint.bin").stat().st_size
