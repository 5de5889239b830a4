"""The page of the Frank slide: tables, two figures, and the text of frank.md with its numbers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reproduction.engine import is_done
from reproduction.studies import frank
from reproduction.study import Place, Study
from reproduction.tables import markdown, text_of
from thawslide.figures.map_panel import coordinate_text, outline, scale_bar
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, RED, styled
from thawslide.maps import Map

SHALTOP, THAWSLIDE = "SHALTOP", "Thawslide"
COLOURS = {SHALTOP: BLUE, THAWSLIDE: RED}
MARKS = {SHALTOP: "o", THAWSLIDE: "^"}

ROWS: dict[str, Callable[[frank.Figures], str]] = {
    "centroid, x (m)": lambda found: f"{found.x:,.0f}",
    "area of the deposit (km2)": lambda found: f"{found.area:.2f}",
    "area passed (km2)": lambda found: f"{found.passed:.2f}",
    "farthest x (m)": lambda found: f"{found.farthest:,.0f}",
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.1f}",
    "maximum speed (m/s)": lambda found: f"{found.speed:.0f}",
    "maximum speed, 95 % of the area passed below it (m/s)": lambda found: f"{found.high_speed:.0f}",
    "maximum speed, median of the area passed (m/s)": lambda found: f"{found.usual_speed:.1f}",
    "maximum thickness of the deposit (m)": lambda found: f"{found.thickness:.0f}",
    "volume at the end (million m3)": lambda found: f"{found.volume:.1f}",
}


def main_table(found: dict[tuple[str, int], frank.Figures]) -> str:
    """Return the numbers of both codes for each angle."""
    head = [""]
    for angle in frank.ANGLES:
        head += [f"{SHALTOP} {angle}", f"{THAWSLIDE} {angle}"]
    rows = [
        [words, *(text(found[code, angle]) for angle in frank.ANGLES for code in (SHALTOP, THAWSLIDE))]
        for words, text in ROWS.items()
    ]
    return markdown([head, *rows])


def difference_table(
    found: dict[tuple[int, str], frank.Figures], differences: dict[tuple[int, str], frank.Difference]
) -> str:
    """Return runs of Thawslide by friction angle, and the differences of their deposits from SHALTOP's."""
    lines = [
        "angle (degrees) | run | centroid, x (m) | area (km2) | farthest x (m) | median speed (m/s) | overlap "
        "| moved volume"
    ]
    for (angle, name), one in found.items():
        apart = differences[angle, name]
        lines.append(
            f"{angle} | {name} | {one.x:,.0f} | {one.area:.2f} | {one.farthest:,.0f} | {one.usual_speed:.1f} | "
            f"{apart.overlap:.2f} | {100.0 * apart.moved:.0f} %"
        )
    return markdown(lines)


@styled
def deposits(
    found: dict[tuple[str, int], frank.Deposit],
    numbers: dict[tuple[str, int], frank.Figures],
    fluid: dict[int, frank.Deposit],
    pile: Map,
) -> Figure:
    """Return the outlines of the deposits, one panel per angle."""
    figure = Figure(figsize=(COLUMN_WIDTH, 7.0), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True, sharey=True).ravel()
    for panel, angle, letter in zip(panels, frank.ANGLES, "abcd", strict=True):
        outline(panel, pile, 0.5, colors=BLACK, linewidths=0.9, linestyles="dotted")
        outline(panel, fluid[angle].final, frank.EDGE, colors=RED, linewidths=1.0, linestyles="dashed")
        for code, colour in COLOURS.items():
            outline(panel, found[code, angle].final, frank.EDGE, colors=colour, linewidths=1.6)
            centre = numbers[code, angle]
            panel.plot(centre.x, centre.y, MARKS[code], color=colour, markeredgecolor="white", ms=8)
        panel.set_title(f"({letter}) friction angle {angle}°", loc="left")
        panel.set_aspect("equal")
        panel.set_xlim(200.0, 4040.0)
        panel.set_ylim(900.0, 4040.0)
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_formatter(lambda value, _: coordinate_text(value))
        panel.grid(True)
    for panel in panels[2:]:
        panel.set_xlabel("easting, local (km)")
    for panel in panels[::2]:
        panel.set_ylabel("northing, local (km)")
    scale_bar(panels[0], "lower right")
    handles = []
    for code, colour in COLOURS.items():
        handles.append(Line2D([], [], color=colour, label=f"{code}, deposit"))
        handles.append(
            Line2D([], [], color=colour, marker=MARKS[code], ls="", mec="white", ms=8, label=f"{code}, centroid")
        )
    words = f"{THAWSLIDE}, {frank.FLUID.words}, deposit"
    handles.append(Line2D([], [], color=RED, linestyle="dashed", linewidth=1.0, label=words))
    handles.append(Line2D([], [], color=BLACK, linestyle="dotted", linewidth=0.9, label="release"))
    figure.legend(handles=handles, loc="outside lower center", ncols=3)
    return figure


@styled
def sections(found: dict[tuple[str, int], frank.Deposit], fluid: dict[int, frank.Deposit], pile: Map) -> Figure:
    """Return the section area of the deposits along x, one panel per angle."""
    figure = Figure(figsize=(COLUMN_WIDTH, 5.2), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True).ravel()
    for panel, angle, letter in zip(panels, frank.ANGLES, "abcd", strict=True):
        x = pile.grid.x / 1e3
        panel.plot(x, frank.volume_along(pile) / 1e3, color=BLACK, linestyle="dotted", linewidth=1.0, label="release")
        for code, colour in COLOURS.items():
            panel.plot(x, frank.volume_along(found[code, angle].final) / 1e3, color=colour, label=code)
        panel.plot(
            x, frank.volume_along(fluid[angle].final) / 1e3, color=RED, linestyle="dashed", linewidth=1.1,
            label=f"{THAWSLIDE}, {frank.FLUID.words}",
        )  # fmt: skip
        panel.set_title(f"({letter}) friction angle {angle}°", loc="left")
        panel.set_xlim(0.2, 4.0)
        panel.set_ylim(0.0, None)
        panel.grid(True)
    for panel in panels[2:]:
        panel.set_xlabel("easting, local (km)")
    for panel in panels[::2]:
        panel.set_ylabel("section area (1,000 m²)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def write(place: Place) -> None:
    """Write the page and its figures from existing runs."""
    data = place.data / "frank"
    terrain, pile = (frank.read_grid(data / f"Frankslide_{kind}.asc") for kind in ("topography", "pile"))
    names = [f"{each.name}-{angle}" for each in (frank.BASE, frank.FLUID, *frank.CAUSES) for angle in frank.ANGLES]
    folders = {name: place.runs / name for name in names if is_done(place.runs / name)}
    own = {name: frank.read_run(folder, terrain.grid) for name, folder in folders.items()}
    found = {
        (code, angle): frank.read_shaltop(data, angle, terrain) if code == SHALTOP else own[f"base-{angle}"]
        for angle in frank.ANGLES
        for code in COLOURS
    }
    numbers = {key: frank.figures(deposit, terrain, pile) for key, deposit in found.items()}
    fluid = {angle: own[f"fluid-{angle}"] for angle in frank.ANGLES}
    for name, figure in (
        ("deposits", deposits(found, numbers, fluid, pile)),
        ("sections", sections(found, fluid, pile)),
    ):
        figure.savefig(place.page(f"docs/comparison/frank-{name}.png"), dpi=150)
    rows, apart = {}, {}
    for angle in frank.ANGLES:
        for variant in (frank.BASE, frank.FLUID, *frank.CAUSES):
            deposit = own.get(f"{variant.name}-{angle}")
            if deposit is not None:
                rows[angle, variant.words] = frank.figures(deposit, terrain, pile)
                apart[angle, variant.words] = frank.difference(deposit, found[SHALTOP, angle])
    parts = {
        "numbers": main_table(numbers),
        "causes": difference_table(rows, apart),
    }
    place.page("docs/frank.md").write_text(text_of("frank.md", parts), encoding="utf-8")


def needs(place: Place) -> list[Path]:
    """Return the terrain, the pile and the results of SHALTOP."""
    data = place.data / "frank"
    return [data / name for name in ("Frankslide_topography.asc", "Frankslide_pile.asc", "shaltop")]


STUDY = Study(
    "frank",
    ("docs/frank.md",),
    20.0,
    write,
    (frank.jobs,),
    needs,
    "The files come from the project tilupy (github.com/marcperuz/tilupy).",
)
