"""Studies of `scripts/pages` with coarse and short runs: the report of the paper, the pages of Lamplugh, pictures."""

import math
import os
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT

HANG = 600.0  # s


@pytest.fixture(scope="module")
def output(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pages")


def pages(binary: Path, output: Path, environment: dict[str, str], *words: str) -> str:
    """Make pages with coarse and short runs; return what the command prints."""
    command = [ROOT / "scripts" / "pages", "--quick", "--program", binary, "--output", output, "--only", *words]
    home = {"HOME": os.environ.get("HOME", "")}
    done = subprocess.run(command, env=environment | home, capture_output=True, text=True, timeout=HANG, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def text_of(page: Path) -> str:
    """Return the text of a page, whose lines are short except those of tables."""
    text = page.read_text(encoding="utf-8")
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 120
    return text


def test_paper_and_pictures(binary: Path, report_environment: dict[str, str], output: Path) -> None:
    assert "pictures: 3 runs, 3 of them complete" in pages(binary, output, report_environment, "paper", "pictures")
    quick = output / "quick"
    page = (quick / "paper" / "report.html").read_text(encoding="utf-8")
    links = re.findall(r'<img src="([^"]+)"', page)
    assert len(links) == 15
    figures = [quick / "paper" / link for link in links]
    figures += (quick / "written" / "docs" / "explanation" / "pictures").glob("*.png")
    assert len(figures) == 20
    assert all(figure.read_bytes().startswith(b"\x89PNG") for figure in figures)
    assert "Shortened runs" in page
    assert len(re.findall(r"<td[^>]*>(?:true|false|undetermined)</td>", page)) > 50
    rows = dict(line.split(",") for line in (quick / "paper" / "measures.csv").read_text().splitlines()[1:])
    # After 864 s the fronts are in the first cell; without latent heat, cooling has passed through several cells.
    assert float(rows["freezing_m050_no_latent_rms_error"]) < 0.01
    # The published update creates heat spuriously as soon as the bar freezes.
    assert float(rows["freezing_m100_printed_heat"]) > 1.0
    # The block starts with its frozen band at the pressure of ice, rho_I g H.
    assert math.isclose(float(rows["block_e050_pressure_start"]), 917 * 9.81 * 50 / 1e3, rel_tol=1e-3)


def test_columns(binary: Path, report_environment: dict[str, str], output: Path) -> None:
    assert "columns: 2 runs, 0 of them complete" in pages(binary, output, report_environment, "columns")
    page = output / "quick" / "written" / "cases" / "lamplugh-columns" / "results.md"
    text = text_of(page)
    assert "## 3 members" in text
    assert "| model | peak of the mean velocity [m/s] | 80 | 72 to 88 |" in text
    # A second of sliding is not enough for 8 m/s.
    assert "- from 8 m/s to the peak: no member has it (accepted: 28 to 42)" in text
    assert "| bound | maximum P over averaged N |  | at most 1 | 0.000 | 0.000 | 3 of 3 | yes |" in text
    assert "| `band.thickness=" in text and "not run" not in text
    assert "@" not in text and "{" not in text
    page.unlink()
    assert "runs," not in pages(binary, output, report_environment, "columns", "--draw-only")
    assert page.read_text(encoding="utf-8") == text


def test_lamplugh_force(binary: Path, report_environment: dict[str, str], output: Path) -> None:
    assert "made: lamplugh-force" in pages(binary, output, report_environment, "lamplugh-force")
    folder = output / "quick" / "written" / "cases" / "lamplugh-columns"
    text = text_of(folder / "force.md")
    assert "| record | 1.00 | -1.0 | 10.9 | 21.2 | 31.8 | 28.9 |" in text and "@" not in text
    # 24 s do not contain the reversal of the fitted run, but null models have their whole motion.
    for words, low, high in (
        ("two parts, fitted, cells of 20 m", 0.3, 0.8),
        ("points, lower half of the release", 0.8, 1.0),
        ("chain, lower half of the release", 0.8, 1.0),
    ):
        assert low < float(text.split(f"| {words} | ")[1].split(" | ")[0]) < high, words
    assert (folder / "figures" / "force_two_parts.png").is_file()


def test_assumptions(binary: Path, report_environment: dict[str, str], output: Path) -> None:
    keys = ("case", "no-viscosity", "thick", "s-c100", "lamplugh-block*")
    assert "min left: " in pages(binary, output, report_environment, *(f"assumptions:{key}" for key in keys))
    page = output / "quick" / "written" / "cases" / "lamplugh" / "assumptions.md"
    text = text_of(page)
    lines = [line for line in text.splitlines() if line.startswith("| no viscosity |")]
    assert len(lines) == 1 and "`material.rock_ice.viscosity_time=0.0`" in lines[0] and "not run" not in lines[0]
    assert "| lubrication off | not run |" in text
    assert "[thick-body.toml](thick-body.toml)" in text
    for name in ("assumptions", "block", "deposit"):
        assert (page.parent / "figures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_lamplugh_and_numbers(binary: Path, report_environment: dict[str, str], output: Path) -> None:
    words = pages(binary, output, report_environment, "lamplugh", "numbers")
    assert "numbers compared, " in words and "made: lamplugh, numbers" in words
    text = text_of(output / "quick" / "written" / "cases" / "lamplugh" / "results.md")
    assert text.count("| does not start |") == 8 and "not run" not in text  # within a second
    assert "- no viscosity: `./run cases/lamplugh --set material.rock_ice.viscosity_time=0.0`" in text
