"""Entry points of the commands of the Python package. Each ends with a message, also after an unexpected error."""

from __future__ import annotations

import os
import sys
import tempfile
import traceback
from importlib import import_module, metadata
from pathlib import Path
from typing import TextIO

from thawslide.errors import ReportError, printable

_INTERNAL, _USER_MISTAKE, _INTERRUPTED = 1, 2, 4  # exit codes, as those of the program


def report() -> int:
    """Run `thawslide report`."""
    return run_command("thawslide-report", "thawslide.command_line")


def scarp() -> int:
    """Run `thawslide scarp`."""
    return run_command("thawslide scarp", "thawslide.scarps.command")


def sweep() -> int:
    """Run `thawslide sweep`."""
    return run_command("thawslide sweep", "thawslide.sweeps.command")


def probability() -> int:
    """Run `thawslide probability`."""
    return run_command("thawslide probability", "thawslide.sweeps.probability_command")


def score() -> int:
    """Run `thawslide score`."""
    return run_command("thawslide score", "thawslide.scores.command")


def forecast() -> int:
    """Run `thawslide forecast`."""
    return run_command("thawslide forecast", "thawslide.forecasts.command")


def terrain() -> int:
    """Run `thawslide terrain`."""
    return run_command("thawslide terrain", "thawslide.handover.command", "terrain")


def export() -> int:
    """Run `thawslide export`."""
    return run_command("thawslide export", "thawslide.handover.command", "export")


def assets() -> int:
    """Run `thawslide assets`."""
    return run_command("thawslide assets", "thawslide.handover.command", "assets")


def pair() -> int:
    """Run `thawslide run --pair`."""
    return run_command("thawslide run --pair", "thawslide.pairs.command")


def forget_missing_proj_data() -> None:
    """Remove PROJ_LIB and PROJ_DATA from the environment if they name no database: rasterio has one of its own."""
    for variable in ("PROJ_LIB", "PROJ_DATA"):
        folders = os.environ.get(variable, "").split(os.pathsep)
        if not any(folder and Path(folder, "proj.db").is_file() for folder in folders):
            os.environ.pop(variable, None)


def run_command(name: str, module: str, function: str = "main") -> int:
    """Import a module and run a function of it; return the exit code, 1 for an internal error."""
    forget_missing_proj_data()
    try:
        import_module("matplotlib")
    except Exception as error:
        print_line(
            f"{name}: error: matplotlib cannot be loaded ({error}). Correct the file matplotlibrc, or the environment "
            f"variable MPLBACKEND.",
            sys.stderr,
        )
        return _USER_MISTAKE
    try:
        return int(getattr(import_module(module), function)())
    except Exception as error:
        code, text = _explained(error)
    except KeyboardInterrupt:
        code, text = _INTERRUPTED, "interrupted."
    print_line(f"{name}: error: {text}", sys.stderr)
    return code


def _explained(error: Exception) -> tuple[int, str]:
    """Return exit code and message of an error that a command has not handled."""
    core = sys.modules.get("thawslide._core")
    if isinstance(error, (ReportError, core.UserError) if core else ReportError):
        return _USER_MISTAKE, str(error)
    if isinstance(error, ModuleNotFoundError) and not (error.name or "thawslide").startswith("thawslide"):
        return _USER_MISTAKE, f"the Python package {error.name} is missing. Install it, e.g. by ./run --setup."
    if isinstance(error, MemoryError):
        return _USER_MISTAKE, "the memory of this machine is not enough. Use smaller maps, or fewer workers."
    if isinstance(error, OSError) and error.strerror and error.filename is not None:
        return _USER_MISTAKE, f"{os.fsdecode(error.filename)}: {error.strerror}. Correct the path or its permissions."
    text = f"thawslide {metadata.version('thawslide')}, Python {sys.version}\n{sys.argv}\n{traceback.format_exc()}"
    try:
        with tempfile.NamedTemporaryFile(prefix="thawslide-error-", suffix=".log", delete=False) as file:
            file.write(text.encode(errors="backslashreplace"))
        place = file.name
    except OSError:  # no folder for temporary files
        place = f"this text:\n{text}"
    return _INTERNAL, f"internal error ({type(error).__name__}: {error}). Please report it, with {place}"


def print_line(line: str, stream: TextIO | None = None) -> None:
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
