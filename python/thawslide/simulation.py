"""Simulations in memory: the steps of `thawslide run`, driven from Python."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any, cast

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from thawslide import _core
from thawslide.basal_law import BasalLaw, CheckedLaw
from thawslide.case import Case, toml_text
from thawslide.errors import errors_with_parameters, with_parameters
from thawslide.maps import Grid, Map, named_system
from thawslide.units import cf_unit

__all__ = ["Field", "LiveMaps", "Nodes", "Simulation"]

_ROUND_OFF = 1e-12  # relative, of multiples of an interval
_CHUNK = 0.1  # wall-clock time between two looks at signals [s]


class Field:
    """A particle field: name, unit (as in the CF conventions), meaning and number of components."""

    def __init__(self, core: _core.FieldDescription) -> None:
        self.name, self.unit, self.text, self.components = core.name, cf_unit(core.unit), core.text, core.components

    def __repr__(self) -> str:
        return f"Field({self.name!r}, unit={self.unit!r}, components={self.components}, {self.text!r})"


@dataclass(frozen=True)
class Nodes:
    """The nodes of the grid that had mass in the last step; the state is that at its start."""

    position: NDArray[np.float64]  # in the coordinates of the case [m], shape (nodes, dimension)
    mass: NDArray[np.float64]  # [kg], per metre of width in 2D
    velocity: NDArray[np.float64]  # [m/s], shape (nodes, dimension)

    def __repr__(self) -> str:
        return f"Nodes({len(self.mass)} nodes, {float(np.sum(self.mass)):.6g} kg)"


class LiveMaps(Mapping[str, Map]):
    """The maps of a simulation so far by name; each is made at every access. Empty in 2D."""

    def __init__(self, core: _core.LiveRun) -> None:
        self._core = core
        self._kinds = {each.name: each for each in core.maps}

    def __getitem__(self, name: str) -> Map:
        """Return a map; KeyError for an unknown name."""
        if name not in self._kinds:
            raise KeyError(f"{name} (found: {', '.join(self._kinds) or 'none, because only 3D cases have maps'})")
        kind = self._kinds[name]
        values, x, y, cell_x, cell_y, crs = self._core.map(name)
        numbers = cast(NDArray[np.float64], values)
        grid = Grid(x, y, cell_x, cell_y, numbers.shape[1], numbers.shape[0])
        return Map(grid, numbers, cf_unit(kind.unit), kind.text, *named_system(crs))

    def __iter__(self) -> Iterator[str]:
        return iter(self._kinds)

    def __len__(self) -> int:
        return len(self._kinds)

    def __repr__(self) -> str:
        return f"LiveMaps({', '.join(self._kinds)})"


class _Messages(_core.Observer):
    """Passes warnings and notes to a function, with keys and parameters in place of options."""

    def __init__(self, on_message: Callable[[str], None]) -> None:
        super().__init__()
        self._on_message = on_message

    def text(self, line: str) -> None:
        self._on_message(with_parameters(line))

    def error(self, line: str) -> None:
        self._on_message(with_parameters(line))


def require_threads(threads: int) -> None:
    """Require a valid number of threads; UserError otherwise."""
    if threads < 0:
        raise _core.UserError(f"threads is {threads}; allowed: at least 0, where 0 means all cores.")


def print_message(line: str) -> None:
    """Print a warning or note to the standard error."""
    print(line, file=sys.stderr)


class Simulation:
    """A simulation in memory. Steps and history are those of `thawslide run` for the same case and device, bit for bit.

    The steps run without the GIL. Ctrl-C stops them between two steps with KeyboardInterrupt; they can be continued.
    """

    def __init__(
        self,
        case: Case | str | PathLike[str],
        *,
        threads: int = 0,
        device: str = "cpu",
        on_message: Callable[[str], None] = print_message,
        basal_law: BasalLaw | None = None,
    ) -> None:
        """Set up the particles of a case at t = 0, and settle them if the case requests it.

        Parameters
        ----------
        case : Case, str or path
            The case, its file or its folder.
        threads : int
            Threads to use at most; 0: the cores that this process may use.
        device : str
            "cpu", "gpu" or "auto".
        on_message : callable
            Receives warnings and notes as lines.
        basal_law : callable, optional
            Replaces the basal strength of the case, for studies. It is called once in each step with the
            `ContactNodes`, and returns their shear strengths [Pa]. The simulation is then slower, and reproducible
            if the function is. A checkpoint does not contain the function. If it raises an exception, the
            simulation remains at the end of the previous step.

        Raises
        ------
        UserError
            For an invalid case, a basal law in a case without terrain or mechanics, and a GPU that cannot be used.
        RunError, DeviceError
            If settling or the GPU fails.

        Examples
        --------
        >>> simulation = Simulation("cases/block/e100.toml")
        >>> simulation.run(until=0.1)
        >>> simulation.maps
        LiveMaps()

        """
        require_threads(threads)
        self.case = case.copy() if isinstance(case, Case) else Case(case)
        self.threads = threads
        self._messages = _Messages(on_message)
        with errors_with_parameters():
            self._core = _core.make_live_run(self.case._core, device, threads, self._messages)
        self._failed = False
        if basal_law is not None and not self._core.has_basal_law:
            raise _core.UserError(
                "basal_law: the case has no basal friction (found no terrain, or mechanics.enabled = false). "
                "Remove the function."
            )
        self._law = None if basal_law is None else CheckedLaw(basal_law, self.origin)

    @property
    def time(self) -> float:
        """The simulated time [s]."""
        return self._core.time

    @property
    def step_number(self) -> int:
        """The number of steps so far."""
        return self._core.step_number

    @property
    def particle_count(self) -> int:
        """The present number of particles."""
        return self._core.particle_count

    @property
    def is_done(self) -> bool:
        """Whether the run has ended: at time.end, at rest, or because the whole slide has left the domain."""
        return self._core.is_done

    @property
    def end_text(self) -> str:
        """The reason of an end at rest or without particles; empty otherwise."""
        return self._core.end_text

    @property
    def origin(self) -> NDArray[np.float64]:
        """The lower corner of the domain [m], to which `blocks("position")` is relative."""
        return np.array(self._core.origin)

    @property
    def history(self) -> pd.DataFrame:
        """The history so far, with the columns of history.csv."""
        return pd.DataFrame(self._core.history())

    @property
    def row(self) -> pd.Series:
        """The present state as a row of the history, also between two rows."""
        return pd.DataFrame(self._core.row()).iloc[0]

    @property
    def front(self) -> float:
        """The position of the front [m]: along the path in 3D, x in 2D; nan while a 3D slide has no path."""
        return float(self.row["front_position_m"])

    @property
    def key_numbers(self) -> dict[str, float]:
        """State and results so far, such as `travel_distance_m` and `affected_area_m2`: those of run.json."""
        return dict(self._core.key_numbers())

    @property
    def maps(self) -> LiveMaps:
        """The maps so far by name, such as `simulation.maps["max_thickness"]`; empty in 2D."""
        return LiveMaps(self._core)

    @property
    def nodes(self) -> Nodes:
        """The nodes of the grid in the last step; none before the first step."""
        position, mass, velocity = (cast(NDArray[np.float64], each) for each in self._core.nodes())
        return Nodes(position, mass, velocity)

    @property
    def fields(self) -> dict[str, Field]:
        """The particle fields by name."""
        return {each.name: Field(each) for each in self._core.fields}

    def blocks(self, name: str) -> NDArray[Any]:
        """Return a read-only view of a field without a copy.

        The view shows the field until the next step, change or restoration; later, its content is undefined. With an
        erodible bed it is a copy. Particles are in the order of memory, which changes when the simulation sorts them;
        the field `id` identifies them.

        Parameters
        ----------
        name : str
            One of `fields`; UserError for any other.

        Returns
        -------
        numpy.ndarray
            Shape (particles) for a scalar. Vectors and tensors are stored in blocks of 8 particles: shape (blocks, 8,
            components), whose last block may have unused rows.

        """
        return cast(NDArray[Any], self._core.field(name))

    def field(self, name: str) -> NDArray[Any]:
        """Return a field by particle, in the order of memory.

        Parameters
        ----------
        name : str
            One of `fields`; UserError for any other.

        Returns
        -------
        numpy.ndarray
            A scalar is that of `blocks`, shape (particles). A vector or tensor is a copy, shape (particles,
            components); `position` is in the coordinates of the case.

        """
        view = self.blocks(name)
        if view.ndim == 1:
            return view
        values = view.reshape(-1, view.shape[2])[: self.particle_count].copy()
        return values + self.origin if name == "position" else values

    def step(self, steps: int = 1) -> None:
        """Perform time steps, fewer if the run ends.

        Parameters
        ----------
        steps : int
            The number of steps, at least 0.

        Raises
        ------
        UserError, RunError, DeviceError
            As `run`.

        """
        if steps < 0:
            raise _core.UserError(f"steps is {steps}; allowed: at least 0.")
        self._advance(math.inf, steps)

    def run(
        self,
        until: float | None = None,
        *,
        callback: Callable[[Simulation], object] | None = None,
        every: float | None = None,
        every_steps: int | None = None,
    ) -> None:
        """Advance to the first step that ends at or after a time, by default to the end of the run.

        Parameters
        ----------
        until : float, optional
            Time [s].
        callback : callable, optional
            Called with this simulation after every interval, and at the end; it ends the call early by returning a
            true value. A `Logger` is one.
        every : float, optional
            Interval of the calls in simulated time [s].
        every_steps : int, optional
            Interval of the calls in steps.

        Raises
        ------
        UserError
            For a callback without an interval, and for an interval without a callback.
        RunError, DeviceError
            If a step or the GPU fails, after which no step is possible.

        """
        target = math.inf if until is None else until
        if math.isnan(target):
            raise _core.UserError("until is not a number. Specify a time [s].")
        if callback is None:
            if every is not None or every_steps is not None:
                raise _core.UserError("`every` and `every_steps` need a callback. Specify it, or omit the interval.")
            self._advance(target, sys.maxsize)
            return
        if (every is None) == (every_steps is None):
            raise _core.UserError("a callback needs one of `every` [s] and `every_steps`.")
        if (every is not None and not every > 0.0) or (every_steps is not None and every_steps < 1):
            raise _core.UserError("`every` must be above 0 s, and `every_steps` at least 1.")
        next_call = self.time
        while self.time < target and not self.is_done:
            if every is not None:
                while next_call * (1.0 - _ROUND_OFF) <= self.time:
                    next_call += every
                self._advance(min(target, next_call * (1.0 - _ROUND_OFF)), sys.maxsize)
            else:
                self._advance(target, every_steps or 1)
            if callback(self):
                return

    def change(self, changes: Mapping[str, object]) -> None:
        """Replace keys that may change during a run: those of `thawslide.resume`.

        Parameters
        ----------
        changes : mapping
            Keys with their values.

        Raises
        ------
        UserError
            For other keys and invalid values; the simulation is then unchanged.

        """
        case = self.case.copy()
        case.change(changes)
        self._require_intact()
        with errors_with_parameters():
            self._core.change(case._core, [f"{key}={toml_text(value)}" for key, value in changes.items()], self.threads)
        self.case = case

    def checkpoint(self) -> bytes:
        """Return the complete state, for `restore`; UserError if the simulation has failed or no particle is left."""
        self._require_intact()
        return self._core.checkpoint(self.threads)

    def restore(self, checkpoint: bytes) -> None:
        """Return to a state of this case, of this process or another one.

        Parameters
        ----------
        checkpoint : bytes
            A result of `checkpoint`; UserError for that of another case.

        """
        self._core.restore(checkpoint, self.threads)
        self._failed = False

    def __repr__(self) -> str:
        state = "failed" if self._failed else "done" if self.is_done else f"of {self.case.end:g} s"
        return f"Simulation({self.case.name!r}, t = {self.time:g} s {state}, {self.particle_count} particles)"

    def _require_intact(self) -> None:
        if self._failed:
            raise _core.UserError("the simulation has failed. Restore a checkpoint, or make a new simulation.")

    def _advance(self, until: float, steps: int) -> None:
        self._require_intact()
        last = self.step_number + steps
        while self.time < until and self.step_number < last and not self.is_done:
            try:
                self._core.advance(until, last - self.step_number, _CHUNK, self.threads, self._law)
            except (RuntimeError, MemoryError) as error:
                self._failed = isinstance(error, _core.DeviceError) or self._law is None or self._law.is_evaluated
                raise
