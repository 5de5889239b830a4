"""Comparison of numbers of pages with runs."""

import math
import random
import re
from pathlib import Path

import pytest

from reproduction import page_numbers
from reproduction.__main__ import main
from reproduction.page_measures import from_table
from reproduction.page_numbers import DeclarationError, Phrase, differences, number_of, phrase_of

SOURCE = """# A case

It reaches a peak of 84 m/s, 31 s
after the start, and `1 km` in code.

## Inputs

Cells of 10 m.
"""
PEAK = phrase_of(["a peak of {84} m/s, {31} s after the start", "peak", "rise"])


def page_of(*checked: Phrase, given: tuple[str, ...] = ()) -> page_numbers.Page:
    return page_numbers.Page("page.md", checked, tuple(Phrase(each) for each in given))


def test_number_has_its_rule_and_its_format() -> None:
    for text, expression, right, wrong in (
        ("1,220", "x to 10", (1215.1, 1224.9), (1214.0, 1226.0)), ("-36", "x", (-35.6, -36.4), (36.0, -35.0)),
        ("1,220", "x", (1219.6, 1220.4), (1219.0, 1221.0)), ("0.25", "x", (0.245, 0.2549), (0.24, 0.256)),
        ("+72", "x", (72.3,), (71.0,)), ("−4", "x", (-4.2,), (4.0,)), ("3e-7", "x", (3.4e-7,), (4e-7,)),
        ("0.01", "x at most", (0.0, 0.01), (0.0101,)), ("150", "x at least", (150.0, 1e3), (149.9,)),
        ("1", "x", (), (math.nan, math.inf)),
    ):  # fmt: skip
        number = number_of(text, expression)
        assert number.expression == "x" and all(map(number.agrees, right)), text
        assert not any(map(number.agrees, wrong)), text
    for text, expression, found, written in (
        ("1,220", "x to 10", 1234.0, "1,230"), ("999", "x", 1000.4, "1,000"), ("+72", "x", -3.2, "-3"),
        ("+72", "x", 70.6, "+71"), ("−4", "x", -5.1, "−5"), ("0.25", "x", 0.3, "0.30"),
        ("150", "x at most", 160.0, "150"), ("1e-6", "x", 2e-6, "1e-6"), ("84", "x", float("inf"), "84"),
    ):  # fmt: skip
        assert number_of(text, expression).written(found) == written, text


def test_wrong_numbers_and_expressions_without_a_value_are_reported_with_their_line() -> None:
    assert differences(page_of(PEAK), SOURCE, {"peak": 84.4, "rise": 30.9}) == ([], 2)
    bound, entry = (page_of(phrase_of(["a peak of {84} m/s", text])) for text in ("peak at most", 'peak["speed"]'))
    for page, names, count, message in (
        (page_of(PEAK), {"peak": 80.27, "rise": 30.9}, 2,
         "says 84, the run gives 80.3 ('a peak of 84 m/s, 31 s after the start': peak)"),
        (bound, {"peak": 84.5}, 1, "says at most 84, the run gives 84.5 ('a peak of 84 m/s': peak)"),
        (page_of(PEAK), {"peak": 84.4}, 2, "'rise' has no value: name 'rise' is not defined"),
        (entry, {"peak": {}}, 1, "'peak[\"speed\"]' has no value: 'speed'"),
    ):  # fmt: skip
        wrong, compared = differences(page, SOURCE, names)
        assert ([str(each) for each in wrong], compared) == ([f"page.md:3: {message}"], count)
    assert differences(page_of(PEAK), SOURCE, {"peak": 84.4}, {"rise"}) == ([], 1)
    with pytest.raises(DeclarationError, match=r"do not match \(found 1 and 2\). Give one expression for each number"):
        phrase_of(["a peak of {84} m/s", "peak", "rise"])


@pytest.mark.parametrize("seed", range(5))
def test_corrected_page_differs_only_in_its_numbers(seed: int) -> None:
    chosen = random.Random(seed)
    numbers = [f"{chosen.uniform(-5e3, 5e4):,.{chosen.randint(0, 4)}f}" for _ in range(9)]
    rows = [f"row {row}: {{{number}}} m and {{+1.0}} %" for row, number in enumerate(numbers)]
    phrases = [phrase_of([row, "one", "two"]) for row in rows]
    page = page_of(*phrases)
    spaces = (" ", "\n", "\n  ")
    source = "".join(phrase.text.replace(" ", chosen.choice(spaces)) + ".\n\n" for phrase in phrases)
    declarations = "\n".join(phrase.declared for phrase in phrases)
    names = {"one": chosen.uniform(-5e3, 5e4), "two": chosen.uniform(-50.0, 50.0)}
    wrong, _ = differences(page, source, names)
    assert len(wrong) == 18
    new_source, new_declarations = page_numbers.corrected(source, declarations, wrong)
    new_page = page_of(*(phrase_of([line, "one", "two"]) for line in new_declarations.splitlines()))
    assert (differences(new_page, new_source, names), len(new_page.checked)) == (([], 18), 9)
    words = [re.sub(r"[-+]?[\d,]*\.?\d+(?= |\n)", "#", each) for each in (source, new_source)]
    assert words[0] == words[1]


@pytest.mark.parametrize(("text", "count"), [("a peak of {85} m/s", 0), ("{1} km", 1), ("{10} m", 1)])
def test_checked_phrase_must_occur_once(text: str, count: int) -> None:
    wrong = page_numbers.misplaced(page_of(phrase_of([text, "x"])), SOURCE)
    assert len(wrong) == 1 - count
    assert all(f"as declared (found {count} times; allowed 1)" in line for line in wrong)
    assert len(page_numbers.misplaced(page_of(phrase_of([text, "x"])), SOURCE + SOURCE)) == 1


def test_given_phrases_occur_and_undeclared_numbers_are_reported() -> None:
    assert page_numbers.misplaced(page_of(given=("Cells of 10 m",)), SOURCE + SOURCE) == []
    assert page_numbers.misplaced(page_of(given=("Cells of 20 m",)), SOURCE) == [
        "page.md: the page does not state 'Cells of 20 m' as declared (found 0 times; allowed 1 or more). Write in the "
        "declarations what the page says."
    ]
    for page, found in (
        (page_of(PEAK, given=("Cells of 10 m",)), []),
        (page_of(PEAK, given=("## Inputs",)), []),
        (page_of(PEAK), ["page.md:8: '10 m'"]),
        (page_of(given=("## Inputs",)), ["page.md:3: '84 m/s'", "page.md:3: '31 s'"]),
    ):
        assert page_numbers.undeclared(page, SOURCE) == [f"{place} is not declared" for place in found]


def test_declarations_are_read_with_texts_runs_and_pages(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "numbers.toml"
    file.write_text(
        '[texts]\nPAGE = "a.md"\n[runs]\nshort = "cases/block/e050.toml time.end=1 \'b = [1, 2]\'"\n'
        '[[page]]\nfile = "page.md"\nchecked = [["a {1} m", "short.peak"]]\ngiven = ["2 m"]\n'
    )
    found = page_numbers.read_declarations(file)
    assert found.texts == {"PAGE": "a.md"}
    assert found.runs == {"short": ("cases/block/e050.toml", "time.end=1", "b = [1, 2]")}
    assert found.pages == (page_numbers.Page("page.md", (phrase_of(["a {1} m", "short.peak"]),), (Phrase("2 m"),)),)
    assert found.pages[0].checked[0].numbers[0].names == {"short"}
    program = tmp_path / "thawslide"
    program.touch()
    assert main(["--only", "numbers:NONE.md", "--program", str(program)]) == 1
    assert "NONE.md: not in reproduction/page_numbers.toml (allowed: README.md, " in capsys.readouterr().out


TABLES = """| e | quantity | 5 m |
|---|---|---|
| 0.3 | runout | **8.4** |

| run | runout | band |
| --- | --- | --- |
| the case | 9.0 (−0.4 %) | 177 to 192 |
| none | 1,023 | −10 |
"""


def test_number_of_a_table_is_found_by_column_and_row() -> None:
    assert from_table(TABLES, "5 m", "0.3", "runout") == 8.4
    found = [from_table(TABLES, column, row) for row in ("the case", "none") for column in ("runout", "band")]
    assert found == [9.0, 192.0, 1023.0, -10.0]
    with pytest.raises(KeyError, match=r"no table has the column 'band' and a row that begins with \('0.3',\)"):
        from_table(TABLES, "band", "0.3")
