"""Designs: combinations, samples, seeds and limits."""

from __future__ import annotations

import numpy as np
import pytest

from thawslide.errors import ReportError
from thawslide.sweeps.design import Design, parse_sample
from thawslide.sweeps.variables import Levels, Normal, Uniform

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


def test_a_latin_hypercube_has_one_member_in_each_interval() -> None:
    members = Design(("case",), RANGES, "lhs", 50, 1).members()
    values = np.sort([member.changes["a"] for member in members])
    assert np.array_equal(np.floor(values * 50.0), np.arange(50))


def test_morris_trajectories_change_one_key_at_a_time() -> None:
    members = Design(("case",), RANGES, "morris", 4, 1).members()
    assert len(members) == 12
    for start in range(0, 12, 3):
        for first, second in zip(members[start : start + 2], members[start + 1 : start + 3], strict=True):
            assert sum(first.changes[key] != second.changes[key] for key in "ab") == 1


def test_cases_and_lists_are_equally_probable_in_a_sample() -> None:
    members = Design(("one", "two"), (Levels("a", (1, 2, 3)),), "lhs", 60, 3).members()
    assert sum(member.case_file == "one" for member in members) == 30
    assert [sum(member.changes["a"] == value for member in members) for value in (1, 2, 3)] == [20, 20, 20]


def test_invalid_designs_are_refused() -> None:
    with pytest.raises(ReportError, match="varied twice"):
        Design(("case",), (Levels("a", (1,)), Levels("a", (2,))))
    with pytest.raises(ReportError, match="needs a sample"):
        Design(("case",), RANGES)
    with pytest.raises(ReportError, match="no key varies"):
        Design(("case",), (), "lhs", 10)
    with pytest.raises(ReportError, match="Use sobol:128"):
        parse_sample("sobol:100")
    with pytest.raises(ReportError, match="allowed lhs:N"):
        parse_sample("lsh:100")
