"""Probability and quantile maps of an ensemble of simulations, exact for any number of members.

Each window of the grid is read from the rasters of all members, and its counts and order statistics are computed from
all values. Memory is therefore constant; no histogram or other approximation is involved.
"""

from __future__ import annotations

import contextlib
import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from thawslide import _core
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.sweeps.raster_files import write_style, write_window, written_raster
from thawslide.sweeps.raster_stack import MEMORY, RasterStack
from thawslide.text_files import MEGABYTE, is_number, read_text

QUANTILES = (0.1, 0.5, 0.9)
_MOST = 500.0  # m or m/s: no slide has more
_ROUNDING = 1e-12  # of a probability
REACHED = 0.1  # m: thickness above which a cell counts as reached, without a map of arrival times


@dataclass(frozen=True)
class Quantity:
    """A mapped quantity: its file in the folder maps, kind of its values, unit, and the value of cells without data."""

    name: str
    file: str
    kind: _core.Quantity
    unit: str
    words: str
    missing: float
    colours: str


QUANTITIES = {
    each.name: each
    for each in (
        Quantity("thickness", "max_thickness", _core.Quantity.LENGTH, "m", "maximum flow thickness", 0.0, "YlOrRd"),
        Quantity("speed", "max_speed", _core.Quantity.SPEED, "m/s", "maximum speed", 0.0, "viridis"),
        Quantity("arrival", "arrival_time", _core.Quantity.TIME, "s", "arrival time", math.inf, "cividis"),
    )
}
DEFAULT_THRESHOLDS = {"thickness": (0.5, 1.0, 5.0), "speed": (1.0, 5.0, 10.0)}


@dataclass(frozen=True)
class _Output:
    """A map to compute from the values of all members in a window."""

    name: str
    unit: str
    words: str
    colours: str
    compute: Callable[[Numbers], Numbers]
    is_probability: bool
    threshold: str = ""  # of a probability, with its unit


def fraction(is_counted: NDArray[np.bool_], weights: Numbers | None) -> Numbers:
    """Return the fraction of the members that count, by weight (None: equal ones); the members are the first axis."""
    if weights is None:
        return np.asarray(np.count_nonzero(is_counted, axis=0) / len(is_counted))
    return np.asarray(np.tensordot(weights, is_counted, 1) / weights.sum()).clip(0.0, 1.0)


def quantile(values: Numbers, probability: float, weights: Numbers | None) -> Numbers:
    """Return the smallest value that at least a fraction of the members do not exceed (`inverted_cdf` of NumPy)."""
    if weights is None:
        index = max(math.ceil(probability * len(values) * (1.0 - _ROUNDING)) - 1, 0)
        return np.asarray(np.partition(values, index, axis=0)[index])
    order = np.argsort(values, axis=0)
    below = np.cumsum(weights[order], axis=0)
    first = np.argmax(below >= probability * (1.0 - _ROUNDING) * below[-1], axis=0)
    return np.asarray(np.take_along_axis(values, np.take_along_axis(order, first[None], axis=0), axis=0)[0])


def write_probability_maps(
    rasters: Mapping[str, Sequence[Path]],
    output: Path,
    thresholds: Mapping[str, Sequence[float]] | None = None,
    quantiles: Sequence[float] = QUANTILES,
    memory: float = MEMORY,
    report: Callable[[str], object] = lambda _: None,
    weights: Sequence[float] | None = None,
) -> list[Path]:
    """Write the maps of each quantity (thickness, speed, arrival) from the rasters of all members; return the files.

    `thresholds` are those of exceedance by quantity. `report` is called with each note on a raster. `weights` of the
    members, in their order, need not sum to 1. ReportError if the cells of the rasters do not coincide.
    """
    given = None if weights is None else np.asarray(weights, dtype=np.float64)
    chosen = {**DEFAULT_THRESHOLDS, **(thresholds or {})}
    written: list[Path] = []
    try:
        output.mkdir(parents=True, exist_ok=True)
        for name, files in rasters.items():
            arrival = arrival_thickness(rasters["arrival"]) if "arrival" in rasters else None
            outputs = _outputs(QUANTITIES[name], chosen.get(name, ()), quantiles, arrival, given)
            stack = RasterStack(files, QUANTITIES[name].kind)
            for note in stack.notes:
                report(note)
            # The order and the sums of weighted members need three times the memory of their values.
            of_values = memory if given is None else 0.25 * memory
            written += _write(stack, QUANTITIES[name], outputs, output, of_values, report)
    except OSError as error:
        raise ReportError(
            f"{error.filename or output}: cannot be written ({error.strerror or error}). Select another --output."
        ) from error
    return written


def _outputs(
    quantity: Quantity,
    thresholds: Sequence[float],
    quantiles: Sequence[float],
    arrival: str | None,
    weights: Numbers | None,
) -> list[_Output]:
    def above(threshold: float) -> Callable[[Numbers], Numbers]:
        return lambda values: fraction(values > threshold, weights)

    def are_finite(times: Numbers) -> Numbers:
        return fraction(np.isfinite(times), weights)

    def quantile_at(probability: float) -> Callable[[Numbers], Numbers]:
        return lambda values: quantile(values, probability, weights)

    found = []
    if quantity.name == "arrival":
        words = f"probability of being reached: thickness above {arrival}"
        found.append(_Output("reached", "", words, "YlOrRd", are_finite, True, arrival or ""))
    elif quantity.name == "thickness" and arrival is None:
        words = f"probability of being reached: maximum flow thickness above {REACHED:g} m"
        found.append(_Output("reached", "", words, "YlOrRd", above(REACHED), True, f"{REACHED:g} m"))
    for threshold in thresholds:
        name = f"{quantity.name}_above_{threshold:g}"
        words = f"probability of {quantity.words} above {threshold:g} {quantity.unit}"
        found.append(_Output(name, "", words, "YlOrRd", above(threshold), True, f"{threshold:g} {quantity.unit}"))
    for probability in quantiles:
        percent = f"{100.0 * probability:g}"
        words = f"{percent} % quantile of {quantity.words}"
        found.append(
            _Output(
                f"{quantity.name}_p{percent}", quantity.unit, words, quantity.colours, quantile_at(probability), False
            )
        )
    return found


def arrival_threshold(files: Sequence[Path]) -> float | None:
    """Return the thickness [m] from which the runs of map files count as arrived, None if unknown or different."""
    found = set()
    for path in files:
        try:
            maps = tomllib.loads(read_text(path.parent.parent / "case.toml", MEGABYTE)).get("maps", {})
        except (ReportError, tomllib.TOMLDecodeError):
            maps = {}
        found.add(maps.get("arrival_thickness") if isinstance(maps, dict) else None)
    number = found.pop() if len(found) == 1 else None
    return float(number) if number is not None and is_number(number) else None


def arrival_thickness(files: Sequence[Path]) -> str:
    """Return the thickness from which runs count as arrived, with its unit; the key if unknown or different."""
    number = arrival_threshold(files)
    return "maps.arrival_thickness" if number is None else f"{number:g} m"


def _write(
    stack: RasterStack,
    quantity: Quantity,
    outputs: Sequence[_Output],
    folder: Path,
    memory: float,
    report: Callable[[str], object],
) -> list[Path]:
    """Write the outputs of one quantity, window by window, and their styles."""
    lowest, highest = np.full(len(stack.files), math.inf), np.full(len(stack.files), -math.inf)
    paths = [folder / f"{each.name}.tif" for each in outputs]
    low, high = [math.inf] * len(outputs), [0.0] * len(outputs)
    with contextlib.ExitStack() as open_files:
        files: list[Any] = [
            open_files.enter_context(written_raster(path, stack.grid, each.unit, each.words, each.threshold))
            for path, each in zip(paths, outputs, strict=True)
        ]
        for window in stack.windows(memory):
            values = stack.read(window, quantity.missing)
            lowest, highest = np.fmin(lowest, values.min((1, 2))), np.fmax(highest, values.max((1, 2)))
            for index, (each, file) in enumerate(zip(outputs, files, strict=True)):
                found = each.compute(values)
                shown = found[np.isfinite(found)]
                if shown.size:
                    low[index], high[index] = min(low[index], shown.min()), max(high[index], shown.max())
                write_window(file, window, found)
    for path, least, most in zip(stack.files, lowest, highest, strict=True):
        if quantity.missing not in (least, most) or least < 0.0 or _MOST < most < math.inf:
            report(
                f"note: {path}: the values are {least:,.4g} to {most:,.4g} {quantity.unit}: is it a map of "
                f"{quantity.words}, or another raster, such as a DEM? Check the path."
            )
    is_time = quantity.name == "arrival"
    for path, each, least, most in zip(paths, outputs, low, high, strict=True):
        begin = float(least) if is_time and not each.is_probability and math.isfinite(least) else 0.0
        end = 1.0 if each.is_probability else float(most)
        hides_zero = each.is_probability or not is_time
        write_style(path.with_suffix(".qml"), begin, end, each.unit, each.colours, hides_zero)
    return paths


def rasters_in(folders: Sequence[Path]) -> dict[str, list[Path]]:
    """Return the rasters of each quantity that all folders have.

    A folder is a run folder, or contains files named like the maps of a run.
    """
    found: dict[str, list[Path]] = {}
    for name, quantity in QUANTITIES.items():
        files = [_file_in(folder, quantity.file) for folder in folders]
        present = [path for path in files if path is not None]
        if len(present) == len(folders):
            found[name] = present
        elif present:
            lacking = folders[files.index(None)]
            raise ReportError(f"{lacking}: no map {quantity.file}.tif, which other folders have. Remove the folder.")
    if not found:
        names = ", ".join(f"{quantity.file}.tif" for quantity in QUANTITIES.values())
        raise ReportError(f"{folders[0]}: no map (allowed {names}). Specify folders of 3D runs on a DEM.")
    return found


def _file_in(folder: Path, name: str) -> Path | None:
    return next((path for path in (folder / "maps" / f"{name}.tif", folder / f"{name}.tif") if path.is_file()), None)
