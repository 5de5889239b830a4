"""The figures of a report: one entry a figure, in the order the page shows them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from thawslide.figures.animation import Film, animation
from thawslide.figures.band import band
from thawslide.figures.base import base_along, base_pressure, base_temperature
from thawslide.figures.cross_sections import cross_sections
from thawslide.figures.energy import energy
from thawslide.figures.entrainment import entrainment
from thawslide.figures.force import force
from thawslide.figures.force_record import caption as force_record_caption
from thawslide.figures.force_record import force_record
from thawslide.figures.largest import extent_maps, impact_maps
from thawslide.figures.motion import motion
from thawslide.figures.probes import probes
from thawslide.figures.slide_on_map import slide_speed, slide_temperature, slide_thickness
from thawslide.figures.snapshots import plastic_strain, pore_pressure, temperature, velocity
from thawslide.figures.water import water
from thawslide.maps import on_map
from thawslide.run import Run


@dataclass(frozen=True)
class FigureKind:
    """One figure: its heading and caption on the page, the function that draws it, and which runs it is for."""

    heading: str
    caption: str | Callable[[Run], str]
    draw: Callable[[Run], Figure | Film]
    suits: Callable[[Run], bool] = lambda run: True
    of_columns: str = ""  # the caption where the band is of columns, if it is another

    def caption_of(self, run: Run) -> str:
        """Return the caption for a run."""
        if self.of_columns and run.has_band_columns:
            return self.of_columns
        return self.caption if isinstance(self.caption, str) else self.caption(run)


_PANELS = (
    "Top: the whole profile and which stretch each panel shows. Under each panel: the slide peeled off the terrain, by "
    "height above the ground right below. Particles have their real height and at least the width of a grid cell, as "
    "the model has no narrower gaps, or are just large enough to be seen."
)

_FROM_ABOVE = (
    "From above at chosen times, particles gathered on the cells of the maps. Contour lines and shading: the ground "
    "below the slide."
)


_BASE_FROM_ABOVE = (
    "From above at chosen times: means over the pieces of base on each cell of the maps. At 1 of pore pressure over "
    "normal pressure the base floats."
)


def _in_section(run: Run) -> bool:
    return not on_map(run)


def _with_heat_on_map(run: Run) -> bool:
    return on_map(run) and not run.has_band_columns


def _base_on_map(run: Run) -> bool:
    return on_map(run) and run.has_band_columns


def _base_in_section(run: Run) -> bool:
    return _in_section(run) and run.has_band_columns


def _with_heat_in_section(run: Run) -> bool:
    """Where particles heat up; with band columns these do, and particles stay as they were."""
    return _in_section(run) and not run.has_band_columns


FIGURES: dict[str, FigureKind] = {
    "extent_maps": FigureKind(
        "Extent of the slide",
        "Largest thickness and speed, arrival, and the thickness at the last time, gathered in every step of the run. "
        "White lines: equal arrival time.",
        extent_maps,
        on_map,
    ),
    "animation": FigureKind(
        "The slide in motion",
        "Speed as mean over the thickness, one frame a snapshot.",
        animation,
        on_map,
    ),
    "slide_speed": FigureKind("Speed from above", _FROM_ABOVE, slide_speed, on_map),
    "slide_thickness": FigureKind("Thickness from above", _FROM_ABOVE, slide_thickness, on_map),
    "slide_temperature": FigureKind("Temperature from above", _FROM_ABOVE, slide_temperature, _with_heat_on_map),
    "base_temperature": FigureKind("Temperature of the band", _BASE_FROM_ABOVE, base_temperature, _base_on_map),
    "base_pressure": FigureKind("Pore pressure of the band", _BASE_FROM_ABOVE, base_pressure, _base_on_map),
    "cross_sections": FigureKind(
        "Sections",
        "Through terrain and slide along the path line, and across it; where thin, the slide is drawn thicker than it "
        "is, by the factor each panel names.",
        cross_sections,
        on_map,
    ),
    "impact_maps": FigureKind(
        "Pressures, heat and change of the ground",
        "The largest values of the whole run. Dynamic pressure is density times speed squared; momentum flux is "
        "thickness times speed squared.",
        impact_maps,
        on_map,
    ),
    "probes": FigureKind(
        "Probes",
        "Thickness and speed at points; flow area and discharge through cross sections.",
        probes,
        lambda run: run.probes is not None,
    ),
    "motion": FigureKind(
        "Velocity and displacement",
        "Mass means over the slide; the runout is the front (99.5 % of the mass lies behind it) less the rear at the "
        "start. Open markers: reported values, where the case names any.",
        motion,
    ),
    "velocity": FigureKind("Velocity", _PANELS, velocity, _in_section),
    "plastic_strain": FigureKind("Equivalent plastic strain", _PANELS, plastic_strain, _in_section),
    "temperature": FigureKind("Temperature", _PANELS, temperature, _with_heat_in_section),
    "pore_pressure": FigureKind("Pore pressure", _PANELS, pore_pressure, _with_heat_in_section),
    "force": FigureKind(
        "Seismic force and plastic strain",
        "The force of the slide on the ground less its static weight, which is what seismic waves are inverted for.",
        force,
    ),
    "force_record": FigureKind(
        "Force against its inversion from seismic waves",
        force_record_caption,
        force_record,
        lambda run: bool(run.section("report").get("force_record")),
    ),
    "band": FigureKind(
        "The shear band",
        "Means over the particles next to the ground; the friction coefficient is the mean over nodes in contact. "
        "N is the weight above them on the slope, at rest. Gaps: no particle there at that time.",
        band,
        of_columns="Means over the base by area, as its columns have it. The shear traction is what the base resists "
        "with, cohesion and friction, over the area in contact: friction follows the effective normal stress N − P, "
        'and on substrates of the law "coefficient" N alone. Under its own N no column\'s water gets hotter than where '
        "it boils; the line is for the mean N. P and N of each column are compared with N averaged over "
        "band.load_time.",
    ),
    "base_along": FigureKind(
        "Along the base",
        "Left: what presses on each piece of base, averaged over band.load_time, and the mean pore pressure of its "
        "band; friction acts on what is left, in green. Right: the hottest cell of each column, the mean of its band, "
        "and where water boils under its N.",
        base_along,
        _base_in_section,
    ),
    "energy": FigureKind(
        "Energy ledger",
        "Every account as its change since the start; the residual is what the accounts of a ledger leave over.",
        energy,
    ),
    "entrainment": FigureKind(
        "Bed taken up",
        "Mass that the slide took off the erodible bed, the work that it lost to setting it in motion, and the depth "
        "that was taken up along x, by where particles joined.",
        entrainment,
        lambda run: "entrained_mass_kg" in run.history,
    ),
    "water": FigureKind(
        "Water of the band",
        "Ice and water of the band's columns: what they hold, took in and lost; the volume that water at P = N has "
        "opened along the base, and that of pores which water has left.",
        water,
        lambda run: run.has_band_columns,
    ),
}
