"""Commands of the Python package end with a message, figures do not depend on settings, and the program is found."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from thawslide import commands, program

SETTINGS = {
    "TeX": "text.usetex: True\n",
    "other sizes": "figure.dpi: 30\nsavefig.dpi: 20\nsavefig.bbox: tight\nfont.size: 30\naxes.grid: True\n",
    "dark": "axes.facecolor: black\naxes.prop_cycle: cycler('color', ['w'])\nsavefig.facecolor: black\n",
    "unknown font and back end": "font.family: NoSuchFont\nbackend: TkAgg\npath.sketch: 1, 100, 2\n",
}


def command(name: str, *words: object, folder: Path, code: str = "", **variables: str) -> Any:
    """Run a command of the package as its script does; `code` runs before it."""
    script = f"import sys; from thawslide import commands; {code}\nsys.argv[0] = {name!r}; sys.exit(commands.{name}())"
    return subprocess.run(
        [sys.executable, "-c", script, *map(str, words)], capture_output=True, text=True, cwd=folder, timeout=600,
        env={**{key: value for key, value in os.environ.items() if key != "MPLBACKEND"}, **variables},
    )  # fmt: skip


def report_into(output: Path, run: Path, folder: Path) -> bytes:
    done = command("report", run, "--only", "motion", "--output", output, folder=folder)
    assert done.returncode == 0, done.stderr
    return (output / "figures" / "motion.png").read_bytes()


def test_figures_do_not_depend_on_the_settings_of_matplotlib(make_run: Any, tmp_path: Path) -> None:
    run = make_run(rows=20)
    plain = report_into(tmp_path / "a", run, tmp_path)
    for name, settings in SETTINGS.items():
        (tmp_path / "matplotlibrc").write_text(settings)
        assert report_into(tmp_path / "b", run, tmp_path) == plain, name


@pytest.mark.parametrize(
    ("settings", "variables"), [(b"font.size: \xff\xfe\n", {}), (b"", {"MPLBACKEND": "nonsense"})],
    ids=["bytes", "back end"],
)  # fmt: skip
@pytest.mark.parametrize("name", ["report", "scarp", "sweep", "probability", "score", "forecast"])
def test_settings_that_prevent_the_import_are_named(
    tmp_path: Path, name: str, settings: bytes, variables: dict[str, str]
) -> None:
    (tmp_path / "matplotlibrc").write_bytes(settings)
    done = command(name, "x", folder=tmp_path, **variables)
    assert done.returncode == 2 and "Traceback" not in done.stderr
    assert "error: matplotlib cannot be loaded" in done.stderr and "Correct the file matplotlibrc" in done.stderr


FAULTS = {
    "ZeroDivisionError()": (1, "internal error (ZeroDivisionError: ). Please report it, with {log}"),
    "AssertionError('a')": (1, "internal error (AssertionError: a). Please report it, with {log}"),
    "RecursionError('deep')": (1, "internal error (RecursionError: deep). Please report it, with {log}"),
    "MemoryError()": (2, "the memory of this machine is not enough. Use smaller maps, or fewer workers."),
    "KeyboardInterrupt()": (4, "interrupted."),
    "PermissionError(13, 'Permission denied', 'a.tif')": (
        2, "a.tif: Permission denied. Correct the path or its permissions.",
    ),
    "ModuleNotFoundError('x', name='scipy')": (
        2, "the Python package scipy is missing. Install it, e.g. by ./run --setup.",
    ),
}  # fmt: skip
MODULES = {
    "report": "thawslide.command_line", "scarp": "thawslide.scarps.command", "sweep": "thawslide.sweeps.command",
    "probability": "thawslide.sweeps.probability_command", "score": "thawslide.scores.command",
    "forecast": "thawslide.forecasts.command",
}  # fmt: skip


@pytest.mark.parametrize("name", MODULES)
@pytest.mark.parametrize("fault", FAULTS)
def test_an_unexpected_error_ends_with_a_message(tmp_path: Path, name: str, fault: str) -> None:
    exit_code, text = FAULTS[fault]
    code = f"import {MODULES[name]} as module\ndef main(): raise {fault}\nmodule.main = main"
    done = command(name, folder=tmp_path, code=code, TMPDIR=str(tmp_path))
    logs = list(tmp_path.glob("thawslide-error-*.log"))
    assert len(logs) == (exit_code == 1)
    start = "thawslide-report" if name == "report" else f"thawslide {name}"
    message = f"{start}: error: {text.format(log=logs[0] if logs else '')}\n"
    assert (done.returncode, done.stderr) == (exit_code, message)
    for log in logs:
        assert fault.partition("(")[0] in log.read_text() and "Traceback" in log.read_text()


def test_without_a_folder_for_the_log_the_message_contains_it(tmp_path: Path) -> None:
    code = "import thawslide.command_line as module, tempfile\ndef main(): raise ValueError\n"
    code += "def fail(**_): raise OSError\nmodule.main = main; tempfile.NamedTemporaryFile = fail"
    done = command("report", folder=tmp_path, code=code)
    assert done.returncode == 1 and "Please report it, with this text:" in done.stderr and "line " in done.stderr


def test_a_missing_database_of_proj_is_not_used(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "proj.db").touch()
    monkeypatch.setenv("PROJ_LIB", str(tmp_path / "missing"))
    monkeypatch.setenv("PROJ_DATA", os.pathsep.join([str(tmp_path / "missing"), str(tmp_path)]))
    commands.forget_missing_proj_data()
    assert "PROJ_LIB" not in os.environ and os.environ["PROJ_DATA"].endswith(str(tmp_path))


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


def test_programs_are_found_in_order_starter_package_path(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
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
    monkeypatch.setattr(program, "PROGRAMS", (Path("/nowhere/thawslide"),))
    monkeypatch.setattr(os, "execve", lambda *_: pytest.fail("executed"))
    assert program.main() == 2
    assert capsys.readouterr().err.startswith("error: /nowhere/thawslide: the program is missing")
