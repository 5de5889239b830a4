"""Examples in the docstrings of the public API run, and every parameter of a function or method is described."""

import doctest
import inspect
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import thawslide
from thawslide.maps import Map

ROOT = Path(__file__).resolve().parents[2]
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


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_have_all_sections(name: str) -> None:
    text = inspect.getdoc(FUNCTIONS[name]) or ""
    assert [each for each in SECTIONS if f"\n{each}\n{'-' * len(each)}\n" not in text] == []


@pytest.mark.parametrize("name", FUNCTIONS | METHODS)
def test_every_parameter_is_described(name: str) -> None:
    function = (FUNCTIONS | METHODS)[name]
    text = function.__doc__ or PUBLIC[name.partition(".")[0]].__doc__  # a constructor without text: that of the class
    section = inspect.cleandoc(text).partition("Parameters\n----------\n")[2].split("\n\n")[0]
    described = {word.lstrip("*") for line in section.splitlines() if not line.startswith(" ")
                 for word in line.split(" : ")[0].split(", ")}  # fmt: skip
    assert described == set(inspect.signature(function).parameters) - {"self", "cls"}


def test_only_public_names_are_listed() -> None:
    assert dir(thawslide) == sorted(thawslide.__all__)
