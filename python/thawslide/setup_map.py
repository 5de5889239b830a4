"""Map of the setup of a case on a DEM: hillshade, domain, release with its thickness, flow path and probes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from thawslide.arrays import Numbers
from thawslide.figures.colours import THICKNESS, colour_range
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import (
    HALO,
    Scene,
    box_about,
    colour_map,
    covered_box,
    label_place,
    make_scene,
    paint,
    quiet_corner,
    scale_bar,
)
from thawslide.figures.style import BLACK, BLUE, GREEN, PURPLE, RED, styled
from thawslide.maps import Box, Grid, Map
from thawslide.number_text import number_text, volume_text

MOST_CELLS = 1e7  # along an axis of the domain
_BODY_COLOURS = (BLACK, BLUE, GREEN, PURPLE)
_PATH = "#0B3C8C"
_HATCHES = ("//", "..", "xx", "--")  # of substrates
_HATCH = "#5B7F95"


@dataclass(frozen=True)
class Release:
    """A body of a setup: closed outlines, each of shape (n, 2) [m]; volume [m3] and thickness [m] if known."""

    name: str
    material: str
    outlines: list[Numbers]
    volume: float | None
    thickness: Map | None


@dataclass(frozen=True)
class Substrates:
    """Names of the substrates, and the number of the name in each cell, from 1; 0 for none."""

    names: list[str]
    numbers: Map


@dataclass(frozen=True)
class SetupOnMap:
    """Setup of a case on a DEM; lines are of shape (n, 2) [m]."""

    title: str
    cell: float  # m, of the simulator's grid
    domain: Box
    terrain: Map
    releases: list[Release]
    path: Numbers | None
    probes: dict[str, Numbers]
    substrates: Substrates | None = None


def setup_on_map(data: dict[str, Any]) -> SetupOnMap:
    """Return a setup from the data of the simulator; KeyError, TypeError or ValueError if a part is missing."""
    crs = str(data.get("crs") or "")
    west, south = (float(value) for value in data["min"][:2])
    east, north = (float(value) for value in data["max"][:2])
    cell = float(data["cell"])
    check_domain((west, south), (east, north), cell)
    releases = [
        Release(
            str(body["name"]),
            str(body["material"]),
            [_line(outline) for outline in body.get("outlines") or []],
            float(body["volume_m3"]) if body.get("volume_m3") is not None else None,
            _raster(body["thickness"], crs) if body.get("thickness") else None,
        )
        for body in data.get("bodies") or []
    ]
    return SetupOnMap(
        str(data["title"]),
        cell,
        (west, east, south, north),
        _raster(data["terrain"], crs),
        releases,
        _line(data["path"]) if data.get("path") else None,
        {str(name): _line(probe) for name, probe in (data.get("probes") or {}).items()},
        _substrates(data["substrates"], crs) if data.get("substrates") else None,
    )


def check_domain(low: tuple[float, float], high: tuple[float, float], cell: float) -> None:
    """Raise ValueError for a domain [m] without extent or with too many cells."""
    for start, end in zip(low, high, strict=True):
        if not (np.isfinite([start, end]).all() and cell > 0.0 and 0.0 < (end - start) / cell <= MOST_CELLS):
            raise ValueError(f"domain from {start:g} to {end:g} m with cells of {cell:g} m")


def numbers_of(values: Any) -> Numbers:
    """Return a list as finite numbers; ValueError or TypeError if one is not."""
    numbers = np.array(values, dtype=np.float64)
    if not np.isfinite(numbers).all():
        raise ValueError("a number is missing or not finite")
    return numbers


def _substrates(data: dict[str, Any], crs: str) -> Substrates:
    return Substrates([str(name) for name in data["names"]], _raster(data["numbers"], crs))


def _line(points: Any) -> Numbers:
    return numbers_of(points).reshape(-1, 2)


def _raster(data: dict[str, Any], crs: str) -> Map:
    grid = Grid(
        float(data["x0"]), float(data["y0"]), float(data["cell_x"]), float(data["cell_y"]),
        int(data["columns"]), int(data["rows"]),
    )  # fmt: skip
    numbers_of([grid.x0, grid.y0, grid.cell_x, grid.cell_y])
    if min(grid.cell_x, grid.cell_y) <= 0.0 or min(grid.columns, grid.rows) < 1:
        raise ValueError(f"raster of {grid.columns} x {grid.rows} cells of {grid.cell_x:g} x {grid.cell_y:g} m")
    values = np.array(data["heights"], dtype=np.float64)  # null becomes nan
    if values.size != grid.rows * grid.columns:
        raise ValueError(f"{values.size} heights for {grid.columns} columns and {grid.rows} rows")
    return Map(grid, values.reshape(grid.rows, grid.columns), "m", "", crs)


@styled
def plot_setup_on_map(setup: SetupOnMap) -> Figure:
    """Map the whole domain, and the release at a larger scale with its initial thickness."""
    terrain = setup.terrain
    overview = make_scene(terrain, box_about([setup.domain]))
    boxes = [_box_of(outline) for release in setup.releases for outline in release.outlines]
    boxes += [_box_with_values(release.thickness) for release in setup.releases if release.thickness is not None]
    scenes = [overview]
    if boxes:
        scenes.append(make_scene(terrain, box_about(boxes), (overview.aspect, overview.aspect)))
    handles = _legend(setup)
    columns = 4 if len(setup.releases) < 2 else 3
    foot = 0.05 + 0.18 * -(-len(handles) // columns)
    page = MapPage(
        f"{setup.title}: setup", overview, len(scenes), note=_note(scenes), foot=foot, bar=0.62, has_own_scenes=True
    )
    painter, extend = _painter(setup)
    panels = []
    for number, (scene, words) in enumerate(zip(scenes, ("whole domain", "release"), strict=False)):
        axes = page.panel(number, labels=True, scene=scene)
        box = "; box: (b)" if number == 0 and len(scenes) > 1 else ""
        panels.append((axes, words + box, f"grid cells of {setup.cell:g} m" if number == 1 else ""))
        _plot_parts(axes, setup, painter)
        scale_bar(axes, quiet_corner(_all_thickness(setup), scene.box))
        if number == len(scenes) - 1 and painter is not None:
            bar = page.figure.colorbar(painter, cax=page.panel_bar(axes), extend=extend)
            bar.set_label("release thickness (m)", labelpad=2)
    page.set_titles(panels)
    if len(scenes) > 1:
        _frame(page.figure.axes[0], scenes[1].box, RED, 1.0)
    page.legend(handles, columns)
    return page.figure


def _note(scenes: list[Scene]) -> str:
    """Return sentences on coordinates and terrain of both maps."""
    note = scenes[0].note()
    if len(scenes) > 1 and scenes[1].hillshade_words() != scenes[0].hillshade_words():
        note += f" (b): {scenes[1].hillshade_words().removeprefix(', ') or 'no contour lines'}."
    return note


def _plot_parts(axes: Axes, setup: SetupOnMap, painter: ScalarMappable | None) -> None:
    if painter is not None:
        for thickness in each_cell_once([each.thickness for each in setup.releases if each.thickness is not None]):
            paint(axes, Map(thickness.grid, np.where(thickness.values > 0.0, thickness.values, np.nan)), painter)
    if setup.substrates is not None:
        _hatch(axes, setup.substrates)
    for number, release in enumerate(setup.releases):
        for outline in release.outlines:
            axes.plot(*outline.T, color=_BODY_COLOURS[number % len(_BODY_COLOURS)], linewidth=1.2, zorder=5)
    _frame(axes, setup.domain, BLACK, 1.4, linestyle="--")
    if setup.path is not None:
        axes.plot(*setup.path.T, color=_PATH, linewidth=1.2, path_effects=HALO, zorder=6)
    for name, points in setup.probes.items():
        axes.plot(
            *points.T, color=PURPLE, marker="D" if len(points) == 1 else "", markeredgecolor="white", markersize=5,
            linewidth=1.6, path_effects=None if len(points) == 1 else HALO, zorder=7,
        )  # fmt: skip
        label_place(axes, name, (float(points[-1][0]), float(points[-1][1])))


def _hatch(axes: Axes, substrates: Substrates) -> None:
    grid = substrates.numbers.grid
    x = grid.x0 + grid.cell_x * np.arange(grid.columns)
    y = grid.y0 + grid.cell_y * np.arange(grid.rows)
    for number in range(len(substrates.names)):
        there = (substrates.numbers.values == number + 1).astype(np.float64)
        if there.any():
            hatches = [_HATCHES[number % len(_HATCHES)]]
            areas = axes.contourf(x, y, there, levels=[0.5, 1.5], colors="none", hatches=hatches, zorder=3)
            areas.set_edgecolor(_HATCH)
            areas.set_linewidth(0.0)


def each_cell_once(thicknesses: list[Map]) -> list[Map]:
    """Return maps of which at most one fills a cell: in cells of adjoining bodies, the first one has the sum."""
    filled = [np.nan_to_num(each.values) for each in thicknesses]
    for number, each in enumerate(thicknesses):
        for before in range(number):
            cells = _common_cells(thicknesses[before].grid, each.grid)
            if cells is not None:
                first, second = filled[before][cells[0]], filled[number][cells[1]]  # views
                both = (first > 0.0) & (second > 0.0)
                first[both] += second[both]
                second[both] = 0.0
    return [Map(each.grid, values) for each, values in zip(thicknesses, filled, strict=True)]


def _common_cells(one: Grid, other: Grid) -> tuple[tuple[slice, slice], tuple[slice, slice]] | None:
    """Return the common rows and columns of two grids, in the indices of each; None if cells do not coincide."""
    cells: list[tuple[slice, slice]] = []
    for first, second, size, other_size, count, other_count in (
        (one.y0, other.y0, one.cell_y, other.cell_y, one.rows, other.rows),
        (one.x0, other.x0, one.cell_x, other.cell_x, one.columns, other.columns),
    ):
        steps = (second - first) / size
        shift = round(steps)
        begin, end = max(0, shift), min(count, shift + other_count)
        if size != other_size or abs(steps - shift) > 1e-3 or begin >= end:
            return None
        cells.append((slice(begin, end), slice(begin - shift, end - shift)))
    return (cells[0][0], cells[1][0]), (cells[0][1], cells[1][1])


def _frame(axes: Axes, box: Box, colour: str, width: float, **style: Any) -> None:
    corner, size = (box[0], box[2]), (box[1] - box[0], box[3] - box[2])
    axes.add_patch(Rectangle(corner, *size, fill=False, edgecolor=colour, linewidth=width, zorder=7, **style))


def _box_of(line: Numbers) -> Box:
    low, high = line.min(axis=0), line.max(axis=0)
    return float(low[0]), float(high[0]), float(low[1]), float(high[1])


def _box_with_values(thickness: Map) -> Box:
    return covered_box(thickness) or thickness.grid.box


def _all_thickness(setup: SetupOnMap) -> Map | None:
    found = [release.thickness for release in setup.releases if release.thickness is not None]
    return found[0] if found else None


def _painter(setup: SetupOnMap) -> tuple[ScalarMappable | None, str]:
    """Return the common scale of the thickness of all releases, None if none is known."""
    found = [release.thickness.values.ravel() for release in setup.releases if release.thickness is not None]
    values = np.concatenate(found) if found else np.zeros(0)
    values = values[np.nan_to_num(values) > 0.0]
    if not values.size:
        return None, "neither"
    _, high, extend = colour_range(values, from_zero=True)
    return ScalarMappable(Normalize(0.0, high), colour_map(THICKNESS.colours)), extend


def _legend(setup: SetupOnMap) -> list[Patch | Line2D]:
    handles: list[Patch | Line2D] = []
    for number, release in enumerate(setup.releases):
        label = f"{release.name} ({release.material})"
        if release.volume is not None:
            label += f": {volume_text(release.volume)}"
        if release.thickness is not None and np.isfinite(release.thickness.values).any():
            label += f", maximum thickness {number_text(float(np.nanmax(release.thickness.values)))} m"
        handles.append(Line2D([], [], color=_BODY_COLOURS[number % len(_BODY_COLOURS)], linewidth=1.2, label=label))
    for number, name in enumerate(setup.substrates.names if setup.substrates is not None else []):
        handles.append(
            Patch(fill=False, edgecolor=_HATCH, hatch=_HATCHES[number % len(_HATCHES)], label=f"substrate {name}")
        )
    handles.append(Line2D([], [], color=BLACK, linestyle="--", linewidth=1.4, label="domain"))
    if setup.path is not None:
        handles.append(Line2D([], [], color=_PATH, linewidth=1.2, label="flow path"))
    if setup.probes:
        handles.append(Line2D([], [], color=PURPLE, marker="D", markersize=5, label="probe"))
    return handles
