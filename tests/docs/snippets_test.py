"""Reading of blocks, and comparison of outputs."""

import time
from pathlib import Path

import pytest
from snippets import Block, Scratch, difference, fault_of, missing_line, page_failures


@pytest.mark.parametrize(
    ("language", "text", "marks", "words"),
    [
        ("", "./run cases/incline\n", {}, "language console"),
        ("", "build/release/thawslide check\n", {}, "language console"),
        ("text", "$ ls\n", {}, "language console"),
        ("", "tau = mu N\n", {}, ""),
        ("bash", "ls\n", {}, "say why"),
        ("bash", "ls\n", {"not run": "needs a key"}, ""),
        ("toml", "a = 1\n", {}, "needs a mark"),
        ("toml", "a = 1\n", {"merged into": "cases/incline/D.toml"}, ""),
        ("console", "ls\n", {}, "begins with"),
        ("console", "$ ls\n...\n$ pwd\n/tmp\n", {}, "`$ ls`: the expected output is only `...`"),
        ("console", "$ ls\n...\na.txt\n$ cd a\n", {}, ""),
    ],
)
def test_form_of_a_block(language: str, text: str, marks: dict[str, str], words: str) -> None:
    fault = fault_of(Block(1, language, text, marks))
    assert (words in fault) if words else not fault


def test_dots_match_lines_and_diffs_show_the_others() -> None:
    output = ["particles: 10", "", "time 3.1 s", "done"]
    assert missing_line(output, output) is None
    assert missing_line(["...", "time [..] s", "..."], output) is None
    assert missing_line(["particles: 10", "...", "done"], output) is None
    assert missing_line(["..."], []) is None
    assert missing_line(["...", "time [..] h", "..."], output) == "time [..] h"
    assert missing_line(["particles: 10", "..."], ["x", *output]) == "particles: 10"
    assert missing_line(["particles: 10"], output) == "(end of the output)"
    assert missing_line([], ["unexpected"]) == "(end of the output)"
    assert difference(["a [..]", "b"], ["a 1", "c"]).splitlines()[3:] == [" a [..]", "-b", "+c"]


def test_commands_run_in_one_folder_within_their_limit(tmp_path: Path) -> None:
    page = (
        "<!-- file: data/a.txt -->\n```text\none\n```\n"
        "```console\n$ cd data\n$ cat a.txt\none\n```\n"
        "<!-- exit code: 3 -->\n```console\n$ exit 3\n```\n"
        "```console\n$ ls\na.txt\n$ ls ../run ../cases/incline/D.toml\n...\n```\n"
        "<!-- long: a minute -->\n```console\n$ false\n```\n"
    )
    assert page_failures(page, Scratch(tmp_path / "clone"), long=False) == []
    (failure,) = page_failures(page.replace("a.txt\none\n", "a.txt\ntwo\n"), Scratch(tmp_path / "other"), long=False)
    assert failure.startswith("line 7: $ cat a.txt\ndoes not come: two\n") and "-two\n+one" in failure
    scratch = Scratch(tmp_path / "limited")
    code, output = scratch.run("(sleep 3; touch late) & sleep 30", 0.5)
    assert (code, output) == (-1, ["(stopped after 0.5 s)"])
    time.sleep(4.0)
    assert not (scratch.folder / "late").exists()


def test_snippets_are_checked_with_their_tools(tmp_path: Path) -> None:
    scratch = Scratch(tmp_path / "clone")
    page = (
        "<!-- merged into: cases/incline/D.toml -->\n```toml\n[time]\nend = 1.0\n```\n"
        "```python\nimport thawslide\n```\n"
        '```cpp\n#include "base/error.hpp"\n```\n'
    )
    assert page_failures(page, scratch, long=False) == []
    wrong = page.replace("end =", "ende =").replace("thawslide", "thawslyde").replace("error.hpp", "eror.hpp")
    mistaken, unknown, absent = page_failures(wrong, scratch, long=False)
    assert "ende" in mistaken
    assert "thawslyde" in unknown
    assert "eror.hpp" in absent
