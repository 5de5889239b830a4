"""The page of refinement: tables of the plane and of AlR, apparent friction next to the wedge factor of the ground."""

import math
from pathlib import Path

import numpy as np
from grounds import ALR, Variant
from jobs import Job
from matplotlib.figure import Figure
from refinement import (
    CAUSES,
    FILTERED,
    HERE,
    PLANE_THICKNESS,
    ROUGH,
    STUDIED,
    WIDE,
    Deposit,
    Found,
    limit,
    order,
    read_deposit,
    read_found,
    spread,
)
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREEN, ORANGE, RED, styled
from thawslide.maps import Map, read_map
from thawslide.run_folder import Run
from wedge import Interval, intervals

LENGTH = 10.0  # s, of the intervals of apparent friction
SLOWEST = 2.0  # m/s: minimum mean speed of an interval that is compared
COLOURS = (BLUE, ORANGE, GREEN, RED)
HALVING = (20.0, 10.0, 5.0)  # m: the cells of the plane for orders and limits

ROWS = {
    "travel distance (m)": lambda found: f"{found.travel:,.0f}",
    "reach angle (degrees)": lambda found: f"{found.reach_angle:.2f}",
    "displacement of the centre of mass (m)": lambda found: f"{found.centre:,.0f}",
    "maximum mean velocity (m/s)": lambda found: f"{found.speed:.1f}",
    "mean velocity at the end (m/s)": lambda found: f"{found.end_speed:.2f}",
    "simulated (s)": lambda found: f"{found.simulated:.0f}",
    "mass that left the DEM": lambda found: f"{100.0 * found.left:.1f} %",
    "particles": lambda found: f"{found.particles:,}",
    "processor time (s)": lambda found: "" if math.isnan(found.processor) else f"{found.processor:,.0f}",
}


def markdown(lines: list[list[str]]) -> str:
    """Return a table, its first line the header."""
    head, *rest = lines
    return "\n".join("| " + " | ".join(line) + " |" for line in [head, ["---"] * len(head), *rest])


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
    return {
        "observed order": [each for each, _ in pairs] + empty,
        "extrapolated": [each for _, each in pairs] + empty,
    }


def deposit_table(found: list[Deposit]) -> str:
    """Return the numbers of maps on several cells, with the limit of areas and widths from the two finest ones."""
    names = {
        "deposit area (m2)": ("covered", 0, True),
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
    lines.append(["increase of volume by dilation", *(f"{100.0 * each.dilation:.0f} %" for each in found), ""])
    lines.append(["cell of the maps (m)", *(f"{each.map_cell:g}" for each in found), ""])
    return markdown(lines)


def spread_words(found: list[Found]) -> str:
    """Return a sentence on the spread of runs that differ by their cell."""
    parts = [
        f"{words} {100.0 * spread([getattr(each, name) for each in found]):.1f} %"
        for words, name in (
            ("travel distance", "travel"),
            ("reach angle", "reach_angle"),
            ("displacement of the centre", "centre"),
        )
    ]
    return f"Range over mean of the {len(found)} cells: {', '.join(parts)}."


def friction_rows(job: Job, terrain: Map) -> list[Interval]:
    """Return the intervals of a run in which it moves fast enough to evaluate friction."""
    run = Run(job.output)
    speed, time = run.history["mean_velocity_m_s"], run.history["time_s"]
    found = intervals(run, terrain, math.tan(math.radians(ALR.friction_angle)), LENGTH)
    return [
        each
        for each in found
        if float(speed[(time >= each.start) & (time <= each.end)].min()) > SLOWEST or each.start == 0.0
    ]


def friction_table(rows: list[Interval]) -> str:
    """Return apparent friction over the coefficient, and the wedge factor, over time."""
    lines = [["time (s)", "wedge factor w", "on the ground", "ground and inside", "ground over w", "both over w"]]
    for each in rows:
        both = each.ground + each.inside
        values = (each.wedge, each.ground, both, each.ground / each.wedge, both / each.wedge)
        lines.append([f"{each.start:.0f} to {each.end:.0f}", *(f"{value:.3f}" for value in values)])
    return markdown(lines)


@styled
def friction_figure(runs: dict[Variant, dict[float, list[Interval]]]) -> Figure:
    """Return apparent friction over time, a panel for each filter of the DEM."""
    figure = Figure(figsize=(COLUMN_WIDTH, 3.8), layout="constrained")
    panels = figure.subplots(1, len(runs), sharey=True, sharex=True)
    for panel, (variant, cells), letter in zip(panels, runs.items(), "abc", strict=True):
        for colour, (cell, rows) in zip(COLOURS, cells.items(), strict=False):
            middle = [0.5 * (each.start + each.end) for each in rows]
            both = [each.ground + each.inside for each in rows]
            panel.plot(middle, both, "o-", color=colour, ms=4, label=f"ground and inside, {cell:g} m")
            panel.plot(middle, [each.ground for each in rows], ":", color=colour, label=f"ground, {cell:g} m")
        finest = cells[min(cells)]
        middle = np.array([0.5 * (each.start + each.end) for each in finest])
        wedge = np.array([each.wedge for each in finest])
        panel.plot(middle, wedge, color=BLACK, linestyle="dashed", label="wedge factor, finest cells")
        panel.fill_between(middle, 0.9 * wedge, 1.1 * wedge, color=BLACK, alpha=0.12, linewidth=0, label="within 10 %")
        panel.set_title(f"({letter}) {variant.words}", loc="left")
        panel.set_xlabel("time (s), 0 at the start of the run")
        panel.grid(True)
    panels[0].set_ylabel("apparent friction / friction coefficient")
    handles, labels = max((panel.get_legend_handles_labels() for panel in panels), key=lambda each: len(each[0]))
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def write(jobs: list[Job], runs: Path, folder: Path) -> None:
    """Write refinement.md and its figure into a folder, from existing runs."""
    done = {job.output.name: job for job in jobs if job.is_done}

    def found(start: str) -> list[Found]:
        named = [read_found(job) for name, job in done.items() if name.rpartition("-")[0] == start]
        return sorted(named, key=lambda one: -one.cell)

    def friction(start: str) -> dict[float, list[Interval]]:
        runs = {each.cell: done[f"{start}-{each.cell:g}"] for each in found(start)}
        return {cell: friction_rows(job, read_map(job.output / "maps" / "terrain.tif")) for cell, job in runs.items()}

    deposits = [read_deposit(job) for name, job in done.items() if name.rpartition("-")[0] == "plane"]
    deposits.sort(key=lambda one: -one.cell)
    plane, alr, wide, rough = (found(start) for start in ("plane", FILTERED.name, WIDE.name, ROUGH.name))
    has_halving = {each.cell for each in plane} >= set(HALVING)
    causes = {each: done.get(f"{each.name}-{STUDIED:g}") for each in (FILTERED, ROUGH, *CAUSES)}
    causes = {each: job for each, job in causes.items() if job}
    studied = {each.words: friction(each.name)[STUDIED] for each in causes}
    (folder / "comparison").mkdir(exist_ok=True)
    friction_figure({each: friction(each.name) for each in (WIDE, FILTERED, ROUGH)}).savefig(
        folder / "comparison" / "alr-friction.png", dpi=150
    )
    parts = [
        (HERE / "refinement.md").read_text().strip(),
        cells_table(plane, convergence(plane) if has_halving else None),
        (HERE / "refinement-plane.md").read_text().strip(),
        (HERE / "refinement-deposit.md").read_text().strip(),
        deposit_table(deposits) if len(deposits) > 1 else "",
        (HERE / "refinement-deposit-cells.md").read_text().strip(),
        (HERE / "refinement-slope.md").read_text().strip(),
        "The DEM filtered by 10 m on every cell (`terrain.smooth = 10`):",
        cells_table(wide),
        spread_words(wide),
        'The DEM filtered by default (`terrain.smooth = "auto"`), which is 5.5 m on all of these cells:',
        cells_table(alr),
        spread_words(alr),
        "The unfiltered DEM (`terrain.smooth = 0`):",
        cells_table(rough),
        (HERE / "refinement-alr.md").read_text().strip(),
        f"Single causes, on cells of {STUDIED:g} m:",
        table(["", *(each.words for each in causes)], [read_found(job) for job in causes.values()]),
        (HERE / "refinement-causes.md").read_text().strip(),
        (HERE / "refinement-wedge.md").read_text().strip(),
        "![apparent friction and wedge factor over time](comparison/alr-friction.png)",
        *(f"On cells of {STUDIED:g} m, {words}:\n\n{friction_table(rows)}" for words, rows in studied.items()),
        (HERE / "refinement-friction.md").read_text().strip(),
    ]
    (folder / "refinement.md").write_text("\n\n".join(part for part in parts if part) + "\n")
