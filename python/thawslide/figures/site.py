"""Common data of the maps of a 3D run on a DEM: terrain, covered area, outlines and lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from thawslide.errors import NotInRunError
from thawslide.figures.map_panel import (
    HALO,
    MOST_CELLS,
    Scene,
    box_about,
    covered_box,
    label_place,
    make_scene,
    outline,
)
from thawslide.figures.style import BLACK, BLUE, PURPLE
from thawslide.maps import Box, Grid, Map, Maps
from thawslide.run_folder import Numbers, Run

RELEASE, PATH = BLACK, BLUE


@dataclass
class Site:
    """Terrain and maps of a run, cropped to the covered area and thinned to the resolution of a page."""

    run: Run
    maps: Maps
    also: tuple[Box, ...] = ()  # boxes in the scene in addition to those of the run

    @cached_property
    def scene(self) -> Scene:
        """The terrain of the covered area and its surroundings."""
        about = [
            covered_box(self.maps["max_thickness"], self.threshold),
            covered_box(self.maps["release"]) if "release" in self.maps else None,
        ]
        boxes = [*(box for box in about if box is not None), *self.also]
        terrain = self.maps["terrain"]
        return make_scene(terrain, box_about(boxes) if boxes else terrain.grid.box)

    @property
    def ground(self) -> Map:
        """The elevation [m] above which thicknesses are: of the cells if they follow the terrain, or of the terrain."""
        return self.maps["ground" if "ground" in self.maps else "terrain"]

    @property
    def threshold(self) -> float:
        """Thickness [m] above which a cell counts as covered."""
        return float(self.run.section("maps").get("arrival_thickness", 0.0))

    @cached_property
    def grid(self) -> Grid:
        """The grid of the maps, cropped to the scene and thinned; particles are averaged on it."""
        grid = self.maps["max_thickness"].grid.cropped(self.scene.box)
        return grid.thinned(grid.factor(MOST_CELLS))

    @cached_property
    def reached(self) -> Map:
        """The maximum thickness [m], in the scene."""
        return self.part("max_thickness")

    @cached_property
    def release(self) -> Map | None:
        """The thickness [m] at t = 0, in the scene; None if the run has not written it."""
        return self.part("release") if "release" in self.maps else None

    def part(self, name: str) -> Map:
        """Return a map cropped to the scene and thinned to the maximum of each block of cells."""
        return self.maps[name].cropped(self.scene.box).thinned(MOST_CELLS, "maximum")

    @cached_property
    def path(self) -> Numbers | None:
        """The flow path, shape (n, 2) [m]; None without one."""
        try:
            features = self.run.features("path")
        except NotInRunError:
            return None
        parts = [part for feature in features for part in feature.parts]
        return parts[0] if parts and len(parts[0]) > 1 else None

    @cached_property
    def affected(self) -> list[Numbers] | None:
        """The outlines of the affected area, each of shape (n, 2) [m]; None if the run has not written them."""
        try:
            features = self.run.features("affected_area")
        except NotInRunError:
            return None
        return [part for feature in features for part in feature.parts]

    @property
    def outline_words(self) -> str:
        """The meaning of the outline."""
        least = f"thickness > {self.threshold:g} m"
        return (
            least
            if self.affected is None
            else f"affected area, {least}; edge cells count by their covered fraction, the release by its outline"
        )

    @property
    def has_given_path(self) -> bool:
        """Whether the case specifies the path; otherwise it is the track of the centre of mass."""
        return bool(self.run.section("maps").get("path"))

    @cached_property
    def probes(self) -> dict[str, tuple[float, float]]:
        """Positions of the point probes of the case, by name."""
        points = {name: probe.get("point") for name, probe in self.run.section("probe").items()}
        return {name: (float(point[0]), float(point[1])) for name, point in points.items() if point}

    def draw_release(self, axes: Axes, width: float = 1.3) -> None:
        """Draw the outline of the release."""
        if self.release is not None:
            outline(axes, self.release, 1e-6, colors=RELEASE, linewidths=width, linestyles="--")

    def draw_outline(self, axes: Axes) -> None:
        """Draw the outline of the affected area, or without it the contour of the threshold thickness."""
        if self.affected is None:
            outline(axes, self.reached, self.threshold, colors=BLACK, linewidths=0.6)
            return
        for ring in self.affected:
            axes.plot(*ring.T, color=BLACK, linewidth=0.6, zorder=5)

    def draw_path(self, axes: Axes) -> None:
        """Draw the path line."""
        if self.path is not None:
            axes.plot(*self.path.T, color=PATH, linewidth=1.1, path_effects=HALO, zorder=6)

    def draw_probes(self, axes: Axes) -> None:
        """Mark the probes with their names."""
        for name, (x, y) in self.probes.items():
            axes.plot([x], [y], marker="D", color=PURPLE, markeredgecolor="white", markersize=5, zorder=7)
            label_place(axes, name, (x, y))

    def legend(self, *, path: bool = True, probes: bool = True) -> list[Line2D]:
        """Return legend entries of the existing lines."""
        handles = []
        if self.release is not None:
            handles.append(Line2D([], [], color=RELEASE, linestyle="--", linewidth=1.3, label="release"))
        if path and self.path is not None:
            handles.append(Line2D([], [], color=PATH, linewidth=1.3, label="flow path"))
        if probes and self.probes:
            handles.append(Line2D([], [], color=PURPLE, marker="D", linestyle="", markersize=5, label="probe"))
        return handles


def make_site(run: Run, also: tuple[Box, ...] = ()) -> Site:
    """Return the site of a run, whose scene includes the boxes `also`; NotInRunError for a run that has no maps."""
    site = Site(run, run.maps, also)
    for name in ("terrain", "max_thickness"):
        if name not in site.maps:
            raise NotInRunError(f"{site.maps.folder / name}.tif: no such map. Repeat the run.")
    return site


def distances(line: Numbers) -> Numbers:
    """Return the distance of each point from the start of a line, along it, shape (n,) [m]."""
    steps = np.hypot(*np.diff(line, axis=0).T)
    return np.concatenate(([0.0], np.cumsum(steps)))
