"""Files that are there whole or not at all, whatever happens while they are written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_LONGEST_NAME = 200  # letters: file systems take 255, of the whole


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """Yield a name beside the path, of the same kind, to write to; it takes its place when that has gone well.

    The name is of this process, so that two reports of one run do not take each other's files away; it is one that the
    simulator knows (src/io/atomic_file.cpp): what a kill leaves goes with the run.
    """
    beside = path.with_name(f".{path.stem[:_LONGEST_NAME]}.{os.getpid()}.thawslide-part{path.suffix}")
    beside.unlink(missing_ok=True)  # of a process that is gone, or a link that leads elsewhere
    try:
        yield beside
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)
