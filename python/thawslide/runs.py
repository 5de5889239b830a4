"""Runs of cases in folders, from Python: those of `thawslide run`, `resume` and `block`."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from os import PathLike, fspath

import pandas as pd

from thawslide import _core
from thawslide.case import Case, toml_text
from thawslide.errors import errors_with_parameters, with_parameters
from thawslide.run_folder import Run
from thawslide.simulation import print_message, require_threads

__all__ = ["block", "resume", "run"]


class _Lines(_core.Observer):
    """Prints the lines of a run, and its progress if requested; keeps the reason why it ended early."""

    def __init__(self, shows_progress: bool) -> None:
        super().__init__()
        self.shows_progress = shows_progress
        self.reason = ""
        self._is_drawn = False

    def text(self, line: str) -> None:
        if self.shows_progress or line.startswith(("warning: ", "note: ")):
            self.end_progress()
            print_message(with_parameters(line))

    def error(self, line: str) -> None:
        self.end_progress()
        self.reason = with_parameters(line)

    def progress(self, state: _core.ProgressState) -> None:
        if self.shows_progress:
            fraction = 100.0 * state.time / state.end
            print(f"\r{fraction:3.0f} % | {state.time:.1f} of {state.end:g} s", end="", file=sys.stderr, flush=True)
            self._is_drawn = True

    def end_progress(self) -> None:
        if self._is_drawn:
            print(file=sys.stderr)
            self._is_drawn = False


_ERRORS = {
    _core.ExitCode.USER_MISTAKE: _core.UserError,
    _core.ExitCode.NOT_WRITTEN: _core.WriteError,
    _core.ExitCode.DEVICE_FAILED: _core.DeviceError,
}


def _run_of(folder: str, work: Callable[[], _core.ExitCode], lines: _Lines) -> Run:
    """Return the run in a folder after its work, or raise the error that ended it early."""
    try:
        with errors_with_parameters():
            code = work()
    except KeyboardInterrupt as interrupt:
        raise KeyboardInterrupt(lines.reason) from interrupt
    if code in _ERRORS:
        raise _ERRORS[code](lines.reason.removeprefix("error: "))
    return Run(folder)


def run(
    case: Case | str | PathLike[str],
    output: str | PathLike[str] | None = None,
    *,
    overwrite: bool = False,
    threads: int = 0,
    device: str = "cpu",
    progress: bool = True,
) -> Run:
    """Run a case to its end in a folder, as `thawslide run`.

    Parameters
    ----------
    case : Case, str or path
        The case, its file or its folder.
    output : str or path, optional
        The folder, by default runs/NAME.
    overwrite : bool
        Replace the run in the folder.
    threads : int
        Threads to use at most; 0: all cores.
    device : str
        "cpu", "gpu" or "auto".
    progress : bool
        Print progress and all lines of the run; otherwise warnings and notes only.

    Returns
    -------
    Run
        The run in its folder.

    Raises
    ------
    UserError
        Before any file is written.
    RunError
        If the run fails.
    WriteError
        If a file cannot be written.
    DeviceError
        If a GPU fails.
    KeyboardInterrupt
        At Ctrl-C. Results so far are complete in each case, and `resume` continues the run.

    Examples
    --------
    >>> done = run("cases/block/e100.toml", "runs/block", overwrite=True, progress=False)
    >>> done.is_complete
    True

    """
    case = case if isinstance(case, Case) else Case(case)
    folder = _core.run_folder(case._core) if output is None else fspath(output)
    require_threads(threads)
    lines = _Lines(progress)
    core = case._core
    return _run_of(folder, lambda: _core.start_run(core, folder, overwrite, device, threads, lines), lines)


def resume(
    folder: str | PathLike[str],
    changes: Mapping[str, object] | None = None,
    *,
    threads: int = 0,
    device: str = "cpu",
    progress: bool = True,
) -> Run:
    """Continue a run from its checkpoint to its end, as `thawslide resume`.

    Parameters
    ----------
    folder : str or path
        The folder of the run.
    changes : mapping, optional
        Keys that change for the rest of the run, with their values.
    threads, device, progress
        As in `run`.

    Returns
    -------
    Run
        The run.

    Raises
    ------
    UserError, RunError, WriteError, DeviceError
        As `run`.

    Examples
    --------
    >>> done = resume("runs/block", {"time.end": 2.0})  # doctest: +SKIP

    """
    require_threads(threads)
    lines = _Lines(progress)
    sets = [f"{key}={toml_text(value)}" for key, value in (changes or {}).items()]
    path = fspath(folder)
    return _run_of(path, lambda: _core.resume_run(path, sets, device, threads, lines), lines)


def block(case: Case | str | PathLike[str], *, threads: int = 1) -> pd.DataFrame:
    """Simulate a case as a rigid block, as `thawslide block`.

    Parameters
    ----------
    case : Case, str or path
        The case, its file or its folder.
    threads : int
        Threads to use at most.

    Returns
    -------
    pandas.DataFrame
        One row per time.

    Raises
    ------
    UserError
        For an invalid case, or one without a block.

    Examples
    --------
    >>> rows = block("cases/incline/D.toml")
    >>> bool(rows["velocity_m_s"].max() > 0.0)
    True

    """
    require_threads(threads)
    case = case if isinstance(case, Case) else Case(case)
    with errors_with_parameters():
        return pd.DataFrame(_core.block(case._core, _Lines(False), threads))
