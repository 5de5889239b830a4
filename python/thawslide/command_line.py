"""The command thawslide-report: exit code 0 done, 2 a mistake or damaged files, with a line on what to do."""

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
from thawslide.setup_picture import draw_setup_file


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    parser = _parser()
    given = parser.parse_args(arguments)
    try:
        if given.setup is not None or given.picture is not None:
            if given.run is not None or given.setup is None or given.picture is None:
                raise ReportError("--setup SETUP.json and --picture OUT.png belong together, without RUN")
            draw_setup_file(given.setup, given.picture, given.dpi)
        elif given.run is None:
            raise ReportError("give a run folder, e.g. thawslide-report runs/lamplugh")
        else:
            with warnings.catch_warnings():
                # Numbers of a run that exploded overflow; its figures and its page say more of that than numpy does.
                warnings.simplefilter("ignore", RuntimeWarning)
                return _report(given.run, given.output, _names(given.only), given.dpi)
    except ReportError as error:
        _say(f"thawslide-report: error: {error}", sys.stderr)
        return 2
    return 0


def _say(line: str, stream: TextIO | None = None) -> None:
    """Tell a line; where nobody takes it (a closed pipe, a full disk) the work goes on, as its results are files.

    Letters that the stream's encoding lacks are told by their numbers.
    """
    to = stream or sys.stdout
    if to is None:  # closed by whoever started the program
        return
    encoding = to.encoding or "utf-8"
    try:
        print(printable(line).encode(encoding, "backslashreplace").decode(encoding), file=to, flush=True)
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, to.fileno())
        os.close(nowhere)


def _report(folder: Path, output: Path | None, names: list[str] | None, dpi: int) -> int:
    run = Run(folder, leave_out_damaged=True)
    _say(f"{run.title}: {run.history.rows} rows of history, {len(run.snapshot_files)} snapshots")
    report = make_report(run, output, names, dpi, progress=_say)
    for warning in run.warnings:
        _say(f"thawslide-report: note: {warning}", sys.stderr)
    for name in report.faults:
        _say(f"thawslide-report: error: {name} is left out: {report.left_out[name]}", sys.stderr)
    _say(f"report: {report.page}")
    return 2 if report.faults else 0


def _names(texts: list[str] | None) -> list[str] | None:
    """Return the figure names of --only, in the page's order; ReportError for one that is none."""
    if not texts:
        return None
    asked = [name.strip() for text in texts for name in text.split(",") if name.strip()]
    for name in asked:
        if name not in FIGURES:
            raise ReportError(
                f"--only: no figure {quoted(name)}{nearest(name, FIGURES)} There are: {', '.join(FIGURES)}"
            )
    if not asked:
        raise ReportError(f"--only: names no figure. There are: {', '.join(FIGURES)}")
    return [name for name in FIGURES if name in asked]


def _dpi(text: str) -> int:
    if not text.isdigit() or not 30 <= int(text) <= 1200:
        raise argparse.ArgumentTypeError(f"expected a whole number from 30 to 1200, found '{text}'")
    return int(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide-report",
        description="Draw the figures of a run and write report.html beside them, or draw a set-up before it runs.",
    )
    parser.add_argument("run", metavar="RUN", nargs="?", type=Path, help="folder a run has written, e.g. runs/lamplugh")
    parser.add_argument("--output", metavar="DIR", type=Path, help="where to write (default: the run folder)")
    parser.add_argument(
        "--only", metavar="NAMES", action="append", help=f"figures to draw, with commas between: {', '.join(FIGURES)}"
    )
    parser.add_argument("--dpi", type=_dpi, default=150, help="dots per inch of the figures (default: 150)")
    parser.add_argument("--setup", metavar="SETUP.json", type=Path, help="set-up to draw, as the simulator writes it")
    parser.add_argument("--picture", metavar="OUT.png", type=Path, help="where to draw the set-up")
    return parser


if __name__ == "__main__":
    sys.exit(main())
