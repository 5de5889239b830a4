"""Simulate rock-ice avalanches, and read, plot and report runs."""

import os
from importlib import import_module
from typing import TYPE_CHECKING, Any

from thawslide.errors import NotInRunError, ReportError
from thawslide.run_folder import Run, Snapshot, Target

if TYPE_CHECKING:
    from thawslide._core import DeviceError, RunError, UserError, WriteError
    from thawslide._core import version as __version__
    from thawslide.basal_law import ContactNodes
    from thawslide.case import Case
    from thawslide.logger import Logger
    from thawslide.new_cases import new_case
    from thawslide.reports import report
    from thawslide.runs import block, resume, run
    from thawslide.scarps.release import scarp
    from thawslide.simulation import Simulation
    from thawslide.sweeps.api import sweep

__all__ = [
    "Case",
    "ContactNodes",
    "DeviceError",
    "Logger",
    "NotInRunError",
    "ReportError",
    "Run",
    "RunError",
    "Simulation",
    "Snapshot",
    "Target",
    "UserError",
    "WriteError",
    "__version__",
    "block",
    "new_case",
    "report",
    "resume",
    "run",
    "scarp",
    "sweep",
]

# Waiting threads of the extension module sleep after a few microseconds, as those of the program do: otherwise steps
# slow down much on a busy machine. OpenMP reads the settings when the module is loaded.
if "OMP_WAIT_POLICY" not in os.environ:
    os.environ["OMP_WAIT_POLICY"] = "passive"
    os.environ.setdefault("GOMP_SPINCOUNT", "1000")

# Modules of the names that are loaded at first use: the reader of runs works without the extension module, and starts
# faster without pandas.
_HOMES = {
    "Case": "case",
    "ContactNodes": "basal_law",
    "DeviceError": "_core",
    "Logger": "logger",
    "RunError": "_core",
    "Simulation": "simulation",
    "UserError": "_core",
    "WriteError": "_core",
    "block": "runs",
    "new_case": "new_cases",
    "report": "reports",
    "resume": "runs",
    "run": "runs",
    "scarp": "scarps.release",
    "sweep": "sweeps.api",
}


def __dir__() -> list[str]:
    return __all__


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("thawslide._core").version
    if name not in _HOMES:
        raise AttributeError(f"module 'thawslide' has no attribute {name!r}")
    return getattr(import_module(f"thawslide.{_HOMES[name]}"), name)
