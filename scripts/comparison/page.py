"""The page of the comparison: figures, a table and the causes of the differences for each terrain."""

import math
import textwrap
from pathlib import Path

import numpy as np
from grounds import Ground
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from results import AFFECTED, Numbered, Outcome, PointMass, numbers, point_mass
from thawslide.figures.colours import SPEED, THICKNESS, label_bar, normalization, thickness_words
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import box_about, colour_map, covered_box, make_scene, outline, paint, scale_bar
from thawslide.figures.style import styled
from thawslide.maps import Map

FOLDER = Path(__file__).resolve().parent

OPENING = f"""# Comparison with AvaFrame

This page compares Thawslide with [AvaFrame](https://avaframe.org) on three terrains. AvaFrame is widely used in
practice. Its `com1DFA` is a depth-averaged model: particles move in the surface and repel each other by an SPH gradient
of their thickness. Thawslide resolves the thickness.

Both programs receive the same DEM, the same release and the same Coulomb friction. There is no entrainment, heat, pore
pressure or cohesion. `scripts/compare-avaframe` generates this page. Further comparisons: [the Frank slide with
SHALTOP](frank.md), [the same slide on finer cells](refinement.md).

- *AvaFrame.* Friction model `Coulomb`, 2,063 kg/m3, all other settings by default. These are cells and SPH kernels of
  5 m, time steps of 0.1 s, artificial viscosity, and curvature in the friction. A run ends when the kinetic energy
  falls below 1 % of its maximum.
- *Thawslide.* Cells of 3.3 m, of 6.6 m on the slope of the Alps; particles half a cell apart, internal friction 35
  degrees, no tension. The DEM is filtered by default. The filter leaves the plane and the bowl unchanged.
- *Release.* 10 m along the normal for both, as in the release thickness of AvaFrame. The slope of the DEM converts
  AvaFrame's maps to vertical thickness here.
- *Reached.* A place is reached if the maximum thickness is at least {AFFECTED} m. The travel distance is horizontal,
  from the top of the release to the farthest place reached; the reach angle is that of the straight line between them.
- *Run times* are processor times of one thread on a machine with other work, with an uncertainty of a quarter.
- *Point mass.* A point that slides from the middle of the release, integrated along the DEM. Friction acts on its
  weight across the ground and on the centrifugal force. On a straight path, the centre of a slide should move about as
  far.
- *Causes* are isolated by runs that differ in one setting. The columns name the setting.

"""

FIELDS = [
    ("thickness", "maximum thickness (m, vertical)"),
    ("speed", "maximum speed (m/s)"),
]
PAINTINGS = {"thickness": THICKNESS, "speed": SPEED}
ROWS = {
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.1f}",
    "displacement of the centre (m)": lambda found: f"{found.centre_displacement:,.0f}",
    "maximum speed (m/s)": lambda found: f"{found.max_speed:.1f}",
    "maximum speed, median of places reached (m/s)": lambda found: f"{found.usual_speed:.1f}",
    "maximum thickness (m, vertical)": lambda found: f"{found.max_thickness:.1f}",
    "area reached (m2)": lambda found: f"{found.area:,.0f}",
}


def table(outcomes: list[Outcome], found: list[Numbered], point: PointMass | None) -> str:
    """Return the table of a terrain: a column per program, and one of the point mass if available."""
    columns = [outcome.program for outcome in outcomes]
    rows = [[what, *(text(each) for each in found)] for what, text in ROWS.items()]
    rows += [
        ["volume released (m3)", *(f"{outcome.released:,.0f}" for outcome in outcomes)],
        ["fraction of it that left the DEM", *(f"{100.0 * outcome.left_share:.1f} %" for outcome in outcomes)],
        ["particles at the start", *(f"{outcome.particles:,}" for outcome in outcomes)],
        ["simulated (s)", *(f"{outcome.simulated:.0f}" for outcome in outcomes)],
        ["run time of one thread (s)", *(f"{outcome.processor:.0f}" for outcome in outcomes)],
    ]
    if point is not None:
        columns.append("point mass")
        of_point = {
            "displacement of the centre (m)": f"{point.travel:,.0f}",
            "maximum speed (m/s)": f"{point.max_speed:.1f}",
        }
        rows = [[*row, of_point.get(row[0], "")] for row in rows]
    lines = [["", *columns], ["---"] * (len(columns) + 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def differences(first: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return other minus first; nan in cells that neither reached, 0 for the program that did not reach a cell."""
    both = np.nan_to_num(other) - np.nan_to_num(first)
    return np.where(np.isfinite(first) | np.isfinite(other), both, np.nan)


@styled
def comparison_figure(
    ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome], field: str, words: str
) -> Figure:
    """Plot a field of each program over the terrain, and the differences from the first."""
    places = [covered_box(outcome.thickness, AFFECTED) for outcome in outcomes]
    scene = make_scene(terrain, box_about([place for place in places if place is not None]))
    note = f"Outline: maximum thickness of at least {AFFECTED} m. Blue line: release. Differences: 0 for a program "
    note += f"without material in a cell. {scene.note()}"
    page = MapPage(f"{ground.title}: {words}", scene, 2 * len(outcomes) - 1, note=note, foot=0.0, bar=0.62)
    shown = [np.where(each.thickness.values >= AFFECTED, getattr(each, field).values, np.nan) for each in outcomes]
    norm, extend = normalization(np.concatenate([values.ravel() for values in shown]), PAINTINGS[field])
    painter = ScalarMappable(norm, colour_map(PAINTINGS[field].colours))
    changes = [differences(shown[0], values) for values in shown[1:]]
    most = float(np.nanquantile(np.abs(np.concatenate([change.ravel() for change in changes])), 0.998))
    change_painter = ScalarMappable(Normalize(-most, most), "RdBu_r")
    names = [outcome.program.split(", ")[-1] for outcome in outcomes]
    drawn = [(values, painter, name) for values, name in zip(shown, names, strict=True)]
    # Letters, because two names do not fit above a narrow panel.
    drawn += [(change, change_painter, f"{letter} − a") for change, letter in zip(changes, "bcdefg", strict=False)]
    panels = []
    for number, (values, colours, name) in enumerate(drawn):
        axes = page.panel(number, labels=False)
        paint(axes, Map(terrain.grid, values), colours)
        outcome = outcomes[number if number < len(outcomes) else number - len(outcomes) + 1]
        outline(axes, outcome.thickness, AFFECTED, colors="#222222", linewidths=0.6)
        axes.plot(*zip(*corners, strict=True), color="#0072B2", linewidth=1.0, zorder=6)
        panels.append((axes, name, ""))
        bar = page.figure.colorbar(colours, cax=page.panel_bar(axes), extend=extend if colours is painter else "both")
        if colours is painter:
            label_bar(bar, norm)
            if field == "thickness":
                bar.set_label(thickness_words(norm).replace("thickness (m)", "m").replace("; ", "\n"), labelpad=2)
        scale_bar(axes, "lower left")
    page.set_titles(panels)
    return page.figure


def draw(ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome], folder: Path) -> None:
    """Write two figures, of maximum thickness and of maximum speed."""
    for field, words in FIELDS:
        drawn = comparison_figure(ground, terrain, corners, outcomes, field, words)
        drawn.savefig(folder / f"{ground.name}-{field}.png", dpi=150)


def section(ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome]) -> str:
    """Return the section of a terrain."""
    coefficient = math.tan(math.radians(ground.friction_angle))
    found = [numbers(outcome, terrain, corners) for outcome in outcomes]
    point = point_mass(terrain, corners, coefficient) if ground.is_straight else None
    friction = f"Friction along the ground: {ground.friction_angle:g} degrees, a coefficient of {coefficient:.3f}."
    reasons = (FOLDER / f"{ground.name}.md").read_text().strip()
    parts = [
        f"## {ground.title}",
        textwrap.fill(f"{ground.text} {friction}", 118),
        *(f"![{words}](comparison/{ground.name}-{field}.png)" for field, words in FIELDS),
    ]
    return "\n\n".join([*parts, table(outcomes, found, point), reasons]) + "\n\n"
