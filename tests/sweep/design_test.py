"""Varied keys, designs and expressions: forms on the command line, distributions, samples, seeds and limits."""

import math
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from thawslide.errors import ReportError
from thawslide.sweeps.design import Design, parse_sample
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.variables import Levels, Normal, Uniform, parse_distribution, parse_levels

RANGES = (Uniform("a", 0.0, 1.0), Normal("b", 5.0, 1.0))


def test_a_full_factorial_design_has_all_combinations_in_order() -> None:
    design = Design(("one", "two"), (Levels("a", (1, 2)), Levels("b", (3, 4, 5))))
    members = design.members()
    assert design.size == len(members) == 12
    assert [member.number for member in members] == list(range(12))
    assert members[0].case_file == "one" and members[0].changes == {"a": 1, "b": 3}
    assert members[-1].case_file == "two" and members[-1].changes == {"a": 2, "b": 5}


@pytest.mark.parametrize(("method", "count", "size"), [("lhs", 20, 20), ("sobol", 16, 16), ("saltelli", 8, 32)])
def test_samples_have_their_size_and_depend_on_the_seed_only(method: str, count: int, size: int) -> None:
    design = Design(("case",), RANGES, method, count, 7)
    assert design.size == len(design.members()) == size
    assert design.members() == Design(("case",), RANGES, method, count, 7).members()
    assert design.members() != Design(("case",), RANGES, method, count, 8).members()


def test_latin_hypercubes_fill_intervals_and_morris_changes_one_key() -> None:
    values = np.sort([member.changes["a"] for member in Design(("case",), RANGES, "lhs", 50, 1).members()])
    assert np.array_equal(np.floor(values * 50.0), np.arange(50))
    members = Design(("case",), RANGES, "morris", 4, 1).members()
    assert len(members) == 12
    for start in range(0, 12, 3):
        for first, second in zip(members[start : start + 2], members[start + 1 : start + 3], strict=True):
            assert sum(first.changes[key] != second.changes[key] for key in "ab") == 1


def test_cases_and_lists_are_equally_probable_in_a_sample() -> None:
    members = Design(("one", "two"), (Levels("a", (1, 2, 3)),), "lhs", 60, 3).members()
    assert sum(member.case_file == "one" for member in members) == 30
    assert [sum(member.changes["a"] == value for member in members) for value in (1, 2, 3)] == [20, 20, 20]


@pytest.mark.parametrize(
    ("words", "make"),
    [
        ("varied twice", lambda: Design(("case",), (Levels("a", (1,)), Levels("a", (2,))))),
        ("needs a sample", lambda: Design(("case",), RANGES)),
        ("no key varies", lambda: Design(("case",), (), "lhs", 10)),
        ("Use sobol:128", lambda: parse_sample("sobol:100")),
        ("allowed lhs:N", lambda: parse_sample("lsh:100")),
        *(
            ("--vary", partial(parse_levels, text))
            for text in ("band.thickness", "=1", "k=", "k=1,1", "k=3:1:1", "k=1:2:0", "k=0:1:1e-9")
        ),
        *(("--range", partial(parse_distribution, "range", text)) for text in ("k=2:2", "k=2", "k=nan:1")),
        ("--normal", partial(parse_distribution, "normal", "k=1:0")),
        ("--lognormal", partial(parse_distribution, "lognormal", "k=-1:1")),
    ],
)
def test_invalid_designs_are_refused(words: str, make: Callable[[], object]) -> None:
    with pytest.raises(ReportError, match=words):
        make()


def test_lists_and_distributions_have_their_values() -> None:
    assert parse_levels("band.thickness=0.05,0.1,0.2") == Levels("band.thickness", (0.05, 0.1, 0.2))
    assert parse_levels("basal.friction=coulomb,lubricated").values == ("coulomb", "lubricated")
    assert parse_levels("heat.steam=true,false").values == (True, False)
    assert parse_levels("body.block.velocity=[0.0, 1.0],[0.0, 2.0]").values == ([0.0, 1.0], [0.0, 2.0])
    assert parse_levels("basal.friction_angle=20:30:5").values == (20, 25, 30)
    assert parse_levels("band.thickness=0.1:0.3:0.1").values == (0.1, 0.2, 0.3)
    assert parse_levels("band.thickness=0.1:0.35:0.1").values == (0.1, 0.2, 0.3)
    uniform = parse_distribution("range", "k=2:4")
    assert uniform == Uniform("k", 2.0, 4.0) and uniform.at(0.25) == 2.5
    normal = parse_distribution("normal", "k=10:2")
    assert isinstance(normal, Normal) and normal.at(0.5) == pytest.approx(10.0)
    assert normal.at(0.0) == pytest.approx(4.0) and normal.at(1.0) == pytest.approx(16.0)
    lognormal = parse_distribution("lognormal", "k=10:0.5")
    assert lognormal.at(0.5) == pytest.approx(10.0)
    assert lognormal.at(1.0) == pytest.approx(10.0 * 2.718281828**1.5, rel=1e-6)


COLUMNS = {"time_s": np.array([0.0, 1.0, 2.0]), "speed": np.array([0.0, 4.0, 2.0])}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("max(speed)", 4.0),
        ("last(speed) / first(time_s + 1)", 2.0),
        ("at(0.5, speed)", 2.0),
        ("first_time(speed > 3)", 1.0),
        ("integral(speed)", 5.0),
        ("-mean(speed) ** 2", -4.0),
    ],
)
def test_an_expression_has_one_value(text: str, value: float) -> None:
    assert Expression("x", text).value(COLUMNS) == pytest.approx(value)


OTHERS = "__import__('os') | speed.tofile('x') | [1 for x in a] | lambda: 1 | open(1) | 'a' | max(speed | a if b else c"


@pytest.mark.parametrize("text", OTHERS.split(" | "))
def test_expressions_with_other_syntax_are_refused(text: str) -> None:
    with pytest.raises(ReportError, match="--column x"):
        Expression("x", text)


def test_unknown_columns_several_values_and_numbers_without_a_size_are_refused() -> None:
    with pytest.raises(ReportError, match="allowed, for example: speed"):
        Expression("x", "max(sped)").value(COLUMNS)
    with pytest.raises(ReportError, match="not a single value"):
        Expression("x", "speed").value(COLUMNS)
    assert Expression("x", "1 / (first(speed) - first(speed))").value(COLUMNS) == float("inf")
    assert math.isnan(Expression("x", "(0 - 8) ** 0.5").value(COLUMNS))
    with pytest.raises(ReportError, match="cannot be computed"):
        Expression("x", "1" + 400 * "0").value(COLUMNS)
