"""Common parts of maps: hillshade with contour lines, coordinates, scale bar, north arrow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, cast

import matplotlib.patheffects as patheffects
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.offsetbox import AnchoredOffsetbox, AuxTransformBox, HPacker, TextArea, VPacker
from matplotlib.patches import Rectangle
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

from thawslide.figures.colours import THICKNESS, THIN
from thawslide.figures.style import BLACK
from thawslide.maps import Box, Map
from thawslide.number_text import exact_text, number_text
from thawslide.relief import contour_levels, hillshade, round_number
from thawslide.run_folder import Numbers

MOST_CELLS = 800  # per side: the resolution of a page
COVER = 0.82  # opacity of a field over the terrain, whose relief remains visible
ASPECTS = (0.45, 2.4)  # width over height of a map, narrowest and widest
_MOST_CONTOURS = 24
_MOST_INTERVALS = 4  # between coordinates on a side of a map
_DIGIT, _BETWEEN_LABELS, _OVERHANG = 0.071, 0.12, 0.14  # inches, of a coordinate's label
_TO_BORDER, _TO_OTHERS = 0.17, 0.3  # inches, least distances of labels of contour lines
_MARGIN = 0.12  # of the longer side of the mapped boxes, on each side
_VERTICAL_LIGHT = 0.35  # fraction of the light from above, which gives contrast to steep slopes in the shadow
SHADES = LinearSegmentedColormap.from_list("shades", ["#8B867D", "#B5B0A7", "#DFDBD3", "#FAF9F6"])
CONTOUR = "#5B4B37"
HALO: list[patheffects.AbstractPathEffect] = [patheffects.withStroke(linewidth=2.2, foreground="white")]


@dataclass(frozen=True)
class Scene:
    """Visible part of the terrain, thinned to the resolution of the page, and its hillshade."""

    box: Box
    terrain: Map  # elevation [m]
    shade: Numbers  # 0..1, shape (rows, columns) of the terrain
    exaggeration: float  # vertical, of the hillshade

    @property
    def aspect(self) -> float:
        """Width over height."""
        west, east, south, north = self.box
        return (east - west) / (north - south)

    def note(self) -> str:
        """Return a sentence on the coordinates, and one on the terrain."""
        crs = self.terrain.crs or "unknown reference system"
        return f"Coordinates: {crs}. Hillshade from the north-west{self.hillshade_words()}."

    def hillshade_words(self) -> str:
        """Return exaggeration and contour interval of the terrain."""
        exaggeration = "" if self.exaggeration == 1.0 else f", vertical exaggeration {self.exaggeration:g}×"
        levels = contour_levels(self.terrain.values, _MOST_CONTOURS)
        interval = f", contour interval {number_text(levels[1] - levels[0])} m" if len(levels) > 1 else ""
        return exaggeration + interval


def make_scene(terrain: Map, box: Box, aspects: tuple[float, float] = ASPECTS) -> Scene:
    """Return the scene of a box, widened to an aspect that fits a page, within the terrain."""
    box = page_box(box, terrain.grid.box, aspects)
    part = terrain.cropped(box).thinned(MOST_CELLS)
    finite = part.values[np.isfinite(part.values)]
    relief = float(np.ptp(finite)) / max(box[1] - box[0], box[3] - box[2]) if finite.size else 0.0
    # Without exaggeration, gentle terrain would be an even grey.
    exaggeration = float(np.clip(round_number(0.25 / relief), 1.0, 10.0)) if relief > 0.0 else 1.0
    cells = part.grid.cell_x, part.grid.cell_y
    aside = hillshade(part.values, *cells, exaggeration)
    above = hillshade(part.values, *cells, exaggeration, altitude=90.0)
    return Scene(box, part, (1.0 - _VERTICAL_LIGHT) * aside + _VERTICAL_LIGHT * above, exaggeration)


def box_about(places: Sequence[Box]) -> Box:
    """Return the box around boxes, with a margin."""
    west, east = min(box[0] for box in places), max(box[1] for box in places)
    south, north = min(box[2] for box in places), max(box[3] for box in places)
    margin = _MARGIN * max(east - west, north - south)
    return west - margin, east + margin, south - margin, north + margin


def page_box(box: Box, whole: Box, aspects: tuple[float, float] = ASPECTS) -> Box:
    """Return the box cropped to the whole, with its shorter side extended if it is too narrow for a page."""
    west, east, south, north = (
        max(box[0], whole[0]), min(box[1], whole[1]), max(box[2], whole[2]), min(box[3], whole[3]),
    )  # fmt: skip
    width, height = east - west, north - south
    wanted = max(width, aspects[0] * height), max(height, width / aspects[1])
    west, east = _longer(west, east, wanted[0], whole[0], whole[1])
    south, north = _longer(south, north, wanted[1], whole[2], whole[3])
    return west, east, south, north


def _longer(low: float, high: float, length: float, least: float, most: float) -> tuple[float, float]:
    length = min(length, most - least)
    start = min(max(0.5 * (low + high - length), least), most - length)
    return start, start + length


def covered_box(field: Map, threshold: float = 0.0) -> Box | None:
    """Return the box around the cells whose value is above a threshold, None without such cells."""
    rows, columns = np.nonzero(np.nan_to_num(field.values, nan=-np.inf) > threshold)
    if not rows.size:
        return None
    grid = field.grid
    west, _, south, _ = grid.box
    return (
        west + float(columns.min()) * grid.cell_x,
        west + float(columns.max() + 1) * grid.cell_x,
        south + float(rows.min()) * grid.cell_y,
        south + float(rows.max() + 1) * grid.cell_y,
    )


def draw_scene(axes: Axes, scene: Scene, labels: bool = True, lines: bool = True) -> None:
    """Draw the hillshade, contour lines (with elevations if `labels`) and coordinates in km."""
    axes.imshow(
        scene.shade, cmap=SHADES, vmin=0.0, vmax=1.0, extent=scene.terrain.grid.box, origin="lower",
        interpolation="bilinear", zorder=1,
    )  # fmt: skip
    west, east, south, north = scene.box
    axes.set_xlim(west, east)
    axes.set_ylim(south, north)
    axes.set_aspect("equal")
    levels = contour_levels(scene.terrain.values, _MOST_CONTOURS)
    if lines and len(levels):
        grid = scene.terrain.grid
        interval = levels[1] - levels[0] if len(levels) > 1 else levels[0]
        heavy = np.isclose(np.mod(levels / (5.0 * interval) + 0.5, 1.0), 0.5)
        drawn = axes.contour(
            grid.x, grid.y, np.ma.masked_invalid(scene.terrain.values), levels=levels, colors=CONTOUR,
            linewidths=np.where(heavy, 0.7, 0.35).tolist(), alpha=0.75, zorder=4,
        )  # fmt: skip
        if labels:
            texts = axes.clabel(drawn, levels=levels[::2], fontsize=6, fmt=exact_text, inline=False)
            thin_labels(axes, texts, 4.5)
    inches = _inches(axes)
    for axis, low, high, length in ((axes.xaxis, west, east, inches[0]), (axes.yaxis, south, north, inches[1])):
        axis.set_major_locator(FixedLocator(coordinates(low, high, float(length))))
        axis.set_major_formatter(FuncFormatter(lambda value, _: coordinate_text(value)))
    axes.tick_params(axis="y", labelrotation=90)
    for text in axes.get_yticklabels():
        text.set_verticalalignment("center")
    for side in axes.spines.values():
        side.set_visible(True)


def _inches(axes: Axes) -> Numbers:
    """Return width and height of a map."""
    assert isinstance(axes.figure, Figure)
    return axes.figure.get_size_inches() * axes.get_position().size


def thin_labels(axes: Axes, texts: Sequence[Text], zorder: float) -> None:
    """Remove labels of contour lines that the border of a map would cut, and those next to another one."""
    (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
    corner, size, inches = np.array([west, south]), np.array([east - west, north - south]), _inches(axes)
    kept: list[Numbers] = []
    for text in texts:
        place = (np.array(text.get_position()) - corner) / size * inches
        to_border = float(np.minimum(place, inches - place).min())
        to_others = min((float(np.hypot(*(place - other))) for other in kept), default=np.inf)
        if to_border < _TO_BORDER or to_others < _TO_OTHERS:
            text.remove()
            continue
        kept.append(place)
        text.set_zorder(zorder)
        text.set_path_effects(HALO)


def coordinate_text(value: float) -> str:
    """Return a coordinate [m] in km."""
    return exact_text(value / 1000.0)


def coordinates(low: float, high: float, inches: float) -> list[float]:
    """Return at most five round coordinates [m] from low to high whose labels fit along so many inches.

    The labels are parallel to the axis. They extend over its ends by at most half of the gap between two maps.
    """
    for intervals in range(_MOST_INTERVALS, 0, -1):
        places = np.array(MaxNLocator(intervals, steps=[1, 2, 5, 10], min_n_ticks=1).tick_values(low, high))
        half = 0.5 * _DIGIT * max(len(coordinate_text(place)) for place in places)
        inch = (high - low) / inches
        over = max(0.0, half - _OVERHANG) * inch
        if places[1] - places[0] >= (2.0 * half + _BETWEEN_LABELS) * inch or intervals == 1:
            break
    if found := [float(place) for place in places if low + over <= place <= high - over]:
        return found
    # No two labels fit: the middle one of finer coordinates.
    places = np.array(MaxNLocator(_MOST_INTERVALS, steps=[1, 2, 5, 10], min_n_ticks=1).tick_values(low, high))
    places = places[(low <= places) & (places <= high)]
    return [float(place) for place in places[np.abs(places - 0.5 * (low + high)).argsort()[:1]]]


def paint(axes: Axes, field: Map, painter: ScalarMappable) -> AxesImage:
    """Paint a field over the terrain; cells without a value are transparent."""
    return axes.imshow(
        np.ma.masked_invalid(field.values), cmap=painter.get_cmap(), norm=cast(Normalize, painter.norm),
        extent=field.grid.box, origin="lower", interpolation="nearest", alpha=COVER, zorder=3,
    )  # fmt: skip


def outline(axes: Axes, field: Map, level: float, **style: Any) -> None:
    """Draw the contour of a field at a level; cells without data count as below it."""
    grid = field.grid
    values = np.pad(np.nan_to_num(field.values, nan=0.0), 1)
    if values.max() <= level:
        return
    x = grid.x0 + grid.cell_x * np.arange(-1, grid.columns + 1)
    y = grid.y0 + grid.cell_y * np.arange(-1, grid.rows + 1)
    axes.contour(x, y, values, levels=[level], **({"zorder": 5} | style))


def quiet_corner(field: Map | None, box: Box) -> str:
    """Return the corner of a box that a field covers least, in matplotlib's words; the upper right is for remarks."""
    corners = {"lower left": (0, 0), "lower right": (1, 0), "upper left": (0, 1)}
    if field is None:
        return "lower left"
    west, east, south, north = box
    width, height = (east - west) / 3.0, (north - south) / 3.0

    def covered(corner: str) -> int:
        right, top = corners[corner]
        start_x, start_y = west + 2.0 * width * right, south + 2.0 * height * top
        part = field.cropped((start_x, start_x + width, start_y, start_y + height))
        return int(np.count_nonzero(part.values > 0.0))

    return min(corners, key=covered)


def scale_bar(axes: Axes, corner: str) -> None:
    """Draw a scale bar of a round length and a north arrow in a corner."""
    west, east = axes.get_xlim()
    length = round_number(0.3 * (east - west))
    bar = AuxTransformBox(axes.transData)
    bar.add_artist(Rectangle((0, 0), length, 0, fill=False, linewidth=2.2, edgecolor=BLACK))
    words = f"{exact_text(length / 1000)} km" if length >= 1000.0 else f"{exact_text(length)} m"
    ruler = VPacker(children=[TextArea(words, textprops={"size": 7.5}), bar], align="center", pad=0, sep=2)
    north = TextArea("N\n▲", textprops={"size": 7.5, "ha": "center", "linespacing": 0.95, "multialignment": "center"})
    anchored = AnchoredOffsetbox(
        loc=corner, child=HPacker(children=[north, ruler], align="center", pad=0, sep=6), pad=0.35, borderpad=0.4
    )
    anchored.patch.set(facecolor="white", alpha=0.82, linewidth=0)
    anchored.set_zorder(8)
    axes.add_artist(anchored)


def label_place(axes: Axes, name: str, place: tuple[float, float]) -> None:
    """Write the name of a place next to it, on the side away from the nearer edge; nothing outside the map."""
    west, east = axes.get_xlim()
    left = place[0] > 0.5 * (west + east)
    axes.annotate(
        name, place, xytext=(-5 if left else 5, 4), textcoords="offset points", ha="right" if left else "left",
        size=7.5, zorder=7, path_effects=HALO, annotation_clip=True,
    )  # fmt: skip


def colour_map(name: str) -> Colormap:
    """Return a colour map of matplotlib by its name."""
    found = ScalarMappable(cmap=name).get_cmap()
    return found.with_extremes(under=THIN) if name == THICKNESS.colours else found
