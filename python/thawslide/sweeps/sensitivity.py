"""Sensitivity of a number to the varied keys: Sobol indices, Morris screening, or rank correlation."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from thawslide.arrays import Numbers, is_constant
from thawslide.errors import NotInRunError
from thawslide.sweeps.design import FACTORIAL, MORRIS_LEVELS, Design, problem_of
from thawslide.sweeps.variables import Levels

CONFIDENCE = 0.95
_RESAMPLES = 1000
_FEWEST = 4  # members, blocks or trajectories with a value

SOBOL_FIRST, SOBOL_TOTAL = "first-order Sobol index", "total Sobol index"
MORRIS = "mean absolute elementary effect μ*"
MORRIS_SPREAD = "standard deviation of elementary effects σ"
RANK = "rank correlation (Spearman)"


@dataclass(frozen=True)
class Index:
    """One measure of sensitivity to a key, with its confidence interval of 95 % (nan: not available)."""

    key: str
    measure: str
    value: float
    low: float
    high: float


def indices_of(design: Design, values: Numbers, weights: Numbers | None = None) -> list[Index]:
    """Return the measures that suit a design, from one value per member, in order; nan: a failed member.

    Sobol indices and Morris effects compare members of a block: a failed member removes its block. Only rank
    correlations use weights. NotInRunError if too few values are left, or all are equal, or for weights of another
    design.
    """
    values = np.asarray(values, dtype=np.float64)
    names = [variable.key for variable in design.dimensions]
    if weights is not None and design.method in ("saltelli", "morris"):
        raise NotInRunError(f"the sample {design.method} has no measure for weighted members. Use lhs or sobol.")
    if design.method == "saltelli":
        return _sobol(names, design, values)
    if design.method == "morris":
        return _morris(names, design, values)
    return _rank(names, _inputs(design), values, design.seed, weights)


def _sobol(names: Sequence[str], design: Design, values: Numbers) -> list[Index]:
    from SALib.analyze import sobol

    blocks = _complete_blocks(values, len(names) + 2)
    found = sobol.analyze(
        problem_of(names),
        blocks.ravel(),
        calc_second_order=False,
        num_resamples=_RESAMPLES,
        conf_level=CONFIDENCE,
        seed=design.seed,
    )
    return [
        _symmetric(name, measure, float(found[short][index]), float(found[f"{short}_conf"][index]))
        for short, measure in (("S1", SOBOL_FIRST), ("ST", SOBOL_TOTAL))
        for index, name in enumerate(names)
    ]


def _morris(names: Sequence[str], design: Design, values: Numbers) -> list[Index]:
    from SALib.analyze import morris

    size = len(names) + 1
    kept = np.repeat(np.isfinite(values.reshape(-1, size)).all(axis=1), size)
    blocks = _complete_blocks(values, size)
    found = morris.analyze(
        problem_of(names),
        design.probabilities()[kept],
        blocks.ravel(),
        num_resamples=_RESAMPLES,
        conf_level=CONFIDENCE,
        num_levels=MORRIS_LEVELS,
        seed=design.seed,
    )
    stars = [
        _symmetric(name, MORRIS, float(found["mu_star"][index]), float(found["mu_star_conf"][index]))
        for index, name in enumerate(names)
    ]
    nan = float("nan")
    return stars + [
        Index(name, MORRIS_SPREAD, float(found["sigma"][index]), nan, nan) for index, name in enumerate(names)
    ]


def _rank(names: Sequence[str], inputs: Numbers, values: Numbers, seed: int, weights: Numbers | None) -> list[Index]:
    """Return rank correlations with the inputs that are numbers, with percentiles of bootstrap samples.

    Weighted members are drawn in proportion to their weights, as many as their effective number.
    """
    kept = np.isfinite(values) if weights is None else np.isfinite(values) & (weights > 0.0)
    inputs, values = inputs[kept], values[kept]
    _require_spread(values, len(values))
    random = np.random.default_rng(seed)
    if weights is None:
        mass = np.full(len(values), 1.0 / len(values))
        samples = random.integers(0, len(values), (_RESAMPLES, len(values)))
    else:
        mass = weights[kept] / weights[kept].sum()
        samples = random.choice(len(values), (_RESAMPLES, max(round(effective_number(mass)), _FEWEST)), p=mass)
    found = []
    for index, name in enumerate(names):
        factor = inputs[:, index]
        if not np.ptp(factor) > 0.0:  # constant, or no number
            continue
        value = _rank_correlation(factor, values, mass)
        resampled = _rank_correlations(factor[samples], values[samples])
        tail = 50.0 * (1.0 - CONFIDENCE)
        low, high = np.nanpercentile(resampled, [tail, 100.0 - tail])
        found.append(Index(name, RANK, value, float(low), float(high)))
    if not found:
        raise NotInRunError("no varied key has numbers as values. Use --range, or --vary with numbers.")
    return found


def effective_number(weights: Numbers) -> float:
    """Return the number of equal members whose mean is as uncertain as that of weighted ones (Kish, 1965)."""
    return float(weights.sum() ** 2 / np.sum(weights**2))


def _rank_correlation(first: Numbers, second: Numbers, weights: Numbers) -> float:
    """Return the rank correlation of weighted members; a rank is the weight below a value and half of that at it."""
    a, b = (each - np.sum(weights * each) for each in (_ranks(first, weights), _ranks(second, weights)))
    return float(np.sum(weights * a * b) / np.sqrt(np.sum(weights * a * a) * np.sum(weights * b * b)))


def _ranks(values: Numbers, weights: Numbers) -> Numbers:
    _, which = np.unique(values, return_inverse=True)
    at = np.bincount(which, weights)
    return np.asarray((np.cumsum(at) - 0.5 * at)[which])


def _rank_correlations(first: Numbers, second: Numbers) -> Numbers:
    """Return the rank correlation of each row of two arrays; nan if all values of a row are equal."""
    from scipy.stats import rankdata

    a, b = rankdata(first, axis=1), rankdata(second, axis=1)
    a, b = a - a.mean(axis=1, keepdims=True), b - b.mean(axis=1, keepdims=True)
    with np.errstate(invalid="ignore"):
        return np.asarray((a * b).sum(axis=1) / np.sqrt((a * a).sum(axis=1) * (b * b).sum(axis=1)))


def _inputs(design: Design) -> Numbers:
    """Return the inputs of each member, shape (members, dimensions).

    Numbers of a list are its values; distributions have cumulative probabilities, whose ranks are those of the values.
    A list with other values is nan.
    """
    if design.method == FACTORIAL:
        levels = [each.values for each in design.dimensions if isinstance(each, Levels)]
        rows: list[list[object]] = [list(row) for row in itertools.product(*levels)]
    else:
        rows = [
            [
                each.at(float(u)) if isinstance(each, Levels) else float(u)
                for each, u in zip(design.dimensions, row, strict=True)
            ]
            for row in design.probabilities()
        ]
    columns = [
        column if all(isinstance(value, int | float) for value in column) else [np.nan] * len(column)
        for column in zip(*rows, strict=True)
    ]
    return np.array(columns, dtype=np.float64).T


def _complete_blocks(values: Numbers, size: int) -> Numbers:
    """Return the blocks of members without a failed one, shape (blocks, size)."""
    blocks = values.reshape(-1, size)
    blocks = blocks[np.isfinite(blocks).all(axis=1)]
    _require_spread(blocks, len(blocks))
    return blocks


def _require_spread(values: Numbers, count: int) -> None:
    if count < _FEWEST:
        raise NotInRunError(f"too few members with a value (found {count}; needed {_FEWEST}). Use a larger sample.")
    if is_constant(values):
        raise NotInRunError("all members have the same value. Vary other keys.")


def _symmetric(name: str, measure: str, value: float, half: float) -> Index:
    return Index(name, measure, value, value - half, value + half)
