"""Basal laws written in Python, for studies: the shear strength of the base as a function of its state."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from thawslide import _core
from thawslide.arrays import Numbers

__all__ = ["BasalLaw", "ContactNodes"]


@dataclass(frozen=True)
class ContactNodes:
    """The grid nodes at which the sliding mass is in contact with the ground in one step, as arrays of shape (nodes,).

    The arrays are copies. The quantities are those of the basal laws of a case (theory, section 6): with band columns
    the state of the base, otherwise that of the particles near the ground.
    """

    time: float
    """Time at the beginning of the step [s]."""
    dt: float
    """Duration of the step [s]."""
    position: Numbers
    """Coordinates of the nodes [m], shape (nodes, dimension)."""
    area: Numbers
    """Contact area [m2]; in 2D without a width, per metre of width."""
    substrate: NDArray[np.int32]
    """Number of the substrate, in the order of the case; 0: outside all substrates."""
    normal_pressure: Numbers
    """Normal stress N on the ground [Pa]."""
    pore_pressure: Numbers
    """Pore pressure P [Pa]."""
    temperature: Numbers
    """Temperature [°C]."""
    saturation: Numbers
    """Liquid saturation of the pores."""
    solid_fraction: Numbers
    """Effective solid fraction (Eq. 2)."""
    slip: Numbers
    """Accumulated slip [m]."""
    speed: Numbers
    """Slip speed [m/s]."""
    unit_weight: Numbers
    """Unit weight of the sliding mass [N/m3]."""
    strength: Numbers
    """Shear strength computed by the laws of the case [Pa]."""


BasalLaw = Callable[[ContactNodes], ArrayLike]
"""Function that returns the shear strength of the base [Pa] at contact nodes: shape (nodes,), or one number."""


class CheckedLaw:
    """A basal law as the extension module calls it, once per step."""

    def __init__(self, law: BasalLaw, origin: Numbers) -> None:
        self._law = law
        self._origin = origin
        self.is_evaluated = True  # false during a call, and after an exception of the law

    def __call__(self, nodes: Mapping[str, Any]) -> Numbers:
        """Return the strengths of the law; UserError unless all are finite and at least 0."""
        self.is_evaluated = False
        found = self._law(ContactNodes(**{**nodes, "position": nodes["position"] + self._origin}))
        count = len(nodes["strength"])
        try:
            if found is None:  # a function without a return statement; NumPy would make it nan
                raise TypeError
            strength = np.array(np.broadcast_to(np.asarray(found, dtype=np.float64), (count,)))
        except (TypeError, ValueError) as error:
            raise _core.UserError(
                f"basal_law: no strengths of {count} contact nodes (found {_shape_words(found)}). "
                "Return an array of shape (nodes,) or a number, in Pa."
            ) from error
        wrong = ~(np.isfinite(strength) & (strength >= 0.0))
        if wrong.any():
            first = float(strength[np.argmax(wrong)])
            raise _core.UserError(
                f"basal_law: invalid strength (found {first:g} Pa; allowed: finite, at least 0). Correct the function."
            )
        self.is_evaluated = True
        return strength


def _shape_words(found: object) -> str:
    shape = getattr(found, "shape", None)
    return f"an array of shape {shape}" if shape is not None else f"a {type(found).__name__}"
