"""The command thawslide of the Python package executes the program of the package."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from thawslide import program

SCRIPT = """#!/bin/sh
printf '%s|' "$0" "$@"
command -v thawslide-report
exit 3
"""
CALLER = "import sys; from pathlib import Path; from thawslide import program; program.PROGRAMS = (Path({!r}),); {}"


def write_executable(path: Path, text: str) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)
    return path


def test_command_executes_the_program_and_finds_the_report_next_to_itself(tmp_path: Path) -> None:
    inner = write_executable(tmp_path / "package" / "thawslide", SCRIPT)
    report = write_executable(tmp_path / "bin" / "thawslide-report", "#!/bin/sh\n")
    call = CALLER.format(str(inner), "sys.exit(program.main())")
    command = write_executable(tmp_path / "bin" / "thawslide", f"#!{sys.executable}\n{call}\n")
    done = subprocess.run([command, "run", "a b"], capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 3, done.stderr
    assert done.stdout == f"{inner}|run|a b|{report}\n"


def test_missing_program_is_an_error(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(program, "PROGRAMS", (Path("/nowhere/thawslide"),))
    monkeypatch.setattr(os, "execve", lambda *_: pytest.fail("executed"))
    assert program.main() == 2
    assert capsys.readouterr().err.startswith("error: /nowhere/thawslide: the program is missing")


def test_programs_are_found_in_order_starter_package_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    starter, own, other = (
        write_executable(tmp_path / name / "thawslide", SCRIPT) for name in ("starter", "own", "path")
    )
    monkeypatch.setenv("THAWSLIDE_PROGRAM", str(starter))
    monkeypatch.setenv("PATH", str(other.parent))
    monkeypatch.setattr(program, "PROGRAMS", (tmp_path / "none", own))
    for found in (starter, own, other):
        assert program.find_program() == str(found)
        found.unlink()
    assert program.find_program() is None
