"""The program and the report read reported values and force records by the same rules."""

import re
import sys
from pathlib import Path

import pytest
from conftest import ROOT, Program, Ran

sys.path.append(str(ROOT / "tests" / "python"))

from wrong_tables import FORCE_RANGE, FORCES, HEADER, WRONG_FORCES, WRONG_TARGETS

from thawslide import ReportError
from thawslide.force_record import read_force_record
from thawslide.targets import QUANTITIES, Band, read_targets


@pytest.fixture
def case(small_case: Path) -> Path:
    file = small_case / "case.toml"
    file.write_text(file.read_text() + '\n[report]\ntargets = "targets.csv"\n')
    return small_case


def refusals(thawslide: Program, case: Path, text: str) -> list[str]:
    """Return the errors of `check` in reported values, each after its line."""
    file = case / "targets.csv"
    file.write_text(text)
    found = thawslide("check", case)
    assert found.returncode == (2 if found.stderr else 0)
    return re.findall(rf"report\.targets: {re.escape(str(file))}:(\d+: .*)$", found.stderr, re.MULTILINE)


def test_program_and_report_have_the_same_quantities(thawslide: Program, case: Path) -> None:
    (found,) = refusals(thawslide, case, HEADER + "qqq,0,1,m,x\n")
    with pytest.raises(ReportError) as error:
        read_targets(case / "targets.csv")
    assert str(error.value) == f"{case / 'targets.csv'}:{found}"
    assert found.split("There are: ")[1].split(";")[0].split(", ") == list(QUANTITIES)


def test_program_and_report_have_the_same_units(thawslide: Program, case: Path) -> None:
    rows = [f"{name},0,0.5,{unit},x{k}" for name, each in QUANTITIES.items() for k, unit in enumerate(each.units)]
    rows = [row for row in rows if row[:14] != "start_velocity" or row.endswith("x0")]  # one sets the time reference
    assert refusals(thawslide, case, HEADER + "\n".join(rows) + "\n") == []
    assert len(read_targets(case / "targets.csv")) == len(rows)
    for found, name in zip(
        refusals(thawslide, case, HEADER + "".join(f"{name},0,1,qq,x\n" for name in QUANTITIES)),
        QUANTITIES,
        strict=True,
    ):
        units = ", ".join(filter(None, QUANTITIES[name].units))
        assert found.endswith(f": the unit 'qq' for {name}; allowed: {units}")


def test_program_and_report_convert_and_limit_alike(thawslide: Program, case: Path) -> None:
    """Values are just inside and just outside each range, in each unit; messages are the same."""
    rows, expected = [], []
    for name, quantity in QUANTITIES.items():
        for unit, (factor, offset) in quantity.units.items():
            for end, out in ((quantity.low, -1.0), (quantity.high, 1.0)):
                if abs(end) == float("inf"):
                    continue
                rows.append(f"{name},0,{(end - offset + 1e-3 * out) / factor!r},{unit},x{len(rows)}")
                (case / "one.csv").write_text(HEADER + rows[-1] + "\n")
                with pytest.raises(ReportError) as error:
                    read_targets(case / "one.csv")
                expected.append(str(error.value).split("one.csv:2: ")[1])
                inside = f"{name},0,{(end - offset - 1e-3 * out) / factor!r},{unit},x{len(rows)}"
                assert refusals(thawslide, case, HEADER + inside + "\n") == []
    found: list[str] = []
    for start in range(0, len(rows), 40):  # at most 50 errors are reported at once
        found += refusals(thawslide, case, HEADER + "\n".join(rows[start : start + 40]) + "\n")
    assert [message.split(": ", 1)[1] for message in found] == expected


# The reasons of a quote that does not end differ.
TARGETS = [text for text, _ in WRONG_TARGETS if isinstance(text, str) and not text.endswith(',"x\n')]
KNOTS = HEADER.rstrip() + ",kind\nmean_velocity,4,8,knots,x,guess\n"


@pytest.mark.parametrize("text", [*TARGETS, KNOTS, HEADER + "max_seismic_force_350_15_s,4,8,N,x\n"])
def test_program_and_report_have_the_same_messages(thawslide: Program, case: Path, text: str) -> None:
    (found,) = refusals(thawslide, case, text)
    with pytest.raises(ReportError) as error:
        read_targets(case / "targets.csv")
    assert str(error.value) == f"{case / 'targets.csv'}:{found}"


def test_values_beyond_the_run_are_reported_before_it(thawslide: Program, case: Path) -> None:
    assert refusals(thawslide, case, HEADER + "mean_velocity,-100,8,m/s,x\n") == [
        "2: mean_velocity is of -100 s, before the run; allowed: 0 s and later, or a row start_velocity that sets "
        "their clock"
    ]
    assert refusals(thawslide, case, HEADER + "mean_velocity,0.1,8,m/s,x\nmean_velocity,1e9,8,m/s,x\n") == []
    note = "report.targets is targets.csv: 1 of its values is later than the run, which ends at 0.2 s: mean_velocity "
    for words in (["check", case], ["run", case, "--output", case.parent / "run"]):
        assert note in thawslide.ok(*words)


@pytest.fixture
def recorded(small_case: Path) -> Path:
    file = small_case / "case.toml"
    keys = '\n[report]\nforce_record = "force.csv"\nforce_periods = [10.0, 200.0]\n'
    file.write_text(file.read_text() + keys)
    return small_case


OTHER_FORCES = (
    FORCES.rstrip() + ",west_N\n0,0,0,0,0\n1,0,0,0,0\n",
    "# one\n" + FORCE_RANGE + "0,0,0,0,-1,1,-1,1,-1,1\n1,0,0,5,-1,1,-1,1,-1,4\n",
    FORCE_RANGE + "0,0,0,0,-1,1,1,2,-1,1\n1,0,0,0,-1,1,-1,1,-1,1\n",
)


@pytest.mark.parametrize("text", [*(text for text, _ in WRONG_FORCES), *OTHER_FORCES])
def test_program_and_report_have_the_same_messages_about_forces(thawslide: Program, recorded: Path, text: str) -> None:
    file = recorded / "force.csv"
    file.write_text(text)
    (found,) = re.findall(r"report\.force_record: (.*)$", thawslide.error("check", recorded), re.MULTILINE)
    with pytest.raises(ReportError) as error:
        read_force_record(file, Band(10.0, 200.0), "")
    assert str(error.value) == found


def test_program_and_report_read_the_records_of_the_cases(thawslide: Program) -> None:
    for name in ("lamplugh", "lamplugh-columns"):
        thawslide.ok("check", ROOT / "cases" / name)
        record = read_force_record(ROOT / "cases" / name / "lamplugh_force.csv", Band(10.0, 200.0), "")
        assert len(record.time) == 171 and record.low and record.high


def test_a_run_with_a_changed_record_can_be_resumed(ran: Ran, thawslide: Program, recorded: Path) -> None:
    """Only figures use it: a corrected copy needs no new run."""
    (recorded / "force.csv").write_text(FORCES + "0,0,0,0\n1,0,0,0\n")
    run = ran(case=recorded)
    (run / "inputs" / "force.csv").write_text(FORCES + "0,1,0,0\n1,0,0,0\n")
    end = float(re.findall(r"\[time\][^\[]*?\nend = ([\d.]+)", (run / "case.toml").read_text())[0])
    thawslide.ok("resume", run, "--end", str(1.5 * end))
