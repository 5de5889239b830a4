"""The comparison with AvaFrame's com1DFA on three terrains: runs of both programs, figures, tables and causes."""

from __future__ import annotations

import json
import math
import shutil
import textwrap
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from reproduction.engine import Task
from reproduction.studies.grounds import ALR, GROUNDS, Ground, Variant, write_case, write_dem
from reproduction.studies.results import (
    AFFECTED,
    Numbered,
    Outcome,
    PointMass,
    numbers,
    on_grid,
    point_mass,
    read_avaframe,
    read_thawslide,
)
from reproduction.study import ROOT, Job, Place, Study
from reproduction.tables import markdown, text_of
from thawslide.figures.colours import SPEED, THICKNESS, label_bar, normalization, thickness_words
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import (
    box_about,
    colour_map,
    covered_box,
    make_scene,
    outline,
    paint,
    quiet_corner,
    scale_bar,
)
from thawslide.figures.style import styled
from thawslide.maps import Map, read_map

SCRIPT = Path(__file__).resolve().parent / "run_com1dfa.py"
AVAFRAME, THAWSLIDE = Variant("avaframe", ""), Variant("thawslide", "")
CELLS = "alr-cells"  # folder of the ground that the cells of Thawslide represent, as a DEM
QUICK = ("time.end=0.3", "time.output_interval=0.3")
FIELDS = [("thickness", "maximum thickness (m, vertical)"), ("speed", "maximum speed (m/s)")]
PAINTINGS = {"thickness": THICKNESS, "speed": SPEED}
ROWS: dict[str, Callable[[Numbered], str]] = {
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.1f}",
    "displacement of the centre (m)": lambda found: f"{found.centre_displacement:,.0f}",
    "maximum speed (m/s)": lambda found: f"{found.max_speed:.1f}",
    "maximum thickness (m, vertical)": lambda found: f"{found.max_thickness:.1f}",
    "area reached (m2)": lambda found: f"{found.area:,.0f}",
}


def table(outcomes: list[Outcome], found: list[Numbered], point: PointMass | None) -> str:
    """Return the table of a terrain: a column per program, and one of the point mass if available."""
    columns = [outcome.program for outcome in outcomes]
    rows = [[what, *(text(each) for each in found)] for what, text in ROWS.items()]
    rows += [
        ["fraction of the release that left the DEM", *(f"{100.0 * outcome.left_share:.1f} %" for outcome in outcomes)],
        ["run time of one thread (s)", *(f"{outcome.processor:.0f}" for outcome in outcomes)],
    ]
    if point is not None:
        columns.append("point mass")
        of_point = {
            "displacement of the centre (m)": f"{point.travel:,.0f}",
            "maximum speed (m/s)": f"{point.max_speed:.1f}",
        }
        rows = [[*row, of_point.get(row[0], "")] for row in rows]
    return markdown([["", *columns], *rows])


@styled
def comparison_figure(
    ground: Ground, terrain: Map, corners: list[list[float]], outcomes: list[Outcome], field: str, words: str
) -> Figure:
    """Plot a field of each run over the terrain, on one scale."""
    places = [covered_box(outcome.thickness, AFFECTED) for outcome in outcomes]
    scene = make_scene(terrain, box_about([place for place in places if place is not None]))
    note = f"Colours and outline: maximum thickness of at least {AFFECTED} m. Blue line: release. {scene.note()}"
    page = MapPage(f"{ground.title}: {words}", scene, len(outcomes), note=note, foot=0.72)
    shown = [np.where(each.thickness.values >= AFFECTED, getattr(each, field).values, np.nan) for each in outcomes]
    norm, extend = normalization(np.concatenate([values.ravel() for values in shown]), PAINTINGS[field])
    painter = ScalarMappable(norm, colour_map(PAINTINGS[field].colours))
    corner = quiet_corner(max(outcomes, key=lambda each: np.count_nonzero(each.thickness.values >= AFFECTED)).thickness,
                          scene.box)  # fmt: skip
    panels = []
    for number, (values, outcome) in enumerate(zip(shown, outcomes, strict=True)):
        axes = page.panel(number, labels=False)
        paint(axes, Map(terrain.grid, values), painter)
        outline(axes, outcome.thickness, AFFECTED, colors="#222222", linewidths=0.6)
        axes.plot(*zip(*corners, strict=True), color="#0072B2", linewidth=1.0, zorder=6)
        panels.append((axes, outcome.short_name, ""))
        if number == 0:
            scale_bar(axes, corner)
    bar = page.figure.colorbar(painter, cax=page.common_bar(), orientation="horizontal", extend=extend)
    label_bar(bar, norm)
    bar.set_label(thickness_words(norm) if field == "thickness" else words, labelpad=1)
    page.set_titles(panels)
    return page.figure


def task(place: Place, folder: Path, angle: float, variant: Variant) -> Task:
    """Return a run of AvaFrame on the DEM and the release of a folder."""
    command = (str(python_of(place)), "-I", str(SCRIPT), str(folder), str(angle), variant.name, *variant.changes)
    inputs = (SCRIPT, folder / "dem.tif", folder / "release.json")  # -I: the folder of the script has an avaframe.py
    return Task(f"{folder.name}/{variant.name}", command, folder / variant.name, inputs=inputs)


def avaframe_tasks(place: Place) -> list[Task]:
    """Write the inputs; return the runs of AvaFrame."""
    tasks = []
    for ground in GROUNDS.values():
        write_case(ground, ground.name, place.runs, place.data / "alr")
        folder = place.runs / ground.name
        tasks += [task(place, folder, ground.friction_angle, each) for each in (AVAFRAME, *ground.avaframe)]
    return tasks


def tasks_on_cells(place: Place) -> list[Task]:
    """Write the ground that the cells of Thawslide represent as a DEM; return the run of AvaFrame on it."""
    terrain, folder = read_map(place.runs / ALR.name / "dem.tif"), place.runs / CELLS
    ground = on_grid(read_map(place.runs / ALR.name / "ground" / "maps" / "ground.tif"), terrain).values
    folder.mkdir(exist_ok=True)
    elevation = np.where(np.isfinite(ground), ground, terrain.values)
    write_dem(folder / "dem.tif", elevation, (terrain.grid.box[0], terrain.grid.box[2]))
    shutil.copy(place.runs / ALR.name / "release.json", folder / "release.json")
    return [task(place, folder, ALR.friction_angle, AVAFRAME)]


def thawslide_jobs(place: Place) -> list[Job]:
    """Return the runs of Thawslide."""
    jobs = [
        Job(f"{ground.name}/{each.name}", "", each.changes, str(place.runs / ground.name / f"{ground.name}.toml"))
        for ground in GROUNDS.values()
        for each in (THAWSLIDE, *ground.thawslide)
    ]
    jobs = [replace(job, sets=(*job.sets, *QUICK)) for job in jobs] if place.is_quick else jobs
    grounds = str(place.runs / ALR.name / f"{ALR.name}.toml")
    return [*jobs, Job(f"{ALR.name}/ground", "", ("maps.cell=5", "time.end=0.1"), grounds)]


def python_of(place: Place) -> Path:
    """Return the Python of AvaFrame."""
    return (place.avaframe or ROOT / "build" / "avaframe") / "bin" / "python"


def needs(place: Place) -> list[Path]:
    """Return what runs need: AvaFrame, and the data of AlR."""
    if place.draws_only:
        return []
    return [python_of(place), place.data / "alr" / "alr.tif", place.data / "alr" / "release.shp"]


def section(ground: Ground, place: Place) -> str:
    """Plot the figures of a terrain; return its section of the page."""
    folder = place.runs / ground.name
    terrain = read_map(folder / "dem.tif")
    corners = json.loads((folder / "release.json").read_text())["corners"]
    avaframe, *variants = (
        read_avaframe(folder, terrain, each.name, each.words) for each in (AVAFRAME, *ground.avaframe)
    )
    own = [read_thawslide(folder, terrain, each.name, each.words) for each in (THAWSLIDE, *ground.thawslide)]
    if ground is ALR:
        cells = read_map(place.runs / CELLS / "dem.tif")
        variants.append(read_avaframe(place.runs / CELLS, cells, words="same ground"))
    outcomes = [avaframe, *own, *variants]
    for field, words in FIELDS:
        drawn = comparison_figure(ground, terrain, corners, outcomes, field, words)
        drawn.savefig(place.page(f"docs/comparison/{ground.name}-{field}.png"), dpi=150)
    coefficient = math.tan(math.radians(ground.friction_angle))
    found = [numbers(outcome, terrain, corners) for outcome in outcomes]
    point = point_mass(terrain, corners, coefficient) if ground.is_straight else None
    friction = f"Friction along the ground: {ground.friction_angle:g} degrees, a coefficient of {coefficient:.3f}."
    parts = [
        f"## {ground.title}",
        textwrap.fill(f"{ground.text} {friction}", 118),
        *(f"![{words}](comparison/{ground.name}-{field}.png)" for field, words in FIELDS),
    ]
    return "\n\n".join([*parts, table(outcomes, found, point), text_of(f"{ground.name}.md", {}).strip()])


def write(place: Place) -> None:
    """Write the page and its figures from existing runs."""
    sections = "\n\n".join(section(ground, place) for ground in GROUNDS.values())
    place.page("docs/comparison.md").write_text(text_of("avaframe.md", {"sections": sections}), encoding="utf-8")


STUDY = Study(
    "avaframe",
    ("docs/comparison.md",),
    15.0,
    write,
    (avaframe_tasks, thawslide_jobs, tasks_on_cells),
    needs,
    "Install AvaFrame: python3 -m venv build/avaframe && build/avaframe/bin/pip install avaframe==2.1. Or give its "
    "virtual environment with --avaframe. cases/alr/README.md states the source of the data.",
)
