"""Command `./run paper`: exit code 0 for success, 2 for an error of the user."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from reproduction.page import make_page
from reproduction.runs import all_runs, read_runs, run_all
from thawslide.errors import ReportError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the paper's cases and write the page; return the exit code."""
    parser = argparse.ArgumentParser(
        prog="./run paper",
        description="Run all cases of the paper and write one page with figures, summaries of the paper, and results.",
    )
    parser.add_argument("--quick", action="store_true", help="only the first time steps of each case, as a test")
    parser.add_argument("--draw-only", action="store_true", help="plot existing runs only")
    parser.add_argument("--program", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--cases", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--output", type=Path, required=True, metavar="DIR", help="output folder")
    given = parser.parse_args(arguments)
    started = time.monotonic()

    def progress(line: str) -> None:
        print(f"{time.monotonic() - started:5.0f} s  {line}", flush=True)

    try:
        runs = all_runs()
        if not given.draw_only:
            run_all(runs, given.program, given.cases, given.output, given.quick, progress)
        page = make_page(read_runs(runs, given.output), given.output, given.quick, progress)
    except ReportError as error:
        print(f"./run paper: error: {error}", file=sys.stderr)
        return 2
    progress(f"page: {page}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
