"""CRPS, percentiles and quantiles of ensembles against independent implementations, and their invariants."""

import numpy as np
import pytest
import scoringrules
from scipy.stats import percentileofscore

from thawslide.scores.ensemble import compare, crps, percentile, quantiles
from thawslide.scores.forecast import front_duration

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


def test_the_crps_of_one_member_is_the_absolute_difference() -> None:
    for member, observed in ((3.0, 8.0), (8.0, 3.0), (5.0, 5.0)):
        assert crps(np.array([member]), np.array([0.3]), observed) == abs(member - observed)


def test_the_order_of_members_and_the_unit_of_weights_do_not_matter() -> None:
    random = np.random.default_rng(1)
    members, weights = random.normal(size=40), random.random(40)
    first = compare(members, weights, 0.3, 0.2)
    for seed in range(5):
        order = np.random.default_rng(seed).permutation(40)
        again = compare(members[order], 7.0 * weights[order], 0.3, 0.2)
        assert [*vars(again).values()] == pytest.approx([*vars(first).values()])


def test_percentiles_are_within_0_and_100_and_uncertainty_widens_them() -> None:
    random = np.random.default_rng(2)
    for _ in range(200):
        members, weights = random.normal(size=9), random.random(9)
        found = compare(members, weights, 2.0 * random.normal(), random.random())
        assert 0.0 <= found.percentile_low <= found.percentile <= found.percentile_high <= 100.0
        assert found.low <= found.median <= found.high and found.crps >= 0.0


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
