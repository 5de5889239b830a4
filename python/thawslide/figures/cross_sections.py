"""Sections through terrain and slide of a 3D run: along the path line, and across it at chosen places."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from thawslide.errors import NotInRunError
from thawslide.figures.site import Site, distances, make_site
from thawslide.figures.style import COLUMN_WIDTH, GROUND, GROUND_LINE, NOTE, ORANGE, RED, SKY, length_unit, styled
from thawslide.figures.window import Window, fill_terrain, fit
from thawslide.maps import Map
from thawslide.relief import round_number
from thawslide.run import Numbers, Run

_MOST_STEPS = 500  # along what the slide covered beyond the path
_MOST_STRETCHES = 4  # beside the slide, that a note tells
_PLACES = 4  # sections across the path
_POINTS = 600  # of a section
_SEEN = 0.06  # of the height of a panel: thinner bodies are drawn thicker than they are
_RELEASE, _LAST, _LARGEST = SKY, ORANGE, RED
_CHORD = 0.02  # of the path, to either side of a place: its direction there
_MARGINS = (1.0, 1.3)
_FIRST = (1.3, 4.2)  # inches, least and most height of the section along the path
_WIDTH, _LEFT, _RIGHT, _GAP, _ROW, _HIGH, _LINE = COLUMN_WIDTH, 0.65, 0.12, 0.65, 2.15, 1.35, 0.15  # inches
_NOTE_CHARACTERS = 17.0  # of a note in one inch


@dataclass(frozen=True)
class Section:
    """Heights along a line: distance from its start, ground, and thicknesses upon it, shape (n,) [m]."""

    distance: Numbers
    ground: Numbers
    release: Numbers
    largest: Numbers
    final: Numbers


@dataclass(frozen=True)
class _Fields:
    terrain: Map
    release: Map | None
    largest: Map
    final: Map


def along(line: Numbers, count: int = _POINTS) -> tuple[Numbers, Numbers]:
    """Return evenly spaced points of a line, shape (count, 2) [m], and their distances from its start [m]."""
    reached = distances(line)
    distance = np.linspace(0.0, reached[-1], count)
    return np.stack([np.interp(distance, reached, line[:, axis]) for axis in (0, 1)], axis=1), distance


def across(line: Numbers, place: float, half_width: float, chord: float) -> Numbers:
    """Return the ends, left then right as one looks along the line, of a section across it at a distance [m].

    Its direction is normal to the chord of the line that reaches `chord` [m] to either side of the place.
    """
    reached = distances(line)
    before, at, after = (
        np.array([np.interp(distance, reached, line[:, axis]) for axis in (0, 1)])
        for distance in (max(place - chord, 0.0), place, min(place + chord, reached[-1]))
    )
    forward = (after - before) / np.hypot(*(after - before))
    left = np.array([-forward[1], forward[0]])
    return np.stack([at + half_width * left, at - half_width * left])


def reaching(line: Numbers, touched: Numbers, step: float) -> Numbers:
    """Return a line that goes on at both ends along the middle of places of shape (n, 2) [m], to the last of them.

    The way of a centre of mass begins and ends in the middle of the slide. The places that lie from half a step [m] to
    one and a half of it ahead, no more than 60 degrees off, have their middle where the next step leads.
    """
    front = _onward(line[-1], line[-1] - line[-2], touched, step)
    rear = _onward(line[0], line[0] - line[1], touched, step)
    return np.array([*rear[::-1], *line, *front])


def _onward(end: Numbers, direction: Numbers, touched: Numbers, step: float) -> list[Numbers]:
    corners: list[Numbers] = []
    for _ in range(_MOST_STEPS):
        direction = direction / np.hypot(*direction)
        offset = touched - end
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
    """Return what lies under evenly spaced points of a line; its distances [m] count from `start`."""
    points, distance = along(line)
    x, y = points.T

    def thickness(field: Map | None) -> Numbers:
        return np.zeros(len(x)) if field is None else np.nan_to_num(field.at(x, y), nan=0.0)

    return Section(
        start + distance,
        fields.terrain.at(x, y),
        thickness(fields.release),
        thickness(fields.largest),
        thickness(fields.final),
    )


@styled
def cross_sections(run: Run) -> Figure:
    """Draw the section along the path, thicknesses along it, and sections across it where the slide went."""
    site = make_site(run)
    if site.path is None:
        raise NotInRunError(f"{site.maps.folder / 'results.gpkg'}: no path line, so there is nothing to cut along")
    fields = _whole(site)
    touched_rows, touched_columns = np.nonzero(fields.largest.values > site.threshold)
    touched = np.stack([fields.largest.grid.x[touched_columns], fields.largest.grid.y[touched_rows]], axis=1)
    path = site.path if site.path_is_given else reaching(site.path, touched, _step(fields.largest, touched, site.path))
    profile = section(fields, path)
    if not np.isfinite(profile.ground).any():
        raise NotInRunError("the path line lies outside the terrain")
    places = _places(profile, site.threshold)
    full = _WIDTH - _LEFT - _RIGHT
    broad, first = _size(profile, full)
    about = run.end_note + ("" if site.path_is_given else _about_way(profile, site.threshold))
    told = textwrap.wrap(about, int(_NOTE_CHARACTERS * full), break_on_hyphens=False)
    top = 0.7 + _LINE * len(told)
    head = top + first + 0.35
    rows = -(-len(places) // 2)
    height = head + 1.2 + 0.85 + rows * _ROW + 0.3
    figure = Figure(figsize=(_WIDTH, height))
    figure.suptitle(run.titled("sections"), x=_LEFT / _WIDTH, y=1 - 0.14 / height, ha="left", va="top", size=10)

    figure.text(_LEFT / _WIDTH, 1 - 0.4 / height, "\n".join(told), size=7.5, color=NOTE, va="top", linespacing=1.3)

    def place(left: float, top: float, wide: float, high: float) -> Axes:
        return figure.add_axes((left / _WIDTH, 1 - (top + high) / height, wide / _WIDTH, high / height))

    upper, lower = place(_LEFT, top, broad, first), place(_LEFT, head, broad, 1.2)
    window = _window(profile, broad / first, _MARGINS)
    _draw_profile(upper, profile, window, "(a) along the path")
    upper.set_xlabel("")
    upper.tick_params(labelbottom=False)
    _mark_places(upper, profile, places)
    _draw_thicknesses(lower, profile, window)
    wide = 0.5 * (full - _GAP)
    for number, at in enumerate(places):
        row, column = divmod(number, 2)
        axes = place(_LEFT + column * (wide + _GAP), head + 2.05 + row * _ROW, wide, _HIGH)
        _draw_across(axes, fields, path, at, wide / _HIGH, chr(ord("c") + number))
    figure.legend(handles=_legend(site), loc="lower center", ncols=4, bbox_to_anchor=(0.5, 0.0), borderaxespad=0.5)
    return figure


def _whole(site: Site) -> _Fields:
    """Return the maps at their own resolution, cut to the scene; the path may lead on over the terrain around."""
    box = site.scene.box

    def thickness(name: str) -> Map:
        found = site.maps[name].cropped(box)
        return replace(found, values=np.nan_to_num(found.values, nan=0.0))  # no data: the slide never was there

    release = thickness("release") if site.release is not None else None
    return _Fields(site.maps["terrain"], release, thickness("max_thickness"), thickness("final_thickness"))


def _places(profile: Section, threshold: float) -> list[float]:
    """Return distances [m] along the path for sections across it, evenly over where the slide was."""
    touched = np.flatnonzero((profile.largest > threshold) & np.isfinite(profile.ground))
    if touched.size < 2:
        return []
    start, end = (float(profile.distance[index]) for index in (touched[0], touched[-1]))
    return [start + (number + 0.5) / _PLACES * (end - start) for number in range(_PLACES)]


def _step(largest: Map, touched: Numbers, line: Numbers) -> float:
    """Return about how wide the slide was [m], four cells at least: how far one looks ahead for where it went."""
    width = len(touched) * largest.grid.cell_area / float(distances(line)[-1])
    return max(width, 4.0 * max(largest.grid.cell_x, largest.grid.cell_y))


def _about_way(profile: Section, threshold: float) -> str:
    """Say what line the path is, and where it runs beside what the slide covered."""
    told = "Path: the way of the centre of mass, at its ends on along the middle of what the slide covered."
    covered = np.flatnonzero(profile.largest > threshold)
    beside = [
        f"{profile.distance[before]:,.0f} to {profile.distance[after]:,.0f} m"
        for before, after in pairwise(covered)
        if after - before > 1
    ]
    shown = ", ".join(beside[:_MOST_STRETCHES]) + (" and further on" if len(beside) > _MOST_STRETCHES else "")
    return told + (f" It runs beside that at {shown}." if beside else "")


def _size(profile: Section, full: float) -> tuple[float, float]:
    """Return width and height [inches] of the section along the path: as wide as the page, narrower for a steep one.

    So that a panel of bounded height shows no more than the path.
    """
    (start, end), (low, high) = _reach(profile)
    high_over_wide = _MARGINS[1] * (high - low) / (end - start)
    height = float(np.clip(full * high_over_wide, *_FIRST))
    return min(full, height / high_over_wide) if high_over_wide > 0.0 else full, height


def _window(cut: Section, box: float, margins: tuple[float, float]) -> Window:
    return fit(*_reach(cut), box, None, margins)


def _reach(cut: Section) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ends of what is known of the ground, and the lowest and highest of ground and slide [m]."""
    shown = np.isfinite(cut.ground)
    x, ground = cut.distance[shown], cut.ground[shown]
    return (float(x[0]), float(x[-1])), (float(ground.min()), float((ground + cut.largest[shown]).max()))


def _draw_profile(axes: Axes, cut: Section, window: Window, title: str) -> None:
    """Draw ground, release, last and largest thickness over it; thin ones are drawn thicker, as told."""
    shown = np.isfinite(cut.ground)
    x, ground = cut.distance[shown], cut.ground[shown]
    release, final, largest = cut.release[shown], cut.final[shown], cut.largest[shown]
    thickest = float(np.max(np.maximum(release, largest)))
    times = max(1.0, round_number(max(_SEEN * (window.top - window.bottom) / thickest, 1.0))) if thickest > 0.0 else 1.0
    fill_terrain(axes, (x, ground), window.bottom)
    axes.fill_between(x, ground, ground + times * release, color=_RELEASE, linewidth=0, zorder=2)
    axes.fill_between(x, ground, ground + times * final, color=_LAST, linewidth=0, zorder=3)
    axes.plot(x, np.where(largest > 0.0, ground + times * largest, np.nan), color=_LARGEST, linewidth=1.0, zorder=5)
    window.apply(axes)
    thicker = f", thickness ×{times:g}" if times > 1.0 else ""
    axes.set_title(f"{title}, {window.note()}{thicker}", loc="left")


def _mark_places(axes: Axes, profile: Section, places: list[float]) -> None:
    """Name the sections across where they are."""
    for number, at in enumerate(places):
        top = float(np.interp(at, profile.distance, np.nan_to_num(profile.ground + profile.largest)))
        axes.annotate(
            f"({chr(ord('c') + number)})", (at, top), xytext=(0, 12), textcoords="offset points", ha="center", size=8,
            color=NOTE, arrowprops={"arrowstyle": "-", "color": NOTE, "linewidth": 0.7},
        )  # fmt: skip


def _draw_thicknesses(axes: Axes, cut: Section, window: Window) -> None:
    axes.fill_between(cut.distance, 0.0, cut.release, color=_RELEASE, linewidth=0)
    axes.fill_between(cut.distance, 0.0, cut.final, color=_LAST, linewidth=0, alpha=0.9)
    axes.plot(cut.distance, cut.largest, color=_LARGEST, linewidth=1.0)
    axes.axhline(0.0, color=GROUND_LINE, linewidth=0.9)
    Window(window.left, window.right, 0.0, max(1.12 * float(cut.largest.max()), 1e-6), 1).apply(axes)
    axes.set_xlabel(f"distance along the path ({length_unit(window.right - window.left)[1]})")
    axes.set_ylabel("thickness (m)")
    axes.set_title("(b) thickness along the path", loc="left")


def _draw_across(axes: Axes, fields: _Fields, path: Numbers, place: float, box: float, letter: str) -> None:
    """Draw a section as wide as the slide was there and half as much again, and the terrain beside it."""
    length = float(distances(path)[-1])

    def cut(half_width: float) -> Section:
        return section(fields, across(path, place, half_width, _CHORD * length), -half_width)

    whole = cut(0.25 * length)
    reach = np.abs(whole.distance[whole.largest > 0.0])
    window = _window(cut(1.5 * float(reach.max(initial=_CHORD * length))), box, _MARGINS)
    _draw_profile(axes, cut(0.5 * (window.right - window.left)), window, f"({letter}) across, at {place:,.0f} m")
    axes.set_xlabel(f"distance to the right of the path ({length_unit(window.right - window.left)[1]})")


def _legend(site: Site) -> list[Patch | Line2D]:
    handles: list[Patch | Line2D] = [Patch(facecolor=GROUND, edgecolor=GROUND_LINE, label="ground")]
    if site.release is not None:
        handles.append(Patch(color=_RELEASE, label="release"))
    handles.append(Patch(color=_LAST, label=f"at {site.run.last_state}"))
    handles.append(Line2D([], [], color=_LARGEST, label="largest thickness"))
    return handles
