"""Commands and snippets of the pages run with the shown output, and the friction law of CONTRIBUTING.md compiles."""

import shutil
import subprocess
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


HEADER = "physics/basal/weakening_friction.hpp"
UNIT = """#include "exec/cpu.hpp"
#include "terrain/basal_law.hpp"
namespace thawslide::terrain {  // evaluates all laws
template void evaluate_basal_law(exec::Cpu&, const BasalLaw&, BasalNode*, std::size_t);
}
"""


def test_friction_law_of_the_recipe_fits_the_list(tmp_path: Path) -> None:
    (law,) = [block.text for block in blocks_of((ROOT / "CONTRIBUTING.md").read_text()) if block.language == "cpp"]
    laws = (ROOT / "src" / "physics" / "basal" / "laws.hpp").read_text()
    first = "using FrictionLaw = std::variant<"
    assert first in laws
    listed = laws.replace("#pragma once", f'#pragma once\n#include "{HEADER}"', 1)
    listed = listed.replace(f"{first}  //", f"{first}WeakeningFriction,", 1)
    folder = tmp_path / "physics" / "basal"
    folder.mkdir(parents=True)
    (tmp_path / HEADER).write_text(law)
    (folder / "laws.hpp").write_text(listed)
    (tmp_path / "unit.cpp").write_text(UNIT)
    flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", f"-I{tmp_path}", f"-I{ROOT / 'src'}"]
    done = subprocess.run(["g++", *flags, tmp_path / "unit.cpp"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
