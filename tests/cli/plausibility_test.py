"""Plausibility warnings of `check` and `run` about valid cases, and facts of `check`, as text and as JSON."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT, Program, sets

# Additions to the small case that avoid all warnings.
BAND = '\n[band]\nmodel = "scaled"\nthickness = 0.2\n'
LID = '\n[body.lid]\nmaterial = "rock"\nmin = [10.0, 3.0]\nmax = [14.0, 6.0]\ntemperature = -10.0\nporosity = 0.3\n'
CASES = sorted((ROOT / "cases").glob("*/*.toml"))
USER_DATA = {"alr", "fluchthorn"}  # need terrain of the user


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


def test_a_plain_case_has_no_warnings(thawslide: Program, plain_case: Path) -> None:
    assert warnings_of(thawslide, plain_case, "--set", "grid.cell=0.5") == []


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.parent.name}/{case.stem}")
def test_the_cases_of_the_project_have_only_the_known_warnings(thawslide: Program, case: Path) -> None:
    if case.parent.name in USER_DATA:
        pytest.skip("the case needs data that are not in the repository")
    notes = re.findall(r"^warning: (.*)$", thawslide("check", case).stdout, re.MULTILINE)
    expected = []
    if case.parent.name == "valley3d":
        if case.stem in ("columns", "weak"):  # their bodies are weaker than the base
            expected.append("the base is stronger than the broken material of body slide (shear strength 0.")
        expected.append("too few cells for maps of thickness and area (found 4.5; needed 8). Set grid.cell to 10 m, ")
    assert len(notes) == len(expected), notes
    assert all(words in note for words, note in zip(expected, notes, strict=True)), notes


COARSE = (
    "{case}:11:8: grid.cell: across the median thickness of body block, 1.5 m, there are too few particles to resolve "
    "shear and thinning (found 3; needed 4). Set grid.cell to 0.5 m, at about 8 times the run time."
)


@pytest.mark.parametrize(
    ("words", "note"),
    [
        (
            sets(body__block__min="[10.0,2.0]", body__block__max="[14.0,5.0]"),
            "{case}:27:1: body.block floats: its underside is 2 m above what is below it, and it falls for 0.64 s "
            'before it touches. Place it on that, or set shape = "surface" or "release", which follow the ground.',
        ),
        (
            sets(terrain__type="none"),
            '{case}:27:1: body.block has nothing below it: terrain.type is "none" and the lower side of the domain is '
            "open, so it falls out of the domain. Set terrain.type, or close the lower side.",
        ),
        (
            sets(terrain__type="plane", terrain__slope=40, terrain__elevation=8.39),
            "{case}:27:1: body.block rests on 6.2 % of its area; the gap below the rest is at least 0.25 m, one "
            "particle spacing. "
            'Use a shape that follows the terrain: shape = "surface", "release", or a polygon.',
        ),
        (sets(body__block__max="[14.0,1.5]"), COARSE),
        (
            sets(band__thickness=5),
            "--set band.thickness=5: band.thickness is 5 m: more than the body block, 3 m thick in the median. The "
            "band is the part of a slide that shears at its base: typical values are 0.01 to 2 m.",
        ),
        (
            sets(material__rock__youngs_modulus=1e6, time__step=0.001),
            "--set material.rock.youngs_modulus=1000000.0: material.rock.youngs_modulus is 1000000 Pa: the weight of "
            "body block, 65,000 Pa where it is thickest, compresses it by 6 % there. Give it 2e+06 Pa or more.",
        ),
        (
            sets(material__rock__youngs_modulus=0.5),
            "--set material.rock.youngs_modulus=0.5: material.rock.youngs_modulus is 0.5 Pa: too soft: the slide "
            "collapses under its own weight. Typical values for broken rock and ice are 1e7 Pa or more.",
        ),
        (
            sets(basal__friction_angle=0.4),
            "--set basal.friction_angle=0.4: basal.friction_angle is 0.4 degrees: was a coefficient meant? Angles are "
            'in degrees; for a coefficient set friction = "coefficient" and friction_coefficient.',
        ),
        (
            sets(body__block__temperature=5),
            "--set body.block.temperature=5: body.block.temperature is 5 C: its pores contain water and no ice from "
            "the start. Was a temperature below 0 meant?",
        ),
        (
            sets(time__output_interval=100),
            "--set time.output_interval=100: time.output_interval is 100 s: longer than the run of 0.2 s, which leaves "
            "only the first and the last snapshot.",
        ),
    ],
)
def test_probably_unintended_values_have_a_warning(
    thawslide: Program, plain_case: Path, words: list[str], note: str
) -> None:
    """Each appears once, with location, value and remedy; `run` has the same warning."""
    cell = [] if note == COARSE else sets(grid__cell=0.5)
    words = [*cell, *sets(time__step=0.0005), *words]
    reported = note.format(case=plain_case / "case.toml")
    assert warnings_of(thawslide, plain_case, *words) == [reported]
    run = thawslide("run", plain_case, "--output", plain_case.parent / "run", *sets(time__end=0.001), *words)
    assert f"warning: {reported}\n".replace("0.2 s, which", "0.001 s, which") in run.stdout


def test_the_example_of_the_how_to_page_has_no_warnings(thawslide: Program, tmp_path: Path) -> None:
    page = (ROOT / "docs" / "how-to" / "write-a-2d-case.md").read_text()
    example = re.search(r"```toml\n( *\[case\]\n *title = \"A block on a slope\".*?)```", page, re.DOTALL)
    assert example
    (tmp_path / "case.toml").write_text(example[1])
    assert warnings_of(thawslide, tmp_path) == []


def test_a_body_on_a_body_does_not_float(thawslide: Program, plain_case: Path) -> None:
    file = plain_case / "case.toml"
    file.write_text(file.read_text() + LID)
    assert warnings_of(thawslide, plain_case, "--set", "grid.cell=0.5", "--set", "time.step=0.0005") == []
    lifted = sets(
        body__lid__min="[10.0,5.0]",
        body__lid__max="[14.0,8.0]",
        grid__cell=0.5,
        time__step=0.0005,
        contact__between_bodies="bonded",
    )
    (note,) = warnings_of(thawslide, plain_case, *lifted)
    assert "body.lid floats: its underside is " in note


def test_a_closed_side_of_the_domain_supports_a_body(thawslide: Program, plain_case: Path) -> None:
    words = sets(
        terrain__type="none", grid__boundary__y_min="roller", grid__min="[0.0,0.0]", grid__cell=0.5, time__step=0.0005
    )
    assert warnings_of(thawslide, plain_case, *words) == []


def test_zero_drainage_by_default_has_a_warning(thawslide: Program, small_case: Path) -> None:
    file = small_case / "case.toml"
    file.write_text(file.read_text() + '\n[band]\nmodel = "columns"\nthickness = 0.2\n')
    note = (
        f"warning: {file}: material.rock.hydraulic_conductivity is 0 m/s, its default: pore water cannot drain, and "
        "the avalanche may never stop. Typical values at the base are 1e-8 to 1e-5 m/s. Set a value, or set 0 "
        "explicitly to silence this warning.\n"
    )
    run = thawslide("run", small_case, "--output", small_case.parent / "run", *sets(time__end=0.01))
    assert note in run.stdout and note in thawslide("check", small_case).stdout
    assert note not in thawslide("check", small_case, *sets(material__rock__hydraulic_conductivity=0)).stdout


def test_json_contains_the_facts_of_the_text(thawslide: Program, plain_case: Path) -> None:
    reported = json.loads(thawslide("check", plain_case, "--json").stdout)
    (body,) = reported["bodies"]
    # 4 m x 3 m on cells of 1 m; 70 % rock and 30 % ice are 2200.1 kg/m3, with little water.
    assert body["name"] == "block" and body["particles"] == reported["particles"] == 48
    assert body["volume_m3"] == pytest.approx(12.0, rel=1e-12) and body["area_m2"] == pytest.approx(4.0, rel=1e-12)
    assert body["mass_kg"] == pytest.approx(12.0 * 2200.1, rel=1e-6)
    assert body["mean_thickness_m"] == body["median_thickness_m"] == body["max_thickness_m"] == 3.0
    assert body["spacing_m"] == 0.5 and body["particles_across"] == 6.0
    assert body["clearance_m"] == pytest.approx(0.0, abs=1e-12) and body["resting_fraction"] == 1.0
    assert body["coldest_C"] == body["warmest_C"] == -10.0
    assert reported["cells"] == 240 and reported["steps"] == 200 and reported["step_s"] == 0.001
    assert reported["memory"]["particles_bytes"] == 48 * 631 and reported["memory"]["available_bytes"] > 1e6
    disk = reported["disk"]
    assert disk["snapshots"] == 5 and disk["history_rows"] == 21 and disk["checkpoints"] == 3
    assert disk["need_bytes"] == pytest.approx(
        5 * disk["snapshot_bytes"] + 3 * disk["checkpoint_bytes"] + disk["history_bytes"] + disk["inputs_bytes"]
    )
    assert disk["checkpoint_bytes"] == disk["checkpoint_bytes_at_start"]  # no part of it grows with the slide


def test_the_estimated_disk_space_is_that_of_the_files(thawslide: Program, plain_case: Path) -> None:
    words = [*sets(grid__cell=0.1), *sets(time__step=0.0001, time__end=0.001, time__output_interval=0.001)]
    disk = json.loads(thawslide("check", plain_case, "--json", *words).stdout)["disk"]
    run = plain_case.parent / "run"
    assert thawslide("run", plain_case, "--output", run, *words).returncode == 0
    snapshot = (run / "snapshots" / "000001.vtkhdf").stat().st_size
    assert disk["snapshot_bytes"] == pytest.approx(snapshot, rel=0.02)
    assert disk["checkpoint_bytes_at_start"] == pytest.approx((run / "checkpoint.bin").stat().st_size, rel=0.02)
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
def test_a_case_larger_than_memory_is_refused_at_once(
    binary: Path, plain_environment: dict[str, str], plain_case: Path, command: str
) -> None:
    """The limit is like that of batch systems; the proposed cell fits."""

    def outcome(cell: str) -> subprocess.CompletedProcess[str]:
        words = [str(binary), command, str(plain_case), *sets(grid__cell=cell, time__step=1e-7, time__end=1e-7)]
        words += ["--output", str(plain_case.parent / "run"), "--overwrite"] if command == "run" else []
        limited = ["bash", "-c", 'ulimit -v 3000000; exec "$@"', "bash", *words]
        return subprocess.run(limited, env=plain_environment, capture_output=True, text=True, timeout=60, check=False)

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


def test_an_error_on_the_step_names_modulus_and_density(thawslide: Program, plain_case: Path) -> None:
    outcome = thawslide("check", plain_case, *sets(phases__rock_density=2.75, time__step=0.002))
    assert outcome.returncode == 2 and "time.step is 0.002 s, above the limit of" in outcome.stderr
    assert "with a Young's modulus of 1e+08 Pa and 277 kg/m3. Use a smaller time.step" in outcome.stderr
