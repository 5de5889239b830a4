"""Generated pages have the messages of the sources and the help texts of the program; numbers of others are declared.

Declarations of numbers in hand-written pages agree with the pages and are complete.
"""

import builtins
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "python")]

from reproduction.page_numbers import misplaced, read_declarations, undeclared  # noqa: E402
from reproduction.studies.reliability_page import TEXTS, write_page  # noqa: E402

PROGRAM = Path(os.environ.get("THAWSLIDE_BINARY", ROOT / "build" / "release" / "thawslide"))
needs_program = pytest.mark.skipif(not PROGRAM.exists(), reason=f"there is no program {PROGRAM}")


def call(*words: str | Path) -> str:
    called = subprocess.run([*words], capture_output=True, text=True, timeout=600, check=False)
    assert called.returncode == 0, called.stderr
    return called.stdout


def test_every_source_with_messages_has_an_explanation_and_every_table_has_rows(tmp_path: Path) -> None:
    call(sys.executable, ROOT / "scripts" / "warnings-page", tmp_path)
    for page, fewest in (("warnings.md", 60), ("errors.md", 300)):
        text = (tmp_path / page).read_text(encoding="utf-8")
        assert not re.search(r"\{\{|^\|---\|\n(?!\|)", text, re.MULTILINE)
        assert len(re.findall(r"^\| `.+` \|$", text, re.MULTILINE)) > fewest


@needs_program
def test_the_command_line_page_has_every_command(tmp_path: Path) -> None:
    call(sys.executable, ROOT / "scripts" / "command-line-page", PROGRAM, tmp_path)
    sections = re.findall(
        r"^## `thawslide (\w+)`\n\n\w.+\.\n\nSynopsis: `thawslide \1",
        (tmp_path / "command-line.md").read_text(encoding="utf-8"),
        re.MULTILINE,
    )
    commands = re.findall(r"^  ([a-z]\w+) +\S", call(PROGRAM, "--help").split("ubcommands", 1)[-1], re.MULTILINE)
    assert len(commands) > 8
    assert set(commands) - set(sections) == set()


@needs_program
def test_the_overview_has_each_page_of_the_navigation_with_a_sentence(tmp_path: Path) -> None:
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").split("\nnav:\n")[1]
    pages = set(re.findall(r"- (?:[\w ]+: )?(\S+\.md)", navigation)) - {"docs/pages.md"}
    for page in pages:
        if not (ROOT / page).is_file():
            (tmp_path / page).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / page).write_text("# Generated page\n\nThis page is generated.\n", encoding="utf-8")
    call(sys.executable, ROOT / "scripts" / "overview-page", tmp_path)
    text = (tmp_path / "docs" / "pages.md").read_text(encoding="utf-8")
    listed = {os.path.normpath(f"docs/{path}") for path in re.findall(r"^- \[.+?\]\((.+?)\)", text, re.MULTILINE)}
    assert len(listed) > 70
    assert {page for page in pages if not page.startswith("docs/theory/")} == listed
    entries = re.findall(r"^- .+", text, re.MULTILINE)
    assert [entry for entry in entries if not re.fullmatch(r"- \[[^]]+\]\([^)]+\): .+\.", entry)] == []


def test_the_page_of_reliability_has_the_committed_results_of_all_parts(tmp_path: Path) -> None:
    write_page(ROOT / "docs" / "reliability", tmp_path / "page.md")
    text = (tmp_path / "page.md").read_text(encoding="utf-8")
    assert len(re.findall(r"^## ", text, re.MULTILINE)) == len(TEXTS)
    assert "has not been run" not in text and "200 of 200 ended with bitwise identical files" in text


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
