"""Logger: quantities of the user, recorded during a simulation."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pandas as pd

if TYPE_CHECKING:
    from thawslide.simulation import Simulation

__all__ = ["Logger"]


class Logger:
    """Records quantities at every call, for example as the callback of `Simulation.run`.

    Parameters
    ----------
    **quantities : callable
        Functions of the simulation that return a number, by the name of their column.

    Examples
    --------
    >>> from thawslide import Logger, Simulation
    >>> logger = Logger(front_m=lambda simulation: simulation.front)
    >>> simulation = Simulation("cases/block/e100.toml")
    >>> simulation.run(until=0.2, callback=logger, every=0.1)
    >>> list(logger.table.columns)
    ['time_s', 'step', 'front_m']

    """

    def __init__(self, **quantities: Callable[[Simulation], float]) -> None:
        reserved = sorted({"time_s", "step"} & set(quantities))
        if reserved:
            raise ValueError(f"the logger itself records {' and '.join(reserved)}. Use another name.")
        self._quantities = quantities
        self._rows: list[dict[str, float]] = []

    def __call__(self, simulation: Simulation) -> None:
        """Record a row: time, step, and the quantities."""
        row: dict[str, float] = {"time_s": simulation.time, "step": simulation.step_number}
        self._rows.append(row | {name: float(of(simulation)) for name, of in self._quantities.items()})

    @property
    def table(self) -> pd.DataFrame:
        """The rows so far, one per call."""
        return pd.DataFrame(self._rows, columns=["time_s", "step", *self._quantities])

    def __repr__(self) -> str:
        return f"Logger({', '.join(self._quantities)}: {len(self._rows)} rows)"
