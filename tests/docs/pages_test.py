"""Commands and snippets of the pages run, with the output that the pages show."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from snippets import ROOT, Scratch, blocks_of, fault_of, page_failures


def pages() -> list[str]:
    forms = ("*.md", "docs/**/*.md", "cases/*/*.md", "benchmarks/**/*.md", "scripts/*.md", "src/*/*.md", "tests/*/*.md")
    found = [path for form in forms for path in ROOT.glob(form)]
    return sorted(str(path.relative_to(ROOT)) for path in found if blocks_of(path.read_text(encoding="utf-8")))


PAGES = pages()
LONG = [page for page in PAGES if any("long" in block.marks for block in blocks_of((ROOT / page).read_text()))]


@pytest.fixture
def scratch(tmp_path: Path) -> Iterator[Scratch]:
    """Create the folder of a page, and remove it with all its runs afterwards."""
    yield Scratch(tmp_path / "clone")
    shutil.rmtree(tmp_path)


@pytest.mark.parametrize("page", PAGES)
def test_blocks_have_the_form(page: str) -> None:
    faults = [(block.line, fault_of(block)) for block in blocks_of((ROOT / page).read_text(encoding="utf-8"))]
    assert [f"{page}:{line}: {fault}" for line, fault in faults if fault] == []


@pytest.mark.parametrize("page", PAGES)
def test_pages_show_the_output_of_commands(page: str, scratch: Scratch) -> None:
    failures = page_failures((ROOT / page).read_text(encoding="utf-8"), scratch, long=False)
    assert not failures, page + "\n\n" + "\n\n".join(failures)


@pytest.mark.long
@pytest.mark.parametrize("page", LONG)
def test_pages_show_the_output_of_long_commands(page: str, scratch: Scratch) -> None:
    failures = page_failures((ROOT / page).read_text(encoding="utf-8"), scratch, long=True)
    assert not failures, page + "\n\n" + "\n\n".join(failures)
