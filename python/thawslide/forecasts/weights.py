"""Weights that give members the distribution of published events.

The events y_1 ... y_n define the target: the distribution function F is linear between them, with the probability of
the events below y_k and half of those at y_k, and 0 and 1 beyond them (Hazen, 1914). A member with the result x_i is in
the bin between the midpoints to its neighbours, and the bin has the probability F_b that F gives it.

A member that still moved at its end has an upper limit of its result only: it is left-censored. It can be in every bin
below its limit, and below the smallest known result, in a bin of those that are censored. The probability p_b of a bin
before weighting is the product-limit estimate of left-censored data (Kaplan and Meier, 1958; Efron, 1967): with Y_b
members whose result or limit is at most x_b, and d_b known results there,

    p_b = P_b d_b/Y_b,    P_b = product of (1 - d_k/Y_k) over all bins above b

A member gets the ratio of both probabilities of the bins in which it can be,

    w_i = sum F_b / (N sum p_b)

over one bin if its result is known, and over all bins below its limit otherwise. The sum of all weights is 1, and the
weighted members have the distribution F as exactly as their spacing allows. Members of the same result keep the
proportions that the sweep gave them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.sweeps.sensitivity import effective_number

LEAST_NUMBER = 5.0  # effective number of weighted members
MOST_OUTSIDE = 0.1  # probability of events beyond the extreme members, which represent them


def cumulative(events: Numbers, at: Numbers) -> Numbers:
    """Return the distribution function of the events."""
    values, counts = np.unique(events, return_counts=True)
    probabilities = (np.cumsum(counts) - 0.5 * counts) / len(events)
    return np.interp(at, values, probabilities, left=0.0, right=1.0)


def member_weights(members: Numbers, events: Numbers, is_limit: NDArray[np.bool_] | None = None) -> Numbers:
    """Return weights of sum 1; ReportError if the members do not cover the events, or too few of them count.

    is_limit: members whose value is an upper limit of their result; by default none. If all are, none is more probable.
    """
    is_limit = np.zeros(len(members), dtype=bool) if is_limit is None else is_limit
    values, counts = np.unique(members[~is_limit], return_counts=True)
    limits = members[is_limit]
    lowest = limits[limits <= values.min(initial=np.inf)].max(initial=-np.inf)  # end of the bin below all known results
    _require_cover(np.append(lowest, values) if np.isfinite(lowest) else values, np.isfinite(lowest), events)
    at_most = np.searchsorted(np.sort(members), values, side="right")
    below = np.cumprod((1.0 - counts / at_most)[::-1])[::-1]  # probability of all bins below a value
    reached = np.append(below, 1.0)
    bounds = np.append(lowest, 0.5 * (values[1:] + values[:-1])) if values.size else values
    target = np.append(cumulative(events, bounds), 1.0)
    ratios = _ratio(np.diff(target, prepend=0.0), np.diff(reached, prepend=0.0))
    of_known = ratios[np.searchsorted(values, members, side="right")]
    of_limits = _ratio(target, reached)[np.searchsorted(values, members)]
    weights = np.where(is_limit, of_limits, of_known) / len(members)
    if (number := effective_number(weights)) < LEAST_NUMBER:
        raise ReportError(
            f"--prior events: few members carry the weight (found {number:.1f} effective members; needed "
            f"{LEAST_NUMBER:g}). Increase sweep.sample in sweep.toml, or narrow its ranges to the H/L of the events."
        )
    return weights


def _ratio(target: Numbers, found: Numbers) -> Numbers:
    """Return the ratio of both probabilities, 0 for a bin without a member."""
    return np.divide(target, found, out=np.zeros_like(target), where=found > 0.0)


def _require_cover(values: Numbers, is_limit: bool, events: Numbers) -> None:
    """Raise ReportError if events lie beyond the extreme results, of which the lowest can be an upper limit."""
    below = 0.0 if is_limit else float(cumulative(events, values[0]))
    above = 1.0 - float(cumulative(events, values[-1]))
    if below + above > MOST_OUTSIDE:
        advice = "Lower the friction" if above < 0.5 * MOST_OUTSIDE else "Raise friction or band thickness"
        if min(below, above) > 0.5 * MOST_OUTSIDE:
            advice = "Widen the ranges"
        found = f"{'at most ' if is_limit else ''}{values[0]:.2f}"
        found += f" to {values[-1]:.2f}" if len(values) > 1 else ""
        raise ReportError(
            f"--prior events: the members do not cover the events (found H/L {found} of rigid blocks; "
            f"{100.0 * below:.0f} % of the events below, {100.0 * above:.0f} % above; allowed: "
            f"{100.0 * MOST_OUTSIDE:g} %). {advice} in sweep.toml, or use --prior sweep."
        )
