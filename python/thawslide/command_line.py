"""Command thawslide-report: exit code 0 for success, 2 for an error of the user or damaged files."""

from __future__ import annotations

import argparse
import math
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

from thawslide.commands import print_line
from thawslide.contours import write_contours
from thawslide.errors import ReportError, quoted
from thawslide.figures import FIGURES
from thawslide.messages import LANGUAGES
from thawslide.reports import LEAST_DPI, MOST_DPI, figure_names, write_pages
from thawslide.run_folder import Run
from thawslide.setup_picture import plot_setup_file


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if words[:1] == ["contours"]:
        return _run_safely(lambda: _contours(_contours_parser().parse_args(words[1:])))
    return _run_safely(lambda: _plots(_parser().parse_args(words)))


def _run_safely(work: Callable[[], int]) -> int:
    try:
        return work()
    except ReportError as error:
        print_line(f"thawslide-report: error: {error}", sys.stderr)
        return 2


def _plots(given: argparse.Namespace) -> int:
    if given.setup is not None or given.picture is not None:
        if given.run or given.setup is None or given.picture is None:
            raise ReportError("--setup: requires --picture, and no RUN. Specify --setup SETUP.json --picture OUT.png.")
        plot_setup_file(given.setup, given.picture, given.dpi)
        return 0
    if not given.run:
        raise ReportError("RUN: not specified. Specify a run folder, e.g. thawslide-report runs/lamplugh.")
    with warnings.catch_warnings():
        # Numbers of an unstable run can overflow; its figures and its page report the failure.
        warnings.simplefilter("ignore", RuntimeWarning)
        return _pages(given)


def _contours(given: argparse.Namespace) -> int:
    path = write_contours(Run(given.run, skip_damaged=True), given.map, given.threshold, given.below, given.output)
    print_line(f"contours: {path}")
    return 0


def _pages(given: argparse.Namespace) -> int:
    """Write the page that the arguments select; return the exit code."""
    names = figure_names(given.only)
    runs = [_opened(folder) for folder in given.run]
    pages = write_pages(runs, given.output, names, given.brief, given.dpi, print_line, given.language)
    for run in runs:
        _print_warnings(run)
    for name, reason in pages.faults.items():
        print_line(f"thawslide-report: error: {name}: not plotted: {reason}", sys.stderr)
    for kind, path in pages.files:
        print_line(f"{kind}: {path}")
    return 2 if pages.faults else 0


def _opened(folder: Path) -> Run:
    run = Run(folder, skip_damaged=True)
    print_line(f"{run.title}: {run.series.rows} rows of history, {len(run.snapshot_files)} snapshots")
    return run


def _print_warnings(run: Run) -> None:
    for warning in run.warnings:
        print_line(f"thawslide-report: warning: {warning}", sys.stderr)


def _dpi(text: str) -> int:
    if not text.isdigit() or not LEAST_DPI <= int(text) <= MOST_DPI:
        raise argparse.ArgumentTypeError(
            f"not a valid resolution (found {quoted(text)}; allowed whole numbers from {LEAST_DPI} to {MOST_DPI})"
        )
    return int(text)


def _threshold(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"not a number (found {quoted(text)})")
    return value


def _contours_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide-report contours",
        description="Write the areas in which a map of a 3D run exceeds thresholds, as polygons for a GIS.",
    )
    parser.add_argument("run", metavar="RUN", type=Path, help="folder of a run")
    parser.add_argument("--map", metavar="NAME", required=True, help="map of the run, e.g. max_thickness")
    parser.add_argument(
        "--threshold",
        metavar="VALUE",
        type=_threshold,
        required=True,
        action="append",
        help="lower limit of the values, in the unit of the map (may be repeated)",
    )
    parser.add_argument("--below", action="store_true", help="the threshold is the upper limit, as for arrival_time")
    parser.add_argument(
        "--output",
        metavar="FILE",
        type=Path,
        help="GeoPackage (.gpkg) or GeoJSON (.geojson) file (default: contours-NAME.gpkg in the run folder)",
    )
    return parser


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide-report",
        description="Write the page of one run (report.html) or of several (comparison.html), or plot a setup.",
        epilog="thawslide report contours RUN --map NAME --threshold VALUE writes polygons of a map (contours --help).",
    )
    parser.add_argument("run", metavar="RUN", nargs="*", type=Path, help="folder of a run; several are compared")
    parser.add_argument(
        "--output", metavar="DIR", type=Path, help="output folder (default: the folder of the first run)"
    )
    parser.add_argument(
        "--only",
        metavar="NAMES",
        action="append",
        help=f"figures to plot, separated by commas: {', '.join(FIGURES)}",
    )
    parser.add_argument(
        "--brief", action="store_true", help="two-page summary for non-experts: summary.html, summary.pdf"
    )
    parser.add_argument(
        "--language", choices=LANGUAGES, default=LANGUAGES[0], help="of results and summary (default: en)"
    )
    parser.add_argument(
        "--dpi", type=_dpi, default=150, help="resolution of the figures in dots per inch (default: 150)"
    )
    parser.add_argument("--setup", metavar="SETUP.json", type=Path, help="setup file of the simulator")
    parser.add_argument("--picture", metavar="OUT.png", type=Path, help="image file of the setup")
    return parser


if __name__ == "__main__":
    sys.exit(main())
