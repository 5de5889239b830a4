"""Maps of the largest values of a run, of arrival, and of the thickness at its last time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError
from thawslide.figures.colours import colour_range, label_bar, number_text, thickness_norm, thickness_words
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import HALO, colour_map, paint, quiet_corner, scale_bar
from thawslide.figures.site import Site, make_site
from thawslide.figures.style import prefixed, styled
from thawslide.maps import Map
from thawslide.relief import contour_levels
from thawslide.run import Numbers, Run


@dataclass(frozen=True)
class MapKind:
    """One map: the name of its file, words, unit, colours, whether these begin at zero, and whether it is of the end.

    Other maps hold what was largest, or first, in the whole run.
    """

    name: str
    words: str
    unit: str
    colours: str
    from_zero: bool = True
    of_last_state: bool = False

    @property
    def is_thickness(self) -> bool:
        """Whether it has the scale of thicknesses."""
        return self.name.endswith("_thickness")


_EXTENT = (
    MapKind("max_thickness", "largest thickness", "m", "YlOrRd"),
    MapKind("max_speed", "largest speed", "m/s", "viridis"),
    MapKind("arrival_time", "arrival time", "s", "cividis", from_zero=False),
    MapKind("final_thickness", "thickness", "m", "YlOrRd", of_last_state=True),
)
_IMPACT = (
    MapKind("max_pressure", "largest dynamic pressure", "Pa", "magma_r"),
    MapKind("max_momentum_flux", "largest momentum flux", "m³/s²", "viridis"),
    MapKind("max_pore_pressure", "largest pore pressure", "Pa", "viridis"),
    MapKind("max_basal_temperature", "highest temperature at the base", "°C", "plasma", from_zero=False),
    MapKind("max_melt", "most melt water", "m", "YlGnBu"),
    MapKind("elevation_change", "change of elevation", "m", "RdBu", from_zero=False, of_last_state=True),
)
_FOOT = 0.25  # inches below the maps, for the legend


@styled
def extent_maps(run: Run) -> Figure:
    """Draw largest thickness and speed, arrival time and final thickness, with release, path and probes."""
    return _draw(run, _EXTENT, "extent of the slide")


@styled
def impact_maps(run: Run) -> Figure:
    """Draw the largest pressures, momentum flux, temperature and melt, and the change of elevation."""
    return _draw(run, _IMPACT, "pressures, heat and change of the ground")


def _draw(run: Run, kinds: Sequence[MapKind], words: str) -> Figure:
    site = make_site(run)
    fields = [(kind, _touched(site, kind)) for kind in kinds if kind.name in site.maps]
    fields = [(kind, field) for kind, field in fields if np.isfinite(field.values).any()]
    if not fields:
        raise NotInRunError(f"{site.maps.folder}: none of the maps {', '.join(kind.name for kind in kinds)} has values")
    lines = f"Thin line: affected area, thicker than {site.threshold:g} m."
    note = f"{run.end_note}{lines} Time: {run.clock.words}. {site.scene.note()}"
    page = MapPage(run.titled(words), site.scene, len(fields), note=note, foot=_FOOT, bar=0.72)
    corner = quiet_corner(site.reached, site.scene.box)
    panels = []
    for number, (kind, field) in enumerate(fields):
        axes = page.panel(number, labels=number == 0)
        words = f"{kind.words} at {run.last_state}" if kind.of_last_state else kind.words
        panels.append((axes, words, _paint(page, axes, kind, field)))
        site.draw_release(axes)
        site.draw_reach(axes)
        if kind.name == "arrival_time":
            _isochrones(axes, field)
        if number == 0:
            site.draw_path(axes)
            site.draw_probes(axes)
            scale_bar(axes, corner)
    page.name(panels)
    page.legend(site.legend(), 5)
    return page.figure


def _touched(site: Site, kind: MapKind) -> Map:
    """Return a map where the slide was; magnitudes of zero are left free as well."""
    field = site.part(kind.name)
    values = field.values
    if kind.is_thickness:
        values = np.where(values > site.threshold, values, np.nan)
    elif kind.name == "arrival_time":
        values = values + site.run.clock.shift
    elif kind.name == "elevation_change":
        values = np.where(np.abs(values) > 0.0, values, np.nan)
    elif kind.from_zero:
        values = np.where(values > 0.0, values, np.nan)
    return replace(field, values=values)


def _paint(page: MapPage, axes: Axes, kind: MapKind, field: Map) -> str:
    """Draw a field with its colourbar; return its largest value in words, or both ends of its range."""
    divisor, unit = prefixed(field.values, kind.unit) if kind.unit == "Pa" else (1.0, kind.unit)
    field = replace(field, values=field.values / divisor)
    norm, extend = _norm(field.values, kind)
    painter = ScalarMappable(norm, colour_map(kind.colours))
    paint(axes, field, painter)
    bar = page.figure.colorbar(painter, cax=page.panel_bar(axes), extend=extend)
    if kind.is_thickness:
        label_bar(bar, norm)
        unit_words = thickness_words(norm).replace("thickness (m)", "m").replace("; ", "\n")
    else:
        bar.ax.yaxis.set_major_formatter(lambda value, _: f"{value:,.10g}".replace("-", "−"))
        unit_words = unit
    bar.set_label(unit_words, labelpad=2)
    low, high = float(np.nanmin(field.values)), float(np.nanmax(field.values))
    return f"max {number_text(high)} {unit}" if kind.from_zero else f"{number_text(low)} to {number_text(high)} {unit}"


def _norm(values: Numbers, kind: MapKind) -> tuple[Normalize, str]:
    if kind.is_thickness:
        return thickness_norm(values)
    low, high, extend = colour_range(values[np.isfinite(values)], kind.from_zero)
    if kind.name == "elevation_change":
        # As deep a colour for a metre gained as for a metre lost.
        end = max(-low, high)
        return Normalize(-end, end), extend
    return Normalize(low, high), extend


def _isochrones(axes: Axes, field: Map) -> None:
    """Draw lines of equal arrival time with their seconds."""
    levels = contour_levels(field.values, 7)
    levels = levels[levels > np.nanmin(field.values)]
    if len(levels) < 2:
        return
    grid = field.grid
    drawn = axes.contour(
        grid.x, grid.y, np.ma.masked_invalid(field.values), levels=levels, colors="white", linewidths=0.8, zorder=5
    )
    for text in axes.clabel(drawn, fontsize=6.5, fmt="%g s", colors="black"):
        text.set_path_effects(HALO)
        text.set_zorder(7)
