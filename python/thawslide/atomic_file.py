"""Atomic files: complete or absent, even if writing is interrupted."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_LONGEST_NAME = 200  # characters: file systems allow 255 for the full name


@contextmanager
def atomic_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path in the same folder, which is renamed to the final path on success.

    The name contains the process number, so that two reports of one run do not collide. Its form is that of the
    simulator (src/base/atomic_file.cpp), which removes temporary files together with the run.
    """
    temporary = path.with_name(f".{path.stem[:_LONGEST_NAME]}.{os.getpid()}.thawslide-part{path.suffix}")
    temporary.unlink(missing_ok=True)  # of a terminated process, or a link to another place
    try:
        yield temporary
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
