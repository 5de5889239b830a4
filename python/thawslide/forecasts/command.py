"""Command `thawslide forecast`: exit codes as those of `thawslide sweep`."""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from thawslide._core import UserError
from thawslide.case import Case
from thawslide.commands import print_line
from thawslide.errors import ReportError, nearest, quoted
from thawslide.forecasts.output import prior_lines, write_prior
from thawslide.forecasts.prior import check_prior, release_volume
from thawslide.maps import on_map
from thawslide.messages import LANGUAGES, Messages
from thawslide.pages.events import KINDS, published_events
from thawslide.pages.summary import make_summary
from thawslide.run_folder import Run
from thawslide.scores.baseline import LEAST_EVENTS, comparable_kinds
from thawslide.scores.ensemble import quantiles
from thawslide.scores.forecast import read_forecast
from thawslide.sweeps.api import Options, run_sweep
from thawslide.sweeps.command import report_members, whole_number
from thawslide.sweeps.design import Design
from thawslide.sweeps.design_file import read_sweep_file
from thawslide.sweeps.folder import DONE, FAILED, PLAN, PRIOR, PRIOR_FILE, SweepFolder
from thawslide.sweeps.outcome import MAPS
from thawslide.sweeps.page import weights_of

SWEEP_FILE = "sweep.toml"
_PRIORS = ("sweep", "events", "none")
_WITHOUT_WEIGHTS = ("saltelli", "morris")  # samples of indices that have no weighted form


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    given = _parser().parse_args(arguments)
    try:
        return _forecast(given)
    except (ReportError, UserError) as error:
        _print(f"thawslide forecast: error: {error}")
        return 2
    except KeyboardInterrupt:
        _print("interrupted. All finished members are kept. To continue, repeat the command.")
        return 4


def _print(line: str) -> None:
    print_line(line, sys.stderr)


def _forecast(given: argparse.Namespace) -> int:
    file = given.case / SWEEP_FILE
    if not file.is_file():
        raise ReportError(
            f"{file}: no such file. Write it: its table [sweep] lists the case and the varied keys with their ranges. "
            "thawslide new writes one for a new case."
        )
    found = read_sweep_file(file)
    design = found.design
    if found.is_block:
        raise ReportError(
            f"{file}: sweep.block: a forecast needs runs (found true). Remove it, or use: thawslide sweep"
        )
    if given.event and given.event.casefold() not in (names := {one.name.casefold() for one in published_events()}):
        near = nearest(given.event, sorted(names))
        raise ReportError(f"--event: no published event {quoted(given.event)}{near} Correct it, or leave it out.")
    if len(design.cases) > 1:
        raise ReportError(f"{file}: sweep.cases: several cases (found {len(design.cases)}; allowed 1). Specify one.")
    if Case(design.cases[0]).dimension != 3:
        raise ReportError(f"{design.cases[0]}: not a 3D case. For other cases, use: thawslide sweep {file}")
    is_weighted = given.prior == "events"
    if is_weighted and design.method in _WITHOUT_WEIGHTS:
        raise ReportError(f"--prior events: not for the sample {design.method}. Use lhs or sobol in {file}.")
    output = (given.output or Path("runs") / f"{given.case.resolve().name}-forecast").absolute()
    say: Callable[[str], None] = (lambda line: None) if given.quiet else _print
    options = Options(
        output=output,
        expressions=found.expressions,
        workers=given.workers,
        shows_progress=not given.quiet,
        report=say,
    )
    _require_own(output)
    if given.prior == "none":
        (output / PRIOR / PRIOR_FILE).unlink(missing_ok=True)
    else:
        _check_prior(design, options, given, is_weighted)
    folder, table = run_sweep(design, options)
    _summarize(folder, table, given.language, say)
    return report_members(table, "thawslide forecast")


def _require_own(output: Path) -> None:
    """Raise ReportError for a folder with other files than those of a forecast, which would be removed or mixed."""
    for folder in (output, output / PRIOR):
        is_foreign = folder.is_dir() and not (folder / PLAN).is_file()
        if is_foreign and any(each.name != PRIOR or each.parent != output for each in folder.iterdir()):
            raise ReportError(f"{folder}: not empty, and not of a forecast. Specify another --output.")


def _check_prior(design: Design, options: Options, given: argparse.Namespace, is_weighted: bool) -> None:
    """Compute the rigid blocks of all members, and write and print their comparison with events."""
    assert options.output is not None
    folder = options.output / PRIOR
    volume = release_volume(design.cases[0], design.constants)
    options.report("prior check: rigid blocks of all members")
    if not (options.output / PLAN).is_file():
        shutil.rmtree(folder, ignore_errors=True)  # of other ranges, before any member has run
    blocks = replace(options, output=folder, is_block=True, expressions=(), report=lambda line: None)
    _, table = run_sweep(design, blocks)
    failed = table[table["status"] == FAILED]
    if len(failed) == len(table):
        raise ReportError(
            f"{folder}: no rigid block of the {len(table)} members can be computed (first error: "
            f"{failed['error'].iloc[0]}). Correct the case or the ranges in {SWEEP_FILE}, or use --prior none."
        )
    found = check_prior(read_forecast(folder), volume, given.kind, is_weighted, given.event).as_table()
    write_prior(found, options.output)
    for line in prior_lines(found):
        print_line(line)


def _summarize(folder: SweepFolder, table: pd.DataFrame, language: str, say: Callable[[str], None]) -> None:
    """Write the summary of the member with the median travel distance, with the probability map."""
    done = table[table["status"] == DONE]
    lengths = done["travel_distance_m"].to_numpy(dtype=float) if "travel_distance_m" in done else np.zeros(0)
    if not np.isfinite(lengths).any():
        say("note: no summary: no member has a travel distance")
        return
    weights = weights_of(done)
    (median,) = quantiles(lengths, np.ones(len(done)) if weights is None else weights, (0.5,))
    number = int(done["member"].iloc[int(np.flatnonzero(lengths == median)[0])])
    run = Run(folder.run_folder(number), skip_damaged=True)
    if not on_map(run):
        say("note: no summary: only cases on a DEM have one")
        return
    context = Messages(language)("forecast", count=len(done), number=number)
    reached = folder.path / MAPS / "reached.tif"
    probability = reached if reached.is_file() else None
    for path in make_summary(
        run, folder.path, language=language, context=context, members=len(done), probability=probability
    ):
        say(f"summary: {path}")


def _allowed_kinds() -> str:
    return ", ".join(comparable_kinds())


def _kind(text: str) -> str:
    if text in ("", *comparable_kinds()):
        return text
    few = f": fewer than {LEAST_EVENTS} published events of a similar volume" if text in KINDS else ""
    raise argparse.ArgumentTypeError(f'"{text}"{few}; allowed: {_allowed_kinds()}')


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide forecast",
        description="Simulate the members of sweep.toml after a prior check. The same command continues a forecast.",
    )
    add = parser.add_argument
    add("case", metavar="CASE_FOLDER", type=Path, help=f"folder with a case.toml and a {SWEEP_FILE}")
    add(
        "--prior", choices=_PRIORS, default="sweep",
        help="sweep: members are as probable as sweep.toml states (default); events: weighted, so that H/L of their "
        "rigid blocks has the distribution of published events; none: no prior check",
    )  # fmt: skip
    add("--kind", type=_kind, default="", help=f"kind of the published events: {_allowed_kinds()} (default: all)")
    add("--event", metavar="NAME", default="", help="published event to leave out, because it is the one to forecast")
    add("--output", metavar="DIR", type=Path, help="folder of the forecast (default: runs/NAME-forecast)")
    add("--workers", type=whole_number, default=0, help="processes (default: one per core, as many as fit into memory)")
    add("--language", choices=LANGUAGES, default=LANGUAGES[0], help="of the summary (default: en)")
    add("--quiet", action="store_true", help="print the prior check, errors and the last line only")
    return parser


if __name__ == "__main__":
    sys.exit(main())
