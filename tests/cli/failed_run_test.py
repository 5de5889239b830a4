"""Runs that fail: exit code 3, particle, position, time and likely cause in the message; the last state is written."""

from __future__ import annotations

import re
from pathlib import Path

import h5py
import pytest
from conftest import LAMPLUGH, Program, history, run_facts, sets, snapshot_files

PATTERN = (
    r"error: the run failed at t = (\S+) s \(step (\d+)\): particle (\d+) of body '(\w+)' at \((\S+), (\S+)\) m: "
    r"(.*?)\. (?:It moves at \S+ m/s, the slide at \S+ m/s on average\. )?Likely cause: (.*)\n"
)


def expect_failure(thawslide: Program, case: Path, run: Path, *words: str) -> re.Match[str]:
    """Run a case that must fail, check its files, and return the match of the message."""
    outcome = thawslide("run", case, "--output", run, *words)
    assert outcome.returncode == 3, outcome.stderr
    reported = re.fullmatch(PATTERN, outcome.stderr)
    assert reported, outcome.stderr
    time, step, particle = float(reported[1]), int(reported[2]), int(reported[3])
    facts = run_facts(run)
    assert facts["status"] == "failed"
    assert f"error: {facts['message']}\n" == outcome.stderr
    assert facts["simulated_time_s"] == pytest.approx(time, rel=1e-5) and facts["steps"] == step
    columns = history(run)
    assert columns["step"][-1] == step and columns["time_s"][-1] == pytest.approx(time, rel=1e-5)
    with h5py.File(snapshot_files(run)[-1]) as last:
        assert last["VTKHDF"].attrs["step"] == step
        place = last["VTKHDF/Points"][particle]
        assert last["VTKHDF/PointData/id"][particle] == particle
    assert place[:2] == pytest.approx([float(reported[5]), float(reported[6])], rel=1e-4)
    with h5py.File(run / "particles.vtkhdf") as index:
        assert index["VTKHDF/Steps"].attrs["NSteps"] == len(snapshot_files(run))
    assert not (run / "checkpoint.previous.bin").exists(), "only the one before the first step"
    return reported


def test_a_body_that_leaves_the_domain_upward_fails_the_run(thawslide: Program, tmp_path: Path) -> None:
    reported = expect_failure(
        thawslide, LAMPLUGH, tmp_path / "run", *sets(time__end=20, body__slide__velocity="[0,300]")
    )
    # The highest surface, 2146 m, rises 254 m at 300 m/s less gravity: about 0.87 s to the top of the domain at 2400 m.
    assert 0.8 < float(reported[1]) < 0.95
    assert reported[4] == "slide" and 2390.0 < float(reported[6]) < 2400.0
    assert reported[7] == "it left the domain"
    assert reported[8] == "the slide ran further than [grid] min and max allow; widen them in its direction."


def test_a_material_too_soft_for_its_weight_is_named_as_cause(thawslide: Program, tmp_path: Path) -> None:
    reported = expect_failure(
        thawslide, LAMPLUGH, tmp_path / "run", *sets(time__end=20, material__rock_ice__youngs_modulus=0.5)
    )
    assert reported[8] == (
        "material 'rock_ice' is too soft (youngs_modulus 0.5 Pa) and collapses under its own weight. Typical values "
        "for broken rock and ice are 1e7 Pa or more."
    )


def test_a_domain_too_short_for_the_slide_fails_the_run(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    reported = expect_failure(
        thawslide, small_case, tmp_path / "run", *sets(time__end=1, body__block__velocity="[30,0]")
    )
    assert reported[4] == "block" and 19.9 < float(reported[5]) < 20.0
    assert reported[7] == "it left the domain"


def test_a_time_step_too_long_for_the_load_is_named_as_cause(
    thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    # A fall at 1e5 m/s2 is too fast for a step of 4 ms; this is not visible at the start.
    fall = [
        *sets(time__step=0.004, case__gravity=1e5, mechanics__initial_stress='"none"'),
        *sets(body__block__min="[10,4]", body__block__max="[14,8]"),
    ]
    outcome = thawslide("run", small_case, "--output", tmp_path / "guarded", *fall)
    assert outcome.returncode == 3
    assert re.fullmatch(
        r"error: the run failed at t = \S+ s \(step \d+\): energy grew by \S+ J per m of width without a "
        r"physical cause, \S+ % of all energy so far \(guards\.energy_growth allows 25 %\)\. The fastest "
        r"particle, \d+ of body 'block' at "
        r"\(\S+, \S+\) m, moves at \S+ m/s, the slide at \S+ m/s on average\. Likely cause: the step is too long for "
        r"the material, the material is too soft for its load, or it has separated\. Try half of "
        r"time\.step, a viscosity_time in the material, or mechanics\.transfer = \"blend\" with "
        r"mechanics\.pic_fraction = 0\.02\.\n",
        outcome.stderr,
    ), outcome.stderr
    reported = expect_failure(thawslide, small_case, tmp_path / "run", *fall, *sets(guards__energy_growth="inf"))
    assert reported[7] == "its volume ratio is not positive"
    assert reported[8].startswith("the step is too long for the material")
