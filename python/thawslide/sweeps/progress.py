"""Progress of a sweep: finished, failed and running members, and the time left."""

from __future__ import annotations

import sys
import threading
import time
from typing import TextIO

_TERMINAL_INTERVAL, _FILE_INTERVAL = 0.5, 60.0  # seconds between two lines
_MOST_SHOWN = 8  # running members
_LEAST_DONE = 0.05  # members, before the time left is estimated


class Progress:
    """Counts members and prints a line: overwritten on a terminal, at long intervals otherwise."""

    def __init__(self, total: int, finished: int, failed: int, stream: TextIO | None = None) -> None:
        self.total, self.finished, self.failed = total, finished, failed
        self._before = finished
        self._fractions: dict[int, float] = {}
        self._stream = stream
        self._began = self._printed = time.monotonic()
        self._is_drawn = False
        self._lock = threading.Lock()

    def advance(self, number: int, fraction: float) -> None:
        """Set the simulated fraction of a running member."""
        with self._lock:
            self._fractions[number] = fraction
            self._print()

    def finish(self, number: int, has_failed: bool) -> None:
        """Count a member as finished."""
        with self._lock:
            self._fractions.pop(number, None)
            self.finished += 1
            self.failed += has_failed
            self._print()

    def end(self) -> None:
        """Print the last state and end the line."""
        with self._lock:
            self._fractions.clear()
            self._print(is_last=True)

    def text(self) -> str:
        """Return the state as one line."""
        running = [f"{number}: {100.0 * part:.0f} %" for number, part in sorted(self._fractions.items())]
        more = f", and {len(running) - _MOST_SHOWN} more" if len(running) > _MOST_SHOWN else ""
        parts = [f"{self.finished} of {self.total} members finished"]
        if self.failed:
            parts.append(f"{self.failed} failed")
        if running:
            parts.append(f"running {', '.join(running[:_MOST_SHOWN])}{more}")
        if (left := self.seconds_left()) is not None and self.finished < self.total:
            parts.append(f"{_duration(left)} left")
        return " | ".join(parts)

    def seconds_left(self) -> float | None:
        """Return the time left [s] at the mean speed so far, None at the start."""
        done = self.finished - self._before + sum(self._fractions.values())
        if done < _LEAST_DONE:
            return None
        left = self.total - self.finished - sum(self._fractions.values())
        return max(0.0, left) * (time.monotonic() - self._began) / done

    def _print(self, is_last: bool = False) -> None:
        if self._stream is None:
            return
        now, is_terminal = time.monotonic(), self._stream.isatty()
        if not is_last and now - self._printed < (_TERMINAL_INTERVAL if is_terminal else _FILE_INTERVAL):
            return
        self._printed = now
        if is_terminal:
            print(f"\r\x1b[2K{self.text()}", end="\n" if is_last else "", file=self._stream, flush=True)
        else:
            print(self.text(), file=self._stream, flush=True)


def _duration(seconds: float) -> str:
    """Return a duration such as 1 h 05 min, 12 min or 40 s."""
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60:02d} min"


def standard_error() -> TextIO | None:
    """Return the stream of the progress."""
    return sys.stderr
