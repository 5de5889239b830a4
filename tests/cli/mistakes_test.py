"""Mistakes in a case: exit code 2, a message with location, value and remedy, and no output files."""

from __future__ import annotations

from pathlib import Path

import pytest
from common_mistakes import COMMON_MISTAKES, CommonMistake
from conftest import LAMPLUGH, SMALL_CASE, Program, sets


def refused(thawslide: Program, case: Path, *words: str) -> str:
    """Return the error message for an invalid case."""
    run = case.parent / "run-of-a-mistake"
    outcome = thawslide("run", case, "--output", run, *words)
    assert outcome.returncode == 2, outcome.stderr
    assert outcome.stdout == "" and not run.exists()
    assert outcome.stderr.startswith("error: ")
    return outcome.stderr


def edited(case: Path, old: str, new: str) -> Path:
    """Replace one text in the case file; return the file."""
    file = case / "case.toml"
    text = file.read_text()
    assert text.count(old) == 1
    file.write_text(text.replace(old, new))
    return file


def line_of(file: Path, start: str) -> int:
    return 1 + next(k for k, line in enumerate(file.read_text().splitlines()) if line.startswith(start))


@pytest.mark.parametrize("mistake", COMMON_MISTAKES, ids=lambda mistake: mistake.name)
def test_common_mistakes_have_their_message(thawslide: Program, small_case: Path, mistake: CommonMistake) -> None:
    mistake.write(SMALL_CASE, small_case)
    assert refused(thawslide, small_case) == mistake.message.replace("{case}", str(small_case))


def test_there_are_twenty_common_mistakes() -> None:
    assert len({mistake.name for mistake in COMMON_MISTAKES}) == 20


def test_a_missing_case_has_a_suggestion(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case.parent / "smal")
    assert "smal: there is no such file or folder; did you mean 'small'?" in text


def test_a_folder_without_case_is_refused(thawslide: Program, small_case: Path) -> None:
    (small_case / "case.toml").rename(small_case / "first.toml")
    assert "the folder has no case.toml. Give one of its case files: first.toml." in refused(thawslide, small_case)


def test_an_empty_file_is_refused(thawslide: Program, small_case: Path) -> None:
    (small_case / "case.toml").write_text("")
    text = refused(thawslide, small_case)
    assert (
        "case.toml:1:1: the file is empty; a case has at least [time], [grid], [material.NAME] and [body.NAME]" in text
    )


def test_invalid_toml_is_located(thawslide: Program, small_case: Path) -> None:
    file = edited(small_case, "cell = 1.0", "cell = = 1.0")
    assert f"{file}:{line_of(file, 'cell')}:8: this is not TOML" in refused(thawslide, small_case)


def test_a_wrong_type_is_located(thawslide: Program, small_case: Path) -> None:
    file = edited(small_case, "end = 0.2", 'end = "soon"')
    text = refused(thawslide, small_case)
    assert f'{file}:{line_of(file, "end")}:7: time.end is the text "soon"; allowed: a number, > 0 [s]' in text


def test_an_unknown_key_has_a_suggestion(thawslide: Program, small_case: Path) -> None:
    file = edited(small_case, "youngs_modulus", "young_modulus")
    text = refused(thawslide, small_case)
    assert f"{file}:{line_of(file, 'young_modulus')}:1: " in text
    assert "key 'material.rock.young_modulus' is not known in [material.rock]; did you mean 'youngs_modulus'?" in text


def test_a_former_key_is_accepted_with_a_note(thawslide: Program, small_case: Path) -> None:
    file = edited(small_case, "elevation = 0.0", 'elevation = 0.0\ndescription = "rigid_points"')
    outcome = thawslide("check", small_case)
    assert outcome.returncode == 0, outcome.stderr
    line = line_of(file, "description")
    note = f"note: {file}:{line}:15: key 'terrain.description' is called 'terrain.representation' now\n"
    assert note in outcome.stdout


def test_a_dem_in_two_dimensions_is_refused(thawslide: Program, small_case: Path) -> None:
    (small_case / "dem.asc").write_text("")
    edited(small_case, 'type = "flat"\nelevation = 0.0', 'type = "dem"\nfile = "dem.asc"')
    text = refused(thawslide, small_case)
    assert "Set case.dimension = 3, or cut a 2D case out of the DEM with `thawslide section`." in text


def test_a_key_without_effect_is_refused(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(body__block__taper=5))
    assert text == (
        'error: --set body.block.taper=5: body.block.taper has a meaning only when the shape is "release". Remove it, '
        "or change body.block.shape.\n"
    )


def test_an_unknown_table_has_a_suggestion(thawslide: Program, small_case: Path) -> None:
    edited(small_case, "[terrain]", "[terain]")
    assert "table [terain] is not known; did you mean 'terrain'?" in refused(thawslide, small_case)


def test_every_problem_is_reported_at_once(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(time__end=-1, body__block__porosity=2, time__stp=1))
    assert "time.end is -1" in text and "body.block.porosity is 2" in text and "did you mean 'step'?" in text


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("phases__rock_density", -5, "phases.rock_density is -5; allowed: > 0 kg/m3"),
        ("body__block__porosity", 1, "body.block.porosity is 1; allowed: > 0 and <= 0.95"),
        ("body__block__temperature", -300, "-300; allowed: > -273.15"),
        ("body__block__material", '"ice"', "body.block.material is 'ice', and there is no [material.ice]"),
        ("material__rock__poisson_ratio", 0.5, "material.rock.poisson_ratio is 0.5; allowed: "),
        ("time__end", "nan", "time.end is nan"),
    ],
)
def test_a_value_out_of_range_is_refused(
    thawslide: Program, small_case: Path, key: str, value: object, words: str
) -> None:
    text = refused(thawslide, small_case, *sets(**{key: value}))
    assert f"--set {key.replace('__', '.')}={value}" in text
    assert words in text


def test_a_domain_of_fractional_cells_is_refused(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(grid__cell=0.8, grid__max="[20.0,10.1]"))
    assert "the domain is 12.1 m long along y, which is 15.125 cells of 0.8 m; allowed: a whole number." in text
    assert "along x" not in text


def test_set_without_a_value_is_refused(thawslide: Program, small_case: Path) -> None:
    assert "--set time.end: allowed: TABLE.KEY=VALUE" in refused(thawslide, small_case, "--set", "time.end")


def test_a_profile_that_folds_back_is_refused(thawslide: Program, small_case: Path) -> None:
    profile = small_case / "profile.csv"
    profile.write_text("distance_m,terrain_elevation_m\n0,0\n10,0\n9,0\n20,0\n")
    edited(small_case, 'type = "flat"\nelevation = 0.0', 'type = "profile"\nfile = "profile.csv"')
    text = refused(thawslide, small_case)
    assert f"{profile}:4: the profile folds back: distance_m is 9 after 10; allowed: strictly increasing" in text


def test_a_file_outside_the_folder_of_the_case_is_refused(thawslide: Program, small_case: Path) -> None:
    (small_case.parent / "profile.csv").write_text("distance_m,terrain_elevation_m\n0,0\n20,0\n")
    edited(small_case, 'type = "flat"\nelevation = 0.0', 'type = "profile"\nfile = "../profile.csv"')
    assert "terrain.file" in refused(thawslide, small_case)


def test_a_body_below_the_terrain_is_refused(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(body__block__min="[10.0,-1.0]"))
    assert "body.block is below the terrain: at x = 10 m its elevation is -1 m and the ground's 0 m" in text


def test_a_body_outside_the_domain_is_refused(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(body__block__max="[24.0,3.0]"))
    assert "body.block reaches from (10, 0) to (24, 3), outside the domain, which is (0, -2) to (20, 10)" in text


def test_lamplugh_in_a_domain_that_ends_inside_the_body_is_refused(thawslide: Program, tmp_path: Path) -> None:
    outcome = thawslide("run", LAMPLUGH, "--output", tmp_path / "run", *sets(grid__max="[1000.0,2400.0]"))
    assert outcome.returncode == 2
    assert "body.slide reaches from" in outcome.stderr and "outside the domain" in outcome.stderr


def test_a_step_above_the_limit_has_the_limit(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(time__step=0.01))
    # 1e8 Pa (1 - nu) / ((1 + nu) (1 - 2 nu)) over 2200.1 kg/m3 of 70 % rock and 30 % ice is a wave of 224.7 m/s: over
    # cells of 1 m 0.00445 s.
    assert "time.step is 0.01 s, above the limit of 0.00444 s set by the elastic wave of material 'rock'" in text
    material = "with a Young's modulus of 1e+08 Pa and 2,200 kg/m3"
    assert f'(225 m/s) on cells of 1 m, {material}. Use a smaller time.step, or time.stepping = "adaptive".' in text


def test_a_step_above_the_limit_of_the_particle_speed_is_refused(thawslide: Program, small_case: Path) -> None:
    text = refused(thawslide, small_case, *sets(body__block__velocity="[1000.0,0.0]"))
    assert "time.step is 0.001 s, above the limit of 0.0005 s set by the particle speed of 1,000 m/s" in text
