"""Command `thawslide probability`: probability and quantile maps of a sweep, of run folders, or of other rasters."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from thawslide.commands import print_line
from thawslide.errors import ReportError
from thawslide.sweeps.folder import PLAN, SweepFolder
from thawslide.sweeps.outcome import MAPS
from thawslide.sweeps.probability import QUANTILES, QUANTITIES, rasters_in, write_probability_maps


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code: 0 for success, 2 for an error of the user."""
    given = _parser().parse_args(arguments)
    try:
        rasters, weights = _rasters(given.folder, given.quantity)
        output = given.output or _usual_output(given.folder)
        chosen = {name: getattr(given, name) for name in ("thickness", "speed") if getattr(given, name)}
        count = max(map(len, rasters.values()))
        notes: list[str] = []
        quantiles = given.quantiles or QUANTILES
        for path in write_probability_maps(
            rasters, output, chosen or None, quantiles, weights=weights, report=notes.append
        ):
            print_line(f"{path}")
        for note in notes:
            print_line(f"thawslide probability: {note}", sys.stderr)
        print_line(f"maps of {count} members{_unfinished(given.folder)}", sys.stderr)
    except ReportError as error:
        print_line(f"thawslide probability: error: {error}", sys.stderr)
        return 2
    return 0


def _rasters(paths: Sequence[Path], quantity: str) -> tuple[dict[str, Sequence[Path]], list[float] | None]:
    """Return the rasters by quantity: those in folders, or files of one quantity; and the weights of a sweep's members.

    Members of several sweeps, and other runs, are equally probable.
    """
    absent = next((path for path in paths if not path.exists()), None)
    if absent is not None:
        raise ReportError(f"{absent}: no such file or folder. Correct the path.")
    files = [path for path in paths if path.is_file()]
    if files:
        if len(files) < len(paths):
            raise ReportError("FOLDER: folders and files together. Specify either folders or raster files.")
        return {quantity: files}, None
    folders: list[Path] = []
    weights = None
    for path in paths:
        if not (path / PLAN).is_file():
            folders.append(path)
            continue
        sweep = SweepFolder(path)
        done = sweep.done_members()
        folders += map(sweep.run_folder, done)
        if (found := sweep.weights()) is not None and len(paths) == 1:
            weights = [found.get(number, 0.0) for number in done]
        elif found is not None:
            print_line(
                f"thawslide probability: note: {path}: with several folders its weights do not count", sys.stderr
            )
    return dict(rasters_in(folders)), weights


def _unfinished(paths: Sequence[Path]) -> str:
    """Return how many members of sweeps have not finished, as the end of a sentence."""
    sweeps = [SweepFolder(path) for path in paths if (path / PLAN).is_file()]
    count = sum(folder.unfinished() for folder in sweeps)
    return f"; not finished: {count}. To continue, repeat the command of the sweep." if count else ""


def _usual_output(paths: Sequence[Path]) -> Path:
    return paths[0] / MAPS if (paths[0] / PLAN).is_file() else Path(MAPS)


def numbers(text: str) -> tuple[float, ...]:
    """Read numbers separated by commas, for argparse."""
    try:
        return tuple(float(part) for part in text.split(","))
    except ValueError as error:
        raise argparse.ArgumentTypeError(f"not numbers separated by commas (found {text!r})") from error


def _probabilities(text: str) -> tuple[float, ...]:
    found = numbers(text)
    if not all(0.0 < each <= 1.0 for each in found):
        raise argparse.ArgumentTypeError(f"not probabilities above 0 and at most 1 (found {text!r})")
    return found


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide probability",
        description="Write maps of probability and quantiles as GeoTIFF files with QGIS styles.",
    )
    add = parser.add_argument
    add("folder", metavar="FOLDER", nargs="+", type=Path, help="a sweep, run folders, or raster files of one quantity")
    add("--quantity", choices=QUANTITIES, default="thickness", help="quantity of raster files (default: thickness)")
    add("--thickness", metavar="M,...", type=numbers, help="thresholds of thickness [m] (default: 0.5,1,5)")
    add("--speed", metavar="M/S,...", type=numbers, help="thresholds of speed [m/s] (default: 1,5,10)")
    add("--quantiles", metavar="P,...", type=_probabilities, help="quantiles (default: 0.1,0.5,0.9)")
    add("--output", metavar="DIR", type=Path, help="output folder (default: probability, in the folder of a sweep)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
