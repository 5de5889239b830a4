"""Command `thawslide run CASE --pair`: the case on cells of 2h, 4h and h, and the errors of its results."""

from __future__ import annotations

import argparse
import math
import signal
import subprocess
import sys
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from thawslide import _core
from thawslide._core import UserError
from thawslide.case import toml_text
from thawslide.commands import print_line
from thawslide.errors import ReportError
from thawslide.maps import on_map
from thawslide.number_text import exact_text
from thawslide.pairs.output import JSON, PAGE, write_pair
from thawslide.program import find_program
from thawslide.run_folder import Run

_MISTAKE, _FAILED, _BY_SIGNAL = 2, 3, 128  # exit codes of the program
FACTORS = (2, 4, 1)  # cells over that of the case; the first run sets the map cell of all


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code: that of the program if a run fails."""
    given = _parser().parse_args(arguments)
    try:
        whole = _core.case_of(
            _core.read_case_files(str(Path(given.case).absolute())), [(each, str(Path.cwd())) for each in given.sets]
        )
        case = tomllib.loads(_core.resolved_toml(whole))
        cell, corner = float(case["grid"]["cell"]), _upper_corner(case["grid"])
        changes: dict[str, object] = {"grid.max": corner}
        if corner != case["grid"]["max"]:
            print_line(f"pair: grid.max is {toml_text(corner)} in all runs, a whole number of their largest cells")
        filtered = case["terrain"].get("smooth", 0.0) if case["terrain"]["type"] == "dem" else None
        if isinstance(filtered, float) and filtered < max(FACTORS) * cell:
            print_line(
                f"note: terrain.smooth is {exact_text(filtered)} m, less than the largest cells of "
                f"{exact_text(max(FACTORS) * cell)} m: the ground of the runs differs, and so do their results."
            )
        output = Path(given.output or Path("runs") / f"{whole.name}-pair")
        _prepare(output, given.overwrite)
        runs: dict[int, Run] = {}
        for factor in FACTORS:
            print_line(f"pair: cells of {exact_text(factor * cell)} m")
            folder = _folder(output, factor)
            code = _run(given, {**changes, "grid.cell": factor * cell}, folder)
            if code == 0:
                runs[factor] = run = Run(folder)
                if on_map(run):
                    changes["maps.cell"] = run.maps["max_thickness"].grid.cell_x
            elif factor != max(FACTORS) or code not in (_MISTAKE, _FAILED):
                return code
            else:
                print_line("note: without this run, no result is extrapolated.")
        text, files = write_pair(runs, cell, output)
    except (ReportError, UserError) as error:
        print_line(f"thawslide run --pair: error: {error}", sys.stderr)
        return 2
    print_line(f"\n{text}\n")
    for path in files:
        print_line(f"pair: {path}")
    return 0


def _folder(output: Path, factor: int) -> Path:
    return output / ("h" if factor == 1 else f"{factor}h")


def _prepare(output: Path, overwrite: bool) -> None:
    """Refuse existing runs unless they are to be replaced, and remove results of an earlier pair."""
    for factor in FACTORS:
        if not overwrite and (_folder(output, factor) / "run.json").exists():
            raise ReportError(
                f"{_folder(output, factor)}: has a run already. Add --overwrite, or select another --output."
            )
    for name in (PAGE, JSON):
        (output / name).unlink(missing_ok=True)


def _run(given: argparse.Namespace, changes: Mapping[str, object], folder: Path) -> int:
    """Run the case with changed keys; return the exit code of the program."""
    program = find_program()
    if program is None:
        raise ReportError("the program thawslide was not found. Install the package again, or put it on PATH.")
    words = [program, "run", given.case, "--output", str(folder), "--device", given.device]
    words += ["--overwrite"] if given.overwrite else []
    words += ["--threads", given.threads] if given.threads else []
    words += ["--end", given.end] if given.end else []
    sets = [each for each in given.sets if each.partition("=")[0].strip() not in changes]
    sets += [f"{key}={toml_text(value)}" for key, value in changes.items()]
    process = subprocess.Popen([*words, *(word for each in sets for word in ("--set", each))])
    signal.signal(signal.SIGTERM, lambda *_: process.terminate())
    while True:
        try:
            code = process.wait()
            return code if code >= 0 else _BY_SIGNAL - code
        except KeyboardInterrupt:  # the program has it too, and ends after its step, with a checkpoint
            continue


def _upper_corner(grid: Mapping[str, Any]) -> list[float]:
    """Return the upper corner [m] of a domain that is a whole number of the largest cells.

    It is lower by less than such a cell along the horizontal axes, because a DEM must cover it, and higher above.
    """
    largest = max(FACTORS) * float(grid["cell"])
    low, high = grid["min"], grid["max"]
    counts = [(b - a) / largest for a, b in zip(low, high, strict=True)]
    whole = [math.floor(count + 1e-9) for count in counts[:-1]] + [math.ceil(counts[-1] - 1e-9)]
    return [a + max(1, count) * largest for a, count in zip(low, whole, strict=True)]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="thawslide run --pair",
        description="Run a case on cells of twice, four times and once its size; report results with their errors.",
    )
    add = parser.add_argument
    add("case", metavar="CASE", help="case file, or the folder of a case.toml")
    add("--set", dest="sets", action="append", default=[], metavar="KEY=VALUE", help="as for run")
    for name in ("--threads", "--end", "--output"):
        add(name, help="as for run")
    add("--device", default="cpu", help="as for run")
    add("--overwrite", action="store_true", help="as for run")
    return parser


if __name__ == "__main__":
    sys.exit(main())
