"""3D view of the terrain with the maximum speed of the slide on it, seen from in front of the slide.

Orthographic projection of the height field z(x, y), without vertical exaggeration. With the horizontal direction e to
the viewer, the direction r to the viewer's right, and the height angle h of the viewer above the horizon,

    right = (x, y) . r,   up = z cos h - (x, y) . e sin h

Quadrilaterals are painted from far to near, so that nearer ones cover farther ones.
"""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from thawslide.errors import NotInRunError
from thawslide.figures.site import Site, make_site
from thawslide.figures.style import BLACK
from thawslide.maps import Grid, Map
from thawslide.relief import ALTITUDE, hillshade, round_number
from thawslide.run_folder import Numbers, Run

_MOST_POINTS = 260  # per side of the terrain
_HEIGHT_ANGLE, _SIDE = 32.0, 35.0  # degrees: of the viewer above the horizon, and from the direction of motion
_WIDTH, _BAR, _HIGHEST = 7.1, 1.0, 6.0  # inches: of the figure, of the colour bar, and most of the terrain
_GROUND, _SKIRT = np.array([0.80, 0.77, 0.72]), "#8d877e"
_MARGIN = 0.25  # of the terrain around the affected area, of its larger side


class Projection:
    """Projection of positions [m] onto the plane of the picture [m]."""

    def __init__(self, towards: float) -> None:
        """towards: direction of the viewer, counter-clockwise from east [radians]."""
        self.to_viewer = np.array([np.cos(towards), np.sin(towards)])
        self.right = np.array([-self.to_viewer[1], self.to_viewer[0]])
        self._height = np.radians(_HEIGHT_ANGLE)

    def nearness(self, x: Numbers, y: Numbers) -> Numbers:
        """Return horizontal distances towards the viewer [m]."""
        return np.asarray(x * self.to_viewer[0] + y * self.to_viewer[1])

    def __call__(self, x: Numbers, y: Numbers, z: Numbers) -> Numbers:
        """Return positions in the picture, with a last axis of two."""
        across = x * self.right[0] + y * self.right[1]
        up = z * np.cos(self._height) - self.nearness(x, y) * np.sin(self._height)
        return np.stack([across + 0.0 * z, up], axis=-1)  # nan for points without data


def view(run: Run) -> Figure:
    """Plot the terrain in 3D with the maximum speed, the release and the affected area; NotInRunError without maps."""
    site = make_site(run)
    terrain = _surroundings(site)
    x, y = np.meshgrid(terrain.grid.x, terrain.grid.y)
    project = Projection(_direction(site) + np.radians(_SIDE))
    speed = _on(run.maps["max_speed"], x, y)
    scale = Normalize(0.0, max(float(np.nanmax(np.nan_to_num(speed))), 1e-9))
    corners = project(x, y, terrain.values)
    bottom = project(x, y, np.where(np.isfinite(terrain.values), float(np.nanmin(terrain.values)), np.nan))
    low, high = np.nanmin(bottom, axis=(0, 1)), np.nanmax(corners, axis=(0, 1))
    width, height = high - low
    drawn = min(_WIDTH - _BAR, _HIGHEST * width / height)
    figure = Figure(figsize=(drawn + _BAR, drawn * height / width + 0.1), layout="constrained")
    axes = figure.subplots()
    _skirts(axes, terrain, project)
    _surface(axes, terrain, corners, speed, project, scale)
    _lines(axes, site, terrain, project)
    _scale_bar(axes, low, high)
    axes.set(aspect="equal", xlim=(low[0], high[0]))
    axes.axis("off")
    bar = figure.colorbar(ScalarMappable(scale, colormaps["plasma"]), ax=axes, shrink=0.6, pad=0.01)
    bar.set_label("maximum speed (m/s)")
    return figure


def _surroundings(site: Site) -> Map:
    """Return the terrain around the affected area, with at most so many points per side."""
    west, east, south, north = site.scene.box
    margin = _MARGIN * max(east - west, north - south)
    terrain = site.maps["terrain"].cropped((west - margin, east + margin, south - margin, north + margin))
    return terrain.thinned(_MOST_POINTS)


def _direction(site: Site) -> float:
    """Return the direction from the release to the deposit, counter-clockwise from east [radians]."""
    first = _centre(site.release if site.release is not None else site.reached)
    last = _centre(site.part("final_thickness"))
    return float(np.arctan2(last[1] - first[1], last[0] - first[0]))


def _centre(thickness: Map) -> Numbers:
    weights = np.nan_to_num(thickness.values)
    total = max(float(weights.sum()), 1e-300)
    x, y = float((weights.sum(axis=0) * thickness.grid.x).sum()), float((weights.sum(axis=1) * thickness.grid.y).sum())
    return np.array([x / total, y / total])


def _on(values: Map, x: Numbers, y: Numbers) -> Numbers:
    """Return the values of a map at points; nan where the slide never was."""
    grid = values.grid
    column = np.floor((x - grid.x0) / grid.cell_x + 0.5).astype(np.intp)
    row = np.floor((y - grid.y0) / grid.cell_y + 0.5).astype(np.intp)
    inside = (column >= 0) & (column < grid.columns) & (row >= 0) & (row < grid.rows)
    found = values.values[np.clip(row, 0, grid.rows - 1), np.clip(column, 0, grid.columns - 1)]
    return np.where(inside & (found > 0.0), found, np.nan)


def _surface(axes: Axes, terrain: Map, corners: Numbers, speed: Numbers, project: Projection, scale: Normalize) -> None:
    """Paint the terrain, and the speed on it."""
    grid: Grid = terrain.grid
    azimuth = np.degrees(np.pi / 2 - np.arctan2(project.to_viewer[1], project.to_viewer[0])) + 60.0  # from the left
    shade = hillshade(terrain.values, grid.cell_x, grid.cell_y, 1.0, azimuth, ALTITUDE)
    light = 0.35 + 0.75 * np.clip(np.nan_to_num(shade), 0.0, 1.0)
    colour = np.where(np.isfinite(speed)[..., None], colormaps["plasma"](scale(np.nan_to_num(speed)))[..., :3], _GROUND)
    shown = np.clip(colour * light[..., None], 0.0, 1.0)[:-1, :-1].reshape(-1, 3)
    quads = np.stack([corners[:-1, :-1], corners[:-1, 1:], corners[1:, 1:], corners[1:, :-1]], axis=2).reshape(-1, 4, 2)
    x, y = np.meshgrid(grid.x[:-1], grid.y[:-1])
    known = np.isfinite(terrain.values)
    whole = (known[:-1, :-1] & known[:-1, 1:] & known[1:, 1:] & known[1:, :-1]).ravel()
    order = np.argsort(project.nearness(x, y).ravel(), kind="stable")
    order = order[whole[order]]
    axes.add_collection(
        PolyCollection(
            list(quads[order]), facecolors=shown[order], edgecolors=shown[order], linewidths=0.3, rasterized=True
        )
    )


def _skirts(axes: Axes, terrain: Map, project: Projection) -> None:
    """Close the sides of the terrain that face the viewer, down to its lowest point."""
    x, y = np.meshgrid(terrain.grid.x, terrain.grid.y)
    low = float(np.nanmin(terrain.values))
    z = terrain.values
    sides: list[tuple[tuple[float, float], tuple[slice | int, slice | int]]] = [
        ((-1.0, 0.0), (slice(None), 0)), ((1.0, 0.0), (slice(None), -1)),
        ((0.0, -1.0), (0, slice(None))), ((0.0, 1.0), (-1, slice(None))),
    ]  # fmt: skip
    for outwards, at in sides:
        if float(np.dot(outwards, project.to_viewer)) > 0.0:
            top, bottom = project(x[at], y[at], z[at]), project(x[at], y[at], np.where(np.isfinite(z[at]), low, np.nan))
            axes.fill_between(top[:, 0], bottom[:, 1], top[:, 1], color=_SKIRT, linewidth=0.0)


def _lines(axes: Axes, site: Site, terrain: Map, project: Projection) -> None:
    """Draw the outlines of release and affected area on the terrain."""
    outlines: list[tuple[list[Numbers], str]] = [(site.affected or [], "-"), (_release_outline(site), "--")]
    for lines, style in outlines:
        for line in lines:
            shown = project(line[:, 0], line[:, 1], terrain.at(line[:, 0], line[:, 1]))
            axes.plot(*shown.T, color=BLACK, linestyle=style, linewidth=0.9, zorder=5)


def _release_outline(site: Site) -> list[Numbers]:
    try:
        features = site.run.features("release_area")
    except NotInRunError:
        return []
    return [part for feature in features for part in feature.parts]


def _scale_bar(axes: Axes, low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
    """Draw a bar across the picture, along which lengths are true."""
    length = round_number(0.2 * float(high[0] - low[0]))
    start = float(low[0]) + 0.03 * float(high[0] - low[0])
    at = float(low[1]) + 0.02 * float(high[1] - low[1])
    axes.plot([start, start + length], [at, at], color=BLACK, linewidth=2.0, solid_capstyle="butt", zorder=6)
    words = f"{length / 1000:g} km" if length >= 1000.0 else f"{length:g} m"
    axes.text(start + 0.5 * length, at, words, ha="center", va="bottom", fontsize=8, zorder=6)
