"""Figures of a report: one entry for each, in the order of the page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from thawslide.figures.animation import Animation, animation
from thawslide.figures.band import band
from thawslide.figures.base import base_along, base_pressure, base_temperature
from thawslide.figures.cross_sections import cross_sections
from thawslide.figures.energy import energy
from thawslide.figures.entrainment import entrainment
from thawslide.figures.force import force
from thawslide.figures.force_record import caption as force_record_caption
from thawslide.figures.force_record import force_record
from thawslide.figures.maximum_maps import extent_maps, impact_maps
from thawslide.figures.motion import motion
from thawslide.figures.probes import probes
from thawslide.figures.slide_on_map import slide_speed, slide_temperature, slide_thickness
from thawslide.figures.snapshots import plastic_strain, pore_pressure, temperature, velocity
from thawslide.figures.view import view
from thawslide.figures.water import water
from thawslide.maps import on_map
from thawslide.run_folder import Run


@dataclass(frozen=True)
class FigureKind:
    """One figure: its heading and caption on the page, the function that plots it, and the runs it suits."""

    heading: str
    caption: str | Callable[[Run], str]
    plot: Callable[[Run], Figure | Animation]
    suits: Callable[[Run], bool] = lambda run: True
    columns_caption: str = ""  # for runs with band columns, if different

    def caption_of(self, run: Run) -> str:
        """Return the caption for a run."""
        if self.columns_caption and run.has_band_columns:
            return self.columns_caption
        return self.caption if isinstance(self.caption, str) else self.caption(run)


_PANELS = (
    "Top: whole profile, and the range of each panel. Below each panel, if at another scale: height of the particles "
    "above the terrain. "
    "Particles have their true height and at least the width of a grid cell, because the model does not resolve "
    "narrower gaps; very small ones are enlarged."
)

_ON_MAP = "Means over the particles in each map cell, at the report times. Contour lines and hillshade: terrain."
_BASE_ON_MAP = "Area-weighted means over the basal segments in each map cell, at the report times."


def _in_section(run: Run) -> bool:
    return not on_map(run)


def _with_heat_on_map(run: Run) -> bool:
    return on_map(run) and not run.has_band_columns


def _base_on_map(run: Run) -> bool:
    return on_map(run) and run.has_band_columns


def _base_in_section(run: Run) -> bool:
    return _in_section(run) and run.has_band_columns


def _with_heat_in_section(run: Run) -> bool:
    """Return whether temperature and pore pressure of particles change; with band columns they are constant."""
    return _in_section(run) and not run.has_band_columns


FIGURES: dict[str, FigureKind] = {
    "extent_maps": FigureKind(
        "Extent of the avalanche",
        "Maximum flow thickness and speed, arrival time, and flow thickness at the last time, from every time step. "
        "White lines: arrival time.",
        extent_maps,
        on_map,
    ),
    "view": FigureKind(
        "3D view",
        "The terrain from in front of the slide, without vertical exaggeration. Colour: maximum depth-averaged speed. "
        "Lines: affected area, and release (dashed). The bar is true across the view.",
        view,
        on_map,
    ),
    "animation": FigureKind("Animation", "Depth-averaged speed, one frame per snapshot.", animation, on_map),
    "slide_speed": FigureKind("Depth-averaged speed", _ON_MAP, slide_speed, on_map),
    "slide_thickness": FigureKind("Flow thickness", _ON_MAP, slide_thickness, on_map),
    "slide_temperature": FigureKind("Basal temperature", _ON_MAP, slide_temperature, _with_heat_on_map),
    "base_temperature": FigureKind(
        "Band temperature",
        f"{_BASE_ON_MAP} Each basal segment has the mean temperature of its column, whose hottest part is hotter.",
        base_temperature,
        _base_on_map,
    ),
    "base_pressure": FigureKind(
        "Pore pressure ratio of the band",
        f"{_BASE_ON_MAP} At a ratio of 1, pore pressure carries the full load.",
        base_pressure,
        _base_on_map,
    ),
    "cross_sections": FigureKind(
        "Cross sections",
        "Terrain and sliding mass along the flow path and across it. Thicknesses are means over map cells; the release "
        "is that of the input, the others are those of the particles. Small thicknesses are exaggerated by a factor "
        "stated in the panel.",
        cross_sections,
        on_map,
    ),
    "impact_maps": FigureKind(
        "Pressure, temperature and elevation change",
        "Maximum values of the whole run, and elevation change at its last time. Dynamic pressure: density times speed "
        "squared. Momentum flux: thickness times speed squared. Temperature: maximum over time of the mean in each map "
        "cell.",
        impact_maps,
        on_map,
    ),
    "probes": FigureKind(
        "Probes",
        "Flow thickness and speed at points; flow area and discharge through cross sections.",
        probes,
        lambda run: run.probe_series is not None,
    ),
    "motion": FigureKind(
        "Speed and displacement",
        "Mass-weighted means. Runout distance: front (99.5 % of the mass is behind it) minus initial rear. Markers: "
        "reported values, filled if observed.",
        motion,
    ),
    "velocity": FigureKind("Speed", _PANELS, velocity, _in_section),
    "plastic_strain": FigureKind("Equivalent plastic strain", _PANELS, plastic_strain, _in_section),
    "temperature": FigureKind("Temperature", _PANELS, temperature, _with_heat_in_section),
    "pore_pressure": FigureKind("Pore pressure", _PANELS, pore_pressure, _with_heat_in_section),
    "force": FigureKind(
        "Seismic force and plastic strain",
        "Force on the terrain minus static weight: the force that inversions of seismic waves determine.",
        force,
    ),
    "force_record": FigureKind(
        "Force compared with seismic inversion",
        force_record_caption,
        force_record,
        lambda run: bool(run.section("report").get("force_record")),
    ),
    "band": FigureKind(
        "Shear band",
        "Means over the particles next to the terrain; friction coefficient: mean over nodes in contact. N: normal "
        "component of the overburden, without dynamic terms. Gaps: no particles in the band. Boiling is not modelled.",
        band,
        columns_caption="Area-weighted means over the base. Shear traction: resistance by cohesion and friction per "
        "contact area. Friction depends on the effective normal stress N − P, or on N alone for substrates with the "
        'law "coefficient". Parts of a column that contain water are limited by the boiling temperature at its own N, '
        "dry parts are not. The dashed line is for the mean N. N is averaged over band.load_time for P/N.",
    ),
    "base_along": FigureKind(
        "Basal stresses and temperatures",
        "Left: normal pressure N of each basal segment, averaged over band.load_time, and mean pore pressure P of its "
        "column. Green: N − P, on which friction acts. Right: maximum and mean temperature T of each "
        "column, and boiling temperature at its N.",
        base_along,
        _base_in_section,
    ),
    "energy": FigureKind(
        "Energy budget",
        "Change of each budget term since the start. Warming and melting of columns: without the heat of material that "
        "joins and leaves them. Relative residual: imbalance of a budget over the maximum change of its terms.",
        energy,
    ),
    "entrainment": FigureKind(
        "Entrainment",
        "Mass entrained from the erodible bed, work needed to accelerate it, and entrained depth along x where "
        "particles joined.",
        entrainment,
        lambda run: "entrained_mass_kg" in run.series,
    ),
    "water": FigureKind(
        "Water budget of the band",
        "Ice and water in band columns with gains and losses; volume of openings along the base where P = N, and of "
        "gas in pores. Relative residual: imbalance over the largest term.",
        water,
        lambda run: run.has_band_columns,
    ),
}
