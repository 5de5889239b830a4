"""Declarations of numbers in hand-written pages agree with the pages and are complete."""

import builtins
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "python")]

from reproduction.page_numbers import misplaced, read_declarations, undeclared  # noqa: E402

DECLARED = read_declarations(ROOT / "reproduction" / "page_numbers.toml")
PAGES = {page.file: page for page in DECLARED.pages}
WHOLE = [
    str(path.relative_to(ROOT))
    for path in [ROOT / "README.md", *sorted(ROOT.glob("cases/*/README.md")), *sorted(ROOT.glob("docs/tutorials/*.md"))]
]


@pytest.mark.parametrize("file", PAGES)
def test_declared_phrases_occur_in_their_page(file: str) -> None:
    assert misplaced(PAGES[file], (ROOT / file).read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("file", WHOLE)
def test_every_number_of_a_page_is_declared(file: str) -> None:
    assert undeclared(PAGES[file], (ROOT / file).read_text(encoding="utf-8")) == []


def test_expressions_use_declared_names() -> None:
    known = DECLARED.runs.keys() | DECLARED.texts.keys() | vars(builtins).keys() | {"table", "row", "column"}
    used = set().union(*(n.names for page in DECLARED.pages for phrase in page.checked for n in phrase.numbers))
    assert used - known == set()
    assert (DECLARED.runs.keys() | DECLARED.texts.keys()) - used == set()


def test_declared_cases_exist() -> None:
    for name, words in DECLARED.runs.items():
        assert (ROOT / words[words[0] in ("block", "new")]).exists(), name
