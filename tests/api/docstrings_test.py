"""Examples in docstrings and notebooks run, every parameter is described, and types are found by mypy."""

import doctest
import inspect
import json
import os
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, CommandLine

import thawslide
from thawslide.maps import Map

PUBLIC = {name: getattr(thawslide, name) for name in thawslide.__all__}
FUNCTIONS: dict[str, Callable[..., Any]] = {name: each for name, each in PUBLIC.items() if inspect.isfunction(each)}
CLASSES = [each for each in (*PUBLIC.values(), Map) if isinstance(each, type) and not issubclass(each, Exception)]
MODULES = sorted({each.__module__ for each in (*FUNCTIONS.values(), *CLASSES)})
SECTIONS = ("Parameters", "Returns", "Raises", "Examples")


def methods() -> Iterator[tuple[str, Callable[..., Any]]]:
    """Return the public methods that have parameters, and constructors that are not those of dataclasses, by name."""
    for each in CLASSES:
        for name, attribute in vars(each).items():
            function = attribute.__func__ if isinstance(attribute, classmethod) else attribute
            is_public = not name.startswith("_") or (name == "__init__" and not is_dataclass(each))
            if is_public and inspect.isfunction(function) and len(inspect.signature(function).parameters) > 1:
                yield f"{each.__name__}.{name}", function


METHODS = dict(methods())


@pytest.mark.parametrize("module", MODULES)
def test_examples_of_docstrings(module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cases").symlink_to(ROOT / "cases")
    monkeypatch.chdir(tmp_path)
    loaded = import_module(module)
    done = doctest.testmod(loaded, extraglobs=PUBLIC | {"tomllib": tomllib})
    assert done.failed == 0 and (done.attempted > 0) == (">>>" in inspect.getsource(loaded))


@pytest.mark.parametrize("name", FUNCTIONS | METHODS)
def test_functions_have_all_sections_and_every_parameter_is_described(name: str) -> None:
    function = (FUNCTIONS | METHODS)[name]
    text = function.__doc__ or PUBLIC[name.partition(".")[0]].__doc__  # a constructor without text: that of the class
    text = inspect.cleandoc(text)
    missing = [each for each in SECTIONS if f"\n{each}\n{'-' * len(each)}\n" not in text]
    assert missing == [] or name not in FUNCTIONS
    section = text.partition("Parameters\n----------\n")[2].split("\n\n")[0]
    described = {word.lstrip("*") for line in section.splitlines() if not line.startswith(" ")
                 for word in line.split(" : ")[0].split(", ")}  # fmt: skip
    assert described == set(inspect.signature(function).parameters) - {"self", "cls"}


def test_public_names_and_the_version_of_the_program(command_line: CommandLine) -> None:
    assert dir(thawslide) == sorted(thawslide.__all__)
    assert command_line("version").stdout.split()[1] == thawslide.__version__


SCRIPT = """
import numpy as np

import thawslide
from thawslide import Case, Run, RunError, Simulation, UserError


def peak_of(case: Case) -> float:
    simulation = Simulation(case, threads=1)
    simulation.run(until=1.0)
    return float(simulation.history["mean_velocity_m_s"].max())


case = Case("slope", {"basal.friction_angle": 20.0})
case["band.thickness"] = 0.3
try:
    print(peak_of(case), np.pi)
    run: Run = thawslide.run(case, output="out", progress=False)
    print(run.key_numbers["peak_speed_m_s"])
except (UserError, RunError) as error:
    print(error)
table = thawslide.sweep("slope", "sweep", vary={"band.thickness": [0.1, 0.2]}, progress=False)
print(table["status"].tolist())
"""


def mypy(tmp_path: Path, script: str) -> str:
    (tmp_path / "study.py").write_text(script)
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\nstrict = True\n")
    command = [sys.executable, "-m", "mypy", "--config-file", settings, "--cache-dir", ROOT / "build" / "mypy-user"]
    return subprocess.run([*command, "study.py"], cwd=tmp_path, capture_output=True, text=True).stdout


def test_strict_check_accepts_a_script_and_finds_a_wrong_type(tmp_path: Path) -> None:
    assert "Success: no issues found" in mypy(tmp_path, SCRIPT)
    assert 'has incompatible type "str"; expected "float' in mypy(tmp_path, SCRIPT.replace("until=1.0", 'until="1"'))


NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def code_of(notebook: Path) -> list[dict[str, Any]]:
    return [cell for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_has_outputs_and_is_small(notebook: Path, tmp_path: Path) -> None:
    assert any(cell["outputs"] for cell in code_of(notebook)) and notebook.stat().st_size < 200_000
    copy = tmp_path / "docs" / "notebooks" / notebook.name
    copy.parent.mkdir(parents=True)
    shutil.copy(notebook, copy)
    (tmp_path / "cases").symlink_to(ROOT / "cases")
    (tmp_path / "runs").mkdir()
    environment = os.environ | {"PYTHONPATH": f"{ROOT}:{ROOT / 'python'}", "JUPYTER_PLATFORM_DIRS": "1"}
    words = f"import pathlib; from reproduction.studies import notebooks as n; n.execute(pathlib.Path({str(copy)!r}))"
    command = [sys.executable, "-c", words]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert [len(cell["outputs"]) for cell in code_of(copy)] == [len(cell["outputs"]) for cell in code_of(notebook)]
