"""Sections through terrain and sliding mass of a 3D run: along the flow path, and across it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from thawslide.errors import NotInRunError
from thawslide.figures.site import Site, distances, make_site
from thawslide.figures.style import (
    COLUMN_WIDTH,
    GROUND,
    GROUND_LINE,
    NOTE,
    NOTE_LINE,
    ORANGE,
    RED,
    SKY,
    styled,
    title_over_note,
    wrapped,
)
from thawslide.figures.window import Window, fill_terrain, fit
from thawslide.maps import Map
from thawslide.number_text import length_unit, number_text
from thawslide.relief import round_number
from thawslide.run_folder import Numbers, Run

_MOST_STEPS = 500  # of the extension of the path over the covered area
_MOST_RANGES = 4  # outside the covered area, in a note
_PLACES = 4  # sections across the path
_POINTS = 600  # of a section
_VISIBLE = 0.06  # of the height of a panel: smaller thicknesses are exaggerated
_RELEASE, _LAST, _MAXIMUM = SKY, ORANGE, RED
_CHORD = 0.02  # of the path, to either side of a place: its direction there
_MARGINS = (1.0, 1.3)
_TICK_MARGIN = 0.05  # of a panel across the path, without labels at either end
_FIRST = (1.3, 4.2)  # inches, minimum and maximum height of the section along the path
_WIDTH, _LEFT, _RIGHT, _GAP, _ROW, _HIGH, _LINE = COLUMN_WIDTH, 0.65, 0.12, 0.65, 2.15 + NOTE_LINE, 1.35, 0.15  # inches
_NOTE_CHARACTERS = 17.0  # of a note in one inch
_TITLE_CHARACTERS, _TITLE_LINE = 12.5, 0.17  # characters in one inch; inches


@dataclass(frozen=True)
class Section:
    """Values along a line: distance from its start, elevation of the terrain, and thicknesses, shape (n,) [m]."""

    distance: Numbers
    ground: Numbers
    release: Numbers
    maximum: Numbers
    final: Numbers


@dataclass(frozen=True)
class _Fields:
    terrain: Map
    release: Map | None
    maximum: Map
    final: Map


def along(line: Numbers, count: int = _POINTS) -> tuple[Numbers, Numbers]:
    """Return evenly spaced points of a line, shape (count, 2) [m], and their distances from its start [m]."""
    reached = distances(line)
    distance = np.linspace(0.0, reached[-1], count)
    return np.stack([np.interp(distance, reached, line[:, axis]) for axis in (0, 1)], axis=1), distance


def across(line: Numbers, place: float, half_width: float, chord: float) -> Numbers:
    """Return the left and the right end of a section across a line at a distance [m] along it.

    Its direction is normal to the chord of the line that extends `chord` [m] to either side.
    """
    reached = distances(line)
    before, at, after = (
        np.array([np.interp(distance, reached, line[:, axis]) for axis in (0, 1)])
        for distance in (max(place - chord, 0.0), place, min(place + chord, reached[-1]))
    )
    forward = (after - before) / np.hypot(*(after - before))
    left = np.array([-forward[1], forward[0]])
    return np.stack([at + half_width * left, at - half_width * left])


def extended(line: Numbers, covered: Numbers, step: float) -> Numbers:
    """Return a line extended at both ends along the middle of points of shape (n, 2) [m], to the last of them.

    The track of a centre of mass begins and ends in the middle of the sliding mass. Each step leads to the middle of
    the points from half a step [m] to one and a half of it ahead, within 60 degrees of the direction.
    """
    front = _onward(line[-1], line[-1] - line[-2], covered, step)
    rear = _onward(line[0], line[0] - line[1], covered, step)
    return np.array([*rear[::-1], *line, *front])


def _onward(end: Numbers, direction: Numbers, covered: Numbers, step: float) -> list[Numbers]:
    corners: list[Numbers] = []
    for _ in range(_MOST_STEPS):
        direction = direction / np.hypot(*direction)
        offset = covered - end
        away, forward = np.hypot(*offset.T), offset @ direction
        near = (forward > 0.5 * away) & (away < 1.5 * step)
        ahead = near & (away > 0.5 * step)
        if not ahead.any():
            rest = float(forward[near].max(initial=0.0))
            return [*corners, end + rest * direction] if rest > 0.0 else corners
        direction = offset[ahead].mean(axis=0)
        end = end + direction
        corners.append(end)
    return corners


def section(fields: _Fields, line: Numbers, start: float = 0.0) -> Section:
    """Return the values at evenly spaced points of a line; its distances [m] begin at `start`."""
    points, distance = along(line)
    x, y = points.T

    def thickness(field: Map | None) -> Numbers:
        return np.zeros(len(x)) if field is None else np.nan_to_num(field.at(x, y), nan=0.0)

    return Section(
        start + distance,
        fields.terrain.at(x, y),
        thickness(fields.release),
        thickness(fields.maximum),
        thickness(fields.final),
    )


@styled
def cross_sections(run: Run) -> Figure:
    """Plot the section along the path, thicknesses along it, and cross sections within the covered area."""
    site = make_site(run)
    if site.path is None:
        raise NotInRunError(f"{site.maps.folder / 'results.gpkg'}: no flow path. Specify maps.path in the case.")
    fields = _whole(site)
    covered_rows, covered_columns = np.nonzero(fields.maximum.values > site.threshold)
    covered = np.stack([fields.maximum.grid.x[covered_columns], fields.maximum.grid.y[covered_rows]], axis=1)
    path = site.path if site.has_given_path else extended(site.path, covered, _step(fields.maximum, covered, site.path))
    profile = section(fields, path)
    if not np.isfinite(profile.ground).any():
        raise NotInRunError("maps.path: the flow path is outside the terrain. Specify a path within the DEM.")
    places = _places(profile, site.threshold)
    full = _WIDTH - _LEFT - _RIGHT
    broad, first = _size(profile, full)
    about = run.end_note + ("" if site.has_given_path else _path_note(profile, site.threshold))
    note = wrapped(about, _NOTE_CHARACTERS * full)
    title = wrapped(run.titled("cross sections"), _TITLE_CHARACTERS * full)
    extra = _TITLE_LINE * (len(title) - 1)
    top = 0.7 + NOTE_LINE + extra + _LINE * len(note)
    head = top + first + 0.35
    rows = -(-len(places) // 2)
    height = head + 1.2 + 0.85 + rows * _ROW + 0.3
    figure = Figure(figsize=(_WIDTH, height))
    figure.suptitle("\n".join(title), x=_LEFT / _WIDTH, y=1 - 0.14 / height, ha="left", va="top", size=10)

    figure.text(
        _LEFT / _WIDTH, 1 - (0.4 + extra) / height, "\n".join(note), size=7.5, color=NOTE, va="top", linespacing=1.3
    )

    def place(left: float, top: float, wide: float, high: float) -> Axes:
        return figure.add_axes((left / _WIDTH, 1 - (top + high) / height, wide / _WIDTH, high / height))

    upper, lower = place(_LEFT, top, broad, first), place(_LEFT, head, broad, 1.2)
    window = _window(profile, broad / first, _MARGINS)
    _plot_profile(upper, profile, window, "(a) flow path")
    upper.set_xlabel("")
    upper.tick_params(labelbottom=False)
    _mark_places(upper, profile, places)
    _plot_thicknesses(lower, profile, window)
    wide = 0.5 * (full - _GAP)
    for number, at in enumerate(places):
        row, column = divmod(number, 2)
        axes = place(_LEFT + column * (wide + _GAP), head + 2.05 + row * _ROW, wide, _HIGH)
        _plot_across(axes, fields, path, at, wide / _HIGH, chr(ord("c") + number))
    figure.legend(handles=_legend(site), loc="lower center", ncols=4, bbox_to_anchor=(0.5, 0.0), borderaxespad=0.5)
    return figure


def _whole(site: Site) -> _Fields:
    """Return the maps at their own resolution, cropped to the scene; the path may extend over the terrain around.

    The release has the resolution of the DEM. It is averaged over the cells of the maxima, which are means as well.
    """
    box = site.scene.box

    def thickness(name: str) -> Map:
        found = site.maps[name].cropped(box)
        return replace(found, values=np.nan_to_num(found.values, nan=0.0))  # no data: never covered

    maximum = thickness("max_thickness")
    release = site.maps["release"].averaged_over(maximum.grid) if site.release is not None else None
    return _Fields(site.ground, release, maximum, thickness("final_thickness"))


def _places(profile: Section, threshold: float) -> list[float]:
    """Return distances [m] along the path for cross sections, evenly spaced over the covered area."""
    covered = np.flatnonzero((profile.maximum > threshold) & np.isfinite(profile.ground))
    if covered.size < 2:
        return []
    start, end = (float(profile.distance[index]) for index in (covered[0], covered[-1]))
    return [start + (number + 0.5) / _PLACES * (end - start) for number in range(_PLACES)]


def _step(maximum: Map, covered: Numbers, line: Numbers) -> float:
    """Return the step [m] of the extension: about the width of the covered area, four cells at least."""
    width = len(covered) * maximum.grid.cell_area / float(distances(line)[-1])
    return max(width, 4.0 * max(maximum.grid.cell_x, maximum.grid.cell_y))


def _path_note(profile: Section, threshold: float) -> str:
    """Return a sentence on the path, and the ranges in which it is outside the covered area."""
    words = "Path: track of the centre of mass, extended at both ends along the middle of the covered area."
    covered = np.flatnonzero(profile.maximum > threshold)
    outside = [
        f"{number_text(round(profile.distance[before]))} to {number_text(round(profile.distance[after]))} m"
        for before, after in pairwise(covered)
        if after - before > 1
    ]
    shown = ", ".join(outside[:_MOST_RANGES]) + (" and beyond" if len(outside) > _MOST_RANGES else "")
    return words + (f" It is outside the covered area at {shown}." if outside else "")


def _size(profile: Section, full: float) -> tuple[float, float]:
    """Return width and height [inches] of the section along the path.

    It is as wide as the page, or narrower for a steep path, because the height is bounded.
    """
    (start, end), (low, high) = _ranges(profile)
    high_over_wide = _MARGINS[1] * (high - low) / (end - start)
    height = float(np.clip(full * high_over_wide, *_FIRST))
    return min(full, height / high_over_wide) if high_over_wide > 0.0 else full, height


def _window(cut: Section, box: float, margins: tuple[float, float]) -> Window:
    return fit(*_ranges(cut), box, None, margins)


def _ranges(cut: Section) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ends of the known terrain, and the minimum and maximum elevation of terrain and sliding mass [m]."""
    shown = np.isfinite(cut.ground)
    x, ground = cut.distance[shown], cut.ground[shown]
    return (float(x[0]), float(x[-1])), (float(ground.min()), float((ground + cut.maximum[shown]).max()))


def _plot_profile(axes: Axes, cut: Section, window: Window, title: str) -> None:
    """Plot terrain, release, last and maximum thickness; small thicknesses are exaggerated, which a note states."""
    shown = np.isfinite(cut.ground)
    x, ground = cut.distance[shown], cut.ground[shown]
    release, final, maximum = cut.release[shown], cut.final[shown], cut.maximum[shown]
    thickest = float(np.max(np.maximum(release, maximum)))
    times = (
        max(1.0, round_number(max(_VISIBLE * (window.top - window.bottom) / thickest, 1.0))) if thickest > 0.0 else 1.0
    )
    fill_terrain(axes, (x, ground), window.bottom)
    axes.fill_between(x, ground, ground + times * release, color=_RELEASE, linewidth=0, zorder=2)
    axes.fill_between(x, ground, ground + times * final, color=_LAST, linewidth=0, zorder=3)
    axes.plot(x, np.where(maximum > 0.0, ground + times * maximum, np.nan), color=_MAXIMUM, linewidth=1.0, zorder=5)
    window.apply(axes)
    notes = [window.note(), f"thickness exaggeration {times:g}×"] if times > 1.0 else [window.note()]
    title_over_note(axes, title, ", ".join(notes))


def _mark_places(axes: Axes, profile: Section, places: list[float]) -> None:
    """Mark the places of the cross sections with their letters."""
    for number, at in enumerate(places):
        top = float(np.interp(at, profile.distance, np.nan_to_num(profile.ground + profile.maximum)))
        axes.annotate(
            f"({chr(ord('c') + number)})", (at, top), xytext=(0, 12), textcoords="offset points", ha="center", size=8,
            color=NOTE, arrowprops={"arrowstyle": "-", "color": NOTE, "linewidth": 0.7},
        )  # fmt: skip


def _plot_thicknesses(axes: Axes, cut: Section, window: Window) -> None:
    axes.fill_between(cut.distance, 0.0, cut.release, color=_RELEASE, linewidth=0)
    axes.fill_between(cut.distance, 0.0, cut.final, color=_LAST, linewidth=0, alpha=0.9)
    axes.plot(cut.distance, cut.maximum, color=_MAXIMUM, linewidth=1.0)
    axes.axhline(0.0, color=GROUND_LINE, linewidth=0.9)
    Window(window.left, window.right, 0.0, max(1.12 * float(cut.maximum.max()), 1e-6), 1).apply(axes)
    axes.set_xlabel(f"distance along the flow path ({length_unit(window.right - window.left)[1]})")
    axes.set_ylabel("flow thickness (m)")
    axes.set_title("(b) flow thickness along the path", loc="left")


def _plot_across(axes: Axes, fields: _Fields, path: Numbers, place: float, box: float, letter: str) -> None:
    """Plot a cross section 1.5 times as wide as the covered area."""
    length = float(distances(path)[-1])

    def cut(half_width: float) -> Section:
        return section(fields, across(path, place, half_width, _CHORD * length), -half_width)

    whole = cut(0.25 * length)
    reach = np.abs(whole.distance[whole.maximum > 0.0])
    window = _window(cut(1.5 * float(reach.max(initial=_CHORD * length))), box, _MARGINS)
    _plot_profile(
        axes,
        cut(0.5 * (window.right - window.left)),
        window,
        f"({letter}) cross section at {number_text(round(place))} m",
    )
    axes.set_xticks(_inner_ticks(*axes.get_xlim()))
    axes.set_xlabel(f"distance to the right of the path ({length_unit(window.right - window.left)[1]})")


def _inner_ticks(low: float, high: float) -> list[float]:
    """Return round numbers from low to high, except near the ends, where the neighbour or the edge would cut labels."""
    margin = _TICK_MARGIN * (high - low)
    ticks = MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    return [float(tick) for tick in ticks if low + margin <= tick <= high - margin]


def _legend(site: Site) -> list[Patch | Line2D]:
    handles: list[Patch | Line2D] = [Patch(facecolor=GROUND, edgecolor=GROUND_LINE, label="terrain")]
    if site.release is not None:
        handles.append(Patch(color=_RELEASE, label="release"))
    handles.append(Patch(color=_LAST, label=f"at {site.run.last_state}"))
    handles.append(Line2D([], [], color=_MAXIMUM, label="maximum flow thickness"))
    return handles
