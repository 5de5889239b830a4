"""The slide over its terrain from above at chosen times: speed, thickness, temperature next to the ground."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from thawslide.binning import FIELDS, Columns, gather
from thawslide.errors import NotInRunError
from thawslide.figures.colours import (
    TEMPERATURE,
    THICKNESS,
    VELOCITY,
    Painting,
    label_bar,
    normalisation,
    number_text,
    thickness_words,
)
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import colour_map, paint, quiet_corner, scale_bar
from thawslide.figures.moments import chosen_snapshots, window_words
from thawslide.figures.site import Site, make_site
from thawslide.figures.snapshots import time_text
from thawslide.figures.style import styled
from thawslide.maps import Grid, Map
from thawslide.run import Run, Snapshot

SPEED = replace(VELOCITY, words="speed, mean over the thickness")
BASE_TEMPERATURE = replace(TEMPERATURE, words="temperature next to the ground")
_FOOT = 0.7  # inches below the maps, for the colourbar


def columns_on(site: Site, index: int) -> Columns:
    """Return what stands on the cells of the site in one snapshot."""
    return gather(site.grid, site.run.snapshot(index, fields=FIELDS), cell_of(site.run))


def cell_of(run: Run) -> float:
    """Return the size [m] of the simulator's grid cells."""
    return float(run.section("grid").get("cell", 0.0))


def where_thick(field: Map, columns: Columns, threshold: float) -> Map:
    """Return a field without the cells whose thickness [m] is not above a threshold."""
    return replace(field, values=np.where(columns.thickness.values > threshold, field.values, np.nan))


@styled
def slide_speed(run: Run) -> Figure:
    """Draw the speed of the slide, mean over its thickness."""
    return _draw(run, SPEED, lambda columns: columns.speed)


@styled
def slide_thickness(run: Run) -> Figure:
    """Draw the thickness of the slide."""
    return _draw(run, THICKNESS, lambda columns: columns.thickness)


@styled
def slide_temperature(run: Run) -> Figure:
    """Draw the temperature of the slide next to the ground."""
    if not run.section("heat").get("enabled", True):
        raise NotInRunError("heat.enabled is false: temperatures do not change")
    return _draw(run, BASE_TEMPERATURE, lambda columns: columns.temperature)


def _draw(run: Run, painting: Painting, field_of: Callable[[Columns], Map]) -> Figure:
    return draw_on_map(run, painting, lambda grid, shot: field_of(gather(grid, shot, cell_of(run))))


def draw_on_map(run: Run, painting: Painting, field_of: Callable[[Grid, Snapshot], Map]) -> Figure:
    """Draw a field at chosen times from above, where the slide is thick enough to be drawn."""
    site = make_site(run)
    shots = chosen_snapshots(run, FIELDS)
    gathered = [gather(site.grid, shot, cell_of(run)) for shot in shots]
    fields = [
        where_thick(field_of(site.grid, shot), columns, site.threshold)
        for shot, columns in zip(shots, gathered, strict=True)
    ]
    values = np.concatenate([field.values.ravel() for field in fields])
    if not np.isfinite(values).any():
        raise NotInRunError(f"no snapshot has a {painting.words} to show on the map")
    norm, extend = normalisation(values, painting)
    painter = ScalarMappable(norm, colour_map(painting.colours))
    lines = f"Dashed: release. Thinner than {site.threshold:g} m is not drawn."
    note = f"{run.end_note}{lines} Time: {run.clock.words}. {site.scene.note()}"
    title = f"{run.title}: {painting.words.split(',')[0]}"
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
    page.name(panels)
    bar = page.figure.colorbar(painter, cax=page.common_bar(), orientation="horizontal", extend=extend)
    label_bar(bar, norm)
    over = f", {window_words(run)}" if painting is SPEED and window_words(run) else ""
    words = painting.words + (f" ({painting.unit})" if painting.unit != "1" else "") + over
    bar.set_label(thickness_words(norm) if painting is THICKNESS else words, labelpad=1)
    return page.figure
