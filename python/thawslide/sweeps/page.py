"""Page of a sweep, sweep.html: design, results, figures, maps and failed members."""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from thawslide.arrays import Numbers, is_constant
from thawslide.atomic_file import atomic_file
from thawslide.errors import NotInRunError, ReportError, quoted
from thawslide.forecasts.output import prior_section
from thawslide.number_text import exact_text, number_text
from thawslide.pages.markup import details, drawn_data, figure_part, page_frame, table
from thawslide.scores.ensemble import quantiles
from thawslide.scores.output import stored_section
from thawslide.sweeps.design import FACTORIAL, Design
from thawslide.sweeps.figures import scatter, spread, tornado
from thawslide.sweeps.folder import DONE, FAILED, SweepFolder
from thawslide.sweeps.labels import label_of_key, name_and_unit
from thawslide.sweeps.map_figure import probability_maps
from thawslide.sweeps.raster_files import threshold_of
from thawslide.sweeps.results import WEIGHT
from thawslide.sweeps.sensitivity import Index, indices_of
from thawslide.sweeps.variables import CASE, Levels, Normal, Uniform, Variable

NAME = "sweep.html"
_USUAL_RESULTS = (("peak_speed_m_s",), ("travel_distance_m", "runout_m"))  # the first of each that has values
NOT_RESULTS = ("member", CASE, "status", "starts", "seed", "wall_s", WEIGHT, "error")
_MOST_VALUES = 8  # of a list in the table of the design
_HEAD = ("result", "column", "unit", "mean", "SD", "P10", "P50", "P90")
_QUANTILES = (10.0, 50.0, 90.0)
_DPI = 150


def write_page(
    folder: SweepFolder, design: Design, members: pd.DataFrame, results: Sequence[str], maps: Sequence[Path]
) -> Path:
    """Write the page and return its path; `results` are the columns whose sensitivity it shows."""
    done = members[members["status"] == DONE]
    keys = [variable.key for variable in design.dimensions]
    others = [*design.constants, *(tie.name for tie in design.ties)]
    shown = _results(members, [*keys, *others], results)
    count = {status: int((members["status"] == status).sum()) for status in (DONE, FAILED)}
    title = f"Sweep of {design.size} members"
    parts = [f"<h1>{title}</h1>", f'<p class="where">Folder: {html.escape(folder.path.name)}</p>']
    if count[FAILED]:
        parts.append(f'<p class="note">{count[FAILED]} members failed. Results do not include them.</p>')
    if (unfinished := design.size - count[DONE] - count[FAILED]) > 0:
        parts.append(f'<p class="note">{unfinished} members have not finished. Results do not include them.</p>')
    parts += ["<h2>Design</h2>", table(_design_rows(design), "facts"), prior_section(folder.path)]
    numbers = [name for name in members if name not in (*NOT_RESULTS, *keys, *others)]
    parts += ["<h2>Results</h2>", table(number_rows(done, numbers), "runs wide members", _HEAD)]
    parts += _figure("Spread through time", _SPREAD, lambda: spread(_series(folder, done), weights_of(done)))
    for result in shown if keys else ():
        caption = _SENSITIVITY[design.method]
        parts += _figure(f"Sensitivity of {name_and_unit(result)[0]}", caption, _tornado(design, members, result))
    if shown and keys:
        parts += _figure("Inputs and results", "Each point is one member.", lambda: scatter(done, keys, shown))
    parts.append(stored_section(folder.path))
    if maps:
        terrain = maps[0].with_name("terrain.tif")
        parts += _figure(
            "Probability maps", _maps_caption(maps, WEIGHT in done), lambda: probability_maps(maps, terrain, len(done))
        )
        links = ((path.name, "GeoTIFF with a QGIS style") for path in maps)
        parts.append(details(f"{len(maps)} files in the folder {maps[0].parent.name}", table(links, "facts")))
    if count[FAILED]:
        rows = members[members["status"] == FAILED][["member", "error"]].itertuples(index=False)
        parts += ["<h2>Failed members</h2>", details(f"{count[FAILED]} members", table(rows, "facts"))]
    return _written(folder.path / NAME, page_frame(title, "\n".join(parts), is_self_contained=True))


_SPREAD = "Members, their median, and the range from P10 to P90. A member keeps its last value after its end."
_RANK = "Rank correlation between input and result, with the 95 % bootstrap confidence interval."
_SENSITIVITY = {
    "saltelli": "Fraction of the variance due to the input alone, and with interactions; 95 % confidence intervals.",
    "morris": "Elementary effects over the full range of each input, with the 95 % confidence interval of the mean.",
    "lhs": _RANK,
    "sobol": _RANK,
    FACTORIAL: _RANK,
}


def _maps_caption(maps: Sequence[Path], is_weighted: bool) -> str:
    """Return the caption of the maps, with the thickness from which a cell is reached."""
    of_members = "Weight" if is_weighted else "Fraction"
    caption = f"{of_members} of the members that reach a cell or exceed a threshold, and quantiles over all members."
    path = next((each for each in maps if each.stem == "reached"), None)
    threshold = threshold_of(path) if path else ""
    return f"{caption} Reached: thickness above {threshold}." if threshold else caption


def _written(path: Path, text: str) -> Path:
    try:
        with atomic_file(path) as temporary:
            temporary.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ReportError(f"{path}: cannot be written ({error.strerror or error}). Select another --output.") from error
    return path


def _results(members: pd.DataFrame, keys: Sequence[str], asked: Sequence[str]) -> list[str]:
    """Return the columns whose sensitivity is shown; ReportError for a column that is not a result."""
    allowed = [name for name in members if name not in (*NOT_RESULTS, *keys)]
    for name in asked:
        if name not in allowed:
            raise ReportError(f"--results: no column {quoted(name)} (allowed {', '.join(allowed)}). Correct the name.")
    if asked:
        return list(asked)
    known = [name for name in allowed if members[name].notna().any()]
    return [name for names in _USUAL_RESULTS for name in [each for each in names if each in known][:1]]


def _figure(heading: str, caption: str, plot: Callable[[], Figure]) -> list[str]:
    """Return a figure with its heading, or the reason for its absence."""
    try:
        part = figure_part(heading, drawn_data(plot(), _DPI), caption)
    except NotInRunError as error:
        part = f"<p>Not available: {html.escape(str(error))}</p>"
    return [f"<h2>{html.escape(heading)}</h2>", part]


def _tornado(design: Design, members: pd.DataFrame, result: str) -> Callable[[], Figure]:
    return lambda: tornado(result, indices(design, members, result))


def indices(design: Design, members: pd.DataFrame, result: str) -> list[Index]:
    """Return the sensitivity of a column of the table of members to the varied keys."""
    return indices_of(design, members[result].to_numpy(dtype=float), weights_of(members))


def weights_of(members: pd.DataFrame) -> Numbers | None:
    """Return the weights of members, None if all are equally probable."""
    return members[WEIGHT].to_numpy(dtype=float) if WEIGHT in members else None


def _series(folder: SweepFolder, done: pd.DataFrame) -> list[dict[str, Numbers]]:
    """Return the time series of each member, empty without a file."""
    found = []
    for number in done["member"]:
        path = folder.series_file(int(number))
        if path.is_file():
            with np.load(path, allow_pickle=False) as file:
                found.append({name: file[name] for name in file.files})
        else:
            found.append({})
    return found


def _design_rows(design: Design) -> list[tuple[str, str]]:
    sample = "all combinations" if design.method == FACTORIAL else f"{design.method}:{design.count}, seed {design.seed}"
    return (
        [("members", exact_text(design.size)), ("method", sample)]
        + [(label_of_key(variable.key), _distribution_words(variable)) for variable in design.dimensions]
        + [(label_of_key(key), f"{value} (constant)") for key, value in design.constants.items()]
        + [(label_of_key(tie.name), tie.text) for tie in design.ties]
        + [(f"rank correlation of {one} and {other}", f"{value:g}") for one, other, value in design.correlations]
    )


def _distribution_words(variable: Variable) -> str:
    if isinstance(variable, Levels):
        values = [Path(str(value)).name if variable.key == CASE else str(value) for value in variable.values]
        more = f", ... ({len(values)} values)" if len(values) > _MOST_VALUES else ""
        return ", ".join(values[:_MOST_VALUES]) + more
    if isinstance(variable, Uniform):
        return f"uniform from {exact_text(variable.low)} to {exact_text(variable.high)}"
    assert isinstance(variable, Normal)
    more = "" if variable.limits is None else f", from {variable.limits[0]:.4g} to {variable.limits[1]:.4g}"
    if variable.is_logarithmic:
        return f"lognormal, median {exact_text(variable.centre)}, sigma {exact_text(variable.deviation)}{more}"
    return f"normal, mean {exact_text(variable.centre)}, standard deviation {exact_text(variable.deviation)}{more}"


def number_rows(done: pd.DataFrame, names: Sequence[str]) -> list[tuple[Any, ...]]:
    """Return the table of results: name, column, unit, mean, standard deviation and quantiles."""
    rows, weights = [], weights_of(done)
    for name in names:
        values = done[name].to_numpy(dtype=float)
        known = np.isfinite(values)
        if known.any():
            words, unit = name_and_unit(name)
            found = _moments(values[known], None if weights is None else weights[known])
            rows.append((words, name, unit, *map(number_text, found)))
    return rows


def _moments(values: Numbers, weights: Numbers | None) -> list[float]:
    """Return mean, standard deviation and quantiles."""
    if values.size > 1 and is_constant(values) and (weights is None or weights.sum() > 0.0):
        return [float(values[0]), 0.0] + [float(values[0])] * len(_QUANTILES)
    if weights is None:
        deviation = float(values.std(ddof=1)) if values.size > 1 else float("nan")
        return [float(values.mean()), deviation, *map(float, np.percentile(values, _QUANTILES))]
    if not weights.sum() > 0.0:
        return [float("nan")] * (2 + len(_QUANTILES))
    mass = weights / weights.sum()
    mean, left = float(np.sum(mass * values)), 1.0 - float(np.sum(mass**2))
    deviation = math.sqrt(float(np.sum(mass * (values - mean) ** 2)) / left) if left > 0.0 else float("nan")
    return [mean, deviation, *quantiles(values, mass, [each / 100.0 for each in _QUANTILES])]
