"""Examples in the docstrings of the public API run, and every parameter of a function is described."""

import doctest
import inspect
import tomllib
from importlib import import_module
from pathlib import Path

import pytest

import thawslide

ROOT = Path(__file__).resolve().parents[2]
MODULES = ("case", "logger", "new_cases", "runs", "simulation", "sweeps.api")
FUNCTIONS = ("block", "new_case", "resume", "run", "scarp", "sweep")


@pytest.mark.parametrize("module", MODULES)
def test_examples_of_docstrings(module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cases").symlink_to(ROOT / "cases")
    monkeypatch.chdir(tmp_path)
    names = {name: getattr(thawslide, name) for name in thawslide.__all__} | {"tomllib": tomllib}
    done = doctest.testmod(import_module(f"thawslide.{module}"), extraglobs=names)
    assert done.attempted > 0 and done.failed == 0


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_parameter_is_described(name: str) -> None:
    function = getattr(thawslide, name)
    section = inspect.getdoc(function).split("Parameters\n----------\n")[1].split("\n\n")[0]
    described = {word for line in section.splitlines() if not line.startswith(" ")
                 for word in line.split(" : ")[0].split(", ")}  # fmt: skip
    assert described == set(inspect.signature(function).parameters)


def test_only_public_names_are_listed() -> None:
    assert dir(thawslide) == sorted(thawslide.__all__)
