"""Sections whose width varies along x: facts of check, and errors of resume and block."""

from __future__ import annotations

from pathlib import Path

from conftest import Program

ROOT = Path(__file__).resolve().parents[2]
WIDE = ROOT / "cases" / "lamplugh-columns" / "wide-valley.toml"


def test_check_states_the_reference_width_of_values_per_metre(thawslide: Program) -> None:
    outcome = thawslide("check", WIDE)
    assert outcome.returncode == 0, outcome.stderr
    assert "slide: 84,300 m3 and 174,000 t per metre of the width at x = 2190 m, along 1,060 m; " in outcome.stdout
    assert "case.width" not in outcome.stdout, "1,883 m over 2 km is no reason to warn"
    steep = thawslide("check", WIDE, "--set", "case.width={ x = [2190.0, 3190.0], value = [617.0, 2500.0] }")
    assert steep.returncode == 0, steep.stderr
    assert (
        "it changes by 1.9 m per m. The neglected lateral motion would have 0.3 of the kinetic energy there."
        in steep.stdout
    )


def test_resolved_case_of_a_run_has_the_width_and_resume_keeps_it(thawslide: Program, tmp_path: Path) -> None:
    folder = tmp_path / "wide"
    started = thawslide("run", WIDE, "--output", folder, "--set", "time.end=0.1", "--threads", "1")
    assert started.returncode == 0, started.stderr
    resolved = (folder / "case.toml").read_text(encoding="utf-8")
    assert "\nwidth = { x = [2190.0, 4190.0], value = [617.0, 2500.0] }  # m\n" in resolved
    again = thawslide("run", folder, "--output", tmp_path / "again", "--threads", "1")
    assert again.returncode == 0, again.stderr
    assert (folder / "history.csv").read_bytes() == (tmp_path / "again" / "history.csv").read_bytes()
    changed = thawslide("resume", folder, "--set", "time.end=0.2", "--set", "case.width=617.0")
    assert changed.returncode == 2
    assert "error: case.width cannot be changed on resume" in changed.stderr
    longer = thawslide("resume", folder, "--set", "time.end=0.2", "--threads", "1")
    assert longer.returncode == 0, longer.stderr


def test_block_has_one_width(thawslide: Program) -> None:
    outcome = thawslide("block", WIDE)
    assert outcome.returncode == 2
    assert outcome.stderr.endswith(
        "wide-valley.toml:6:9: the block model has one width. Give case.width as a number, or use `thawslide run`.\n"
    )
