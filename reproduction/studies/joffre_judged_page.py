"""The page docs/blind/joffre-judged.md: its tables and figures. All its numbers are in joffre-judged/numbers.json."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from reproduction.studies import joffre, joffre_judged
from reproduction.studies.joffre_judged import Rows
from reproduction.studies.joffre_page import probability_figure
from reproduction.study import Place, Study
from reproduction.tables import markdown, rewrapped, text_of
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, ORANGE, styled
from thawslide.maps import read_map
from thawslide.number_text import number_text
from thawslide.scores.forecast import Forecast
from thawslide.scores.observed import Observed

PAGE = "docs/blind/joffre-judged.md"
FOLDER = "docs/blind/joffre-judged"
NAMES = {"blind": "blind, coarse cells", "frozen": "frozen prior", "frank": "Frank slide, frozen prior"}
COLOURS = {"blind": BLACK, "frozen": BLUE}
# Columns of the table of members: heading, divisor
PANELS = {
    "travel_distance": ("travel_distance_m", "travel distance L (km)", 1e3),
    "h_over_l": ("h_over_l", "H/L", 1.0),
    "mean_velocity": ("mean_speed_m_s", "mean velocity (m/s)", 1.0),
    "duration": ("duration_s", "duration (s)", 1.0),
}
# Columns of a run, with the sign of a limit if the front still advances at the end
RUN_COLUMNS = {"travel_distance_m": "> ", "h_over_l": "< ", "mean_speed_m_s": "", "duration_s": "> "}
END = 240.0  # s: of runs that do not come to rest


def text(value: Any) -> str:
    """Return a number with up to three digits, "" for none, and a text unchanged."""
    if isinstance(value, str):
        return value
    return "" if value is None or not math.isfinite(value) else number_text(float(value))


def spread_of(row: dict[str, Any], prefix: str = "") -> str:
    """Return P5, P50 and P95 of a row."""
    return ", ".join(text(row[f"{prefix}{name}"]) for name in ("low", "median", "high"))


def percentile_text(row: dict[str, Any]) -> str:
    """Return the percentile of an observation, and those of the ends of its range if they differ."""
    middle, low, high = (f"{row[f'members_percentile{end}']:.0f}" for end in ("", "_low", "_high"))
    return middle if low == high else f"{middle} ({low} to {high})"


def score_table(rows: Rows) -> str:
    """Return the scores of all forecasts."""
    lines = ["forecast | quantity | observed | P5, P50, P95 | percentile | CRPS | CRPS of events | CRPS of 23 events"]
    for row in rows:
        unit = "" if row["unit"] == "-" else f" {row['unit'].replace('2', '²')}"
        spread = f" ± {text(row['uncertainty'])}" if row["uncertainty"] else ""
        lines.append(
            f"{NAMES[row['forecast']]} | {row['words']} | {text(row['observed'])}{spread}{unit} | "
            f"{spread_of(row, 'members_')} | "
            f"{percentile_text(row)} | {text(row['members_crps'])} | {text(row['events_crps'])} | "
            f"{text(row.get('table_crps'))}"
        )
    return markdown(lines)


def run_table(rows: Rows) -> str:
    """Return the runs that differ in one cause."""
    lines = ["run | L (m) | H/L | mean velocity (m/s) | duration (s)"]
    for row in rows:
        signs = RUN_COLUMNS if row["simulated_time_s"] >= END else dict.fromkeys(RUN_COLUMNS, "")
        lines.append(" | ".join([row["words"], *(f"{sign}{text(row[name])}" for name, sign in signs.items())]))
    return markdown(lines)


def page_text(found: dict[str, Rows]) -> str:
    """Return the page with its numbers."""
    parts = {"scores": score_table(found["scores"]), "runs": run_table(found["runs"])}
    for kind, rows in found.items():
        for row in rows:
            name = f"{row['forecast']}.{row['quantity']}" if kind == "scores" else row["name"]
            parts |= {f"{kind}.{name}.{key}": text(value) for key, value in row.items()}
            if kind == "priors":
                parts[f"priors.{name}"] = spread_of(row)
    return rewrapped(re.sub(r"@[\w.-]+@", "not computed", text_of("joffre-judged.md", parts)))


@styled
def distribution_figure(found: dict[str, tuple[Forecast, Observed]], data: Path) -> Figure:
    """Plot the cumulative distributions of both forecasts of Joffre Peak, of events, and the observations."""
    figure = Figure(figsize=(COLUMN_WIDTH, 5.2), layout="constrained")
    panels = figure.subplots(2, 2).ravel()
    for panel, (name, (column, label, divisor)), letter in zip(panels, PANELS.items(), "abcd", strict=True):
        for key, (forecast, _) in found.items():
            values, weights = forecast.columns[column] / divisor, forecast.weights
            known = np.isfinite(values) & (weights > 0.0)
            panel.ecdf(values[known], weights[known], color=COLOURS[key], label=NAMES[key])
        last, observed = found["frozen"]
        events = joffre_judged.of_table(name, data, last)
        if events is not None:
            panel.ecdf(events / divisor, color=ORANGE, linestyle="dashed", label=f"{len(events)} published events")
        seen = next(each for each in observed.numbers if each.name == name)
        ends = [(seen.value + sign * seen.uncertainty) / divisor for sign in (-1.0, 1.0)]
        panel.axvspan(*ends, color="0.75", zorder=0, label="observed")
        panel.set_title(f"({letter})", loc="left")
        panel.set_xlabel(label)
        panel.grid(True)
    for panel in panels[::2]:
        panel.set_ylabel("cumulative probability")
    panels[0].set_xlim(0.0, 8.0)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def write(place: Place) -> None:
    """Run the missing members, plot the figures, and write the numbers and the page."""
    runs = place.runs
    if not place.draws_only:
        joffre_judged.run_forecasts(place)
    found = joffre_judged.numbers(place)
    place.page(f"{FOLDER}/numbers.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    place.page(PAGE).write_text(page_text(found), encoding="utf-8")
    of_joffre = {name: pair for name, pair in joffre_judged.forecasts(runs).items() if name in COLOURS}
    maps = {name: read_map(joffre_judged.map_reached(forecast)) for name, (forecast, _) in of_joffre.items()}
    release = {name: read_map(runs / name / "release.tif") for name in joffre.RELEASES}
    terrain = read_map(runs / "upper" / joffre.TERRAIN)
    figure = probability_figure(maps, release, terrain, joffre_judged.REACH)
    figure.savefig(place.page(f"{FOLDER}/probability.png"), dpi=150)
    figure = distribution_figure(of_joffre, place.data)
    figure.savefig(place.page(f"{FOLDER}/distributions.png"), dpi=150)


def needs(place: Place) -> list[Path]:
    """Return the files of the data."""
    frank = [place.data / "frank" / f"Frankslide_{name}.asc" for name in ("topography", "pile")]
    return [place.data / "joffre" / joffre.DEM, place.data / joffre_judged.EVENTS, *frank]


STUDY = Study(
    "joffre-judged",
    (PAGE,),
    15.0,
    write,
    (joffre_judged.jobs,),
    needs,
    "Give the folder of the data with --data.",
)
