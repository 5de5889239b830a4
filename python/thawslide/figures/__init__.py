"""The figures of a report: one entry a figure, in the order the page shows them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from thawslide.figures.band import band
from thawslide.figures.energy import energy
from thawslide.figures.force import force
from thawslide.figures.motion import motion
from thawslide.figures.snapshots import plastic_strain, pore_pressure, temperature, velocity
from thawslide.run import Run


@dataclass(frozen=True)
class FigureKind:
    """One figure: its heading and caption on the page, and the function that draws it from a run."""

    heading: str
    caption: str
    draw: Callable[[Run], Figure]


_PANELS = (
    "Top: the whole profile and which stretch each panel shows. Under each panel: the slide peeled off the terrain, by "
    "height above the ground right below. Particles are squares of their real size, or just large enough to be seen."
)

FIGURES: dict[str, FigureKind] = {
    "motion": FigureKind(
        "Velocity and displacement",
        "Mass means over the slide; the runout is the front (99.5 % of the mass lies behind it) less the rear at the "
        "start. Open markers: reported values, where the case names any.",
        motion,
    ),
    "velocity": FigureKind("Velocity", _PANELS, velocity),
    "plastic_strain": FigureKind("Equivalent plastic strain", _PANELS, plastic_strain),
    "temperature": FigureKind("Temperature", _PANELS, temperature),
    "pore_pressure": FigureKind("Pore pressure", _PANELS, pore_pressure),
    "force": FigureKind(
        "Seismic force and plastic strain",
        "The force of the slide on the ground less its static weight, which is what seismic waves are inverted for.",
        force,
    ),
    "band": FigureKind(
        "The shear band",
        "Means over the particles next to the ground; the friction coefficient is the mean over nodes in contact. "
        "Gaps: no particle there at that time.",
        band,
    ),
    "energy": FigureKind(
        "Energy ledger",
        "Every account as its change since the start; the residual is what the accounts of a ledger leave over.",
        energy,
    ),
}
