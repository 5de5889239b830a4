"""Maps of maximum values of a run, of arrival time, and of the thickness at its last time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
from thawslide.figures.colours import colour_range, label_bar, thickness_norm, thickness_words
from thawslide.figures.map_page import LeadPage, MapPage
from thawslide.figures.map_panel import colour_map, paint, quiet_corner, scale_bar, thin_labels
from thawslide.figures.site import Site, make_site
from thawslide.figures.style import NOTE, styled
from thawslide.maps import Map
from thawslide.number_text import exact_text, number_text, prefixed
from thawslide.relief import contour_levels
from thawslide.run_folder import Numbers, Run


@dataclass(frozen=True)
class MapKind:
    """One map: the name of its file, label, unit, colours, and whether these begin at zero.

    `is_last_state` distinguishes maps of the last time from those of maxima or first times of the whole run.
    """

    name: str
    words: str
    unit: str
    colours: str
    has_zero_base: bool = True
    is_last_state: bool = False

    @property
    def is_thickness(self) -> bool:
        """Whether the map has the scale of thicknesses."""
        return self.name.endswith("_thickness")


_EXTENT = (
    MapKind("max_thickness", "maximum flow thickness", "m", "YlOrRd"),
    MapKind("max_speed", "maximum speed", "m/s", "viridis"),
    MapKind("arrival_time", "arrival time", "s", "cividis", has_zero_base=False),
    MapKind("final_thickness", "flow thickness", "m", "YlOrRd", is_last_state=True),
)
_IMPACT = (
    MapKind("max_pressure", "maximum dynamic pressure", "Pa", "magma_r"),
    MapKind("max_momentum_flux", "maximum momentum flux", "m³/s²", "viridis"),
    MapKind("max_pore_pressure", "maximum pore pressure", "Pa", "viridis"),
    MapKind("max_basal_temperature", "maximum basal temperature", "°C", "plasma", has_zero_base=False),
    MapKind("max_melt", "maximum meltwater depth", "m", "YlGnBu"),
    MapKind("elevation_change", "elevation change", "m", "RdBu", has_zero_base=False, is_last_state=True),
)
_FOOT = 0.25  # inches below the maps, for the legend


@styled
def extent_maps(run: Run) -> Figure:
    """Map maximum thickness and speed, arrival time and final thickness, with release, path and probes."""
    site, fields = _fields(run, _EXTENT)
    page = LeadPage(run.titled("extent"), site.scene, len(fields), note=_note(run, site), foot=_FOOT, bar=0.72)
    return _plot(run, site, page, fields)


@styled
def impact_maps(run: Run) -> Figure:
    """Map maximum pressures, momentum flux, temperature and meltwater depth, and the elevation change."""
    site, fields = _fields(run, _IMPACT)
    title = run.titled("pressure, temperature and elevation change")
    page = MapPage(title, site.scene, len(fields), note=_note(run, site), foot=_FOOT, bar=0.88)
    return _plot(run, site, page, fields)


def _fields(run: Run, kinds: Sequence[MapKind]) -> tuple[Site, list[tuple[MapKind, Map]]]:
    """Return the site of a run, and those of the maps that have values; NotInRunError without any."""
    site = make_site(run)
    fields = [(kind, _covered_part(site, kind)) for kind in kinds if kind.name in site.maps]
    fields = [(kind, field) for kind, field in fields if np.isfinite(field.values).any()]
    if not fields:
        raise NotInRunError(f"{site.maps.folder}: no values in the maps {', '.join(kind.name for kind in kinds)}.")
    return site, fields


def _note(run: Run, site: Site) -> str:
    return f"{run.end_note}Outline: {site.outline_words}. {site.scene.note()}"


def _plot(run: Run, site: Site, page: MapPage, fields: Sequence[tuple[MapKind, Map]]) -> Figure:
    """Plot maps on a page; a map of the same quantity as the first one has its colours."""
    corner = quiet_corner(site.reached, site.scene.box)
    panels = []
    for number, (kind, field) in enumerate(fields):
        axes = page.panel(number, labels=number == 0)
        words = f"{kind.words} at {run.last_state}" if kind.is_last_state else kind.words
        like_first = isinstance(page, LeadPage) and number > 0 and kind.is_thickness and fields[0][0].is_thickness
        panels.append((axes, words, _paint(page, axes, kind, field, fields[0][1] if like_first else None)))
        site.draw_release(axes)
        site.draw_outline(axes)
        if kind.name == "arrival_time":
            _isochrones(axes, field)
        if number == 0:
            site.draw_path(axes)
            site.draw_probes(axes)
            scale_bar(axes, corner)
    page.set_titles(panels)
    page.legend(site.legend(), 5)
    return page.figure


def _covered_part(site: Site, kind: MapKind) -> Map:
    """Return a map of the covered cells; magnitudes of zero have no value."""
    field = site.part(kind.name)
    values = field.values
    if kind.is_thickness:
        values = np.where(values > site.threshold, values, np.nan)
    elif kind.name == "elevation_change":
        values = np.where(np.abs(values) > 0.0, values, np.nan)
    elif kind.has_zero_base:
        values = np.where(values > 0.0, values, np.nan)
    return replace(field, values=values)


def _paint(page: MapPage, axes: Axes, kind: MapKind, field: Map, first: Map | None) -> str:
    """Paint a field with its colour bar, or in the colours of the first map; return its maximum or range as text."""
    divisor, unit = prefixed(field.values, kind.unit) if kind.unit == "Pa" else (1.0, kind.unit)
    field = replace(field, values=field.values / divisor)
    norm, extend = _norm((first or field).values, kind)
    painter = ScalarMappable(norm, colour_map(kind.colours))
    paint(axes, field, painter)
    low, high = float(np.nanmin(field.values)), float(np.nanmax(field.values))
    remark = (
        f"max {number_text(high)} {unit}" if kind.has_zero_base else f"{number_text(low)} to {number_text(high)} {unit}"
    )
    if first is not None:
        axes.text(0.5, -0.06, "colours as in (a)", transform=axes.transAxes, ha="center", va="top", size=8, color=NOTE)
        return remark
    is_below = isinstance(page, LeadPage) and page.figure.axes[0] is not axes
    place = page.bar_below(axes) if isinstance(page, LeadPage) and is_below else page.panel_bar(axes)
    orientation: Literal["horizontal", "vertical"] = "horizontal" if is_below else "vertical"
    bar = page.figure.colorbar(painter, cax=place, extend=extend, orientation=orientation)
    if kind.is_thickness:
        label_bar(bar, norm)
        unit_words = thickness_words(norm).replace("flow thickness (m)", "m").replace("; ", "\n")
    else:
        (bar.ax.xaxis if is_below else bar.ax.yaxis).set_major_formatter(lambda value, _: exact_text(value))
        unit_words = unit
    bar.set_label(unit_words, labelpad=2)
    return remark


def _norm(values: Numbers, kind: MapKind) -> tuple[Normalize, str]:
    if kind.is_thickness:
        return thickness_norm(values)
    low, high, extend = colour_range(values[np.isfinite(values)], kind.has_zero_base)
    if kind.name == "elevation_change":
        # The scale is symmetric about zero.
        end = max(-low, high)
        return Normalize(-end, end), extend
    return Normalize(low, high), extend


def _isochrones(axes: Axes, field: Map) -> None:
    """Draw and label lines of equal arrival time."""
    levels = contour_levels(field.values, 10)
    levels = levels[levels > np.nanmin(field.values)]
    if len(levels) < 2:
        return
    grid = field.grid
    drawn = axes.contour(
        grid.x, grid.y, np.ma.masked_invalid(field.values), levels=levels, colors="white", linewidths=0.8, zorder=5
    )
    thin_labels(axes, axes.clabel(drawn, fontsize=6.5, fmt="%g s", colors="black", inline=False), 7)
