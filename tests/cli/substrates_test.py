"""Substrates of a case and sections of varying width: facts of check, gaps, overlaps, and what a run uses."""

from pathlib import Path

from conftest import ROOT, Program, Ran, history
from terrain_files import toml

GLACIER = toml("""
[substrate.glacier] x_min = 12.0 | friction = "coefficient" | friction_coefficient = 0.12
""")
MORAINE = toml("""
[substrate.moraine] x_max = 5.0 | friction = "constant" | friction_angle = 30.0 | cohesion = 1000.0
  cohesion_law = "bonds" | slip_distance = 5.0
""")


def test_areas_of_the_ground_and_gaps_are_reported(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    case = small_case / "case.toml"
    assert "substrate" not in thawslide.ok("check", small_case)
    case.write_text(case.read_text() + GLACIER + MORAINE)
    printed = thawslide.ok("check", small_case)
    assert (
        '  substrate   glacier: from x = 12 m on, 8 m or 40 % of the domain; friction "coefficient", no cohesion\n'
        "  substrate   moraine: up to x = 5 m, 5 m or 25 % of the domain; "
        'friction "constant", cohesion 1,000 Pa, "bonds"\n'
        '              elsewhere [basal], 35 % of the domain; friction "lubricated", no cohesion\n'
    ) in printed
    for words in (["check", case], ["run", case, "--output", tmp_path / "run"], ["block", case]):
        printed = thawslide.ok(*words)
        place = "between the substrates moraine and glacier, from x = 5 to 12 m"
        note = f"{place}, there is no substrate: [basal] applies there\n"
        assert printed.count(f"warning: {note}") == 1, words


def test_overlaps_are_refused(thawslide: Program, small_case: Path) -> None:
    case = small_case / "case.toml"
    case.write_text(case.read_text() + GLACIER + MORAINE.replace("x_max = 5.0", "x_max = 13.0"))
    assert "the substrates moraine and glacier overlap" in thawslide.error("check", small_case)


def test_a_run_has_the_friction_of_its_substrate(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    words = ["--set", "case.gravity_tilt=15", "--set", "basal.friction_angle=30", "--set", "time.end=0.5"]
    distance = {}
    for name, text in (("rock", ""), ("ice", GLACIER.replace("12.0", "2.0"))):
        case = small_case / f"{name}.toml"
        case.write_text((small_case / "case.toml").read_text() + text)
        run = tmp_path / name
        thawslide.ok("run", case, "--output", run, *words)
        distance[name] = history(run)["mean_displacement_m"][-1]
    assert distance["ice"] > 0.1
    assert distance["rock"] < 0.02
    assert "[substrate.glacier]\nx_min = 2.0  # m\n" in (tmp_path / "ice" / "case.toml").read_text()


WIDE = ROOT / "cases" / "lamplugh-columns" / "wide-valley.toml"


def test_check_states_the_reference_width_of_values_per_metre(thawslide: Program) -> None:
    printed = thawslide.ok("check", WIDE)
    assert "slide: 84,300 m3 and 174,000 t per metre of the width at x = 2190 m, along 1,050 m; " in printed
    assert "case.width" not in printed, "1,883 m over 2 km is no reason to warn"
    printed = thawslide.ok("check", WIDE, "--set", "case.width={ x = [2190.0, 3190.0], value = [617.0, 2500.0] }")
    lateral = "The neglected lateral motion would have 0.3 of the kinetic energy there."
    assert f"it changes by 1.9 m per m. {lateral}" in printed


def test_resolved_case_of_a_run_has_the_width_and_resume_keeps_it(ran: Ran, thawslide: Program, tmp_path: Path) -> None:
    folder = ran("--set", "time.end=0.1", "--threads", "1", case=WIDE, name="wide")
    resolved = (folder / "case.toml").read_text(encoding="utf-8")
    assert "\nwidth = { x = [2190.0, 4190.0], value = [617.0, 2500.0] }  # m\n" in resolved
    ran("--threads", "1", case=folder, name="again")
    assert (folder / "history.csv").read_bytes() == (tmp_path / "again" / "history.csv").read_bytes()
    message = thawslide.error("resume", folder, "--set", "time.end=0.2", "--set", "case.width=617.0")
    assert "error: case.width cannot be changed on resume" in message
    thawslide.ok("resume", folder, "--set", "time.end=0.2", "--threads", "1")


def test_block_has_one_width(thawslide: Program) -> None:
    message = thawslide.error("block", WIDE)
    assert message.endswith(
        "wide-valley.toml:6:9: the block model has one width. Give case.width as a number, or use `thawslide run`.\n"
    )
