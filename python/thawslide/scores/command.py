"""Command `thawslide score`: exit code 0 for success, 2 for an error of the user."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from thawslide._core import UserError
from thawslide.commands import print_line
from thawslide.errors import ReportError
from thawslide.scores.forecast import read_forecast
from thawslide.scores.observed import read_observed
from thawslide.scores.output import REPORT, renew_section, write_score
from thawslide.scores.score import compute_score
from thawslide.sweeps.page import NAME


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    given = _parser().parse_args(arguments)
    try:
        score = compute_score(read_forecast(given.forecast), read_observed(given.observed))
        text, files = write_score(score, given.output or given.forecast)
    except (ReportError, UserError) as error:
        print_line(f"thawslide score: error: {error}", sys.stderr)
        return 2
    for line in [*text.split("\n"), "", *(f"note: {note}" for note in score.notes)]:
        print_line(line)
    page, writer = (NAME, "the command of the sweep") if score.forecast.is_sweep else (REPORT, "thawslide report")
    if given.output is None:
        if renew_section(given.forecast / page):
            files.append(given.forecast / page)
        else:
            print_line(f"note: {given.forecast / page}: not changed. To write it with the score, repeat {writer}.")
    for path in files:
        print_line(f"score: {path}")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide score",
        description="Compare a sweep or a run with observations: percentiles, CRPS, and overlap of outlines.",
    )
    add = parser.add_argument
    add("forecast", metavar="FORECAST", type=Path, help="folder of a sweep or of a run")
    add(
        "--observed",
        metavar="FILE",
        type=Path,
        required=True,
        help="observations of the event, e.g. observed.toml (needed)",
    )
    add("--output", metavar="DIR", type=Path, help="output folder (default: FORECAST)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
