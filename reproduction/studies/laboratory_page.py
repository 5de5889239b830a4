"""Tables and figures of docs/laboratory.md and of its variants: collapses of bars and of sand."""

from __future__ import annotations

from collections.abc import Sequence
from string import Template

import numpy as np
from matplotlib.figure import Figure

from reproduction.studies.laboratory import (
    ACROSS,
    ACROSS_FINEST,
    ACROSS_STUDIED,
    BAR_CAUSES,
    BAR_CELLS,
    BAR_STUDIED,
    COLUMN_CAUSES,
    MEASURED,
    OTHER_ASPECTS,
    TRANSFERS,
    Bars,
    Column,
    bar_name,
    column_name,
    inclination,
    jobs,
    lube_cylinder,
    lube_plane,
    read_bars,
    read_column,
    read_points,
)
from reproduction.study import Place, Study
from reproduction.tables import markdown, rewrapped, text_of
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREEN, ORANGE, RED, styled

PAGES = ("docs/laboratory.md", "benchmarks/decisions/laboratory-variants.md")
NAMES = {"flip": "FLIP", "apic": "APIC", "fmpm": "FLIP filtered every 0.1 s (FMPM)"}


def rms(values: np.ndarray) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def largest(values: np.ndarray) -> float:
    """Return the value with the maximum magnitude."""
    return float(values[np.abs(values).argmax()])


def bar_table(found: dict[tuple[str, float], Bars]) -> str:
    """Return the table of runs on several cells, one column for each run."""
    each = list(found.values())
    coarser = [found.get((transfer, 2.0 * cell)) for transfer, cell in found]
    changes = [
        f"{1e3 * rms(one.surface - before.surface):.1f}" if before else ""
        for one, before in zip(each, coarser, strict=True)
    ]
    rows = {
        "": [f"{NAMES[transfer]}, {cell:g} mm" for transfer, cell in found],
        "deviation of the surface, rms (mm)": [f"{rms(one.surface_error):.1f}" for one in each],
        "deviation of the surface, maximum (mm)": [f"{largest(one.surface_error):+.1f}" for one in each],
        "deviation of the toe (mm)": [f"{1e3 * one.toe - 442.0:+.0f}" for one in each],
        "change of the surface from the next coarser cell, rms (mm)": changes,
    }
    rows |= {
        "deviation of the failure line, rms (mm)": [f"{rms(one.failure_error):.1f}" for one in each],
        "inclination of the failure line (degrees)": [f"{one.slope():.1f}" for one in each],
        "increase of volume": [f"{100.0 * one.dilation:.1f} %" for one in each],
    }
    return markdown([[words, *cells] for words, cells in rows.items()])


def bar_cause_table(runs: dict[str, Bars]) -> str:
    """Return the table of runs that change one parameter, one row for each run."""
    lines = ["variant | surface, rms (mm) | toe (mm) | failure line, rms (mm)"]
    for words, one in runs.items():
        lines.append(
            f"{words} | {rms(one.surface_error):.1f} | {1e3 * one.toe - 442.0:+.0f} | {rms(one.failure_error):.1f}"
        )
    return markdown(lines)


def column_table(found: dict[tuple[str, str, int], Column]) -> str:
    """Return the table of runouts of columns of aspect ratio 1."""
    rows = [["cells across the radius or width", *(str(across) for across in ACROSS), "experiments"]]
    for shape, words, law in (
        ("cylinder", "cylinder", lube_cylinder(1.0)),
        ("plane", "column in the plane", lube_plane(1.0)),
    ):
        for transfer in TRANSFERS:
            runs = [found[shape, transfer, across] for across in ACROSS]
            name = f"{words}, {NAMES[transfer]}"
            rows.append([f"{name}: 99.5 % of the mass", *(f"{one.runout:.2f}" for one in runs), f"{law:.2f}"])
            rows.append([f"{name}: edge", *(f"{one.edge:.2f}" for one in runs), f"{law:.2f}"])
    return markdown(rows)


def aspect_table(found: dict[tuple[float, str, int], Column]) -> str:
    """Return the table of runouts of cylinders of other aspect ratios."""
    rows = [["aspect ratio, cells across the radius", *(str(across) for across in ACROSS[:-1]), "experiments"]]
    for aspect in OTHER_ASPECTS:
        for transfer in TRANSFERS:
            runs = [found[aspect, transfer, across] for across in ACROSS[:-1]]
            name = f"{aspect:g}, {NAMES[transfer]}"
            law = f"{lube_cylinder(aspect):.2f}"
            rows.append([f"{name}: edge", *(f"{one.edge:.2f}" for one in runs), law])
    return markdown(rows)


def column_cause_table(runs: dict[str, Column]) -> str:
    """Return the table of runouts of cylinders that change one parameter."""
    base = next(iter(runs.values()))
    rows = [["variant", "runout, 99.5 % of the mass", "change"]]
    for words, one in runs.items():
        change = f"{100.0 * (one.runout / base.runout - 1.0):+.0f} %" if one is not base else ""
        rows.append([words, f"{one.runout:.2f}", change])
    return markdown(rows)


@styled
def bar_figure(found: dict[tuple[str, float], Bars]) -> Figure:
    """Plot computed and measured surface and failure line, one panel for each transfer."""
    figure = Figure(figsize=(COLUMN_WIDTH, 4.4), layout="constrained")
    panels = figure.subplots(2, 1, sharex=True, sharey=True)
    surface, failure = (read_points(MEASURED / "surface.csv"), read_points(MEASURED / "failure.csv"))
    source = "measured (MaterialPointSolver.jl; Bui et al. 2008)"
    for panel, transfer, letter in zip(panels, TRANSFERS, "ab", strict=True):
        panel.plot([0.0, 0.2, 0.2], [0.1, 0.1, 0.0], color=BLACK, lw=0.8, ls=":", label="before the collapse")
        for colour, cell in zip((ORANGE, GREEN, BLUE), BAR_CELLS[1:], strict=True):
            one = found[transfer, cell]
            x, height = one.profile
            panel.plot(x, height, color=colour, lw=1.3, label=f"surface, cells of {cell:g} mm")
            x, height = one.failure_profile
            panel.plot(x, height, color=colour, lw=1.3, ls="--", label=f"failure line, cells of {cell:g} mm")
        panel.plot(*surface, "o", color=BLACK, mfc="white", ms=4, label=f"surface, {source}")
        panel.plot(*failure, "s", color=RED, mfc="white", ms=4, label=f"failure line, {source}")
        panel.set_title(f"({letter}) {NAMES[transfer]}", loc="left")
        panel.set_ylabel("height (m)")
        panel.set_xlim(0.0, 0.5)
        panel.set_ylim(0.0, 0.115)
        panel.set_yticks([0.0, 0.05, 0.1])
        panel.set_aspect("equal")
        panel.grid(True)
    panels[1].set_xlabel("distance from the wall (m)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


@styled
def column_figure(found: dict[tuple[str, str, int], Column]) -> Figure:
    """Plot profiles of the cylinder, and runouts as functions of the cell."""
    figure = Figure(figsize=(COLUMN_WIDTH, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for colour, across in zip((ORANGE, GREEN, BLUE, BLACK), ACROSS, strict=True):
        x, height = found["cylinder", "apic", across].profile
        left.plot(x / 10.0, height / 10.0, color=colour, lw=1.3, label=f"{across} cells across the radius")
    left.axvline(1.0 + lube_cylinder(1.0), color=RED, ls="--", lw=1.2, label="edge, Lube et al. (2004)")
    left.set_xlim(0.0, 2.6)
    left.set_ylim(0.0, 1.0)
    left.set_xlabel("distance from the axis / initial radius")
    left.set_ylabel("thickness / initial radius")
    left.set_title("(a) deposit of the cylinder, APIC", loc="left")
    left.legend()
    for colour, transfer in zip((BLUE, ORANGE), TRANSFERS, strict=True):
        runs = [found["cylinder", transfer, across] for across in ACROSS]
        size = [1.0 / across for across in ACROSS]
        mass = [one.runout for one in runs]
        right.plot(size, mass, "o-", color=colour, ms=4, label=f"{NAMES[transfer]}, 99.5 % of the mass")
        right.plot(size, [one.edge for one in runs], "s:", color=colour, ms=4, label=f"{NAMES[transfer]}, edge")
    right.axhline(lube_cylinder(1.0), color=RED, ls="--", lw=1.2, label="Lube et al. (2004)")
    right.set_xlim(0.0, 0.13)
    right.set_ylim(0.6, 1.45)
    right.set_xlabel("cell / initial radius")
    right.set_ylabel("runout / initial radius")
    right.set_title("(b) convergence", loc="left")
    right.legend(loc="lower left")
    for panel in (left, right):
        panel.grid(True)
    return figure


def numbers(bars: dict[tuple[str, float], Bars], columns: dict[tuple[str, str, int], Column]) -> dict[str, str]:
    """Return numbers for the text by name, such as bars_flip_5_rms or cylinder_apic_64_edge."""
    named = {}
    for (transfer, cell), bar in bars.items():
        start = f"bars_{transfer}_{cell:g}".replace(".", "_")
        named[f"{start}_rms"] = f"{rms(bar.surface_error):.1f}"
        named[f"{start}_toe"] = f"{1e3 * bar.toe - 442.0:+.0f}"
        named[f"{start}_slope"] = f"{bar.slope():.1f}"
    for (shape, transfer, across), one in columns.items():
        start = f"{shape}_{transfer}_{across}"
        named[f"{start}_bulk"] = f"{one.bulk:.2f}"
        named[f"{start}_mass"] = f"{one.runout:.2f}"
        named[f"{start}_lost"] = f"{-100.0 * one.gained:.1f}"
        named[f"{start}_edge"] = f"{one.edge:.2f}"
    return named


def write(place: Place) -> None:
    """Write the page and its figures from existing runs."""

    def found_bars(name: str, cell: float, particles: int = 2) -> Bars:
        return read_bars(place.runs / name, cell, particles)

    def found_column(name: str, shape: str, aspect: float, across: int) -> Column:
        return read_column(place.runs / name, shape, aspect, across)

    bars = {
        (transfer, cell): found_bars(bar_name(cell, transfer), cell) for transfer in TRANSFERS for cell in BAR_CELLS
    }
    fine = found_bars("bars-21-2.5", BAR_CELLS[-1])
    bar_causes = {"reference: APIC, cells of 5 mm": bars["apic", BAR_STUDIED]}
    for number, (words, changes) in enumerate(BAR_CAUSES.items()):
        particles = 3 if any("particles_per_axis=3" in change for change in changes) else 2
        bar_causes[words] = found_bars(f"bars-cause-{number}", BAR_STUDIED, particles)
    bar_causes[f"friction angle 21.1 degrees, cells of {BAR_CELLS[-1]:g} mm"] = fine

    def columns_of(
        shape: str, aspect: float, transfers: Sequence[str], across: Sequence[int]
    ) -> dict[tuple[str, int], Column]:
        return {
            (transfer, each): found_column(column_name(shape, aspect, each, transfer), shape, aspect, each)
            for transfer in transfers
            for each in across
        }

    columns = {
        (shape, *key): one
        for shape, transfers in (("cylinder", tuple(NAMES)), ("plane", TRANSFERS))
        for key, one in columns_of(shape, 1.0, transfers, ACROSS).items()
    }
    aspects = {
        (aspect, *key): one
        for aspect in OTHER_ASPECTS
        for key, one in columns_of("cylinder", aspect, TRANSFERS, ACROSS[:-1]).items()
    }
    name = column_name("cylinder", 1.0, ACROSS_FINEST, "apic")
    finest = {("cylinder", "apic", ACROSS_FINEST): found_column(name, "cylinder", 1.0, ACROSS_FINEST)}
    causes = {f"reference: APIC, {ACROSS_STUDIED} cells across the radius": columns["cylinder", "apic", ACROSS_STUDIED]}
    for number, words in enumerate(COLUMN_CAUSES):
        causes[words] = found_column(f"cylinder-cause-{number}", "cylinder", 1.0, ACROSS_STUDIED)
    text = Template(text_of("laboratory.md", {})).substitute(
        bars=bar_table(bars),
        columns=column_table(columns),
        aspects=aspect_table(aspects),
        measured_slope=f"{inclination(*read_points(MEASURED / 'failure.csv')):.1f}",
        measured_area=f"{np.trapezoid(*read_points(MEASURED / 'surface.csv')[::-1]):.4f}",
        **numbers(bars, columns | finest),
    )
    bar_figure(bars).savefig(place.page("docs/laboratory/bars.png"), dpi=150)
    column_figure(columns).savefig(place.page("docs/laboratory/cylinder.png"), dpi=150)
    place.page(PAGES[0]).write_text(rewrapped(text), encoding="utf-8")
    variants = Template(text_of("laboratory-variants.md", {})).substitute(
        bar_causes=bar_cause_table(bar_causes), column_causes=column_cause_table(causes)
    )
    place.page(PAGES[1]).write_text(rewrapped(variants), encoding="utf-8")


STUDY = Study("laboratory", PAGES, 30.0, write, (jobs,))
