"""Maps of the sliding mass at the report times: speed, thickness, basal temperature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from thawslide.binning import FIELDS, Columns, gather
from thawslide.errors import NotInRunError
from thawslide.figures.colours import (
    SPEED,
    TEMPERATURE,
    THICKNESS,
    Painting,
    label_bar,
    normalization,
    scale_words,
    thickness_words,
)
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import colour_map, paint, quiet_corner, scale_bar
from thawslide.figures.moments import chosen_snapshots, window_words
from thawslide.figures.site import Site, make_site
from thawslide.figures.snapshots import time_text
from thawslide.figures.style import styled
from thawslide.maps import Grid, Map
from thawslide.number_text import number_text
from thawslide.run_folder import Run, Snapshot

DEPTH_AVERAGED_SPEED = replace(SPEED, words="depth-averaged speed")
BASE_TEMPERATURE = replace(TEMPERATURE, words="basal temperature")
_FOOT = 0.7  # inches below the maps, for the colourbar


def columns_on(site: Site, index: int) -> Columns:
    """Return thickness, speed and temperature on the cells of the site in one snapshot."""
    return gather(site.grid, site.run.snapshot(index, fields=FIELDS), cell_of(site.run))


def cell_of(run: Run) -> float:
    """Return the size [m] of the simulator's grid cells."""
    return float(run.section("grid").get("cell", 0.0))


def where_thick(field: Map, columns: Columns, threshold: float) -> Map:
    """Return a field without the cells whose thickness [m] is not above a threshold."""
    return replace(field, values=np.where(columns.thickness.values > threshold, field.values, np.nan))


@styled
def slide_speed(run: Run) -> Figure:
    """Map the depth-averaged speed."""
    return _plot(run, DEPTH_AVERAGED_SPEED, lambda columns: columns.speed)


@styled
def slide_thickness(run: Run) -> Figure:
    """Map the thickness."""
    return _plot(run, THICKNESS, lambda columns: columns.thickness)


@styled
def slide_temperature(run: Run) -> Figure:
    """Map the temperature next to the terrain."""
    if not run.section("heat").get("enabled", True):
        raise NotInRunError("heat.enabled: temperatures are constant (found false).")
    return _plot(run, BASE_TEMPERATURE, lambda columns: columns.temperature)


def _plot(run: Run, painting: Painting, field_of: Callable[[Columns], Map]) -> Figure:
    return plot_on_map(run, painting, lambda grid, shot: field_of(gather(grid, shot, cell_of(run))))


def plot_on_map(run: Run, painting: Painting, field_of: Callable[[Grid, Snapshot], Map]) -> Figure:
    """Map a field at the report times in cells above the threshold of thickness."""
    site = make_site(run)
    shots = chosen_snapshots(run, FIELDS)
    gathered = [gather(site.grid, shot, cell_of(run)) for shot in shots]
    fields = [
        where_thick(field_of(site.grid, shot), columns, site.threshold)
        for shot, columns in zip(shots, gathered, strict=True)
    ]
    values = np.concatenate([field.values.ravel() for field in fields])
    if not np.isfinite(values).any():
        raise NotInRunError(f"{run.folder}: no {painting.words} in any snapshot.")
    norm, extend = normalization(values, painting)
    painter = ScalarMappable(norm, colour_map(painting.colours))
    lines = f"Dashed: release. Cells below {site.threshold:g} m are not shown."
    note = f"{run.end_note}{lines} {site.scene.note()}"
    title = f"{run.title}: {painting.words}"
    page = MapPage(title, site.scene, len(fields), note=note, foot=_FOOT)
    corner = quiet_corner(site.reached, site.scene.box)
    panels = []
    for number, (shot, field) in enumerate(zip(shots, fields, strict=True)):
        axes = page.panel(number, labels=False)
        paint(axes, field, painter)
        site.draw_release(axes, 1.0)
        finite = field.values[np.isfinite(field.values)]
        unit = "" if painting.unit == "1" else f" {painting.unit}"
        remark = f"max {number_text(float(finite.max()))}{unit}" if finite.size else ""
        panels.append((axes, time_text(run, shot), remark))
        if number == 0:
            scale_bar(axes, corner)
    page.set_titles(panels)
    bar = page.figure.colorbar(painter, cax=page.common_bar(), orientation="horizontal", extend=extend)
    label_bar(bar, norm)
    averaging = window_words(run, shots) if painting is DEPTH_AVERAGED_SPEED else ""
    over = f", {averaging}" if averaging else ""
    words = f"{painting.words} ({painting.unit.replace('1', '–')}){scale_words(norm)}{over}"
    bar.set_label(thickness_words(norm) if painting is THICKNESS else words, labelpad=1)
    return page.figure
