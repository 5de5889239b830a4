"""Weights that give members the distribution of published events.

The events y_1 ... y_n define the target: the distribution function F is linear between them, with the probability of
the events below y_k and half of those at y_k, and 0 and 1 beyond them (Hazen, 1914). A member x_i gets the probability
between the midpoints m to its neighbours,

    w_i = F(m_i+1) - F(m_i)

shared equally by members of the same value. The weighted members then have the distribution F, as exactly as their
spacing allows. Members of the same x keep the proportions that the sweep gave them.
"""

from __future__ import annotations

import numpy as np

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


def member_weights(members: Numbers, events: Numbers) -> Numbers:
    """Return weights of sum 1; ReportError if the members do not cover the events, or too few of them count."""
    below, above = cumulative(events, members.min()), 1.0 - cumulative(events, members.max())
    if below + above > MOST_OUTSIDE:
        advice = "Lower the friction" if above < 0.5 * MOST_OUTSIDE else "Raise the friction"
        if min(below, above) > 0.5 * MOST_OUTSIDE:
            advice = "Widen the ranges"
        raise ReportError(
            f"--prior events: the members do not cover the events (found H/L {members.min():.2f} to "
            f"{members.max():.2f} of rigid blocks; {100.0 * below:.0f} % of the events below, "
            f"{100.0 * above:.0f} % above; allowed: {100.0 * MOST_OUTSIDE:g} %). {advice} in sweep.toml, or "
            "use --prior sweep."
        )
    values, which, counts = np.unique(members, return_inverse=True, return_counts=True)
    bounds = cumulative(events, 0.5 * (values[1:] + values[:-1]))
    weights = np.asarray((np.diff(bounds, prepend=0.0, append=1.0) / counts)[which])
    if (number := effective_number(weights)) < LEAST_NUMBER:
        raise ReportError(
            f"--prior events: few members carry the weight (found {number:.1f} effective members; needed "
            f"{LEAST_NUMBER:g}). Increase sweep.sample in sweep.toml, or narrow its ranges to the H/L of the events."
        )
    return weights
