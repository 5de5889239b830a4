"""Checks of the repository: includes between modules, sizes, words, agreement of documents and code."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src"

# Modules that each module may include (ARCHITECTURE.md, "Modules and dependencies"). "generated" is version.hpp.
ALLOWED = {
    "base": {"base"},
    "physics": {"base", "physics"},
    "config": {"base", "physics", "config"},
    "mpm": {"base", "physics", "exec", "mpm"},
    "terrain": {"base", "physics", "mpm", "exec", "terrain"},
    "exec": {"base", "exec"},
    "band": {"base", "physics", "mpm", "exec", "band"},
    "device": {"base", "physics", "mpm", "exec", "terrain", "band", "device"},
    "sim": {"base", "physics", "config", "mpm", "exec", "terrain", "band", "device", "sim"},
    "io": {"base", "config", "mpm", "io", "generated"},
    "gis": {"base", "config", "gis"},
    "run": {"base", "physics", "config", "mpm", "exec", "terrain", "band", "device", "sim", "io", "gis", "run"},
}
ALLOWED["python"] = ALLOWED["run"] | {"python", "generated"}
ALLOWED["app"] = ALLOWED["run"] | {"app", "generated"}
# Folders of sim that each of them may include, besides itself; "" is sim itself.
ALLOWED_IN_SIM = {
    "setup": set(),
    "solver": {"setup"},
    "maps": {"setup"},
    "between_steps": {"setup", "solver", "maps"},
    "": {"setup", "solver", "maps", "between_steps"},
    "records": {"setup", "solver", "maps", "between_steps", ""},
    "checks": {"setup", "solver", "maps", "between_steps", ""},
    "block": {"setup", "solver", "maps", "between_steps", "", "records", "checks"},
}
# Pages that scripts/site generates; it checks links to them, with their headings.
GENERATED = {"docs/pages.md", "docs/reference.md", "docs/reliability.md", "docs/verification-details.md"} | {
    f"docs/reference/{name}.md" for name in ("command-line", "errors", "outputs-columns", "warnings")
}
LONGEST_FILE = 400  # lines
LONGEST_LINE = 120  # characters, in documents; clang-format and ruff check the code


def code_files(*folders: str) -> list[Path]:
    return sorted(path for folder in folders for end in ("[ch]pp", "cu") for path in (ROOT / folder).rglob(f"*.{end}"))


def own_files() -> list[Path]:
    """Return text files of the project, without generated and built files."""
    code = ["src", "tests", "benchmarks", "python/thawslide", "qgis", "reproduction", "scripts", ".ci"]
    folders = [*code, "cases", "docs"]
    inside = [path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()]
    kinds = {".cpp", ".hpp", ".cu", ".in", ".py", ".toml", ".md", ".txt", ".csv", ".ini", ""}
    found = [path for path in [*inside, *ROOT.iterdir()] if path.is_file() and path.suffix in kinds]
    built = {"__pycache__", ".pytest_cache", ".git"}  # .git is a file in a worktree
    return sorted(path for path in found if not built & set(path.parts))


def documents() -> list[Path]:
    inside = [path for folder in ("docs", "cases", "benchmarks") for path in (ROOT / folder).rglob("*.md")]
    own = [path for form in ("*.md", "scripts/*.md", "src/*/*.md", "tests/*/*.md") for path in ROOT.glob(form)]
    return sorted([*own, *inside])


def includes_of(text: str) -> list[str]:
    return re.findall(r'^\s*#\s*include\s+"([^"]+)"', text, re.MULTILINE)


def module_of(include: str) -> str:
    return "generated" if include == "version.hpp" else include.split("/")[0]


def heading_anchor(title: str) -> str:
    return re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")


def place(path: Path) -> str:
    return str(path.relative_to(ROOT))


def test_modules_are_those_of_the_table_without_a_cycle() -> None:
    assert {path.name for path in SOURCE.iterdir() if path.is_dir()} == set(ALLOWED)
    left = {module: allowed - {module, "generated"} for module, allowed in ALLOWED.items()}
    while left:
        free = {module for module, needs in left.items() if not needs & set(left)}
        assert free, f"these modules include one another: {sorted(left)}"
        left = {module: needs for module, needs in left.items() if module not in free}


def test_modules_include_only_allowed_modules() -> None:
    used = [(path, include) for path in code_files("src") for include in includes_of(path.read_text())]
    assert len(used) > 100
    allowed_in = {path: ALLOWED[path.relative_to(SOURCE).parts[0]] for path, _ in used}
    assert [f"{place(path)}: {name}" for path, name in used if module_of(name) not in allowed_in[path]] == []


def test_folders_of_sim_include_only_allowed_folders() -> None:
    wrong = []
    for path in code_files("src/sim"):
        folder = str(path.parent.relative_to(SOURCE / "sim")).removeprefix(".")
        for include in includes_of(path.read_text()):
            used, *inner = Path(include).parts[:-1] or [""]
            if used == "sim" and "/".join(inner) not in ALLOWED_IN_SIM[folder] | {folder}:
                wrong.append(f"{place(path)} includes {include}")
    assert wrong == []
    assert {path.name for path in (SOURCE / "sim").iterdir() if path.is_dir()} == set(ALLOWED_IN_SIM) - {""}


def test_includes_name_their_module_and_exist() -> None:
    for path in code_files("src", "tests/cpp"):
        for include in includes_of(path.read_text()):
            homes = [SOURCE / include, path.parent / include, ROOT / "tests" / "cpp" / include]
            assert include == "version.hpp" or any(home.is_file() for home in homes), f"{place(path)}: {include}"


def test_only_base_names_the_parallel_backend() -> None:
    word = re.compile(r"#\s*pragma\s+omp|<omp\.h>|\bomp_\w+\(|std::thread\b|<thread>|<execution>")
    users = {place(path) for path in code_files("src") if word.search(path.read_text())}
    assert users
    assert {user for user in users if not user.startswith("src/base/")} == set()


def test_physics_uses_no_arrays_input_or_output_and_names_its_source() -> None:
    allowed = {"cmath", "limits", "utility", "variant", "array"}
    for path in code_files("src/physics"):
        used = set(re.findall(r"#include <([^>]+)>", path.read_text()))
        assert used <= allowed, f"{place(path)} includes {sorted(used - allowed)}"
    for path in (path for path in code_files("src/physics") if path.suffix == ".hpp"):
        opening = path.read_text().split("#pragma once")[0]
        assert re.search(r"Eqs?\. ?\d|\d{4}|chapter|docs/theory/", opening), f"{place(path)} cites no source"


def test_physics_includes_only_device_code() -> None:
    reached = {place(path): path for path in code_files("src/physics")}
    waiting = list(reached.values())
    while waiting:
        of_device = re.sub(r"#ifndef __CUDACC__\n.*?#endif\n", "", waiting.pop().read_text(), flags=re.DOTALL)
        for include in includes_of(of_device):
            if f"src/{include}" not in reached:
                reached[f"src/{include}"] = SOURCE / include
                waiting.append(SOURCE / include)
    outside = {"src/base/linear.hpp", "src/base/portability.hpp", "src/base/select.hpp"}
    assert {name for name in reached if not name.startswith("src/physics/")} == outside


def test_core_neither_prints_nor_exits_nor_catches_signals() -> None:
    word = re.compile(r"\bstd::(cout|cerr|clog)\b|\bfmt::print\b|\bprintf\(|\b(exit|_exit|abort|signal|sigaction)\(")
    for path in code_files("src"):
        if path.relative_to(SOURCE).parts[0] == "app":
            continue
        found = word.search(path.read_text())
        assert not found, f"{place(path)}: {found.group() if found else ''} belongs in src/app"


def test_headers_have_a_guard_and_sources_a_purpose() -> None:
    for path in (path for path in code_files("src") if path.suffix == ".hpp"):
        lines = path.read_text().splitlines()
        assert lines[0].startswith("// "), f"{place(path)} does not open with a comment"
        assert "#pragma once" in lines, f"{place(path)} lacks #pragma once"
    for path in (path for path in code_files("src") if path.suffix == ".cpp"):
        if not path.with_suffix(".hpp").exists():
            assert path.read_text().startswith("// "), f"{place(path)} has no header and no opening comment"


@pytest.mark.parametrize(
    "path",
    code_files("src", "tests", "benchmarks")
    + sorted(path for folder in ("python", "qgis", "reproduction") for path in ROOT.glob(f"{folder}/**/*.py")),
    ids=place,
)
def test_files_are_not_too_long(path: Path) -> None:
    assert len(path.read_text().splitlines()) < LONGEST_FILE


def test_no_todo_tabs_or_machine_paths() -> None:
    unfinished = re.compile(r"\b(" + "|".join(["TO" + "DO", "FIX" + "ME", "X" * 3]) + r")\b|\t|\s$")
    machine = re.compile(r"(?<![\w.}~$-])/(work|root|home|Users)/")
    files = own_files()
    assert len(files) > 100
    wrong = []
    for path in files:
        if path != Path(__file__).resolve():
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if machine.search(line) or (path.suffix != ".csv" and unfinished.search(line)):
                    wrong.append(f"{place(path)}:{number}: {line}")
    assert wrong == []


@pytest.mark.parametrize("path", documents(), ids=place)
def test_document_lines_and_links(path: Path) -> None:
    text = path.read_text()
    folder = ROOT / "docs" / "reference" if path.parent.name == "scripts" else path.parent  # templates of pages there
    for number, line in enumerate(text.splitlines(), 1):
        is_whole = line.lstrip().startswith(("|", "{{")) or "http" in line
        assert len(line) <= LONGEST_LINE or is_whole, f"{place(path)}:{number}"
    prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        if target.startswith(("http://", "https://", "mailto:")):
            continue
        file, _, anchor = target.partition("#")
        there = (folder / file).resolve() if file else path
        if place(there) in GENERATED:
            assert not there.exists(), f"{place(there)} is generated: remove the stored page"
            continue
        assert there.exists(), f"{place(path)} links to {target}"
        if anchor and there.suffix == ".md":
            assert anchor in set(map(heading_anchor, titles_of(there))), f"{place(path)} links to {target}"


@pytest.mark.parametrize("folder", sorted(path for path in (ROOT / "cases").iterdir() if path.is_dir()), ids=place)
def test_case_pages_have_the_same_sections_and_a_sketch(folder: Path) -> None:
    text = (folder / "README.md").read_text()
    sections = ["Set-up", "Running", "Results to expect", "Reasons for the differences", "What to try"]
    assert re.findall(r"^## (.+)$", text, re.MULTILINE) == sections
    assert "](setup.svg)" in text and (folder / "setup.svg").is_file()
    assert f"- {place(folder)}/README.md" in (ROOT / "mkdocs.yml").read_text()


def titles_of(page: Path) -> list[str]:
    return re.findall(r"^#+ (.+)$", page.read_text(), re.MULTILINE)


def test_code_cites_sections_that_the_theory_has() -> None:
    pages = [ROOT / "docs" / "theory.md", *sorted((ROOT / "docs" / "theory").glob("*.md"))]
    assert len(pages) > 10
    titles = [title for page in pages for title in titles_of(page)]
    numbers = {title.split(" ")[0].rstrip(".") for title in titles}
    names = {title.split(" ", 1)[-1] for title in titles} | set(titles)
    cited, wrong = 0, []
    for path in code_files("src", "tests/cpp"):
        text = re.sub(r"\n\s*//\s*", " ", path.read_text())
        named = re.findall(r'docs/theory\.md, "([^"]+)"', text)
        numbered = re.findall(r"docs/theory\.md,? (?:section )?(\d+(?:\.\d+)*)", text)
        of_pages = re.findall(r'(docs/theory/[\w-]+\.md)(?:, "([^"]+)")?', text)
        cited += len(named) + len(numbered) + len(of_pages)
        wrong += [(place(path), name) for name in (*(set(named) - names), *(set(numbered) - numbers))]
        for page, name in of_pages:
            if not (ROOT / page).is_file() or (name and name not in titles_of(ROOT / page)):
                wrong.append((place(path), f"{page}, {name}"))
    assert cited > 0 and wrong == []


def names_in_backticks(path: Path) -> set[str]:
    return set(re.findall(r"`([^`\n]+)`", path.read_text()))


def gtest_names() -> set[str]:
    """Return the C++ tests as `Suite.Test`."""
    macro = re.compile(r"\b(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\s*\)")
    texts = (path.read_text() for path in code_files("tests"))
    return {f"{suite}.{test}" for text in texts for suite, test in macro.findall(text)}


def test_code_files_and_tests_that_pages_name_exist() -> None:
    files = {f"/{place(path)}" for path in code_files("src", "tests", "benchmarks")}
    tests = gtest_names()
    assert len(tests) > 500
    recipe = {"src/physics/basal/weakening_friction.hpp"}  # the reader creates it
    wrong = []
    for page in documents():
        named = set(re.findall(r"[\w/.]*\w\.(?:hpp|cpp|cu)\b", " ".join(names_in_backticks(page)))) - recipe
        wrong += [f"{place(page)}: {name}" for name in named if not any(file.endswith(f"/{name}") for file in files)]
        named = {name for name in names_in_backticks(page) if re.fullmatch(r"[A-Z]\w+\.[A-Z]\w+", name)}
        wrong += [f"{place(page)}: {name}" for name in named - tests]
    assert wrong == []


def test_every_exit_code_is_documented() -> None:
    codes = re.search(r"enum class ExitCode[^{]*\{([^}]*)\}", (SOURCE / "base" / "error.hpp").read_text())
    assert codes
    numbers = re.findall(r"= (\d+)", codes.group(1))
    assert numbers == ["0", "2", "3", "4", "5", "6"]
    page = ROOT / "scripts" / "command_line_page.md"
    assert set(numbers) <= set(re.findall(r"^\| (\d) \|", page.read_text(), re.MULTILINE))


def test_run_and_test_print_help_and_refuse_wrong_options() -> None:
    helped = subprocess.run([ROOT / "run", "--help"], capture_output=True, text=True, timeout=600, check=False)
    assert helped.returncode == 0 and "--setup" in helped.stdout
    bare = subprocess.run([ROOT / "run"], capture_output=True, text=True, timeout=600, check=False)
    assert bare.returncode == 2 and "./run CASE" in bare.stderr
    refused = subprocess.run([ROOT / "test", "--fast"], capture_output=True, text=True, timeout=600, check=False)
    assert refused.returncode == 2 and "--full" in refused.stderr
