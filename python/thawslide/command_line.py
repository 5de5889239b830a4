"""Command thawslide-report: exit code 0 for success, 2 for an error of the user or damaged files."""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TextIO

from thawslide.errors import ReportError, nearest, printable, quoted
from thawslide.figures import FIGURES
from thawslide.report import make_report
from thawslide.run import Run
from thawslide.setup_picture import plot_setup_file


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    parser = _parser()
    given = parser.parse_args(arguments)
    try:
        if given.setup is not None or given.picture is not None:
            if given.run is not None or given.setup is None or given.picture is None:
                raise ReportError(
                    "--setup: requires --picture, and no RUN. Specify --setup SETUP.json --picture OUT.png."
                )
            plot_setup_file(given.setup, given.picture, given.dpi)
        elif given.run is None:
            raise ReportError("RUN: not specified. Specify a run folder, e.g. thawslide-report runs/lamplugh.")
        else:
            with warnings.catch_warnings():
                # Numbers of an unstable run can overflow; its figures and its page report the failure.
                warnings.simplefilter("ignore", RuntimeWarning)
                return _report(given.run, given.output, _names(given.only), given.dpi)
    except ReportError as error:
        _print(f"thawslide-report: error: {error}", sys.stderr)
        return 2
    return 0


def _print(line: str, stream: TextIO | None = None) -> None:
    """Print a line; a closed pipe or a full disk is ignored, because the results are files.

    Characters missing in the encoding of the stream are escaped.
    """
    to = stream or sys.stdout
    if to is None:  # closed by the parent process
        return
    encoding = to.encoding or "utf-8"
    try:
        print(printable(line).encode(encoding, "backslashreplace").decode(encoding), file=to, flush=True)
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, to.fileno())
        os.close(nowhere)


def _report(folder: Path, output: Path | None, names: list[str] | None, dpi: int) -> int:
    run = Run(folder, skip_damaged=True)
    _print(f"{run.title}: {run.history.rows} rows of history, {len(run.snapshot_files)} snapshots")
    report = make_report(run, output, names, dpi, progress=_print)
    for warning in run.warnings:
        _print(f"thawslide-report: warning: {warning}", sys.stderr)
    for name in report.faults:
        _print(f"thawslide-report: error: {name}: not plotted: {report.missing[name]}", sys.stderr)
    _print(f"report: {report.page}")
    return 2 if report.faults else 0


def _names(texts: list[str] | None) -> list[str] | None:
    """Return the figure names of --only, in the order of the page; ReportError for an unknown one."""
    if not texts:
        return None
    asked = [name.strip() for text in texts for name in text.split(",") if name.strip()]
    for name in asked:
        if name not in FIGURES:
            raise ReportError(
                f"--only: no figure {quoted(name)}{nearest(name, FIGURES)} Allowed: {', '.join(FIGURES)}."
            )
    if not asked:
        raise ReportError(f"--only: no name. Allowed: {', '.join(FIGURES)}.")
    return [name for name in FIGURES if name in asked]


def _dpi(text: str) -> int:
    if not text.isdigit() or not 30 <= int(text) <= 1200:
        raise argparse.ArgumentTypeError(
            f"not a valid resolution (found {quoted(text)}; allowed whole numbers from 30 to 1200)"
        )
    return int(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide-report",
        description="Plot the figures of a run and write report.html, or plot the setup of a case.",
    )
    parser.add_argument("run", metavar="RUN", nargs="?", type=Path, help="folder of a run, e.g. runs/lamplugh")
    parser.add_argument("--output", metavar="DIR", type=Path, help="output folder (default: the run folder)")
    parser.add_argument(
        "--only", metavar="NAMES", action="append", help=f"figures to plot, separated by commas: {', '.join(FIGURES)}"
    )
    parser.add_argument(
        "--dpi", type=_dpi, default=150, help="resolution of the figures in dots per inch (default: 150)"
    )
    parser.add_argument("--setup", metavar="SETUP.json", type=Path, help="setup file of the simulator")
    parser.add_argument("--picture", metavar="OUT.png", type=Path, help="image file of the setup")
    return parser


if __name__ == "__main__":
    sys.exit(main())
