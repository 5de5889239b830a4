"""A sweep from its design to its results."""

from __future__ import annotations

import contextlib
import copy
import hashlib
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from typing import Any

import pandas as pd

from thawslide import _core
from thawslide.case import Case
from thawslide.errors import ReportError, errors_with_parameters
from thawslide.simulation import print_message
from thawslide.sweeps.declared import declared_columns, limits_of_key
from thawslide.sweeps.design import FACTORIAL, Design, Member, parse_sample
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.folder import DONE, FAILED, FINISHED, INPUTS, SweepFolder
from thawslide.sweeps.labels import NUMBERS
from thawslide.sweeps.member import KEEPS, MemberInterruptedError, Task, tidy
from thawslide.sweeps.outcome import write_outcome
from thawslide.sweeps.page import NOT_RESULTS
from thawslide.sweeps.progress import Progress, standard_error
from thawslide.sweeps.results import table_of, write_table
from thawslide.sweeps.variables import Levels, Variable, distribution, levels, truncated

_DIGITS = 16  # of a digest in the plan


@dataclass(frozen=True)
class Options:
    """How a sweep is executed and which results it keeps."""

    output: Path | None = None
    is_block: bool = False
    expressions: tuple[Expression, ...] = ()
    keep: str = "maps"
    has_csv: bool = False
    workers: int = 0  # 0: one per core, as many as fit into memory
    scheduler: str | None = None
    max_failures: int | None = None
    retries_failed: bool = False
    shows_progress: bool = True
    results: tuple[str, ...] = ()  # columns whose sensitivity the page shows
    thresholds: Mapping[str, Sequence[float]] | None = None  # of the probability maps, by quantity
    report: Callable[[str], None] = field(default=print_message)


def sweep(
    cases: str | PathLike[str] | Sequence[str | PathLike[str]],
    output: str | PathLike[str] | None = None,
    *,
    vary: Mapping[str, Sequence[object]] | None = None,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    normal: Mapping[str, tuple[float, float]] | None = None,
    lognormal: Mapping[str, tuple[float, float]] | None = None,
    sample: str | None = None,
    seed: int = 0,
    tie: Mapping[str, str] | None = None,
    correlate: Mapping[tuple[str, str], float] | None = None,
    block: bool = False,
    columns: Mapping[str, str] | None = None,
    keep: str = "maps",
    results: Sequence[str] = (),
    thresholds: Mapping[str, Sequence[float]] | None = None,
    workers: int = 0,
    scheduler: str | None = None,
    max_failures: int | None = None,
    retry_failed: bool = False,
    progress: bool = True,
) -> pd.DataFrame:
    """Run a case many times with varied keys, as `thawslide sweep`.

    Parameters
    ----------
    cases : path, or sequence of paths
        A case, or several as values of the variable `case`.
    output : str or path, optional
        Folder of the sweep, by default runs/NAME-sweep; the same call continues an interrupted sweep in it.
    vary : mapping, optional
        Lists of values by key.
    ranges, normal, lognormal : mapping, optional
        Pairs of numbers that describe distributions, by key.
    sample : str, optional
        METHOD:N; without it the design is full factorial.
    seed : int
        Seed of the sample.
    tie : mapping, optional
        Expressions of other keys, by key.
    correlate : mapping, optional
        Rank correlations by pairs of keys.
    block : bool
        Simulate a rigid block instead.
    columns : mapping, optional
        Expressions of history columns, by name.
    keep : str
        "maps", "all" or "none".
    results : sequence of str
        Columns whose sensitivity the page shows.
    thresholds : mapping, optional
        Thresholds of the probability maps, by "thickness" and "speed".
    workers : int
        Processes; 0: one per core.
    scheduler : str, optional
        Address of a Dask scheduler.
    max_failures : int, optional
        The sweep ends if more members fail.
    retry_failed : bool
        Repeat members that have failed.
    progress : bool
        Print progress.

    Returns
    -------
    pandas.DataFrame
        The table of members, one row each.

    Raises
    ------
    UserError
        Before any member runs, for an invalid case.
    ReportError
        For an invalid design.

    Examples
    --------
    >>> angles = {"basal.friction_angle": [20, 25]}
    >>> table = sweep("cases/incline/D.toml", "runs/angles", vary=angles, block=True, workers=1, progress=False)
    >>> len(table)
    2

    """
    with errors_with_parameters():
        files = [cases] if isinstance(cases, str | PathLike) else list(cases)
        variables: list[Variable] = [levels(key, list(values)) for key, values in (vary or {}).items()]
        for kind, pairs in (("range", ranges), ("normal", normal), ("lognormal", lognormal)):
            variables += [
                distribution(kind, key, float(pair[0]), float(pair[1])) for key, pair in (pairs or {}).items()
            ]
        method, count = parse_sample(sample) if sample else (FACTORIAL, 0)
        ties = tuple(Expression(key, text, "--tie") for key, text in (tie or {}).items())
        correlations = tuple((*pair, float(value)) for pair, value in (correlate or {}).items())
        paths = tuple(absolute_case(file) for file in files)
        design = Design(paths, tuple(variables), method, count, seed, ties, correlations)
        options = Options(
            output=None if output is None else Path(output),
            is_block=block,
            expressions=tuple(Expression(name, text) for name, text in (columns or {}).items()),
            keep=keep,
            results=tuple(results),
            thresholds=thresholds,
            workers=workers,
            scheduler=scheduler,
            max_failures=max_failures,
            retries_failed=retry_failed,
            shows_progress=progress,
            report=print_message if progress else lambda line: None,
        )
        return run_sweep(design, options)[1]


def absolute_case(file: str | PathLike[str]) -> str:
    """Return the absolute path of a case file, because workers can have other working directories."""
    path = Path(fspath(file)).absolute()
    return str(path / "case.toml" if path.is_dir() else path)


def run_sweep(design: Design, options: Options) -> tuple[SweepFolder, pd.DataFrame]:
    """Validate all members, run those that have not finished, and write the table."""
    if options.keep not in KEEPS:
        raise ReportError(f"--keep: invalid (found {options.keep}; allowed {', '.join(KEEPS)}). Correct it.")
    design = _within_limits(design, options.report)
    members = design.members()
    cases = validated(members)
    _require_new_names(options.expressions, members[0].changes)
    _require_columns(options)
    folder = SweepFolder((options.output or Path(f"{_core.run_folder(cases[0]._core)}-sweep")).absolute())
    changed = folder.start(plan_of(design, members, options, cases))
    if changed:
        options.report(f"note: {len(changed)} of {len(members)} members run again, because their inputs have changed")
    tasks = [_task(member, case, folder, options) for member, case in zip(members, cases, strict=True)]
    if options.retries_failed:
        _forget_failed(folder, tasks)
    _execute(folder, tasks, members, options)
    table = table_of(folder, members)
    for path in write_table(table, folder.path, options.has_csv):
        options.report(f"table: {path}")
    write_outcome(folder, design, table, options.results, options.thresholds, options.keep, options.report)
    return folder, table


def _within_limits(design: Design, report: Callable[[str], None]) -> Design:
    """Return the design with distributions truncated at the limits of their keys, with a note for each."""
    variables = []
    for variable in design.variables:
        low, high = (-math.inf, math.inf) if isinstance(variable, Levels) else limits_of_key(variable.key)
        variables.append(truncated(variable, low, high))
        if variables[-1] != variable:
            ends = [f"{variables[-1].at(probability):.4g}" for probability in (0.0, 1.0)]
            report(f"note: {variable.key}: the distribution is truncated to {' to '.join(ends)}, the allowed values")
    return replace(design, variables=tuple(variables))


def validated(members: Sequence[Member]) -> list[Case]:
    """Return the case of each member; UserError for the first invalid one."""
    if not members:
        raise ReportError("no members. Vary at least one key.")
    originals = {file: Case(file) for file in {member.case_file: None for member in members}}
    cases = []
    for member in members:
        case = originals[member.case_file].copy()
        case.change(member.changes)
        cases.append(copy.copy(case))  # without the values read, which need more memory
    return cases


def plan_of(
    design: Design, members: Sequence[Member], options: Options, cases: Sequence[Case] | None = None
) -> dict[str, Any]:
    """Return the values that a repeated command must have in common with the first one.

    `inputs`: one digest per member. A member whose digest differs runs again.
    """
    digest = cache(lambda file: hashlib.sha256(Path(file).read_bytes()).digest())
    return {
        "version": _core.version,
        "program": digest(_core.__file__).hex(),  # of the build, and therefore of its compiler and settings
        "design": design.as_table(),
        "block": options.is_block,
        "columns": {each.name: each.text for each in options.expressions},
        "members": design.size,
        INPUTS: [_digest(case, digest) for case in cases or validated(members)],
    }


def _digest(case: Case, digest: Callable[[Path], bytes]) -> str:
    """Return a digest of a resolved case and of all its input files; the case files are part of the former."""
    content = hashlib.sha256(case.to_toml().encode())
    for file in case.input_files:
        content.update(file.name.encode() + digest(file))
    return content.hexdigest()[:_DIGITS]


def _require_new_names(expressions: Sequence[Expression], changes: Mapping[str, Any]) -> None:
    for each in expressions:
        if each.name in (*NOT_RESULTS, *NUMBERS, *changes) or each.name.startswith("probe_"):
            raise ReportError(f"--column {each.name}: the table has this column. Choose another name.")


def _require_columns(options: Options) -> None:
    """Raise ReportError for an expression of a column that no run has; without the program, each run checks it."""
    known = declared_columns(options.is_block) if options.expressions else []
    for each in options.expressions if known else ():
        each.require_columns(known)


def _task(member: Member, case: Case, folder: SweepFolder, options: Options) -> Task:
    expressions = {each.name: each.text for each in options.expressions}
    return Task(member.number, folder.path, case, options.is_block, expressions, options.keep)


def _forget_failed(folder: SweepFolder, tasks: Sequence[Task]) -> None:
    for task in tasks:
        if folder.record(task.number)["status"] == FAILED:
            folder.forget(task.number)


def _execute(folder: SweepFolder, tasks: Sequence[Task], members: Sequence[Member], options: Options) -> None:
    """Run the members that have not finished."""
    # Dask takes seconds to import, which a finished sweep and invalid arguments do not need.
    try:
        from thawslide.sweeps.engine import TooManyFailuresError, connected, perform_all
        from thawslide.sweeps.resources import bytes_of_worker, cores, workers_that_fit
    except ModuleNotFoundError as error:
        raise ReportError(
            f"a sweep needs the Python package {error.name}. Install it, e.g. with `pip install {error.name}`."
        ) from error

    states = {task.number: folder.record(task.number)["status"] for task in tasks}
    for task in tasks:
        if states[task.number] == DONE:
            tidy(task, folder.run_folder(task.number))
    left = [task for task in tasks if states[task.number] not in FINISHED]
    failed = sum(status == FAILED for status in states.values())
    if not left:
        options.report(f"all {len(tasks)} members have already finished")
        return
    workers = min(options.workers or cores(), len(left))
    if options.scheduler is None and not options.is_block:
        need = bytes_of_worker([member for member in members if states[member.number] not in FINISHED])
        fitting = workers_that_fit(workers, need)
        if need is None:
            options.report("note: the memory of a member is unknown: the program thawslide is not on PATH")
        else:
            options.report(f"memory: at most {need / 1e9:.2g} GB for each of {fitting} workers")
        workers = fitting
    options.report(f"{len(left)} of {len(tasks)} members to run")
    progress = Progress(
        len(tasks), len(tasks) - len(left), failed, standard_error() if options.shows_progress else None
    )
    try:
        with connected(options.scheduler, workers) as client:
            perform_all(left, client, progress, lambda task, record: _store(folder, task, record), options.max_failures)
    except TooManyFailuresError as error:
        write_table(table_of(folder, members), folder.path, options.has_csv)
        raise ReportError(
            f"{folder.path}: {progress.failed} members failed (allowed {options.max_failures}). Correct the case, and "
            f"repeat the command with --retry-failed."
        ) from error
    except MemberInterruptedError as error:
        with contextlib.suppress(ReportError):  # the disk can be full
            write_table(table_of(folder, members), folder.path, options.has_csv)
        raise ReportError(f"{error} All finished members are kept. To continue, repeat the command.") from error


def _store(folder: SweepFolder, task: Task, record: dict[str, Any]) -> None:
    """Write the record of a member that its workers could not write."""
    if record.pop("is_unrecorded", False):
        try:
            folder.write_record(task.number, folder.record(task.number) | record)
        except OSError as error:
            raise MemberInterruptedError(f"member {task.number}: its record cannot be written ({error}).") from error
