"""Figure of probability and quantile maps over the terrain of a member."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
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
    panels = []
    for number, (name, whole) in enumerate(fields.items()):
        field = whole.cropped(scene.box).thinned(MOST_CELLS, "maximum")
        axes = page.panel(number, labels=number == 0)
        is_probability = not field.unit
        high = 1.0 if is_probability else float(np.nanmax(field.values))
        low = float(np.nanmin(field.values)) if name.startswith("arrival") else 0.0
        painter = ScalarMappable(Normalize(low, max(high, low + 1e-9)), colour_map(_colours(name)))
        paint(axes, field, painter)
        bar = page.figure.colorbar(painter, cax=page.panel_bar(axes))
        bar.set_label("probability" if is_probability else f"{name.partition('_')[0]} ({field.unit})", labelpad=2)
        panels.append((axes, _words(name), f"max {number_text(high)} {field.unit}".strip()))
        if number == 0:
            scale_bar(axes, quiet_corner(field, scene.box))
    page.set_titles(panels)
    return page.figure


def _shown(name: str, field: Map) -> Map:
    """Return a map without cells of zero, except arrival times."""
    if name.startswith("arrival"):
        return field
    return replace(field, values=np.where(field.values > 0.0, field.values, np.nan))


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
