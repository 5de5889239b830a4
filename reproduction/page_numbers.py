"""Numbers in hand-written pages: their places, and comparison with the results of runs.

A file of declarations lists the runs by name. For each page it lists phrases, with numbers in braces and one expression
for each number. A sequence of spaces or a line break in a page corresponds to one space in a phrase. An expression
refers to runs by name. It ends with "to STEP" if the page rounds to multiples of STEP, and with "at most" or "at least"
if the page states a bound.
"""

from __future__ import annotations

import ast
import math
import re
import shlex
import tomllib
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

from thawslide.errors import ReportError

_NUMBER = r"[-+−]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:e[-+−]?\d+)?"
_MARKED = re.compile(r"\{(" + _NUMBER + r")\}")
_RULE = re.compile(r"(?s)^(.*?)\s+(?:(to)\s+(\S+)|(at most|at least))$")
# Units of results. Many lengths in metres and times in seconds in a page are not results.
_UNITS = r"(?:m/s2?|km2?|m2|m3|TN|GN|[TGP]J|[MGk]?Pa|kg|t|°?C|K|%|s|m|min|degrees)(?![\w/])"
_WITH_UNIT = re.compile(r"(?<![\w.,/-])" + _NUMBER + r"(?: to " + _NUMBER + r")? " + _UNITS)
_CODE = re.compile(r"(?s)```.*?```|`[^`]*`|\]\([^)]*\)")
ROUND_OFF = 1e-9


class DeclarationError(Exception):
    """Error in a declaration; the message identifies it and gives the remedy."""


@dataclass(frozen=True)
class Number:
    """A number in a page, and the expression that computes it from runs."""

    text: str
    expression: str
    step: float  # multiple to which the page rounds; 0 for a bound
    bound: str = ""  # "", "at most" or "at least"

    @property
    def value(self) -> float:
        """The value in the page."""
        return float(_plain(self.text))

    def agrees(self, found: float) -> bool:
        """Return whether a computed value rounds to this number, or satisfies the bound."""
        if self.bound:
            return found <= self.value if self.bound == "at most" else found >= self.value
        return abs(found - self.value) <= 0.5 * self.step * (1.0 + ROUND_OFF) + ROUND_OFF * abs(self.value)

    def written(self, found: float) -> str:
        """Return a computed value in the format of this number; the number itself for a bound or a power of ten."""
        if self.bound or "e" in self.text or not math.isfinite(found):
            return self.text
        step = Decimal(repr(self.step))
        rounded = (Decimal(found) / step).to_integral_value() * step
        decimals = len(self.text.partition(".")[2])
        text = f"{rounded:{'+' if self.text.startswith('+') else ''},.{decimals}f}"
        return text.replace("-", "−") if "−" in self.text else text

    def shown(self, found: float) -> str:
        """Return a computed value with one digit more than in the page."""
        if self.bound or not self.step:
            return f"{found:.4g}"
        decimals = max(0, 1 - Decimal(f"{self.step:g}").adjusted())
        return f"{found:,.{decimals}f}"

    @property
    def names(self) -> set[str]:
        """The names that the expression uses."""
        return {node.id for node in ast.walk(ast.parse(self.expression, mode="eval")) if isinstance(node, ast.Name)}


@dataclass(frozen=True)
class Phrase:
    """A phrase of a page with numbers to compare; without them, its numbers come from no run."""

    declared: str  # with the numbers in braces
    numbers: tuple[Number, ...] = ()

    @property
    def text(self) -> str:
        """The phrase as in the page, with one space for each white space."""
        return " ".join(_MARKED.sub(r"\1", self.declared).split())

    @property
    def places(self) -> list[int]:
        """The start of each number in the text."""
        marks = _MARKED.finditer(" ".join(self.declared.split()))
        return [found.start() - 2 * place for place, found in enumerate(marks)]


@dataclass(frozen=True)
class Difference:
    """A number that differs from its run, or that has no value (found is nan, and why gives the reason)."""

    file: str
    line: int
    phrase: Phrase
    place: int  # of the number within the phrase
    found: float
    why: str = ""

    def __str__(self) -> str:
        number = self.phrase.numbers[self.place]
        if self.why:
            return f"{self.file}:{self.line}: '{number.expression}' has no value: {self.why}"
        says = f"{number.bound} {number.text}".strip()
        return (
            f"{self.file}:{self.line}: says {says}, the run gives {number.shown(self.found)} "
            f"('{self.phrase.text}': {number.expression})"
        )


@dataclass(frozen=True)
class Page:
    """A page's declarations."""

    file: str
    checked: tuple[Phrase, ...]
    given: tuple[Phrase, ...]


@dataclass(frozen=True)
class Declarations:
    """Texts by name, runs by name as arguments of `thawslide`, and pages."""

    texts: dict[str, str]
    runs: dict[str, tuple[str, ...]]
    pages: tuple[Page, ...]


def _plain(text: str) -> str:
    return text.replace(",", "").replace("−", "-")


def shown_step(text: str) -> float:
    """Return the unit of the last digit of a number: 1 for 1,220, 0.01 for 0.25, 1e-7 for 3e-7."""
    exponent = Decimal(_plain(text)).as_tuple().exponent
    assert isinstance(exponent, int)
    return float(Decimal(1).scaleb(exponent))


def number_of(text: str, expression: str) -> Number:
    """Return a number from its text in the page and its declared expression, which may end with a rule."""
    rule = _RULE.match(expression)
    if rule is None:
        return Number(text, expression, shown_step(text))
    return Number(text, rule[1], float(rule[3]) if rule[2] else 0.0, rule[4] or "")


def phrase_of(declared: list[str]) -> Phrase:
    """Return a phrase from its text with {numbers} and their expressions."""
    text, *expressions = declared
    marked = _MARKED.findall(text)
    if len(marked) != len(expressions):
        raise DeclarationError(
            f"'{text}': the numbers in braces and the expressions do not match "
            f"(found {len(marked)} and {len(expressions)}). Give one expression for each number."
        )
    return Phrase(text, tuple(map(number_of, marked, expressions)))


def read_declarations(path: Path) -> Declarations:
    """Read the file of declarations."""
    content: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    runs = {name: tuple(shlex.split(words)) for name, words in content["runs"].items()}
    pages = tuple(
        Page(
            page["file"],
            tuple(phrase_of(each) for each in page.get("checked", ())),
            tuple(Phrase(each) for each in page.get("given", ())),
        )
        for page in content["page"]
    )
    return Declarations(content["texts"], runs, pages)


class PageText:
    """The text of a page with one space for each white space, and the line number of each place."""

    def __init__(self, text: str) -> None:
        words = list(re.finditer(r"\S+", text))
        self.flat = " ".join(word[0] for word in words)
        self._starts: list[int] = []  # of words in the flat text
        self._origins = [word.start() for word in words]  # in the text itself
        self._lines: list[int] = []
        start = 0
        for word in words:
            self._starts.append(start)
            self._lines.append(text.count("\n", 0, word.start()) + 1)
            start += len(word[0]) + 1

    def line(self, place: int) -> int:
        """Return the line of a place in the flat text."""
        return self._lines[bisect_right(self._starts, place) - 1]

    def origin(self, place: int) -> int:
        """Return the place in the text itself of a place in the flat text."""
        word = bisect_right(self._starts, place) - 1
        return self._origins[word] + place - self._starts[word]

    def places(self, phrase: Phrase) -> list[tuple[int, int]]:
        """Return the start and end of each occurrence of a phrase in the flat text."""
        return [found.span() for found in re.finditer(re.escape(phrase.text), self.flat)]


def section_places(text: PageText, source: str) -> Iterator[tuple[int, int, str]]:
    """Yield the start and end of each section in the flat text, with its heading."""
    headings = re.findall(r"(?m)^#+ .+$", re.sub(r"(?s)```.*?```", "", source))
    starts: list[int] = []
    for heading in headings:
        start = text.flat.find(" ".join(heading.split()), starts[-1] + 1 if starts else 0)
        starts.append(start)
    for start, end, heading in zip(starts, [*starts[1:], len(text.flat)], headings, strict=True):
        yield start, end, heading


def misplaced(page: Page, source: str) -> list[str]:
    """Return errors in the phrases of a page: a checked one must occur once, any other at least once."""
    text = PageText(source)
    wrong = []
    for phrase in (*page.checked, *page.given):
        found = len(text.places(phrase))
        if found == 0 or (found > 1 and phrase.numbers):
            allowed = "1" if phrase.numbers else "1 or more"
            wrong.append(
                f"{page.file}: the page does not state '{phrase.text}' as declared (found {found} times; allowed "
                f"{allowed}). Write in the declarations what the page says."
            )
    return wrong


def undeclared(page: Page, source: str) -> list[str]:
    """Return the numbers with a unit, by line, that are in no declared phrase and no section declared as given."""
    text = PageText(source)
    covered = [place for phrase in (*page.checked, *page.given) for place in text.places(phrase)]
    sections = {phrase.text for phrase in page.given if phrase.text.startswith("#")}
    covered += [(start, end) for start, end, heading in section_places(text, source) if heading in sections]
    covered += [found.span() for found in _CODE.finditer(text.flat)]
    return [
        f"{page.file}:{text.line(found.start())}: '{found[0]}' is not declared"
        for found in _WITH_UNIT.finditer(text.flat)
        if not any(start <= found.start() and found.end() <= end for start, end in covered)
    ]


def needed_runs(declared: Declarations, pages: Mapping[str, Page]) -> set[str]:
    """Return the names of the runs that these pages need."""
    numbers = (number for page in pages.values() for phrase in page.checked for number in phrase.numbers)
    return {name for number in numbers for name in number.names if name in declared.runs}


def evaluate(number: Number, names: Mapping[str, Any]) -> float:
    """Return the value of a number that the runs give."""
    return float(eval(number.expression, dict(names)))  # the repository's own declarations


def differences(
    page: Page, source: str, names: Mapping[str, Any], absent: Set[str] = frozenset()
) -> tuple[list[Difference], int]:
    """Return the numbers of a page that differ from their runs, and the count of compared numbers.

    Numbers of absent runs are not compared.
    """
    text = PageText(source)
    wrong, compared = [], 0
    for phrase in page.checked:
        line = text.line(text.places(phrase)[0][0])
        for place, number in enumerate(phrase.numbers):
            if number.names & absent:
                continue
            compared += 1
            try:
                found = evaluate(number, names)
            except (LookupError, ReportError, AttributeError, NameError, TypeError) as error:
                wrong.append(Difference(page.file, line, phrase, place, math.nan, str(error)))
                continue
            if not number.agrees(found):
                wrong.append(Difference(page.file, line, phrase, place, found))
    return wrong, compared


def corrected(source: str, declarations: str, wrong: Sequence[Difference]) -> tuple[str, str]:
    """Return a page and the declarations in which computed values replace the numbers that differ."""
    text = PageText(source)
    changes = []
    for each in wrong:
        number, start = each.phrase.numbers[each.place], text.places(each.phrase)[0][0]
        place = text.origin(start + each.phrase.places[each.place])
        changes.append((place, place + len(number.text), number.written(each.found)))
    for start, end, new in sorted(changes, reverse=True):
        source = source[:start] + new + source[end:]
    for phrase in dict.fromkeys(each.phrase for each in wrong):
        new_texts = [number.text for number in phrase.numbers]
        for each in wrong:
            if each.phrase == phrase:
                new_texts[each.place] = phrase.numbers[each.place].written(each.found)
        parts = _MARKED.split(phrase.declared)[::2]
        marked = "".join(f"{words}{{{new}}}" for words, new in zip(parts, new_texts, strict=False)) + parts[-1]
        declarations = declarations.replace(phrase.declared, marked)
    return source, declarations
