"""The page of refinement: tables of the plane and of AlR, apparent friction next to the wedge factor of the ground."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from reproduction.engine import is_done
from reproduction.studies.grounds import ALR, Variant
from reproduction.studies.refinement import (
    ALR_CELLS,
    CAUSES,
    FILTERED,
    PLANE_CELLS,
    PLANE_THICKNESS,
    ROUGH,
    STUDIED,
    WIDE,
    Deposit,
    Found,
    jobs,
    limit,
    order,
    read_deposit,
    read_found,
    spread,
)
from reproduction.studies.wedge import Interval, intervals
from reproduction.study import Place, Study
from reproduction.tables import markdown, text_of
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREEN, ORANGE, RED, styled
from thawslide.maps import Map, read_map
from thawslide.run_folder import Run

LENGTH = 10.0  # s, of the intervals of apparent friction
SLOWEST = 2.0  # m/s: minimum mean speed of an interval that is compared
COLOURS = (BLUE, ORANGE, GREEN, RED)
HALVING = (20.0, 10.0, 5.0)  # m: the cells of the plane for orders and limits

ROWS: dict[str, Callable[[Found], str]] = {
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.2f}",
    "displacement of the centre of mass (m)": lambda found: f"{found.centre:,.0f}",
    "maximum mean velocity (m/s)": lambda found: f"{found.speed:.1f}",
    "mass that left the DEM": lambda found: f"{100.0 * found.left:.1f} %",
    "deposit area (m2)": lambda found: f"{found.deposit:,.0f}",
    "inundated area (m2)": lambda found: f"{found.inundated:,.0f}",
}


def table(heads: list[str], found: list[Found], more: dict[str, list[str]] | None = None) -> str:
    """Return the numbers of runs, a column each; `more` has further columns by their header."""
    more = more or {}
    lines = [[*heads, *more]]
    for place, (words, text) in enumerate(ROWS.items()):
        lines.append([words, *(text(each) for each in found), *(column[place] for column in more.values())])
    return markdown(lines)


def cells_table(found: list[Found], more: dict[str, list[str]] | None = None) -> str:
    """Return the numbers of runs that differ by their cell."""
    return table(["cell (m)", *(f"{each.cell:.3g}" for each in found)], found, more)


def order_and_limit(values: list[float], digits: int) -> tuple[str, str]:
    """Return the observed order of a value on three cells that halve, and its limit, as texts."""
    coarse, middle, fine = values
    observed = order(coarse, middle, fine)
    return (
        "not monotonic" if math.isnan(observed) else f"{observed:.1f}",
        "" if not observed > 0.0 else f"{limit(middle, fine, observed):,.{digits}f}",
    )


def halving(found: list[Found], name: str) -> list[float]:
    """Return a value on the three cells that halve."""
    return [getattr(each, name) for each in found if each.cell in HALVING]


def convergence(found: list[Found]) -> dict[str, list[str]]:
    """Return the columns of the observed order and of the limit."""
    names = (("travel", 0), ("reach_angle", 2), ("centre", 0), ("speed", 1))
    pairs = [order_and_limit(halving(found, name), digits) for name, digits in names]
    empty = [""] * (len(ROWS) - len(pairs))
    return {"observed order": [each for each, _ in pairs] + empty, "extrapolated": [each for _, each in pairs] + empty}


def deposit_table(found: list[Deposit]) -> str:
    """Return the numbers of maps on several cells, with the limit of areas and widths from the two finest ones."""
    names = {
        "deposit area (m2)": ("covered", 0, True),
        "inundated area (m2)": ("inundated", 0, True),
        "affected area (m2)": ("affected", 0, True),
        "standard deviation of the deposit across the slope (m)": ("width", 0, True),
        "maximum thickness of the deposit (m)": ("thickness", 1, False),
    }
    lines = [
        ["cell (m)", *(f"{each.cell:.3g}" for each in found), "extrapolated, first order"],
        ["cells across the release", *(f"{PLANE_THICKNESS / each.cell:.3g}" for each in found), ""],
    ]
    *_, coarse, fine = found
    for words, (name, digits, has_limit) in names.items():
        values = [f"{getattr(each, name):,.{digits}f}" for each in found]
        at_zero = limit(getattr(coarse, name), getattr(fine, name), 1.0, coarse.cell / fine.cell)
        lines.append([words, *values, f"{at_zero:,.{digits}f}" if has_limit else ""])
    return markdown(lines)


def spread_words(found: list[Found]) -> str:
    """Return a sentence on the spread of the runs on the three finest cells."""
    found = found[-3:]
    parts = [
        f"{words} {100.0 * spread([getattr(each, name) for each in found]):.1f} %"
        for words, name in (
            ("travel distance", "travel"),
            ("reach angle", "reach_angle"),
            ("displacement of the centre", "centre"),
            ("deposit area", "deposit"),
            ("inundated area", "inundated"),
        )
    ]
    words = f"Range over mean of the {len(found)} finest cells: {', '.join(parts)}."
    return textwrap.fill(words, 118)


def listed(texts: list[str]) -> str:
    """Return texts as a list in a sentence."""
    return " and ".join([", ".join(texts[:-1]), texts[-1]] if len(texts) > 1 else texts)


def rough_words(found: list[Found]) -> str:
    """Return a sentence on the travel distance on the unfiltered DEM."""
    cells, travels = (listed([f"{each.cell:.3g}" for each in found]), listed([f"{each.travel:,.0f}" for each in found]))
    words = f"On the unfiltered DEM (`terrain.smooth = 0`), the travel distance is {travels} m on cells of {cells} m."
    return textwrap.fill(words, 120)


def friction_rows(folder: Path, terrain: Map) -> list[Interval]:
    """Return the intervals of a run in which it moves fast enough to evaluate friction."""
    run = Run(folder)
    speed, time = run.series["mean_velocity_m_s"], run.series["time_s"]
    found = intervals(run, terrain, math.tan(math.radians(ALR.friction_angle)), LENGTH)
    return [
        each
        for each in found
        if float(speed[(time >= each.start) & (time <= each.end)].min()) > SLOWEST or each.start == 0.0
    ]


@styled
def friction_figure(runs: dict[Variant, dict[float, list[Interval]]]) -> Figure:
    """Return apparent friction over time, a panel for each filter of the DEM."""
    figure = Figure(figsize=(COLUMN_WIDTH, 3.8), layout="constrained")
    panels = figure.subplots(1, len(runs), sharey=True, sharex=True)
    for panel, (variant, cells), letter in zip(panels, runs.items(), "abc", strict=True):
        for colour, (cell, rows) in zip(COLOURS, cells.items(), strict=False):
            middle = np.array([0.5 * (each.start + each.end) for each in rows])
            both = [each.ground + each.inside for each in rows]
            panel.plot(middle, both, "o-", color=colour, ms=4, label=f"ground and inside, {cell:g} m")
            panel.plot(middle, [each.ground for each in rows], ":", color=colour, label=f"ground, {cell:g} m")
        finest = cells[min(cells)]
        middle = np.array([0.5 * (each.start + each.end) for each in finest])
        wedge = np.array([each.wedge for each in finest])
        panel.plot(middle, wedge, color=BLACK, linestyle="dashed", label="wedge factor, finest cells")
        panel.fill_between(middle, 0.9 * wedge, 1.1 * wedge, color=BLACK, alpha=0.12, linewidth=0, label="within 10 %")
        panel.set_title(f"({letter}) {variant.words}", loc="left")
        panel.set_xlabel("time since the start (s)")
        panel.grid(True)
    panels[0].set_ylabel("apparent friction / friction coefficient")
    handles, labels = max((panel.get_legend_handles_labels() for panel in panels), key=lambda each: len(each[0]))
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def write(place: Place) -> None:
    """Write the page and its figure from existing runs."""

    def folders(start: str) -> dict[float, Path]:
        """Return the complete runs of a variant by their cell, the coarsest first."""
        found = {cell: place.runs / f"{start}-{cell:g}" for cell in (*PLANE_CELLS, *ALR_CELLS)}
        return {cell: folder for cell, folder in sorted(found.items(), reverse=True) if is_done(folder)}

    def found(start: str) -> list[Found]:
        return [read_found(folder) for folder in folders(start).values()]

    @cache
    def friction(folder: Path) -> list[Interval]:
        return friction_rows(folder, read_map(folder / "maps" / "terrain.tif"))

    deposits = [read_deposit(folder) for folder in folders("plane").values()]
    plane, alr, wide, rough = (found(start) for start in ("plane", FILTERED.name, WIDE.name, ROUGH.name))
    has_halving = {each.cell for each in plane} >= set(HALVING)
    causes = {each: place.runs / f"{each.name}-{STUDIED:g}" for each in (FILTERED, ROUGH, *CAUSES)}
    causes = {each: folder for each, folder in causes.items() if is_done(folder)}
    rows = {
        each: {cell: friction(folder) for cell, folder in folders(each.name).items()}
        for each in (WIDE, FILTERED, ROUGH)
    }
    friction_figure(rows).savefig(place.page("docs/comparison/alr-friction.png"), dpi=150)
    parts = {
        "plane": cells_table(plane, convergence(plane) if has_halving else None),
        "deposits": deposit_table(deposits) if len(deposits) > 1 else "",
        "wide": f"{cells_table(wide)}\n\n{spread_words(wide)}",
        "filtered": f"{cells_table(alr)}\n\n{spread_words(alr)}",
        "rough": rough_words(rough),
        "causes": table(["", *(each.words for each in causes)], [read_found(each) for each in causes.values()]),
    }
    place.page("docs/refinement.md").write_text(text_of("refinement.md", parts), encoding="utf-8")


STUDY = Study(
    "refinement",
    ("docs/refinement.md",),
    150.0,
    write,
    (jobs,),
    lambda place: [] if place.draws_only else [place.data / "alr" / "alr.tif", place.data / "alr" / "release.shp"],
    "cases/alr/README.md states the source of the data.",
)
