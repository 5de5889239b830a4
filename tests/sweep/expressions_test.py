"""Expressions of history columns: values, and refusal of everything else."""

import math

import numpy as np
import pytest

from thawslide.errors import ReportError
from thawslide.sweeps.expressions import Expression

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


OTHERS = (
    "__import__('os') | speed.tofile('x') | [1 for x in speed] | lambda: 1 | open(1) | 'a' | max(speed | a if b else c"
)


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
