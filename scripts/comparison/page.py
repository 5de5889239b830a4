"""The page of the comparison: one picture and one table a ground, and the reasons for what differs."""

import math
import textwrap
from pathlib import Path

import numpy as np
from grounds import Ground
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from results import AFFECTED, Numbered, Outcome, PointMass, numbers, point_mass
from thawslide.figures.colours import THICKNESS, VELOCITY, label_bar, normalisation, thickness_words
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import box_about, colour_map, covered_box, make_scene, outline, paint, scale_bar
from thawslide.figures.style import styled
from thawslide.maps import Map

FOLDER = Path(__file__).resolve().parent

OPENING = f"""# Comparison with AvaFrame

[AvaFrame](https://avaframe.org) is what practitioners run: its `com1DFA` is a depth-averaged model whose particles move
in the surface and repel each other by an SPH gradient of their thickness. Thawslide resolves the thickness. Both get
the same DEM, the same release and the same friction, plain Coulomb; there is no entrainment, heat, pore pressure or
cohesion. This page is written by `scripts/compare-avaframe`. Further comparisons: [the Frank slide with
SHALTOP](frank.md), [the same slide on finer cells](refinement.md).

- *AvaFrame.* Friction model `Coulomb`, 2,063 kg/m3, all else by its defaults: cells and SPH kernels of 5 m, steps of
  0.1 s, artificial viscosity, curvature in the friction, the end where the kinetic energy is below 1 % of its largest.
- *Thawslide.* Cells of 3.3 m, of 6.6 m on the slope of the Alps; particles half a cell apart, internal friction 35
  degrees, no tension. The DEM is filtered by default, which leaves the plane and the bowl as they are.
- *Release.* 10 m along the normal for both, which is how AvaFrame takes a thickness. Its maps of thickness are made
  vertical here, by the slope of the DEM.
- *Reached.* A place is reached if the largest thickness is at least {AFFECTED} m. The travel distance is horizontal,
  from the top of the release to the farthest place reached; the reach angle is that of the straight line between them.
- *Run times* are processor times of one thread on a machine with other work: good to a quarter.
- *Point mass.* A point that slides from the middle of the release, with friction on its weight across the ground and on
  the centrifugal force, integrated along the DEM. On a straight path the centre of a slide should do about that.
- *Causes* are isolated by runs that differ in one setting; their columns name it.

"""

FIELDS = [
    ("thickness", "largest thickness (m, vertical)"),
    ("speed", "largest speed (m/s)"),
]
PAINTINGS = {"thickness": THICKNESS, "speed": VELOCITY}
ROWS = {
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.1f}",
    "displacement of the centre (m)": lambda found: f"{found.centre_way:,.0f}",
    "largest speed (m/s)": lambda found: f"{found.largest_speed:.1f}",
    "largest speed, median of places reached (m/s)": lambda found: f"{found.usual_speed:.1f}",
    "largest thickness (m, vertical)": lambda found: f"{found.largest_thickness:.1f}",
    "area reached (m2)": lambda found: f"{found.area:,.0f}",
}


def table(outcomes: list[Outcome], found: list[Numbered], point: PointMass | None) -> str:
    """Return the table of a ground, one column a program, and one of the point mass where there is one."""
    columns = [outcome.program for outcome in outcomes]
    rows = [[what, *(text(each) for each in found)] for what, text in ROWS.items()]
    rows += [
        ["volume released (m3)", *(f"{outcome.released:,.0f}" for outcome in outcomes)],
        ["share of it that left the DEM", *(f"{100.0 * outcome.left_share:.1f} %" for outcome in outcomes)],
        ["particles at the start", *(f"{outcome.particles:,}" for outcome in outcomes)],
        ["simulated (s)", *(f"{outcome.simulated:.0f}" for outcome in outcomes)],
        ["run time of one thread (s)", *(f"{outcome.processor:.0f}" for outcome in outcomes)],
    ]
    if point is not None:
        columns.append("point mass")
        told = {
            "displacement of the centre (m)": f"{point.way:,.0f}",
            "largest speed (m/s)": f"{point.largest_speed:.1f}",
        }
        rows = [[*row, told.get(row[0], "")] for row in rows]
    lines = [["", *columns], ["---"] * (len(columns) + 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def differences(first: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return other less first where either was reached (nan elsewhere); a place that one never reached counts as 0."""
    both = np.nan_to_num(other) - np.nan_to_num(first)
    return np.where(np.isfinite(first) | np.isfinite(other), both, np.nan)


@styled
def picture(
    ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome], field: str, words: str
) -> Figure:
    """Draw a field as each program has it over the terrain, and how each differs from the first."""
    places = [covered_box(outcome.thickness, AFFECTED) for outcome in outcomes]
    scene = make_scene(terrain, box_about([place for place in places if place is not None]))
    note = f"Reached: at least {AFFECTED} m thick. Blue line: the release. Differences count 0 where a program has not "
    note += f"reached. {scene.note()}"
    page = MapPage(f"{ground.title}: {words}", scene, 2 * len(outcomes) - 1, note=note, foot=0.0, bar=0.62)
    shown = [np.where(each.thickness.values >= AFFECTED, getattr(each, field).values, np.nan) for each in outcomes]
    norm, extend = normalisation(np.concatenate([values.ravel() for values in shown]), PAINTINGS[field])
    painter = ScalarMappable(norm, colour_map(PAINTINGS[field].colours))
    changes = [differences(shown[0], values) for values in shown[1:]]
    most = float(np.nanquantile(np.abs(np.concatenate([change.ravel() for change in changes])), 0.998))
    change_painter = ScalarMappable(Normalize(-most, most), "RdBu_r")
    names = [outcome.program.split(", ")[-1] for outcome in outcomes]
    drawn = [(values, painter, name) for values, name in zip(shown, names, strict=True)]
    # By letters: names of two would not fit above a narrow panel.
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
    """Write two pictures, of largest thickness and of largest speed."""
    for field, words in FIELDS:
        drawn = picture(ground, terrain, corners, outcomes, field, words)
        drawn.savefig(folder / f"{ground.name}-{field}.png", dpi=150)


def section(ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome]) -> str:
    """Return the section of a ground."""
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
