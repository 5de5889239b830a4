"""Substrates of a case: the covered parts of the domain, the rest, and gaps."""

from __future__ import annotations

from pathlib import Path

from conftest import Program

GLACIER = """
[substrate.glacier]
x_min = 12.0
friction = "coefficient"
friction_coefficient = 0.12
"""
MORAINE = """
[substrate.moraine]
x_max = 5.0
friction = "constant"
friction_angle = 30.0
cohesion = 1000.0
cohesion_law = "bonds"
slip_distance = 5.0
"""


def test_check_lists_substrates_and_gaps(thawslide: Program, small_case: Path) -> None:
    case = small_case / "case.toml"
    case.write_text(case.read_text() + GLACIER + MORAINE)
    outcome = thawslide("check", small_case)
    assert outcome.returncode == 0, outcome.stderr
    assert (
        '  substrate   glacier: from x = 12 m on, 8 m or 40 % of the domain; friction "coefficient", no cohesion\n'
        "  substrate   moraine: up to x = 5 m, 5 m or 25 % of the domain; "
        'friction "constant", cohesion 1,000 Pa, "bonds"\n'
        '              elsewhere [basal], 35 % of the domain; friction "lubricated", no cohesion\n'
    ) in outcome.stdout


def test_gaps_are_reported_by_every_command_that_uses_the_base(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    case = small_case / "case.toml"
    case.write_text(case.read_text() + GLACIER + MORAINE)
    for words in (["check", case], ["run", case, "--output", tmp_path / "run"], ["block", case]):
        outcome = thawslide(*words)
        assert outcome.returncode == 0, outcome.stderr
        place = "between the substrates moraine and glacier, from x = 5 to 12 m"
        note = f"{place}, there is no substrate: [basal] applies there\n"
        assert outcome.stdout.count(f"warning: {note}") == 1, words


def test_check_does_not_mention_absent_substrates(thawslide: Program, small_case: Path) -> None:
    assert "substrate" not in thawslide("check", small_case).stdout


def test_overlaps_are_refused(thawslide: Program, small_case: Path) -> None:
    case = small_case / "case.toml"
    case.write_text(case.read_text() + GLACIER + MORAINE.replace("x_max = 5.0", "x_max = 13.0"))
    outcome = thawslide("check", small_case)
    assert outcome.returncode == 2
    assert "the substrates moraine and glacier overlap" in outcome.stderr


def test_a_run_has_the_friction_of_its_substrate(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    """A block on a tilted plane rests on rock and slides on ice; the resolved case contains the substrate."""
    words = ["--set", "case.gravity_tilt=15", "--set", "basal.friction_angle=30", "--set", "time.end=0.5"]
    distance = {}
    for name, text in (("rock", ""), ("ice", GLACIER.replace("12.0", "2.0"))):
        case = small_case / f"{name}.toml"
        case.write_text((small_case / "case.toml").read_text() + text)
        run = tmp_path / name
        outcome = thawslide("run", case, "--output", run, *words)
        assert outcome.returncode == 0, outcome.stderr
        header, *_, last = (run / "history.csv").read_text().splitlines()
        distance[name] = float(last.split(",")[header.split(",").index("mean_displacement_m")])
    assert distance["ice"] > 0.1
    assert distance["rock"] < 0.02
    assert "[substrate.glacier]\nx_min = 2.0  # m\n" in (tmp_path / "ice" / "case.toml").read_text()
