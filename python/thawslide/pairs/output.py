"""Results of a case on cells of 4h, 2h and h with their errors: pair.md and pair.json."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path

from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.maps import on_map
from thawslide.mobility import mobility_of
from thawslide.number_text import exact_text, number_text
from thawslide.pairs.errors import Error, error_of
from thawslide.pairs.outlines import OutlineDistance, outline_distance
from thawslide.run_folder import Run

PAGE, JSON = "pair.md", "pair.json"
_WORDS = {
    "travel_distance_m": ("travel distance", "m"),
    "displacement_m": ("mean displacement", "m"),
    "deposit_area_m2": ("deposit area", "m²"),
    "inundated_area_m2": ("inundated area", "m²"),
}
_OUTLINES = {"deposit": "final_thickness", "inundated area": "max_thickness"}
Outlines = dict[str, OutlineDistance | None]


def write_pair(runs: Mapping[int, Run], cell: float, output: Path) -> tuple[str, list[Path]]:
    """Write the files of the pair; return the page as text, and the files.

    runs: by the factor 4, 2 or 1 on their cell; that of 4 can be absent. cell: h [m].
    """
    found = {factor: _results(run) for factor, run in runs.items()}
    errors = {name: error_of(*(found.get(factor, {}).get(name, math.nan) for factor in (4, 2, 1))) for name in found[1]}
    thickness, outlines = _outlines(runs)
    text = _page(errors, outlines, thickness, runs, cell)
    stored = {
        "cell_m": cell,
        "results": {name: _without_nan(asdict(each)) for name, each in errors.items()},
        "outline_distance_m": {name: each and asdict(each) for name, each in outlines.items()},
    }
    try:
        for name, content in ((PAGE, text), (JSON, json.dumps(stored, indent=1, allow_nan=False))):
            with atomic_file(output / name) as temporary:
                temporary.write_text(content + "\n", encoding="utf-8")
    except OSError as error:
        raise ReportError(f"{output}: cannot be written ({error.strerror}). Select another --output.") from error
    return text, [output / PAGE, output / JSON]


def _results(run: Run) -> dict[str, float]:
    length = mobility_of(run).length
    found = {
        "travel_distance_m": math.nan if length is None else float(length),
        "displacement_m": float(run.series["mean_displacement_m"][-1]),
    }
    for name in ("deposit_area_m2", "inundated_area_m2"):
        if run.dimension == 3 and isinstance(run.facts.get(name), int | float):
            found[name] = float(run.facts[name])
    return found


def _outlines(runs: Mapping[int, Run]) -> tuple[float, Outlines]:
    """Return the thickness of outlines [m], and the distance of those on 2h from those on h."""
    fine, coarse = runs[1], runs[2]
    if not on_map(fine):
        return 0.0, {}
    thickness = float(fine.section("maps")["area_thickness"])
    return thickness, {
        words: outline_distance(coarse.maps[name], fine.maps[name], thickness) for words, name in _OUTLINES.items()
    }


def _without_nan(values: dict[str, float | str]) -> dict[str, float | str | None]:
    return {key: None if isinstance(each, float) and math.isnan(each) else each for key, each in values.items()}


def _page(
    errors: Mapping[str, Error], outlines: Outlines, thickness: float, runs: Mapping[int, Run], cell: float
) -> str:
    heads = [f"cells of {exact_text(factor * cell)} m" for factor in (4, 2, 1)]
    rows = [["result", *heads, "error of the last", "extrapolated"], ["---"] * 6]
    rows += [_row(name, each) for name, each in errors.items()]
    rows.append(["particles", *(_particles(runs.get(factor)) for factor in (4, 2, 1)), "", ""])
    lines = [f"# Errors of {runs[1].title}", "", *("| " + " | ".join(row) + " |" for row in rows), ""]
    if outlines:
        lines.append(f"Outlines where {exact_text(thickness)} m is exceeded, on cells of {exact_text(2 * cell)} m:")
        lines.append("")
    for words, each in outlines.items():
        lines.append(
            f"- {words}: no outline in one of the runs"
            if each is None
            else f"- {words}: {abs(each.mean):.0f} m {'outside' if each.mean > 0 else 'inside'} on average of that on "
            f"cells of {exact_text(cell)} m, {each.rms:.0f} m rms; 95 % of it lies within {each.largest:.0f} m"
        )
    return "\n".join(lines).rstrip()


def _row(name: str, error: Error) -> list[str]:
    words, unit = _WORDS[name]
    values = ["-" if math.isnan(v) else number_text(v, 4) for v in (error.coarsest, error.coarse, error.value)]
    if not math.isfinite(error.error):
        return [f"{words} ({unit})", *values, "-", f"no: {error.reason}"]
    share = f" ({100.0 * error.error / abs(error.value):.1f} %)" if error.value else ""
    kind = "" if not error.reason else "differences: "
    limit = f"no: {error.reason}" if error.reason else f"{number_text(error.limit, 4)} (order {error.order:.1f})"
    return [f"{words} ({unit})", *values, f"{kind}{number_text(error.error, 2)}{share}", limit]


def _particles(run: Run | None) -> str:
    return "-" if run is None else f"{int(run.facts['particles']):,}"
