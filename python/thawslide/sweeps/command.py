"""Command `thawslide sweep`: exit code 0 for success, 2 for errors of the user, 3 for failed members, 4 for Ctrl-C."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from thawslide._core import UserError
from thawslide.commands import print_line
from thawslide.errors import ReportError, quoted
from thawslide.sweeps.api import Options, absolute_case, run_sweep
from thawslide.sweeps.design import FACTORIAL, METHODS, Design, parse_correlation, parse_sample
from thawslide.sweeps.design_file import DISTRIBUTIONS, is_sweep_file, read_sweep_file
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.folder import DONE, FAILED
from thawslide.sweeps.member import KEEPS
from thawslide.sweeps.probability_command import numbers
from thawslide.sweeps.variables import (
    Levels,
    Variable,
    parse_distribution,
    parse_levels,
    toml_value,
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    given = _parser().parse_args(arguments)
    try:
        design, options = _from_file(given) if _has_sweep_file(given.case) else _from_arguments(given)
        _, table = run_sweep(design, options)
    except (ReportError, UserError) as error:
        _print(f"thawslide sweep: error: {error}")
        return 2
    except KeyboardInterrupt:
        _print("interrupted. All finished members are kept. To continue, repeat the command.")
        return 4
    return report_members(table, "thawslide sweep")


def report_members(table: pd.DataFrame, command: str) -> int:
    """Print how many members are done, and the errors of those that failed; return the exit code."""
    count = {status: int((table["status"] == status).sum()) for status in (DONE, FAILED)}
    _print(f"{count[DONE]} members done, {count[FAILED]} failed")
    for row in table[table["status"] == FAILED].head(_MOST_ERRORS).itertuples():
        _print(f"{command}: error: member {row.member}: {row.error}")
    return 3 if count[FAILED] else 0


_MOST_ERRORS = 10  # printed; the table contains all


def _print(line: str) -> None:
    print_line(line, sys.stderr)


def _has_sweep_file(cases: Sequence[str]) -> bool:
    return len(cases) == 1 and is_sweep_file(Path(cases[0]))


def _options(given: argparse.Namespace, is_block: bool, expressions: Sequence[Expression]) -> Options:
    return Options(
        output=given.output,
        is_block=is_block,
        expressions=tuple(expressions),
        keep=given.keep,
        has_csv=given.csv,
        workers=given.workers,
        scheduler=given.scheduler,
        max_failures=given.max_failures,
        retries_failed=given.retry_failed,
        shows_progress=not given.quiet,
        results=tuple(given.results),
        thresholds={name: values for name in ("thickness", "speed") if (values := getattr(given, name))} or None,
        report=_print if not given.quiet else lambda line: None,
    )


def _from_arguments(given: argparse.Namespace) -> tuple[Design, Options]:
    variables: list[Variable] = [*map(parse_levels, given.vary), *_constants(given.set)]
    for kind in DISTRIBUTIONS:
        variables += [parse_distribution(kind, text) for text in getattr(given, kind)]
    method, count = parse_sample(given.sample) if given.sample else (FACTORIAL, 0)
    cases = tuple(absolute_case(case) for case in given.case)
    ties = tuple(Expression.parse(text, "--tie") for text in given.tie)
    correlations = tuple(map(parse_correlation, given.correlate))
    design = Design(cases, tuple(variables), method, count, given.seed or 0, ties, correlations)
    return design, _options(given, given.block, [Expression.parse(text) for text in given.column])


def _constants(texts: Sequence[str]) -> list[Levels]:
    """Read KEY=VALUE of --set."""
    found = []
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals:
            raise ReportError(f"--set: invalid (found {quoted(text)}). Specify KEY=VALUE.")
        found.append(Levels(key.strip(), (toml_value(value.strip()),)))
    return found


def _from_file(given: argparse.Namespace) -> tuple[Design, Options]:
    path = Path(given.case[0])
    options = ("vary", "set", "sample", "column", "tie", "correlate", *DISTRIBUTIONS)
    if any(getattr(given, option) for option in options):
        raise ReportError(f"{path}: specifies the design. Remove --vary, --sample and the other design options.")
    found = read_sweep_file(path, given.seed)
    return found.design, _options(given, given.block or found.is_block, found.expressions)


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def whole_number(text: str) -> int:
    """Read a whole number of at least 0, for argparse."""
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"not a whole number of at least 0 (found {quoted(text)})")
    return int(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide sweep",
        description="Run a case many times with varied keys. The same command continues an interrupted sweep.",
    )
    add = parser.add_argument
    add("case", metavar="CASE", nargs="+", help="case files or folders; or one TOML file with a table [sweep]")
    add("--vary", metavar="KEY=VALUES", action="append", default=[], help="values A,B,C or LOW:HIGH:STEP of a key")
    add("--set", metavar="KEY=VALUE", action="append", default=[], help="value of a key for all members")
    add("--range", metavar="KEY=LOW:HIGH", action="append", default=[], help="uniform distribution")
    add("--normal", metavar="KEY=MEAN:SD", action="append", default=[], help="normal, truncated at 3 SD")
    add(
        "--lognormal", metavar="KEY=MEDIAN:SIGMA", action="append", default=[],
        help="lognormal: SIGMA is the standard deviation of the natural logarithm, truncated at 3 SIGMA",
    )  # fmt: skip
    add("--tie", metavar="KEY=EXPRESSION", action="append", default=[], help="key computed from varied and set keys")
    add(
        "--correlate", metavar="KEY,KEY=NUMBER", action="append", default=[],
        help="rank correlation of two varied keys, between -1 and 1, of a sample lhs or sobol",
    )  # fmt: skip
    forms = ", ".join(f"{method}:N" for method in METHODS)
    add("--sample", metavar="METHOD:N", help=f"sample instead of all combinations: {forms}")
    add("--seed", type=whole_number, help="seed of the sample (default: 0)")
    add("--output", metavar="DIR", type=Path, help="folder of the sweep (default: runs/NAME-sweep)")
    add("--block", action="store_true", help="simulate a rigid block instead, as `thawslide block`")
    add("--column", metavar="NAME=EXPRESSION", action="append", default=[], help="column computed from the history")
    add("--keep", choices=KEEPS, default="maps", help="files of each member to keep (default: maps)")
    add("--results", metavar="COLUMN,...", type=_names, default=(), help="columns whose sensitivity the page shows")
    add("--thickness", metavar="M,...", type=numbers, help="thresholds of probability maps [m] (default: 0.5,1,5)")
    add("--speed", metavar="M/S,...", type=numbers, help="thresholds of probability maps [m/s] (default: 1,5,10)")
    add("--csv", action="store_true", help="write the table as CSV too")
    add("--workers", type=whole_number, default=0, help="processes (default: one per core, as many as fit into memory)")
    add("--scheduler", metavar="ADDRESS", help="Dask scheduler to use, e.g. tcp://node1:8786")
    add("--max-failures", metavar="N", type=whole_number, help="stop after more than N failed members")
    add("--retry-failed", action="store_true", help="repeat the members that have failed")
    add("--quiet", action="store_true", help="print errors and the last line only")
    return parser


if __name__ == "__main__":
    sys.exit(main())
