"""Output of a run during the run and at its end: plain lines, a bar on a terminal, the summary."""

import os
import pty
import re
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import HANG, LAMPLUGH, Program, Slope, history, run_facts, sets
from terrain_files import DEPTH, SOUTH, WEST, WIDTH

STATE = r"\d+\.\d of 2 s \| \d+ steps/s \| \S+ (s|min) left \| front \d+ m"
SPEED = r" at -?\d+\.\d m/s"


@pytest.fixture(scope="module")
def run_output(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> tuple[list[str], Path]:
    """Return the lines of a run whose output is not a terminal, and its folder."""
    run = tmp_path_factory.mktemp("runs") / "run"
    printed = thawslide.ok("run", LAMPLUGH, "--output", run, "--threads", 1, *sets(time__end=2))
    assert "\r" not in printed and "\033" not in printed
    return printed.splitlines(), run


def test_the_first_line_has_title_particles_and_threads(run_output: tuple[list[str], Path]) -> None:
    lines, run = run_output
    particles = run_facts(run)["particles"]
    assert "warning: " in lines[0] and "lamplugh_targets.csv: 7 of its values are later than the run" in lines[0]
    title = "Lamplugh rock-ice avalanche, 2016, reproduction of the paper"
    assert lines[1] == f"{title}: {particles:,} particles, 2 s to simulate, on 1 thread"


def test_plain_lines_report_percentage_speed_remaining_time_and_front(run_output: tuple[list[str], Path]) -> None:
    percentages = []
    for line in run_output[0][1:]:
        if "%" in line and "left" in line:
            # A speed requires two positions of the front.
            reported = re.fullmatch(rf" *(\d+) % \| {STATE}{SPEED if percentages else ''}", line)
            assert reported, line
            percentages.append(int(reported[1]))
    assert percentages[0] == 10 and 8 <= len(percentages) <= 10
    assert percentages == sorted(set(percentages)) and percentages[-1] <= 100


def test_summary_reports_throughput_and_result(run_output: tuple[list[str], Path]) -> None:
    lines, run = run_output
    facts = run_facts(run)
    first = next(k for k, line in enumerate(lines) if "particle-steps per second" in line)
    reported = re.fullmatch(
        r"([\d,]+) particles, (\S+) steps in \d+ s: (\S+) million particle-steps per second on 1 thread", lines[first]
    )
    assert reported and int(reported[1].replace(",", "")) == facts["particles"]
    assert int(reported[2].replace(",", "")) == facts["steps"]
    assert reported[3] == f"{facts['particle_steps_per_second'] / 1e6:.3g}"
    assert re.fullmatch(
        r"at 2 s, not at rest: mean velocity \d+\.\d\d m/s, mean displacement \d+ m, front at \d+ m, runout \d+ m",
        lines[first + 1],
    )
    shown = [re.fullmatch(r"  (\S.*?) {2,}(\S+) (.*)", line) for line in lines[first + 2 : -2]]
    expected = {
        ("volume change by dilation", "m3"): facts["dilation_volume_m3"],
        ("relative volume change", "%"): 100.0 * facts["dilation_fraction"],
        ("mass of removed particles", "kg"): facts["left_mass_kg"],
    }
    found = {(line[1], line[3]): float(line[2].replace(",", "")) for line in shown if line}
    assert len(found) == len(shown) and found == pytest.approx(expected, rel=5e-3)
    assert facts["at_rest"] is False and len(facts["warnings"]) == 1
    assert lines[-2] == f"warning: {facts['warnings'][0]}"
    assert lines[-2].startswith("warning: the slide is not at rest at 2 s (mean velocity ")
    assert lines[-1] == f"results in {run}"


def read_terminal(descriptor: int) -> bytes:
    """Return the output on a terminal until the program closes it."""
    shown = b""
    while True:
        try:
            part = os.read(descriptor, 65536)
        except OSError:  # on Linux: the other side has closed
            return shown
        if not part:
            return shown
        shown += part


def test_the_bar_on_a_terminal_is_redrawn_in_place(thawslide: Program, tmp_path: Path) -> None:
    terminal, program_side = pty.openpty()
    words = sets(time__end=2, time__step=0.001)
    with thawslide.start("run", LAMPLUGH, "--output", tmp_path / "run", *words, stdout=program_side) as process:
        os.close(program_side)
        shown = read_terminal(terminal).decode()
        os.close(terminal)
        assert process.wait(timeout=HANG) == 0
    bars = re.findall(rf"\r\033\[K\[(=* *)\] +(\d+) % \| {STATE}({SPEED})?", shown)
    assert bars and not bars[0][3] and all(bar[3] for bar in bars[1:])
    for bar, share, *_ in bars:
        assert len(bar) == 24
        assert bar.count("=") == pytest.approx(int(share) * 24 / 100, abs=1.2)
    percentages = [int(share) for _, share, *_ in bars]
    assert percentages == sorted(percentages)
    # The bar is redrawn in place: no new line between the first and the last, and one before the summary.
    first, last = shown.index("\r\033[K["), shown.rindex("\r\033[K[")
    assert "\n" not in shown[first:last]
    assert re.search(r"m( at -?\d+\.\d m/s)?\r\n[\d,]+ particles, 2,000 steps in ", shown[last:])


def test_a_slide_that_barely_moved_has_no_front(thawslide: Program, slope: Slope, tmp_path: Path) -> None:
    slope.new()
    printed = thawslide.ok("run", tmp_path / "slide", "--output", tmp_path / "run", *sets(time__end=0.05))
    assert "nan" not in printed
    assert re.search(
        r"\nat 0\.05 s, not at rest: mean velocity 0\.\d\d m/s, mean displacement 0 m, no front: maps\.path is not "
        r"set, and the slide has barely moved\n",
        printed,
    )


def test_a_run_ends_when_all_particles_have_left(thawslide: Program, slope: Slope, tmp_path: Path, run: Path) -> None:
    slope.new()
    words = [
        *sets(time__end=60, grid__cell=16, grid__leaving='"remove"', basal__friction_angle=3, band__model="scaled"),
        *sets(grid__min=[WEST + 128, SOUTH + 176, 960], grid__max=[WEST + 512, SOUTH + 432, 1216]),
        *sets(heat__enabled="false", pressure__enabled="false", body__slide__velocity=[20, 0, 0]),
    ]
    printed = thawslide.ok("run", tmp_path / "slide", "--output", run, "--threads", 1, *words)
    facts, columns = run_facts(run), history(run)
    reported = re.fullmatch(
        r"the whole slide has left the domain or the known terrain at t = (\S+) s \(step \d+\)\. mass_kg still "
        r"includes the last (\S+) kg, which left in this step\. Specify a larger domain \(\[grid\] min and max\) or a "
        r"larger DEM, and repeat the run\.",
        facts["message"],
    )
    assert reported and facts["status"] == "done"
    assert printed.splitlines()[-1] == facts["message"]
    work = re.search(
        r"^([\d,]+) particles, ([\d,]+) at the end, [\d,]+ steps in .*: (\S+) million particle-steps per "
        r"second on 1 thread$",
        printed,
        re.MULTILINE,
    )
    assert work and int(work[1].replace(",", "")) == facts["particles"] > int(work[2].replace(",", ""))
    assert work[3] == f"{facts['particle_steps_per_second'] / 1e6:.3g}"
    assert facts["particle_steps_per_second"] * facts["wall_s"] < facts["particles"] * facts["steps"]
    assert columns["time_s"][-1] == pytest.approx(float(reported[1]), rel=1e-5)
    assert columns["time_s"][-1] < 60.0
    assert columns["mass_kg"][-1] == pytest.approx(float(reported[2].replace(",", "")), rel=6e-3)
    np.testing.assert_allclose(columns["mass_kg"] + columns["left_mass_kg"], columns["mass_kg"][0], rtol=1e-12)
    # Final maps are empty; maximum values are kept.
    assert facts["covered_volume_m3"] == facts["covered_area_m2"] == 0.0
    assert facts["affected_area_m2"] > WIDTH * DEPTH
    assert facts["at_rest"] is None and facts["left_mass_kg"] == pytest.approx(columns["left_mass_kg"][-1])
    left = [line for line in printed.splitlines() if line.startswith("warning: ") and "have left" in line]
    assert len(left) == 1 and left[0].removeprefix("warning: ") == facts["warnings"][0]
    assert re.fullmatch(
        rf"{facts['removed_particles']['left']} particles have left the domain or the known terrain and were removed: "
        r"\S+ kg, \d+\.?\d* % of the mass\. The results do not include them\. Use a larger domain or DEM\.",
        facts["warnings"][0],
    )
    with (
        rasterio.open(run / "maps" / "final_thickness.tif") as final,
        rasterio.open(run / "maps" / "max_thickness.tif") as largest,
    ):
        assert final.read(1, masked=True).max() == 0.0
        assert largest.read(1, masked=True).max() > 20.0
