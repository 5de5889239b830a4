"""The program, before a run, and the report, after it, read a force record by the same rules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import ROOT, Program

from thawslide import ReportError
from thawslide.force_record import read_force_record
from thawslide.targets import Band

HEADER = "time_s,up_N,north_N,east_N\n"
RANGE = "time_s,up_N,north_N,east_N,up_low_N,up_high_N,north_low_N,north_high_N,east_low_N,east_high_N\n"


@pytest.fixture
def case(small_case: Path) -> Path:
    """Return a case with a force record."""
    file = small_case / "case.toml"
    keys = '\n[report]\nforce_record = "force.csv"\nforce_periods = [10.0, 200.0]\n'
    file.write_text(file.read_text() + keys)
    return small_case


@pytest.mark.parametrize(
    "text",
    [
        "",
        "time_s,up_N,north_N\n0,0,0\n1,0,0\n",
        "time_s,up_N,north_N,east_N,west_N\n0,0,0,0,0\n1,0,0,0,0\n",
        HEADER,
        HEADER + "0,0,0,0\n",
        HEADER + "0,0,0\n1,0,0,0\n",
        HEADER + "0,0,0,0\n0,0,0,0\n",
        HEADER + "0,0,0,0\n2,0,0,0\n1,0,0,0\n",
        HEADER + "0,0,fast,0\n1,0,0,0\n",
        HEADER + "0,0,nan,0\n1,0,0,0\n",
        HEADER.rstrip() + ",up_low_N\n0,0,0,0,0\n1,0,0,0,0\n",
        "# one\n" + RANGE + "0,0,0,0,-1,1,-1,1,-1,1\n1,0,0,5,-1,1,-1,1,-1,4\n",
        RANGE + "0,0,0,0,-1,1,1,2,-1,1\n1,0,0,0,-1,1,-1,1,-1,1\n",
    ],
)
def test_program_and_report_have_the_same_messages(thawslide: Program, case: Path, text: str) -> None:
    file = case / "force.csv"
    file.write_text(text)
    checked = thawslide("check", case)
    assert checked.returncode == 2
    (found,) = re.findall(r"report\.force_record: (.*)$", checked.stderr, re.MULTILINE)
    with pytest.raises(ReportError) as error:
        read_force_record(file, Band(10.0, 200.0), "")
    assert str(error.value) == found


def test_program_and_report_read_the_records_of_the_cases(thawslide: Program) -> None:
    for name in ("lamplugh", "lamplugh-columns"):
        assert thawslide("check", ROOT / "cases" / name).returncode == 0
        record = read_force_record(ROOT / "cases" / name / "lamplugh_force.csv", Band(10.0, 200.0), "")
        assert len(record.time) == 171 and record.low and record.high


def test_a_run_with_a_changed_record_can_be_resumed(thawslide: Program, case: Path, tmp_path: Path) -> None:
    """Only figures use it: a corrected copy needs no new run."""
    (case / "force.csv").write_text(HEADER + "0,0,0,0\n1,0,0,0\n")
    run = tmp_path / "run"
    assert thawslide("run", case, "--output", run).returncode == 0
    (run / "inputs" / "force.csv").write_text(HEADER + "0,1,0,0\n1,0,0,0\n")
    end = float(re.findall(r"\[time\][^\[]*?\nend = ([\d.]+)", (run / "case.toml").read_text())[0])
    resumed = thawslide("resume", run, "--end", str(1.5 * end))
    assert resumed.returncode == 0, resumed.stderr
