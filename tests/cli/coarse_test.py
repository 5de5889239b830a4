"""`--coarse`: a trial on cells, steps and map cells of twice the size, in its own folder."""

import tomllib
from pathlib import Path

from conftest import Program, edit, run_facts


def test_a_trial_has_double_cells_and_steps_in_its_own_folder(thawslide: Program, small_case: Path) -> None:
    case = tomllib.loads((small_case / "case.toml").read_text())
    thawslide.ok("run", small_case, "--coarse", "--end", "0.05", folder=small_case)
    (run,) = (small_case / "runs").iterdir()
    assert run.name == f"{small_case.name}-coarse"
    resolved = tomllib.loads((run / "case.toml").read_text())
    assert resolved["grid"]["cell"] == 2.0 * case["grid"]["cell"]
    assert resolved["time"]["step"] == 2.0 * case["time"]["step"]
    assert run_facts(run)["steps"] == round(0.05 / resolved["time"]["step"])


def test_check_reports_the_trial(thawslide: Program, small_case: Path) -> None:
    whole = thawslide.json("check", small_case)
    trial = thawslide.json("check", small_case, "--coarse")
    assert trial["particles"] == whole["particles"] / 4
    assert trial["steps"] == whole["steps"] / 2


def test_a_trial_of_another_cell_is_refused(thawslide: Program, small_case: Path) -> None:
    message = thawslide.error("run", small_case, "--coarse", "--set", "grid.cell=0.5")
    assert message == "error: --coarse sets grid.cell: omit --coarse, or --set grid.cell.\n"
    message = thawslide.error("run", small_case, "--coarse", "--pair")
    assert message == "error: --pair runs the case on coarse cells, too: omit --coarse.\n"


def test_a_trial_keeps_a_given_step(thawslide: Program, small_case: Path) -> None:
    trial = thawslide.json("check", small_case, "--coarse", "--set", "time.step=0.001")
    assert trial["steps"] == thawslide.json("check", small_case, "--set", "time.step=0.001")["steps"]


def test_a_trial_of_adaptive_steps_has_no_upper_limit_of_the_step(thawslide: Program, small_case: Path) -> None:
    edit(small_case / "case.toml", "step = 0.001", 'stepping = "adaptive"')
    words = ("check", small_case, "--set", "time.end=9")
    assert "time.step" not in thawslide.ok(*words, "--coarse")
    given = thawslide.ok(*words, "--coarse", "--set", "time.step=0.8")
    assert "warning: --set time.step=0.8: time.step is 0.8 s" in given
    edit(small_case / "case.toml", 'stepping = "adaptive"', 'stepping = "adaptive"\nstep = 0.4')
    trial = thawslide.ok(*words, "--coarse")
    assert "warning: --coarse: time.step is 0.8 s" in trial and "warning: --coarse: grid.cell: across" in trial


def test_an_error_of_a_trial_names_no_option_that_was_not_given(thawslide: Program, small_case: Path) -> None:
    message = thawslide.error("check", small_case, "--coarse", "--set", "grid.max=[21.0, 10.0]")
    assert message.startswith("error: --coarse, which sets cells of 2 m: ") and "--set grid.cell" not in message
