"""The forecast on the page docs/blind/joffre.md: table of quantiles, probability maps and distributions."""

from __future__ import annotations

import textwrap
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure

from reproduction.studies import joffre
from reproduction.study import Place, Study
from reproduction.tables import markdown
from thawslide.figures.colours import PROBABILITY_LIMITS
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
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, RED, styled
from thawslide.maps import Map, read_map
from thawslide.number_text import number_text

HEADING = "## Forecast"
NAMES = {
    "coulomb": "Coulomb",
    "voellmy": "Voellmy",
    "all": "both laws",
    "blind": "blind forecast, coarse cells",
    "frozen": "frozen prior, weighted",
}
COLOURS = {"coulomb": BLUE, "voellmy": RED, "all": BLACK}
# Columns of the table of members: heading, unit factor and decimals.
ROWS = {
    "travel_distance_m": ("travel distance L (m)", 1.0, 0),
    "drop_height_m": ("drop height H (m)", 1.0, 0),
    "h_over_l": ("H/L", 1.0, 2),
    "mean_speed_m_s": ("mean velocity (m/s)", 1.0, 0),
    "duration_s": ("duration (s)", 1.0, 0),
    "covered_area_m2": ("deposit area (km²)", 1e-6, 2),
    "affected_area_m2": ("affected area (km²)", 1e-6, 2),
    "peak_mean_velocity_m_s": ("peak of the mean velocity of the mass (m/s)", 1.0, 0),
}
PLOTTED = ("travel_distance_m", "h_over_l", "mean_speed_m_s", "duration_s", "covered_area_m2")


def groups(table: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Return the members of each law, and of both."""
    return {law: table[table["law"] == law] for law in joffre.LAWS} | {"all": table}


def quantile_table(table: pd.DataFrame) -> str:
    """Return P10, P50 and P90 of each result, by law and of both, and by release."""
    parts = groups(table) | {name: table[table["release"] == name] for name in joffre.RELEASES}
    head = ["P10, P50, P90", *(NAMES.get(name, f"{name} release") for name in parts)]
    lines = [head]
    for column, (heading, factor, decimals) in ROWS.items():
        cells = [
            ", ".join(f"{factor * value:,.{decimals}f}" for value in joffre.quantiles(part[column]))
            for part in parts.values()
        ]
        lines.append([heading, *cells])
    return markdown([*lines, ["members", *(str(len(part)) for part in parts.values())]])


def state_text(table: pd.DataFrame, total: int) -> str:
    """Return how the members ended."""
    resting = int((table["simulated_time_s"] < joffre.end()).sum())
    left = table["left_fraction"]
    text = f"{len(table)} of {total} members finished, and {resting} of them came to rest before {joffre.end():g} s. "
    if (count := int((left > 0.0).sum())) == 0:
        text += "No particle left the DEM."
    else:
        text += f"Particles left the DEM in {count} members, at most {100.0 * left.max():.1f} % of the mass."
    return textwrap.fill(text, 120)


@styled
def probability_figure(
    maps: dict[str, Map], release: dict[str, Map], terrain: Map, reach: tuple[float, float] | None = None
) -> Figure:
    """Map the probability of being reached over the hillshade, by law and for both; reach: an observed end."""
    boxes = [box for field in maps.values() if (box := covered_box(field)) is not None]
    scene = make_scene(terrain, box_about(boxes))
    mark = " Cross: observed reach." if reach else ""
    note = f"Reached: flow thickness above 0.5 m. White outlines: releases.{mark} {scene.note()}"
    page = MapPage("Probability of being reached", scene, len(maps), note=note, foot=0.65)
    painter, panels = ScalarMappable(BoundaryNorm(PROBABILITY_LIMITS, 256), colour_map("YlOrRd")), []
    for number, (name, whole) in enumerate(maps.items()):
        field = whole.cropped(scene.box)
        axes = page.panel(number, labels=number == 0)
        paint(axes, replace(field, values=np.where(field.values > 0.0, field.values, np.nan)), painter)
        for thickness in release.values():
            outline(axes, thickness.cropped(scene.box), 0.5, colors="white", linewidths=1.0)
        if reach:
            axes.plot(*reach, "X", color=BLUE, markeredgecolor="white", ms=9, zorder=10)
        panels.append((axes, NAMES[name], ""))
        if number == 0:
            scale_bar(axes, quiet_corner(field, scene.box))
    page.set_titles(panels)
    bar = page.figure.colorbar(painter, cax=page.common_bar(), orientation="horizontal")
    bar.set_ticks(PROBABILITY_LIMITS, labels=[number_text(limit) for limit in PROBABILITY_LIMITS])
    bar.set_label("probability", labelpad=2)
    return page.figure


@styled
def distribution_figure(table: pd.DataFrame) -> Figure:
    """Plot the cumulative distributions of the results, by law and for both."""
    figure = Figure(figsize=(COLUMN_WIDTH, 5.6), layout="constrained")
    panels = figure.subplots(3, 2).ravel()
    for panel, column, letter in zip(panels, PLOTTED, "abcde", strict=False):
        heading, factor, _ = ROWS[column]
        for name, part in groups(table).items():
            panel.ecdf(factor * part[column].dropna(), color=COLOURS[name], label=NAMES[name])
        panel.set_title(f"({letter})", loc="left")
        panel.set_xlabel(heading)
        panel.grid(True)
    for panel in panels[::2]:
        panel.set_ylabel("fraction of the members")
    panels[-1].axis("off")
    handles, labels = panels[0].get_legend_handles_labels()
    panels[-1].legend(handles, labels, loc="center")
    return figure


def write(place: Place) -> None:
    """Run the missing members, plot the figures, and replace the forecast of the page."""
    runs, page = place.runs, place.page("docs/blind/joffre.md")
    if not place.draws_only:
        joffre.prepare(place.data / "joffre", runs, (*joffre.COARSE, *joffre.FEW) if place.is_quick else ())
        for law in joffre.LAWS:
            joffre.run_ensemble(law, runs, place.at_a_time)
    table = joffre.members(runs)
    total = sum(len(pd.read_parquet(runs / law / "members.parquet")) for law in joffre.LAWS)
    folders = {law: runs / law / "probability" for law in joffre.LAWS} | {"all": joffre.map_probabilities(runs)}
    maps = {name: read_map(folder / "reached.tif") for name, folder in folders.items()}
    release = {name: read_map(runs / name / "release.tif") for name in joffre.RELEASES}
    terrain = read_map(runs / "upper" / joffre.TERRAIN)
    probability_figure(maps, release, terrain).savefig(place.page("docs/blind/joffre/probability.png"), dpi=150)
    distribution_figure(table).savefig(place.page("docs/blind/joffre/distributions.png"), dpi=150)
    fixed = page.read_text(encoding="utf-8").partition(HEADING)[0] if page.exists() else ""
    text = [HEADING, state_text(table, total), quantile_table(table)]
    text += [f"![probability of being reached]({page.stem}/probability.png)"]
    text += [f"![cumulative distributions]({page.stem}/distributions.png)"]
    page.write_text(fixed.rstrip() + "\n\n" + "\n\n".join(text) + "\n", encoding="utf-8")


STUDY = Study(
    "joffre",
    ("docs/blind/joffre.md",),
    900.0,
    write,
    needs=lambda place: [] if place.draws_only else [place.data / "joffre" / joffre.DEM],
    remedy="Give the folder of the data with --data.",
    is_frozen=True,
)
