"""Maps of classes for non-experts: flow thickness, arrival time and probability, with a legend in words."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from thawslide.errors import NotInRunError
from thawslide.figures.area import Area, whole_figure
from thawslide.figures.colours import PROBABILITY_LIMITS
from thawslide.figures.map_panel import COVER, MOST_CELLS, draw_scene, paint, quiet_corner, scale_bar
from thawslide.figures.site import Site
from thawslide.figures.style import BLACK, styled
from thawslide.maps import Map, read_map
from thawslide.messages import Messages
from thawslide.number_text import exact_text, number_text
from thawslide.relief import contour_levels
from thawslide.run_folder import Numbers

# Limits [m] between classes, by the maximum thickness up to which they are used.
_THICKNESS_LIMITS = ((5.0, (0.5, 1.0, 2.0)), (30.0, (1.0, 5.0, 10.0)), (float("inf"), (5.0, 20.0, 50.0)))
_MOST_TIMES = 5
_LEGEND_COLUMN, _LEGEND_LINE = 1.6, 0.19  # of the legend below a map [inches]


@dataclass(frozen=True)
class Classes:
    """A field in classes: heading, map, limits with both ends, colour map, and the words of each class."""

    heading: str
    field: Map
    limits: list[float]
    colours: str
    words: list[str]

    @property
    def painter(self) -> ScalarMappable:
        """The colours of the classes, from light to dark for the thickness."""
        shades = ScalarMappable(cmap=self.colours).get_cmap()(np.linspace(0.12, 1.0, len(self.words)))
        return ScalarMappable(BoundaryNorm(self.limits, len(self.words)), ListedColormap(shades))


def thickness_limits(least: float, highest: float) -> list[float]:
    """Return the limits [m] between the classes of thicknesses from `least` to `highest`."""
    limits = next(limits for most, limits in _THICKNESS_LIMITS if highest <= most)
    return [limit for limit in limits if least < limit < highest]


def thickness_classes(site: Site, say: Messages) -> Classes:
    """Return the maximum flow thickness of the covered cells in up to four classes."""
    field = site.reached
    values = np.where(field.values > site.threshold, field.values, np.nan)
    highest = _highest(values, site, "max_thickness")
    inner = thickness_limits(site.threshold, highest)
    words = [say("covered")]
    if inner:
        lowest, most = (say.localized(f"{number_text(limit)} m") for limit in (inner[0], inner[-1]))
        words = [say("below", high=lowest), *_between(inner, "m", say), say("above", low=most)]
    limits = [site.threshold, *inner, max(highest, 1e-6)]
    return Classes(say("map_thickness"), replace(field, values=values), limits, "YlOrRd", words)


def arrival_classes(site: Site, say: Messages) -> Classes:
    """Return the arrival time since the start of the run in classes of a round interval."""
    field = site.part("arrival_time")
    highest = _highest(field.values, site, "arrival_time")
    inner = [float(level) for level in contour_levels(np.array([0.0, highest]), _MOST_TIMES + 1)]
    limits = sorted({0.0, *inner, highest}) if highest > 0.0 else [0.0, 1.0]
    return Classes(say("map_arrival"), field, limits, "viridis", _between(limits, "s", say))


def probability_classes(site: Site, path: Path, say: Messages) -> Classes:
    """Return the probability of being reached, a raster of an ensemble, in classes."""
    field = read_map(path).cropped(site.scene.box).thinned(MOST_CELLS, "maximum")
    values = np.where(field.values > 0.0, field.values, np.nan)
    percent = [100.0 * limit for limit in PROBABILITY_LIMITS]
    return Classes(
        say("map_probability"), replace(field, values=values), list(PROBABILITY_LIMITS), "YlOrRd",
        _between(percent, "%", say),
    )  # fmt: skip


def _between(limits: list[float], unit: str, say: Messages) -> list[str]:
    return [
        say("range", low=say.localized(exact_text(low)), high=say.localized(f"{number_text(high)} {unit}"))
        for low, high in pairwise(limits)
    ]


def _highest(values: Numbers, site: Site, name: str) -> float:
    if not np.isfinite(values).any():
        raise NotInRunError(f"{site.maps.folder / name}.tif: no covered cell. Repeat the run to a later time.")
    return float(np.nanmax(values))


def draw_classes(axes: Axes, site: Site, classes: Classes, say: Messages) -> list[Artist]:
    """Draw the terrain, the classes, the outlines and the probes; return the entries of the legend."""
    draw_scene(axes, site.scene, labels=False)
    axes.set_xticks([])
    axes.set_yticks([])
    painter = classes.painter
    paint(axes, classes.field, painter)
    site.draw_release(axes)
    site.draw_outline(axes)
    site.draw_probes(axes)
    scale_bar(axes, quiet_corner(classes.field, site.scene.box))
    shades = painter.get_cmap()(np.arange(len(classes.words)))
    handles: list[Artist] = [
        Patch(facecolor=tuple(shade), alpha=COVER, edgecolor=BLACK, linewidth=0.4, label=words)
        for shade, words in zip(shades, classes.words, strict=True)
    ]
    handles.append(Line2D([], [], color=BLACK, linewidth=0.9, label=say("outline")))
    for handle in site.legend(path=False):
        handle.set_label(say("named_place" if handle.get_label() == "probe" else "release_outline"))
        handles.append(handle)
    return handles


def class_map_height(site: Site, classes: Classes, width: float, highest: float) -> float:
    """Return the height [inches] of a map with its legend in a width, at most `highest`."""
    legend = _legend_height(site, classes, width)
    return min(width / site.scene.aspect, highest - legend) + legend


def draw_class_map(area: Area, site: Site, classes: Classes, say: Messages) -> None:
    """Draw one map with its legend below."""
    height = area.height - _legend_height(site, classes, area.width)
    width = min(area.width, height * site.scene.aspect)
    handles = draw_classes(area.axes(0.5 * (area.width - width), 0.0, width, height), site, classes, say)
    area.figure.legend(
        handles=handles, title=classes.heading, loc="upper left", fontsize=8.5, title_fontsize=8.5, alignment="left",
        ncols=_columns(area.width), bbox_to_anchor=area.point(-0.04, height + 0.03), columnspacing=1.2,
    )  # fmt: skip


@styled
def class_map(site: Site, classes: Classes, say: Messages, width: float, highest: float) -> Figure:
    """Return a figure of one map with its legend below; sizes are in inches."""
    area = whole_figure(width, class_map_height(site, classes, width - 0.1, highest) + 0.1)
    draw_class_map(replace(area, left=0.05, top=0.05, width=width - 0.1, height=area.height - 0.1), site, classes, say)
    return area.figure


def _columns(width: float) -> int:
    return max(1, int(width / _LEGEND_COLUMN))


def _legend_height(site: Site, classes: Classes, width: float) -> float:
    entries = len(classes.words) + 1 + len(site.legend(path=False))
    return 0.3 + _LEGEND_LINE * -(-entries // _columns(width))
