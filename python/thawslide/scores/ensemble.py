"""Weighted members against an observation: CRPS, percentile and quantiles.

CRPS of members x_i of weights w_i (sum 1) and an observation y (Gneiting and Raftery 2007, J. Am. Stat. Assoc. 102,
359-378, Eq. 21, for the empirical distribution of the members):

    CRPS = E|X - y| - E|X - X'|/2 = sum_i w_i |x_i - y| - sum_k C_k (1 - C_k) (x_(k+1) - x_(k))

x_(k): sorted members; C_k: total weight of the first k. The second sum equals E|X - X'|/2 without cancellation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers

RANGE = (0.05, 0.5, 0.95)
_ROUNDING = 1e-12  # of a sum of weights


@dataclass(frozen=True)
class Distribution:
    """Members against an observation: 5, 50 and 95 % quantiles, percentiles [%] of the observation, and CRPS."""

    count: int
    low: float
    median: float
    high: float
    percentile: float
    percentile_low: float  # of the observation minus its uncertainty
    percentile_high: float  # of the observation plus its uncertainty
    crps: float


def compare(members: Numbers, weights: Numbers, observed: float, uncertainty: float) -> Distribution:
    """Return the distribution of finite members, whose weights need not sum to 1."""
    low, median, high = quantiles(members, weights)
    at, least, most = (percentile(members, weights, observed + each) for each in (0.0, -uncertainty, uncertainty))
    return Distribution(len(members), low, median, high, at, least, most, crps(members, weights, observed))


def crps(members: Numbers, weights: Numbers, observed: float) -> float:
    """Return the continuous ranked probability score, in the unit of the members; 0 is perfect."""
    order, weights = np.argsort(members, kind="stable"), weights / weights.sum()
    below = np.cumsum(weights[order])[:-1]
    spread = np.sum(below * (1.0 - below) * np.diff(members[order]))
    return float(np.sum(weights * np.abs(members - observed)) - spread)


def percentile(members: Numbers, weights: Numbers, observed: float) -> float:
    """Return the weight of the members below the observation, and half of that of equal ones, in percent."""
    below, equal = weights[members < observed].sum(), weights[members == observed].sum()
    return float(np.clip(100.0 * (below + 0.5 * equal) / weights.sum(), 0.0, 100.0))


def quantiles(members: Numbers, weights: Numbers, probabilities: Sequence[float] = RANGE) -> list[float]:
    """Return quantiles, by default of 5, 50 and 95 %: the smallest member that this weight does not exceed.

    Members that are not finite do not count; nan without any other.
    """
    known = np.isfinite(members) & (weights > 0.0)
    if not known.any():
        return [float("nan")] * len(probabilities)
    members, weights = members[known], weights[known]
    order = np.argsort(members, kind="stable")
    reached = np.cumsum(weights[order]) / weights.sum()
    at = np.searchsorted(reached, np.array(probabilities) * (1.0 - _ROUNDING))
    return [float(value) for value in members[order][np.minimum(at, len(members) - 1)]]
