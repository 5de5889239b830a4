"""Sensitivity and scores of ensembles: published indices, independent implementations, and invariants."""

import math

import numpy as np
import pytest
import scoringrules
from scipy.stats import percentileofscore, spearmanr

from thawslide.errors import NotInRunError
from thawslide.scores.ensemble import crps, percentile, quantiles
from thawslide.scores.forecast import front_duration
from thawslide.sweeps.design import Design
from thawslide.sweeps.sensitivity import MORRIS, RANK, SOBOL_FIRST, SOBOL_TOTAL, effective_number, indices_of
from thawslide.sweeps.variables import Levels, Uniform


def test_sobol_indices_of_the_ishigami_function_match_the_published_values() -> None:
    """Saltelli et al. (2008), Global Sensitivity Analysis: The Primer: a = 7, b = 0.1."""
    design = Design(("case",), tuple(Uniform(f"x{k}", -math.pi, math.pi) for k in (1, 2, 3)), "saltelli", 4096, 1)
    x = np.array([list(member.changes.values()) for member in design.members()])
    values = np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    found = {(each.key, each.measure): each for each in indices_of(design, values)}
    for key, first, total in (("x1", 0.3139, 0.5576), ("x2", 0.4424, 0.4424), ("x3", 0.0, 0.2437)):
        assert found[key, SOBOL_FIRST].value == pytest.approx(first, abs=0.01)
        assert found[key, SOBOL_TOTAL].value == pytest.approx(total, abs=0.01)
        assert found[key, SOBOL_TOTAL].low < total < found[key, SOBOL_TOTAL].high


def test_morris_effects_of_a_linear_function_are_its_slopes() -> None:
    design = Design(("case",), (Uniform("a", 0.0, 2.0), Uniform("b", -1.0, 1.0)), "morris", 10, 1)
    values = np.array([3.0 * member.changes["a"] - member.changes["b"] for member in design.members()])
    values[4] = np.nan  # a failed member removes its trajectory
    found = {each.key: each.value for each in indices_of(design, values) if each.measure == MORRIS}
    assert found == pytest.approx({"a": 6.0, "b": 2.0})


def test_rank_correlations_show_direction_and_need_different_values() -> None:
    design = Design(("case",), (Levels("a", (1, 2, 3, 4)), Levels("b", (1, 2, 3))))
    values = np.array([-(member.changes["a"] ** 3.0) for member in design.members()])
    values[2] = np.nan
    found = {each.key: each for each in indices_of(design, values)}
    assert found["a"].measure == RANK and found["a"].value == pytest.approx(-1.0)
    assert abs(found["b"].value) < 0.2 and found["b"].low < 0.0 < found["b"].high
    design = Design(("case",), (Levels("a", (1, 2, 3, 4, 5)),))
    with pytest.raises(NotInRunError, match="same value"):
        indices_of(design, np.ones(5))
    with pytest.raises(NotInRunError, match="too few"):
        indices_of(design, np.array([1.0, np.nan, np.nan, 2.0, np.nan]))


def test_weighted_rank_correlations_are_those_of_repeated_members() -> None:
    design = Design(("case",), (Uniform("a", 0.0, 1.0), Uniform("b", 0.0, 1.0)), "lhs", 60, 1)
    members = [member.changes for member in design.members()]
    random = np.random.default_rng(2)
    values = np.array([each["a"] - 0.5 * each["b"] for each in members]) + random.normal(0.0, 0.2, 60)
    values[7] = np.nan
    weights = random.integers(0, 4, 60)
    weights[9] = 0
    found = {each.key: each for each in indices_of(design, values, weights / weights.sum())}
    kept = np.repeat(np.flatnonzero(np.isfinite(values)), weights[np.isfinite(values)])
    for key in ("a", "b"):
        inputs = np.array([each[key] for each in members])
        assert found[key].value == pytest.approx(spearmanr(inputs[kept], values[kept]).statistic)
        assert found[key].low < found[key].value < found[key].high
    assert effective_number(np.ones(7)) == 7.0 and effective_number(np.array([1.0, 0.0, 0.0])) == 1.0
    morris = Design(("case",), (Uniform("a", 0.0, 2.0),), "morris", 10, 1)
    with pytest.raises(NotInRunError, match="morris has no measure for weighted members"):
        indices_of(morris, np.arange(20.0), np.ones(20))


def test_rank_correlation_of_a_list_is_that_of_its_values() -> None:
    """The order in which values are given has no effect; texts have no rank."""
    variables = (Levels("a", (30.0, 10.0, 20.0)), Levels("b", ("x", "y")))
    for design in (Design(("case",), variables), Design(("case",), variables, "lhs", 40, 1)):
        found = indices_of(design, np.array([member.changes["a"] for member in design.members()]))
        assert [each.key for each in found] == ["a"]
        assert found[0].value == pytest.approx(1.0)
    with pytest.raises(NotInRunError, match="no varied key has numbers"):
        indices_of(Design(("case",), (Levels("b", ("x", "y", "z", "w")),)), np.arange(4.0))


SIZES = [1, 2, 3, 10, 57, 500]


@pytest.mark.parametrize("size", SIZES)
def test_crps_of_random_ensembles_is_that_of_scoringrules(size: int) -> None:
    random = np.random.default_rng(size)
    for observed in random.normal(3000.0, 2000.0, 20):
        members, weights = random.gamma(4.0, 700.0, size), random.random(size) + 1e-3
        expected = scoringrules.crps_ensemble(observed, members, estimator="nrg")
        assert crps(members, np.ones(size), observed) == pytest.approx(expected, rel=1e-10)
        weighted = scoringrules.crps_ensemble(observed, members, ens_w=weights, estimator="nrg")
        assert crps(members, weights, observed) == pytest.approx(weighted, rel=1e-10)


@pytest.mark.parametrize("size", SIZES)
def test_percentiles_and_quantiles_are_those_of_scipy_and_numpy(size: int) -> None:
    random = np.random.default_rng(size)
    members = random.integers(0, 30, size).astype(float)  # with equal members
    weights = random.integers(1, 5, size).astype(float)
    repeated = np.repeat(members, weights.astype(int))
    for observed in (*range(-1, 32), 7.5):
        expected = percentileofscore(members, observed, kind="mean")
        assert percentile(members, np.ones(size), observed) == pytest.approx(expected, abs=1e-10)
        expected = percentileofscore(repeated, observed, kind="mean")
        assert percentile(members, weights, observed) == pytest.approx(expected, abs=1e-10)
    for values, mass in ((members, np.ones(size)), (members, weights)):
        expected = np.quantile(values, (0.05, 0.5, 0.95), method="inverted_cdf", weights=mass)
        assert quantiles(values, mass) == pytest.approx(list(expected))


def test_members_without_a_value_or_weight_have_no_quantile() -> None:
    values = np.array([np.nan, 1.0, 2.0, 9.0])
    assert quantiles(values, np.array([1.0, 1.0, 1.0, 0.0])) == [1.0, 1.0, 2.0]
    assert np.isnan(quantiles(values, np.array([1.0, 0.0, 0.0, 0.0]))).all()


def test_the_duration_ends_when_the_front_stays_beyond_99_percent_of_its_distance() -> None:
    time = np.linspace(0.0, 100.0, 101)
    assert front_duration(time, np.minimum(10.0 * time, 500.0)) == pytest.approx(49.5)
    assert np.isnan(front_duration(time, np.full(101, 30.0))) and np.isnan(front_duration(time, np.full(101, np.nan)))
    gap = np.where(time < 3.0, np.nan, np.minimum(10.0 * time, 500.0))
    assert front_duration(time, gap) == pytest.approx(49.5)
