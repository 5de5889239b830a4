"""Results of a whole sweep: table, probability maps, score and page."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pandas as pd

from thawslide.errors import ReportError
from thawslide.scores.renewal import renew_score
from thawslide.sweeps.design import Design
from thawslide.sweeps.folder import DONE, FINISHED, SweepFolder
from thawslide.sweeps.page import write_page
from thawslide.sweeps.probability import DEFAULT_THRESHOLDS, rasters_in, write_probability_maps
from thawslide.sweeps.results import WEIGHT

MAPS = "probability"
TERRAIN = "terrain"


def write_outcome(
    folder: SweepFolder,
    design: Design,
    members: pd.DataFrame,
    results: Sequence[str],
    thresholds: Mapping[str, Sequence[float]] | None,
    keep: str,
    report: Callable[[str], None],
) -> None:
    """Write the probability maps of the members that are done, an existing score and the page; remove other maps."""
    finished = members[members["status"] == DONE]
    done = [folder.run_folder(int(number)) for number in finished["member"]]
    weights = finished[WEIGHT].to_list() if WEIGHT in finished else None
    if weights and not sum(weights) > 0.0:
        raise ReportError(
            f"{folder.path}: no member with a weight is done (found {len(weights)} without one). Read the errors in "
            "members.parquet, or use --prior sweep."
        )
    maps = probability_maps_of(folder, done, thresholds, report, weights)
    renew_score(folder.path, report)
    page = write_page(folder, design, members, results, maps)
    report(f"page: {page}")
    if keep == "none" and members["status"].isin(FINISHED).all():
        for run_folder in done:
            shutil.rmtree(run_folder / "maps", ignore_errors=True)


def probability_maps_of(
    folder: SweepFolder,
    done: Sequence[Path],
    thresholds: Mapping[str, Sequence[float]] | None,
    report: Callable[[str], None],
    weights: Sequence[float] | None = None,
) -> list[Path]:
    """Write the maps of all members that are done, or return those written before the members' maps were removed."""
    output = folder.path / MAPS
    with_maps = [run_folder for run_folder in done if (run_folder / "maps").is_dir()]
    if not done or len(with_maps) < len(done):
        written = sorted(path for path in output.glob("*.tif") if path.stem != TERRAIN)
        if written:
            _require_thresholds(folder, written, thresholds)
        if written and with_maps:
            report(
                f"warning: {output}: does not include {len(with_maps)} members that finished later, because the maps "
                f"of the others were removed (--keep none). To include them, specify another --output."
            )
        return written
    try:
        written = write_probability_maps(rasters_in(done), output, thresholds, weights=weights)
        shutil.copyfile(done[0] / "maps" / "terrain.tif", output / f"{TERRAIN}.tif")
    except (ReportError, OSError) as error:  # for example a varied size of map cells
        report(f"warning: no probability maps: {error}")
        return []
    report(f"probability maps: {output}")
    return written


def _require_thresholds(
    folder: SweepFolder, maps: Sequence[Path], thresholds: Mapping[str, Sequence[float]] | None
) -> None:
    """Raise ReportError if thresholds differ from those of maps that cannot be computed again."""
    names = {path.stem for path in maps}
    for quantity, values in {**DEFAULT_THRESHOLDS, **(thresholds or {})}.items():
        prefix = f"{quantity}_above_"
        found = sorted((name.removeprefix(prefix) for name in names if name.startswith(prefix)), key=float)
        asked = sorted((f"{value:g}" for value in values), key=float)
        if found and found != asked:
            raise ReportError(
                f"{folder.path}: the maps of the members were removed (--keep none), and the thresholds cannot change "
                f"(found {quantity} {','.join(asked)}; allowed {','.join(found)}). Specify --{quantity} "
                f"{','.join(found)}, or another --output."
            )
