"""Commands version, describe, check, block, report and scarp, invalid commands, and the option --device."""

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import HANG, LAMPLUGH, ROOT, Outcome, Program, Ran, Slope, columns_of, run_facts, sets
from terrain_files import CELL, COLUMNS, ROWS, SOUTH, WEST, write_rectangle

PNG = b"\x89PNG\r\n\x1a\n"


def test_version_names_version_commit_and_compiler(thawslide: Program) -> None:
    printed = thawslide.ok("version")
    assert re.fullmatch(r"thawslide \d+\.\d+\.\d+ \(commit \S+, (g\+\+|clang) \d.*\)\n", printed)
    assert thawslide.ok("--version") == printed


@pytest.mark.parametrize("words", ["", "slide", "run", "check x --colour", "run x --threads 0", "describe --json --md"])
def test_invalid_arguments_exit_with_2_and_refer_to_help(thawslide: Program, words: str) -> None:
    assert "Run with --help for more information." in thawslide.error(*words.split())


def test_a_misspelt_command_has_a_suggestion(thawslide: Program) -> None:
    assert "there is no command 'rum'; did you mean 'run'?" in thawslide.error("rum", quiet=True)


def test_describe_names_each_key_and_has_a_markdown_page_and_a_schema(thawslide: Program) -> None:
    printed = thawslide.ok("describe")
    assert "[time]" in printed and "[material.NAME]" in printed
    assert re.search(r"gravity +gravitational acceleration \[m/s2\]\n.*default: 9\.81", printed)
    printed = thawslide.ok("describe", "--md")
    assert printed.startswith("# The case file\n")
    assert "| `gravity` | m/s2 |" in printed
    assert {"[case]", "[material.NAME]"} <= {table["table"] for table in json.loads(thawslide.ok("describe", "--json"))}
    schema = json.loads(thawslide.ok("describe", "--schema"))
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert schema["properties"]["time"]["properties"]["end"]["type"] == "number"


def test_check_plots(thawslide: Program, report_environment: dict[str, str], small_case: Path, tmp_path: Path) -> None:
    (small_case / "stiff.toml").write_text('[case]\nbased_on = "case.toml"\n')
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    for case, words, file in (
        (small_case, ["out.png"], elsewhere / "out.png"),
        (small_case, [], small_case / "setup.png"),
        (small_case / "stiff.toml", [], small_case / "stiff-setup.png"),
    ):
        printed = thawslide.ok("check", case, "--picture", *words, environment=report_environment, folder=elsewhere)
        assert file.read_bytes().startswith(PNG)
        assert printed.endswith(f"  picture     {words[0] if words else file}\n")
    assert [file.name for file in elsewhere.iterdir()] == ["out.png"]


@pytest.fixture
def lone_binary(binary: Path, tmp_path: Path) -> Path:
    """Return a copy of the program without thawslide-report next to it or in the .venv of a checkout."""
    (tmp_path / "bin").mkdir()
    return shutil.copy(binary, tmp_path / "bin" / "thawslide")


def run_lone(lone: Path, environment: dict[str, str], *words: object) -> Outcome:
    return subprocess.run([lone, *map(str, words)], env=environment, capture_output=True, text=True, timeout=HANG)


def test_without_thawslide_report_the_remedy_is_named(
    lone_binary: Path, plain_environment: dict[str, str], small_case: Path, tmp_path: Path
) -> None:
    outcome = run_lone(lone_binary, plain_environment, "check", small_case, "--picture", tmp_path / "out.png")
    assert outcome.returncode == 2
    assert re.search(r"^  particles +48$", outcome.stdout, re.MULTILINE)
    assert "the picture was not drawn: thawslide-report is not on PATH." in outcome.stderr
    assert "`./run --setup` installs it" in outcome.stderr
    assert not (tmp_path / "out.png").exists()
    outcome = run_lone(lone_binary, plain_environment, "report", "x")
    assert outcome.returncode == 2
    assert "thawslide-report cannot be started (No such file or directory)." in outcome.stderr
    assert "put .venv/bin on PATH" in outcome.stderr


@pytest.mark.parametrize("place", ["bin", ".venv/bin"])
def test_thawslide_report_is_found_next_to_the_program_and_in_a_checkout(
    binary: Path, plain_environment: dict[str, str], tmp_path: Path, place: str
) -> None:
    """The program is in bin of an installed package, or in build/PRESET of a checkout."""
    for folder in {place, "bin" if place == "bin" else "build/release"}:
        (tmp_path / folder).mkdir(parents=True)
    program = tmp_path / ("bin" if place == "bin" else "build/release") / "thawslide"
    shutil.copy(binary, program)
    report = tmp_path / place / "thawslide-report"
    report.write_text('#!/bin/sh\necho "found $*"\n')
    report.chmod(0o755)
    outcome = run_lone(program, plain_environment, "report", "--help")
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stdout == "found --help\n"


def test_run_with_an_end_is_short_for_set(ran: Ran, thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    ran("--end", 0.05)
    assert tomllib.loads((tmp_path / "run" / "case.toml").read_text())["time"]["end"] == 0.05
    message = thawslide.error("run", small_case, "--end", 0.05, *sets(time__end=0.1))
    assert "--end is short for --set time.end: give one of the two." in message


def test_block_prints_a_table_or_writes_a_csv_and_applies_set(thawslide: Program, tmp_path: Path) -> None:
    names, units, *rows, last = thawslide.ok("block", LAMPLUGH / "case.toml", *sets(time__end=40)).splitlines()
    assert names.split()[:3] == ["time", "velocity", "distance"]
    assert units.split()[:3] == ["s", "m/s", "m"]
    times = [float(row.split()[0]) for row in rows]
    assert len(times) == 21 and times[0] == 0.0 and times == sorted(times)
    assert times[-1] == pytest.approx(40.0, abs=0.02)
    assert re.match(r"safety factor at the start: \d\.\d{3} ", last)
    file = tmp_path / "x.csv"
    words = sets(time__end=10, basal__cohesion=0, basal__residual_cohesion=0)
    printed = thawslide.ok("block", LAMPLUGH, "--output", file, *words)
    columns = columns_of(file)
    times, speeds = columns["time_s"], columns["velocity_m_s"]
    assert next(iter(columns)) == "time_s" and times[0] == 0.0 and times[-1] == pytest.approx(10.0, abs=0.02)
    assert f"{len(times)} rows in {file}" in printed
    # Without cohesion the slope is far from stable: the block accelerates throughout.
    assert (np.diff(speeds) >= 0.0).all() and speeds[-1] > 10.0


def test_report_plots_the_figures_of_a_run_and_passes_on_the_exit_code(
    ran: Ran, thawslide: Program, report_environment: dict[str, str], tmp_path: Path
) -> None:
    run = ran()
    printed = thawslide.ok("report", run, "--only", "velocity,energy", environment=report_environment)
    assert sorted(file.name for file in (run / "figures").iterdir()) == ["energy.png", "velocity.png"]
    assert all(file.read_bytes().startswith(PNG) for file in (run / "figures").iterdir())
    assert (run / "report.html").read_text().lstrip().startswith("<!")
    assert f"report: {run / 'report.html'}" in printed
    outcome = thawslide("report", tmp_path / "nothing", environment=report_environment)
    assert outcome.returncode == 2 and "thawslide-report: error:" in outcome.stderr


def test_a_missing_gpu_is_reported_before_writing(thawslide: Program, small_case: Path, run: Path) -> None:
    outcome = thawslide("run", small_case, "--output", run, "--device", "gpu")
    if outcome.returncode == 0:
        assert run_facts(run)["parts"][0]["device"]
        pytest.skip("a GPU is available, and the run used it")
    assert outcome.returncode == 2 and not run.exists()
    assert outcome.stderr.startswith("error: --device gpu: ")
    assert outcome.stderr.endswith("un the case on the CPU: --device cpu\n")


@pytest.mark.parametrize("device", ["auto", "cpu"])
def test_auto_and_cpu_run_and_resume(ran: Ran, thawslide: Program, device: str) -> None:
    run = ran("--device", device)
    assert device == "auto" or run_facts(run)["parts"][0]["device"] == ""
    thawslide.ok("resume", run, "--device", device)


X, Y = WEST + 0.3 * COLUMNS * CELL, SOUTH + 0.5 * ROWS * CELL
SURFACES = {
    "plane": ["--plane", f"x={X},y={Y},dip=25,direction=90,depth=5"],
    "ellipsoid": ["--ellipsoid", f"x={X},y={Y},half_length=90,half_width=60,azimuth=90"],
    "slbl": ["--slbl"],
}


@pytest.mark.parametrize("surface", SURFACES)
def test_a_scarp_is_a_case(surface: str, thawslide: Program, report_environment: dict[str, str], slope: Slope) -> None:
    folder = slope.folder / "case"
    outline = write_rectangle(slope.folder / "outline.geojson", X - 90.0, Y - 60.0, 180.0, 120.0)
    words = [slope(), *SURFACES[surface], "--within", outline, "--volume", 250000]
    environment = report_environment | {"PYTHONPATH": str(ROOT / "python")}
    scarp = [sys.executable, "-m", "thawslide.scarps.command", *words, "--output", slope.folder / "scarp.tif"]
    done = thawslide.finish(scarp, env=environment)
    assert done.returncode == 0, done.stderr
    command = done.stdout.splitlines()[-1].removeprefix("To continue: thawslide ").replace("FOLDER", str(folder))
    (volume,) = re.findall(r"a release of ([\d,]+) m3", thawslide.ok(*command.split()))
    assert float(volume.replace(",", "")) == pytest.approx(250_000.0, rel=2e-3)
    assert tomllib.loads((folder / "case.toml").read_text())["body"]["slide"]["placement"] == "cut"
    assert thawslide.json("check", folder)
