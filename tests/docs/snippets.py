"""Fenced blocks of a page: reading them, checking their form, and running their commands.

A comment in the line above a block specifies its test:

    <!-- not run: REASON -->       no test
    <!-- long: REASON -->          with ./test --full only
    <!-- exit code: N -->          each of its commands ends with N instead of 0
    <!-- setup: COMMAND -->        a command that runs before the block; $TESTS is the folder of the tests
    <!-- file: NAME -->            the block is saved under this name, for the commands after it
    <!-- merged into: CASE -->     of a toml block: `thawslide check` accepts the case with these keys
"""

import difflib
import os
import re
import shutil
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("THAWSLIDE_BINARY", ROOT / "build" / "release" / "thawslide"))
LIMIT = {False: 600.0, True: 1800.0}  # s, of a command; of one in a block marked long

FENCE = re.compile(r"^( *)```(\S*)\s*$")
MARK = re.compile(r"^ *<!-- (not run|long|exit code|setup|file|merged into): (.+) -->$")
COMMAND = re.compile(r"^(\$ |\./|\w+=\S+ \S|(thawslide|cmake|ctest|git|cd|pip|python3?|sudo|apt-get|export)\b)")
PATHS = re.compile(r"^(build|scripts|benchmarks|\.venv)/\S+")
SHELLS = {"sh", "bash", "shell", "zsh"}


@dataclass(frozen=True)
class Command:
    """A command of a console block, and the lines that it should print."""

    line: int
    text: str
    expected: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Block:
    """A fenced block: the line of its fence, its language, its text, and its marks."""

    line: int
    language: str
    text: str
    marks: dict[str, str]


def blocks_of(page: str) -> list[Block]:
    """Return the fenced blocks of a page."""
    found = []
    lines = page.splitlines()
    k = 0
    while k < len(lines):
        opening = FENCE.match(lines[k])
        if not opening:
            k += 1
            continue
        marks: dict[str, str] = {}
        above = k - 1
        while above >= 0 and (mark := MARK.match(lines[above])):
            marks[mark[1]] = mark[2]
            above -= 1
        end = next((n for n in range(k + 1, len(lines)) if lines[n].strip() == "```"), len(lines))
        indent = len(opening[1])
        text = "\n".join(line[indent:] if not line[:indent].strip() else line for line in lines[k + 1 : end])
        found.append(Block(k + 1, opening[2], text + "\n", marks))
        k = end + 1
    return found


def only_dots(expected: list[str]) -> bool:
    """Return whether an expected output consists of dots only, which match any output."""
    return bool(expected) and all(line in {"", "...", "[..]"} for line in expected)


def fault_of(block: Block) -> str:
    """Return the error in the form of a block, or nothing."""
    if "not run" in block.marks:
        return ""
    if block.language in SHELLS:
        return "use ```console with `$ command` and its output, or say why it is not run"
    if block.language == "toml" and not {"file", "merged into"} & block.marks.keys():
        return "a toml block needs a mark: file, merged into or not run"
    if block.language == "console" and not block.text.startswith("$ "):
        return "a console block begins with `$ command`"
    lines = block.text.split("\n")
    if block.language in {"", "text"} and any(COMMAND.match(line) or PATHS.match(line) for line in lines):
        return "a block with a command needs the language console"
    if block.language == "console":
        unshown = next((each for each in commands_of(block) if only_dots(each.expected)), None)
        if unshown:
            return f"`$ {unshown.text}`: the expected output is only `...`. Show a line of it."
    return ""


def commands_of(block: Block) -> list[Command]:
    """Return the commands of a console block; one that ends with a backslash continues in the next line."""
    found: list[Command] = []
    continues = False
    for number, line in enumerate(block.text.splitlines(), block.line + 1):
        if continues:
            last = found.pop()
            found.append(Command(last.line, f"{last.text}\n{line}"))
            continues = line.endswith("\\")
        elif line.startswith("$ "):
            found.append(Command(number, line[2:]))
            continues = line.endswith("\\")
        else:
            found[-1].expected.append(line.rstrip())
    return found


def line_fits(expected: str, actual: str) -> bool:
    """Return whether a line is as expected: [..] matches any text."""
    return re.fullmatch(".*".join(map(re.escape, expected.split("[..]"))), actual) is not None


def missing_line(expected: list[str], actual: list[str]) -> str | None:
    """Return the first missing expected line, if any; a line ... matches any lines."""
    after = {0}  # numbers of actual lines that the expected lines so far can cover
    for line in expected:
        if line == "...":
            after = set(range(min(after), len(actual) + 1))
        else:
            after = {n + 1 for n in after if n < len(actual) and line_fits(line, actual[n])}
        if not after:
            return line
    return None if len(actual) in after else "(end of the output)"


def difference(expected: list[str], actual: list[str]) -> str:
    """Return a diff of two outputs in which lines that fit are equal."""
    patterns = [line for line in expected if line != "..."]
    shown = [next((line for line in patterns if line_fits(line, there)), there) for there in actual]
    return "\n".join(difflib.unified_diff(expected, shown, "page", "output", lineterm="", n=1))


class Scratch:
    """A folder like a clone after setup, in which the commands of one page run."""

    def __init__(self, folder: Path) -> None:
        self.folder = self.current = folder
        shutil.copytree(ROOT / "cases", folder / "cases")
        shutil.copy(ROOT / "run", folder / "run")
        (folder / "scripts").mkdir()
        (folder / "scripts" / "setup").write_text("#!/bin/sh\n")
        (folder / "scripts" / "setup").chmod(0o755)
        (folder / "build" / "release").mkdir(parents=True)
        (folder / "build" / "release" / "thawslide").symlink_to(PROGRAM.resolve())
        (folder / ".venv").symlink_to(ROOT / ".venv")
        path = [f"{folder}/build/release", f"{folder}/.venv/bin", os.environ["PATH"]]
        own = {"PATH": ":".join(path), "TESTS": str(ROOT / "tests"), "LC_ALL": "C.UTF-8", "MPLBACKEND": "agg"}
        self.environment = os.environ | own

    def run(self, command: str, limit: float) -> tuple[int, list[str]]:
        """Run a command in the folder of the previous one; return its exit code and its output."""
        kept = self.folder / ".current"
        script = f'{command}\ncode=$?; pwd > "{kept}"; exit $code'
        streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        with subprocess.Popen(
            ["bash", "-c", script], cwd=self.current, env=self.environment, encoding="utf-8", errors="replace",
            start_new_session=True, **streams,
        ) as running:  # fmt: skip
            try:
                printed, _ = running.communicate(timeout=limit)
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, signal.SIGKILL)  # with all processes of the shell
                return -1, [f"(stopped after {limit:g} s)"]
        if kept.exists():
            self.current = Path(kept.read_text().strip())
        return running.returncode, [line.rstrip() for line in printed.splitlines()]

    def write(self, name: str, text: str) -> Path:
        """Write a file in the folder."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path


def command_failures(command: Command, code_expected: int, scratch: Scratch, limit: float) -> list[str]:
    """Run a command; return differences from the page."""
    code, output = scratch.run(command.text, limit)
    head = f"line {command.line}: $ {command.text}"
    if code != code_expected:
        return [f"{head}\nexit code {code}, not {code_expected}:\n" + "\n".join(output)]
    missing = missing_line(command.expected, output)
    if missing is None:
        return []
    return [f"{head}\ndoes not come: {missing}\n{difference(command.expected, output)}"]


def checked(command: list[str | Path], what: str, scratch: Scratch, limit: float) -> list[str]:
    """Run a tool on a block; return its output if it fails."""
    code, output = scratch.run(" ".join(f"'{word}'" for word in command), limit)
    return [] if code == 0 else [f"{what}: exit code {code}:\n" + "\n".join(output)]


def block_failures(block: Block, scratch: Scratch) -> list[str]:
    """Run or check a block; return its failures."""
    limit = LIMIT["long" in block.marks]
    what = f"line {block.line}"
    if setup := block.marks.get("setup"):
        code, output = scratch.run(setup, limit)
        if code != 0:
            return [f"{what}: setup: exit code {code}:\n" + "\n".join(output)]
    if name := block.marks.get("file"):
        scratch.write(name, block.text)
        return []
    if block.language == "console":
        code = int(block.marks.get("exit code", "0"))
        return [text for command in commands_of(block) for text in command_failures(command, code, scratch, limit)]
    if base := block.marks.get("merged into"):
        case = Path(base)
        head = f'[case]\nbased_on = "{case.name}"\n'
        text = block.text.replace("[case]\n", head, 1) if "[case]\n" in block.text else head + block.text
        merged = scratch.write(str(case.parent / "merged.toml"), text)
        return checked([PROGRAM, "check", merged], what, scratch, limit)
    if block.language == "python":
        return checked([sys.executable, scratch.write("snippet.py", block.text)], what, scratch, limit)
    if block.language == "cpp":
        flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", f"-I{ROOT / 'src'}", "-include"]
        unit = scratch.write("snippet.cpp", "")
        return checked(["g++", *flags, scratch.write("snippet.hpp", block.text), unit], what, scratch, limit)
    return []


def page_failures(page: str, scratch: Scratch, long: bool) -> list[str]:
    """Run the blocks of a page in order; return their failures."""
    failures = []
    for block in blocks_of(page):
        if "not run" not in block.marks and (long or "long" not in block.marks):
            failures += block_failures(block, scratch)
    return failures
