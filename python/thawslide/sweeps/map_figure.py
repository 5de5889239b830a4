"""Figure of probability and quantile maps over the terrain of a member."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, Normalize
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
from thawslide.figures.colours import PROBABILITY_LIMITS
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import (
    MOST_CELLS,
    box_about,
    colour_map,
    covered_box,
    make_scene,
    paint,
    quiet_corner,
    scale_bar,
)
from thawslide.figures.style import styled
from thawslide.maps import Map, read_map
from thawslide.number_text import number_text

_NAMES = ("reached", "thickness_above_1", "thickness_p50", "thickness_p90", "speed_p90", "arrival_p10")
_PROBABILITY = "probability"
_COLOURS = {"thickness": "YlOrRd", "speed": "viridis", "arrival": "cividis"}
_BAR, _FOOT = 0.72, 0.1  # inches right of a map for its colour bar, and below all maps


@styled
def probability_maps(files: Sequence[Path], terrain: Path, members: int) -> Figure:
    """Map the most important of the files over the hillshade of a terrain."""
    by_name = {path.stem: path for path in files}
    fields = {name: _shown(name, read_map(by_name[name])) for name in _NAMES if name in by_name}
    fields = {name: field for name, field in fields.items() if np.isfinite(field.values).any()}
    if not fields:
        raise NotInRunError("no member covers any cell.")
    boxes = [box for field in fields.values() if (box := covered_box(field, -1.0)) is not None]
    scene = make_scene(read_map(terrain), box_about(boxes))
    note = f"{members} members. Quantiles include members that do not reach a cell. {scene.note()}"
    page = MapPage("Probability and quantiles", scene, len(fields), note=note, foot=_FOOT, bar=_BAR)
    panels, names = [], list(fields)
    for number, (name, whole) in enumerate(fields.items()):
        field = whole.cropped(scene.box).thinned(MOST_CELLS, "maximum")
        axes = page.panel(number, labels=number == 0)
        scale = _scale(name)
        painter = ScalarMappable(_norm([one for other, one in fields.items() if _scale(other) == scale], scale))
        painter.set_cmap(colour_map(_colours(name)))
        paint(axes, field, painter)
        panels.append((axes, _words(name), f"max {number_text(float(np.nanmax(field.values)))} {field.unit}".strip()))
        if _has_bar(names, number, page.columns):
            bar = page.figure.colorbar(painter, cax=page.panel_bar(axes))
            bar.set_label(scale if scale == _PROBABILITY else f"{scale} ({field.unit})", labelpad=2)
            if scale == _PROBABILITY:
                bar.set_ticks(PROBABILITY_LIMITS, labels=[number_text(limit) for limit in PROBABILITY_LIMITS])
        if number == 0:
            scale_bar(axes, quiet_corner(field, scene.box))
    page.set_titles(panels)
    return page.figure


def _shown(name: str, field: Map) -> Map:
    """Return a map without cells of zero, except arrival times."""
    if name.startswith("arrival"):
        return field
    return replace(field, values=np.where(field.values > 0.0, field.values, np.nan))


def _scale(name: str) -> str:
    """Return the quantity of a map; maps of the same quantity have the same colours."""
    quantity, _, rest = name.partition("_")
    return _PROBABILITY if name == "reached" or rest.startswith("above_") else quantity


def _norm(fields: Sequence[Map], scale: str) -> Normalize:
    """Return the classes of probabilities, or the range of all fields of a quantity."""
    if scale == _PROBABILITY:
        return BoundaryNorm(PROBABILITY_LIMITS, 256)
    high = max(float(np.nanmax(each.values)) for each in fields)
    low = min(float(np.nanmin(each.values)) for each in fields) if scale == "arrival" else 0.0
    return Normalize(low, max(high, low + 1e-9))


def _has_bar(names: Sequence[str], number: int, columns: int) -> bool:
    """Return whether a map is the last one of its quantity in its row of the page."""
    is_last = number + 1 == len(names) or (number + 1) % columns == 0
    return is_last or _scale(names[number + 1]) != _scale(names[number])


def _colours(name: str) -> str:
    return "YlOrRd" if "_p" not in name else _COLOURS[name.partition("_")[0]]


def _words(name: str) -> str:
    quantity, _, rest = name.partition("_")
    if name == "reached":
        return "reached"
    if rest.startswith("above_"):
        unit = {"thickness": "m", "speed": "m/s"}[quantity]
        return f"{quantity} above {rest.removeprefix('above_')} {unit}"
    return f"{quantity}, P{rest.removeprefix('p')}"
