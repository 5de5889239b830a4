"""Designs of a sweep: full factorial and samples, as members with values of the varied keys."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError, nearest, quoted
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.variables import CASE, Levels, Variable

FACTORIAL = "factorial"
METHODS = ("lhs", "sobol", "saltelli", "morris")
MORRIS_LEVELS = 4
_MOST_MEMBERS = 1_000_000
_POWERS_OF_TWO = ("sobol", "saltelli")
_CORRELATED = ("lhs", "sobol")
_LEAST_EIGENVALUE = 1e-9
_EDGE = 1e-12  # probability at which normal scores are limited


@dataclass(frozen=True)
class Member:
    """One member: its number from 0, its case file, and the values of the varied keys."""

    number: int
    case_file: str
    changes: dict[str, Any]


@dataclass(frozen=True)
class Design:
    """Cases, variables, and the method that combines them; the same design always has the same members."""

    cases: tuple[str, ...]
    variables: tuple[Variable, ...]
    method: str = FACTORIAL
    count: int = 0  # of the sample: members, base points (saltelli) or trajectories (morris)
    seed: int = 0
    ties: tuple[Expression, ...] = ()  # keys computed from the others, in this order
    correlations: tuple[tuple[str, str, float], ...] = ()  # pairs of keys and their rank correlations

    def __post_init__(self) -> None:
        keys = [variable.key for variable in self.variables] + [tie.name for tie in self.ties]
        for index, key in enumerate(keys):
            if key in keys[:index]:
                raise ReportError(f"{key}: varied twice. Remove one of the options.")
        if self.method == FACTORIAL:
            for variable in self.variables:
                if not isinstance(variable, Levels):
                    raise ReportError(f"{variable.key}: a distribution needs a sample. Add --sample, e.g. lhs:200.")
        elif not self.dimensions:
            raise ReportError("--sample: no key varies. Add --range KEY=LOW:HIGH.")
        if self.seed < 0:
            raise ReportError(f"--seed: negative (found {self.seed}). Use 0 or more.")
        if self.correlations:
            self._require_correlations()
        if self.size > _MOST_MEMBERS:
            raise ReportError(f"too many members (found {self.size:,}; allowed {_MOST_MEMBERS:,}). Vary fewer values.")

    @property
    def dimensions(self) -> tuple[Variable, ...]:
        """The variables with more than one value, after that of the case if there are several."""
        varied = tuple(each for each in self.variables if not (isinstance(each, Levels) and len(each.values) == 1))
        return ((Levels(CASE, self.cases),) if len(self.cases) > 1 else ()) + varied

    @property
    def constants(self) -> dict[str, Any]:
        """The keys with one value."""
        return {
            each.key: each.values[0] for each in self.variables if isinstance(each, Levels) and len(each.values) == 1
        }

    @property
    def size(self) -> int:
        """The number of members."""
        varied = len(self.dimensions)
        if self.method == FACTORIAL:
            return math.prod(len(each.values) for each in self.dimensions if isinstance(each, Levels))
        return self.count * {"saltelli": varied + 2, "morris": varied + 1}.get(self.method, 1)

    def _require_correlations(self) -> None:
        varied = [each.key for each in self.dimensions]
        for one, other, value in self.correlations:
            for key in (one, other):
                if key not in varied:
                    raise ReportError(f"--correlate: {key} does not vary{nearest(key, varied)}")
            if one == other or not -1.0 < value < 1.0:
                raise ReportError(
                    f"--correlate {one},{other}: invalid (found {value:g}; allowed two keys and a number between -1 "
                    f"and 1, ends excluded). Correct it."
                )
        if self.method not in _CORRELATED or self.count <= len(varied):
            raise ReportError(
                f"--correlate: needs a sample of more than {len(varied)} members (found {self.method}, {self.count}; "
                f"allowed {', '.join(_CORRELATED)}). Add --sample, e.g. lhs:200."
            )
        if np.linalg.eigvalsh(self._normal_correlations()).min() < _LEAST_EIGENVALUE:
            raise ReportError("--correlate: the correlations contradict each other. Use smaller ones.")

    def _normal_correlations(self) -> Numbers:
        """Return the correlations of normal variables that have the rank correlations (Pearson, 1907)."""
        keys = [each.key for each in self.dimensions]
        matrix = np.eye(len(keys))
        for one, other, value in self.correlations:
            pair = keys.index(one), keys.index(other)
            matrix[pair] = matrix[pair[::-1]] = 2.0 * np.sin(np.pi / 6.0 * value)
        return matrix

    def probabilities(self) -> Numbers:
        """Return the sample in the unit cube, shape (members, dimensions): cumulative probabilities.

        Correlations rearrange the values of each key (Iman and Conover, 1982), whose distributions do not change.
        """
        sample = _SAMPLES[self.method](len(self.dimensions), self.count, self.seed)
        if not self.correlations:
            return sample
        from scipy.special import ndtri

        scores = ndtri(np.clip(sample, _EDGE, 1.0 - _EDGE))
        independent = np.linalg.solve(np.linalg.cholesky(np.cov(scores.T)), (scores - scores.mean(axis=0)).T)
        correlated = (np.linalg.cholesky(self._normal_correlations()) @ independent).T
        ranks = correlated.argsort(axis=0, kind="stable").argsort(axis=0)
        return np.asarray(np.take_along_axis(np.sort(sample, axis=0), ranks, axis=0))

    def members(self) -> list[Member]:
        """Return all members in order."""
        if self.method == FACTORIAL:
            combinations: Sequence[Sequence[Any]] = list(
                itertools.product(*(each.values for each in self.dimensions if isinstance(each, Levels)))
            )
        else:
            rows = self.probabilities()
            combinations = [[each.at(float(u)) for each, u in zip(self.dimensions, row, strict=True)] for row in rows]
        return [self._member(number, values) for number, values in enumerate(combinations)]

    def _member(self, number: int, values: Sequence[Any]) -> Member:
        changes = {each.key: value for each, value in zip(self.dimensions, values, strict=True)}
        case_file = changes.pop(CASE, self.cases[0])
        changes = self.constants | changes
        for tie in self.ties:
            value = tie.value({key: each for key, each in changes.items() if type(each) in (int, float)})
            changes[tie.name] = int(value) if value.is_integer() else value
        return Member(number, case_file, changes)

    def as_table(self) -> dict[str, Any]:
        """Return the design as values of a JSON file."""
        return {
            "cases": list(self.cases),
            "method": self.method,
            "count": self.count,
            "seed": self.seed,
            "variables": [variable.as_table() for variable in self.variables],
            **({"ties": {tie.name: tie.text for tie in self.ties}} if self.ties else {}),
            **({"correlations": list(map(list, self.correlations))} if self.correlations else {}),
        }


def parse_correlation(text: str) -> tuple[str, str, float]:
    """Read KEY,KEY=NUMBER of --correlate."""
    keys, _, number = text.rpartition("=")
    one, _, other = (part.strip() for part in keys.partition(","))
    try:
        return one, other, float(number)
    except ValueError:
        raise ReportError(f"--correlate: invalid (found {quoted(text)}). Specify KEY,KEY=NUMBER.") from None


def parse_sample(text: str) -> tuple[str, int]:
    """Read METHOD:N of --sample."""
    method, _, number = text.partition(":")
    if method not in METHODS or not number.isdecimal() or int(number) < 1:
        forms = ", ".join(f"{name}:N" for name in METHODS)
        raise ReportError(
            f"--sample: invalid (found {quoted(text)}; allowed {forms}, with N from 1). Correct the sample."
        )
    count = int(number)
    if method in _POWERS_OF_TWO and count & (count - 1):
        nearest = 2 ** round(math.log2(count))
        raise ReportError(f"--sample: {method} needs a power of two (found {count}). Use {method}:{nearest}.")
    return method, count


def _lhs(dimensions: int, count: int, seed: int) -> Numbers:
    from scipy.stats import qmc

    return np.asarray(qmc.LatinHypercube(dimensions, rng=np.random.default_rng(seed)).random(count))


def _sobol(dimensions: int, count: int, seed: int) -> Numbers:
    from scipy.stats import qmc

    return np.asarray(qmc.Sobol(dimensions, scramble=True, rng=np.random.default_rng(seed)).random(count))


def problem_of(names: Sequence[str]) -> dict[str, Any]:
    """Return the description of the unit cube for SALib."""
    return {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}


def _saltelli(dimensions: int, count: int, seed: int) -> Numbers:
    from SALib.sample import sobol

    problem = problem_of([str(index) for index in range(dimensions)])
    return np.asarray(sobol.sample(problem, count, calc_second_order=False, seed=seed))


def _morris(dimensions: int, count: int, seed: int) -> Numbers:
    from SALib.sample import morris

    problem = problem_of([str(index) for index in range(dimensions)])
    return np.asarray(morris.sample(problem, count, num_levels=MORRIS_LEVELS, seed=seed))


_SAMPLES = {"lhs": _lhs, "sobol": _sobol, "saltelli": _saltelli, "morris": _morris}
