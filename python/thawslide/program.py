"""Program thawslide of the package, or of a clone of the repository, and the command that executes it."""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
PROGRAMS = (PACKAGE / "thawslide", PACKAGE.parents[1] / "build" / "release" / "thawslide")


def find_program() -> str | None:
    """Return the path of the program: that which started this process, that of this package, or that on PATH."""
    starter = os.environ.get("THAWSLIDE_PROGRAM", "")
    if os.access(starter, os.X_OK):
        return starter
    own = _own_program()
    return str(own) if own is not None else shutil.which("thawslide")


def main() -> int:
    """Replace this process by the program; return an exit code only if there is none."""
    program = _own_program()  # not that on PATH, which can be this command
    if program is None:
        print(
            f"error: {PROGRAMS[0]}: the program is missing from the Python package. "
            "Install the package again, or run ./run --setup in a clone of the repository.",
            file=sys.stderr,
        )
        return 2
    called = Path(sys.argv[0])
    found = shutil.which(called.name)
    name = called.name if found and Path(found).samefile(called) else sys.argv[0]  # as the user called it
    # thawslide-report is installed next to this command.
    path = os.pathsep.join([str(called.resolve().parent), os.environ.get("PATH", os.defpath)])
    os.execve(program, [name, *sys.argv[1:]], {**os.environ, "PATH": path})


def _own_program() -> Path | None:
    return next((each for each in PROGRAMS if os.access(each, os.X_OK)), None)
