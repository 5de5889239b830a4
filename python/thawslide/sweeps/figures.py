"""Figures of a sweep: spread through time, sensitivity, and scatter of inputs and results."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, NOTE, ORANGE, styled, title_figure, title_panels
from thawslide.number_text import number_text
from thawslide.sweeps.labels import label, label_of_key, label_of_result, name_and_unit
from thawslide.sweeps.sensitivity import MORRIS, SOBOL_FIRST, Index

_TIMES = 200  # of the spread
_MOST_LINES = 200  # individual members behind the spread
_MOST_INPUTS, _MOST_RESULTS = 6, 4  # rows and columns of the scatter
_CHARACTERS = 100  # in small letters across all panels of the scatter
_COMMON = {MORRIS: "elementary effect over the full range", SOBOL_FIRST: "Sobol index (fraction of the variance)"}
_WORDS = {"speed_m_s": "mean speed (m/s)", "runout_m": "runout distance (m)"}


@styled
def spread(series: Sequence[Mapping[str, Numbers]], weights: Numbers | None = None) -> Figure:
    """Plot speed and runout distance through time: members, their median, and the range from P10 to P90.

    A member keeps its last value after its end, because it is then at rest or has been stopped.
    """
    names = [name for name in _WORDS if any(name in each and np.isfinite(each[name]).any() for each in series)]
    if not names:
        raise NotInRunError("no time series of any member.")
    figure = Figure(figsize=(COLUMN_WIDTH, 2.6), layout="constrained")
    title_figure(figure, f"Spread of {len(series)} members")
    panels = figure.subplots(1, len(names), squeeze=False)[0]
    for axes, name in zip(panels, names, strict=True):
        kept = np.array([name in each for each in series])
        members = [each for each in series if name in each]
        _plot_spread(axes, members, name, None if weights is None else weights[kept])
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    title_panels(list(panels), [_WORDS[name].partition(" (")[0] for name in names])
    return figure


def _plot_spread(axes: Axes, series: Sequence[Mapping[str, Numbers]], name: str, weights: Numbers | None) -> None:
    time = np.linspace(0.0, max(float(each["time_s"][-1]) for each in series), _TIMES)
    values = np.array([np.interp(time, each["time_s"], each[name]) for each in series])
    for row in values[:: -(-len(values) // _MOST_LINES)]:
        axes.plot(time, row, color=BLUE, linewidth=0.4, alpha=0.25)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # times without a value of any member
        if weights is None:
            low, median, high = np.nanpercentile(values, [10.0, 50.0, 90.0], axis=0)
        else:
            mass = np.broadcast_to(weights[:, None], values.shape)
            low, median, high = np.nanpercentile(
                values, [10.0, 50.0, 90.0], axis=0, method="inverted_cdf", weights=mass
            )
    axes.fill_between(time, low, high, color=BLUE, alpha=0.2, linewidth=0, label="P10 to P90")
    axes.plot(time, median, color=BLACK, label="median")
    axes.plot([], [], color=BLUE, linewidth=0.6, label="members")
    axes.set_xlabel("time (s)")
    axes.set_ylabel(_WORDS[name])
    axes.grid(True)


@styled
def tornado(result: str, indices: Sequence[Index]) -> Figure:
    """Plot measures of sensitivity as bars with confidence intervals, the largest on top."""
    measures = list(dict.fromkeys(index.measure for index in indices))
    first = [index for index in indices if index.measure == measures[-1 if len(measures) == 2 else 0]]
    keys = [index.key for index in sorted(first, key=lambda index: abs(index.value))]
    figure = Figure(figsize=(COLUMN_WIDTH, 1.0 + 0.36 * len(keys)), layout="constrained")
    title_figure(figure, f"Sensitivity of {name_and_unit(result)[0]}")
    axes = figure.subplots()
    height = 0.8 / len(measures)
    for number, (measure, colour) in enumerate(zip(measures, (BLUE, ORANGE), strict=False)):
        found = {index.key: index for index in indices if index.measure == measure}
        positions = np.arange(len(keys)) - height * (number - 0.5 * (len(measures) - 1))
        values = np.array([found[key].value for key in keys])
        errors = np.array([[found[key].value - found[key].low, found[key].high - found[key].value] for key in keys]).T
        errors = np.where(np.isfinite(errors), np.maximum(errors, 0.0), 0.0)
        axes.barh(
            positions, values, height, xerr=errors, color=colour, label=measure,
            error_kw={"elinewidth": 0.9, "capsize": 2.0, "ecolor": BLACK},
        )  # fmt: skip
    axes.set_yticks(np.arange(len(keys)), keys)
    axes.axvline(0.0, color=NOTE, linewidth=0.8)
    unit = name_and_unit(result)[1] if measures[0] == MORRIS else ""  # other measures are dimensionless
    axes.set_xlabel(label(measures[0] if len(measures) == 1 else _COMMON.get(measures[0], "sensitivity"), unit))
    if len(measures) > 1:
        axes.legend(loc="lower right")
    return figure


@styled
def scatter(table: pd.DataFrame, inputs: Sequence[str], results: Sequence[str]) -> Figure:
    """Plot each result over each input; each point is one member. Text inputs are in order of appearance."""
    inputs, results = list(inputs)[:_MOST_INPUTS], list(results)[:_MOST_RESULTS]
    figure = Figure(figsize=(COLUMN_WIDTH, 0.5 + 1.7 * len(results)), layout="constrained")
    title_figure(figure, "Results over inputs")
    panels = figure.subplots(len(results), len(inputs), squeeze=False, sharex="col", sharey="row")
    for column, key in enumerate(inputs):
        values, names = _as_numbers(table[key])
        for row, result in enumerate(results):
            axes = panels[row, column]
            axes.plot(values, table[result].to_numpy(dtype=float), ".", color=BLUE, markersize=3, alpha=0.6)
            axes.grid(True)
            if column == 0:
                axes.set_ylabel(label_of_result(result), size=7)
        if names:
            panels[-1, column].set_xticks(range(len(names)), names)
        else:
            panels[-1, column].xaxis.set_major_locator(MaxNLocator(2))
            panels[-1, column].xaxis.set_major_formatter(lambda value, _: number_text(value))
        panels[-1, column].set_xlabel(_in_lines(label_of_key(key), _CHARACTERS / len(inputs)), size=7)
    return figure


def _in_lines(words: str, most: float) -> str:
    """Return the label of a key in lines of at most `most` characters, broken behind a dot, underscore or space."""
    lines = [""]
    for part in re.findall(r"[^._ ]*[._ ]?", words):
        if len(lines[-1]) + len(part) <= most:
            lines[-1] += part
        else:
            lines.append(part)
    return "\n".join(lines).strip()


def _as_numbers(values: pd.Series) -> tuple[Numbers, list[str]]:
    """Return numbers, and the names of their integers if the values are text."""
    if pd.api.types.is_numeric_dtype(values):
        return values.to_numpy(dtype=float), []
    codes, names = pd.factorize(values.astype(str))
    return codes.astype(float), [name if len(name) <= 16 else f"...{name[-13:]}" for name in names]
