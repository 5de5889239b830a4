"""Figures of a 2D section for non-experts: extent and thickness of the mass, and arrival of its front."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from thawslide.errors import NotInRunError
from thawslide.figures.area import Area, whole_figure
from thawslide.figures.style import BLACK, BLUE, RED, styled
from thawslide.figures.window import Window, fill_terrain, fit, squares
from thawslide.messages import Messages
from thawslide.number_text import exact_text, length_unit
from thawslide.run_folder import Numbers, Run, Snapshot
from thawslide.section_thickness import maximum_thickness_at, thickness_at

_LEFT, _RIGHT, _FOOT, _GAP = 0.7, 0.1, 0.5, 0.12  # inches around and between panels
_LEGEND = 0.28  # inches above a panel
_MARGINS = (1.12, 1.15)  # of the visible part, over the extent of the mass
_START, _MOST = "#8C8C8C", "#F3B26B"
_POINTS = 800  # of a curve along the section


def draw_section_extent(area: Area, run: Run, say: Messages) -> None:
    """Draw the profile with the mass at the start and at the end, and the thickness along the section."""
    first, last = _ends(run)
    inside = area.width - _LEFT - _RIGHT
    upper = 0.5 * (area.height - 2 * _LEGEND - _GAP - _FOOT)
    window = _window(run, first, last, inside / upper)
    profile = area.axes(_LEFT, _LEGEND, inside, upper)
    fill_terrain(profile, run.terrain, window.bottom)
    times = say("at_start"), say("at_end", time=say.time(last.time))
    for shot, colour in ((first, _START), (last, RED)):
        cell = float(run.section("grid").get("cell", 0.0))
        x, z = shot.points[:, 0], shot.points[:, run.vertical]
        body = squares(x, z, _sizes(run, shot), window, (inside, upper), cell)
        body.set_facecolor(colour)
        profile.add_collection(body, autolim=False)
    window.apply(profile)
    _label(profile.xaxis, window.right - window.left, "", say)
    profile.tick_params(labelbottom=False)
    name = "axis_above_slope" if run.gravity_tilt else "axis_elevation"
    _label(profile.yaxis, window.top - window.bottom, name, say)
    _legend(profile, [Patch(color=colour, label=words) for colour, words in zip((_START, RED), times, strict=True)])

    panel = area.axes(_LEFT, 2 * _LEGEND + upper + _GAP, inside, upper)
    x = np.linspace(window.left, window.right, _POINTS)
    most = maximum_thickness_at(run, x)
    panel.fill_between(x, most, color=_MOST, linewidth=0, label=say("at_any_time"))
    for shot, words, colour, dashes in ((first, times[0], BLACK, "--"), (last, times[1], RED, "-")):
        thickness = thickness_at(run, shot, x)
        shown = np.where(thickness > 0.0, thickness, np.nan)
        panel.plot(x, shown, label=words, color=colour, linestyle=dashes, linewidth=1.2)
    panel.set_xlim(window.left, window.right)
    panel.set_ylim(0.0, 1.08 * max(float(most.max()), 1e-9))
    _label(panel.xaxis, window.right - window.left, "axis_distance", say)
    _label(panel.yaxis, 0.0, "axis_thickness", say)
    _legend(panel, panel.get_legend_handles_labels()[0])


def draw_section_arrival(area: Area, run: Run, say: Messages) -> None:
    """Draw the time at which the front first attains each distance."""
    if "front_position_m" not in run.series or not np.isfinite(run.series["front_position_m"]).any():
        raise NotInRunError(f"{run.folder}: no position of the front.")
    front, time = run.series["front_position_m"], run.series["time_s"]
    known = np.isfinite(front)
    forward = 1.0 if front[known][-1] >= front[known][0] else -1.0
    inside, height = area.width - _LEFT - _RIGHT, area.height - _FOOT - 0.05
    panel = area.axes(_LEFT, 0.05, inside, height)
    panel.plot(forward * np.maximum.accumulate(forward * front[known]), time[known], color=BLUE)
    window = _window(run, *_ends(run), inside / height)
    panel.set_xlim(window.left, window.right)
    panel.set_ylim(0.0, 1.05 * max(float(time[-1]), 1e-9))
    _label(panel.xaxis, window.right - window.left, "axis_distance", say)
    _label(panel.yaxis, 0.0, "axis_arrival", say)
    panel.grid(True)


@styled
def section_extent(run: Run, say: Messages, width: float, height: float) -> Figure:
    """Return a figure of the extent of a section; sizes are in inches."""
    area = whole_figure(width, height)
    draw_section_extent(area, run, say)
    return area.figure


def _ends(run: Run) -> tuple[Snapshot, Snapshot]:
    """Return the first and the last snapshot."""
    if not len(run.times):
        raise NotInRunError(f"{run.folder}: no snapshots. Set time.output_interval and repeat the run.")
    return run.snapshot(0, fields=("volume",)), run.snapshot(-1, fields=("volume",))


def _window(run: Run, first: Snapshot, last: Snapshot, box: float) -> Window:
    """Return the part of the section between the start and the end of the mass."""
    x, z = (np.concatenate([shot.points[:, axis] for shot in (first, last)]) for axis in (0, run.vertical))
    return fit(_range(x), _range(z), box, None, _MARGINS)


def _range(values: Numbers) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if known.size else (0.0, 1.0)


def _sizes(run: Run, shot: Snapshot) -> Numbers:
    return np.sqrt(np.maximum(np.nan_to_num(run.section_areas(shot)), 0.0))


def _label(axis: Axis, span: float, name: str, say: Messages) -> None:
    """Label an axis over `span` metres in m or km, or in its own unit for 0, with a message; "" for none."""
    divisor, unit = length_unit(span)
    axis.set_major_formatter(lambda value, _: say.localized(exact_text(value / divisor)))
    axis.set_label_text(say(name, unit=unit) if name else "")


def _legend(axes: Axes, handles: Sequence[Artist]) -> None:
    axes.legend(
        handles=list(handles), loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(handles), fontsize=8,
        borderaxespad=0.1, columnspacing=1.2,
    )  # fmt: skip
