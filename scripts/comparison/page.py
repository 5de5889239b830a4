"""The page of the comparison: one picture and one table a ground, and the reasons for what differs."""

import math
from pathlib import Path

import matplotlib.pyplot as plt
from grounds import Ground
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from results import AFFECTED, Numbered, Outcome, PointMass, numbers, point_mass
from thawslide.figures.map_panel import MapPage, box_about, covered_box, make_scene, outline, paint, scale_bar
from thawslide.maps import Map

FOLDER = Path(__file__).resolve().parent

OPENING = f"""# Beside AvaFrame

[AvaFrame](https://avaframe.org) is what practitioners run: its `com1DFA` is a depth-averaged model, whose particles
move in the surface and hold each other apart by an SPH gradient of their thickness. Thawslide resolves the thickness.
Both get the same DEM, the same release and the same friction, plain Coulomb; no entrainment, no heat, no pore pressure,
no cohesion. This page is written by `scripts/compare-avaframe`, from what the two programs left; the reasons are ours.

- AvaFrame: friction model `Coulomb`, 2,063 kg/m3, all else by its defaults: cells and SPH kernels of 5 m, steps of
  0.1 s, artificial viscosity, curvature in the friction, the end where the kinetic energy is below 1 % of its largest.
- Thawslide: cells of 3.3 m, particles 1.65 m apart, friction inside 35 degrees, no tension; to a given time.
- Release: 10 m along the normal for both, which is how AvaFrame takes a thickness. Its maps of thickness are turned to
  the vertical here, by the slope of the DEM, as ours are.
- "Reached" is a place where the largest thickness is at least {AFFECTED} m. The travel distance is horizontal, from
  the top of the release to the farthest place reached, the reach angle that of the straight line between them. Run
  times are of one thread on the same machine, which had other work: good to a quarter.
- "Point mass": a point that slides from the middle of the release, with friction on its weight across the ground and on
  the centrifugal force, integrated along the DEM. Where the way is straight the centre of a slide should do about that.

"""

ROWS = {
    "deposit volume (m3)": lambda found: f"{found.volume:,.0f}",
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.1f}",
    "way of the centre (m)": lambda found: f"{found.centre_way:,.0f}",
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
        ["particles", *(f"{outcome.particles:,}" for outcome in outcomes)],
        ["simulated (s)", *(f"{outcome.simulated:.0f}" for outcome in outcomes)],
        ["run time, one thread (s)", *(f"{outcome.wall:.0f}" for outcome in outcomes)],
    ]
    if point is not None:
        columns.append("point mass")
        told = {"way of the centre (m)": f"{point.way:,.0f}", "largest speed (m/s)": f"{point.largest_speed:.1f}"}
        rows = [[*row, told.get(row[0], "")] for row in rows]
    lines = [["", *columns], ["---"] * (len(columns) + 1), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def draw(ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome], file: Path) -> None:
    """Draw largest thickness and largest speed of the programs beside each other, over the terrain."""
    places = [covered_box(outcome.thickness, AFFECTED) for outcome in outcomes]
    scene = make_scene(terrain, box_about([place for place in places if place is not None]))
    fields = {
        "largest thickness (m)": ([outcome.thickness for outcome in outcomes], "YlOrRd"),
        "largest speed (m/s)": ([outcome.speed for outcome in outcomes], "viridis"),
    }
    page = MapPage(ground.title, scene, 2 * len(outcomes), foot=0.35, bar=0.55)
    number = 0
    for words, (maps, colours) in fields.items():
        reached = [
            each.values[outcome.thickness.values >= AFFECTED] for each, outcome in zip(maps, outcomes, strict=True)
        ]
        most = max(float(values.max()) for values in reached)
        painter = ScalarMappable(Normalize(0.0, most), colours)
        for outcome, field in zip(outcomes, maps, strict=True):
            axes = page.panel(number, labels=False)
            shown = field.values.copy()
            shown[~(outcome.thickness.values >= AFFECTED)] = math.nan
            paint(axes, Map(field.grid, shown), painter)
            outline(axes, outcome.thickness, AFFECTED, colors="#222222", linewidths=0.6)
            axes.plot(*zip(*corners, strict=True), color="#0072B2", linewidth=1.0, zorder=6)
            axes.set_title(f"{outcome.program}: {words}", loc="left", size=8.5)
            page.figure.colorbar(painter, cax=page.panel_bar(axes))
            if number == 0:
                scale_bar(axes, "lower left")
            number += 1
    page.note(f"Where the thickness was at least {AFFECTED} m. Blue: the release. {scene.note()}")
    page.figure.savefig(file, dpi=110)
    plt.close("all")


def section(ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome]) -> str:
    """Return the section of a ground."""
    coefficient = math.tan(math.radians(ground.friction_angle))
    found = [numbers(outcome, terrain, corners) for outcome in outcomes]
    point = point_mass(terrain, corners, coefficient) if ground.is_straight else None
    friction = f"Friction along the ground: {ground.friction_angle:g} degrees, a coefficient of {coefficient:.3f}."
    reasons = (FOLDER / f"{ground.name}.md").read_text().strip()
    parts = [
        f"## {ground.title}",
        ground.text,
        friction,
        f"![Largest thickness and speed](comparison/{ground.name}.png)",
    ]
    return "\n\n".join([*parts, table(outcomes, found, point), reasons]) + "\n\n"
