"""Maps of classes for non-experts: maximum flow thickness and arrival time, with a legend in words."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from thawslide.errors import NotInRunError
from thawslide.figures.map_panel import COVER, draw_scene, paint, quiet_corner, scale_bar
from thawslide.figures.site import Site
from thawslide.figures.style import BLACK, styled
from thawslide.maps import Map
from thawslide.number_text import number_text
from thawslide.relief import contour_levels
from thawslide.run_folder import Numbers

# Limits [m] between classes, by the maximum thickness up to which they are used.
_THICKNESS_LIMITS = ((5.0, (0.5, 1.0, 2.0)), (30.0, (1.0, 5.0, 10.0)), (float("inf"), (5.0, 20.0, 50.0)))
_MOST_TIMES = 5
_LEGEND = 2.0  # inches right of a map


@dataclass(frozen=True)
class Classes:
    """A field in classes: its map, limits with both ends, colour map, and the words of each class."""

    field: Map
    limits: list[float]
    colours: str
    words: list[str]

    @property
    def painter(self) -> ScalarMappable:
        """The colours of the classes, from light to dark for the thickness."""
        shades = ScalarMappable(cmap=self.colours).get_cmap()(np.linspace(0.12, 1.0, len(self.words)))
        return ScalarMappable(BoundaryNorm(self.limits, len(self.words)), ListedColormap(shades))


def thickness_classes(site: Site) -> Classes:
    """Return the maximum flow thickness of the covered cells in up to four classes."""
    field = site.reached
    values = np.where(field.values > site.threshold, field.values, np.nan)
    highest = _highest(values, site, "max_thickness")
    limits = next(limits for most, limits in _THICKNESS_LIMITS if highest <= most)
    inner = [limit for limit in limits if site.threshold < limit < highest]
    words = [f"{number_text(low)} to {number_text(high)} m" for low, high in pairwise(inner)]
    words = [f"below {number_text(inner[0])} m", *words, f"above {number_text(inner[-1])} m"] if inner else ["covered"]
    return Classes(replace(field, values=values), [site.threshold, *inner, max(highest, 1e-6)], "YlOrRd", words)


def arrival_classes(site: Site) -> Classes:
    """Return the arrival time since the start of the run in classes of a round interval."""
    field = site.part("arrival_time")
    highest = _highest(field.values, site, "arrival_time")
    inner = [float(level) for level in contour_levels(np.array([0.0, highest]), _MOST_TIMES + 1)]
    limits = sorted({0.0, *inner, highest}) if highest > 0.0 else [0.0, 1.0]
    words = [f"{number_text(low)} to {number_text(high)} s" for low, high in pairwise(limits)]
    return Classes(field, limits, "viridis", words)


def _highest(values: Numbers, site: Site, name: str) -> float:
    if not np.isfinite(values).any():
        raise NotInRunError(f"{site.maps.folder / name}.tif: no covered cell. Repeat the run to a later time.")
    return float(np.nanmax(values))


def draw_classes(axes: Axes, site: Site, classes: Classes) -> list[Artist]:
    """Draw the terrain, the classes, the outlines and the probes; return the entries of the legend."""
    draw_scene(axes, site.scene, labels=False)
    axes.set_xticks([])
    axes.set_yticks([])
    painter = classes.painter
    paint(axes, classes.field, painter)
    site.draw_release(axes)
    site.draw_outline(axes)
    site.draw_probes(axes)
    scale_bar(axes, quiet_corner(site.reached, site.scene.box))
    shades = painter.get_cmap()(np.arange(len(classes.words)))
    handles: list[Artist] = [
        Patch(facecolor=tuple(shade), alpha=COVER, edgecolor=BLACK, linewidth=0.4, label=words)
        for shade, words in zip(shades, classes.words, strict=True)
    ]
    handles.append(Line2D([], [], color=BLACK, linewidth=0.9, label="affected area"))
    for handle in site.legend(path=False):
        handle.set_label("named place" if handle.get_label() == "probe" else handle.get_label())
        handles.append(handle)
    return handles


@styled
def class_map(site: Site, classes: Classes, heading: str, width: float = 7.1) -> Figure:
    """Return a figure of one map with its legend at the right, `width` inches wide."""
    map_width = width - _LEGEND - 0.1
    height = map_width / site.scene.aspect
    figure = Figure(figsize=(width, height + 0.1))
    axes = figure.add_axes((0.05 / width, 0.05 / (height + 0.1), map_width / width, height / (height + 0.1)))
    handles = draw_classes(axes, site, classes)
    figure.legend(
        handles=handles, title=heading, loc="upper left", bbox_to_anchor=((map_width + 0.15) / width, 1.0),
        fontsize=9, title_fontsize=9, alignment="left",
    )  # fmt: skip
    return figure
