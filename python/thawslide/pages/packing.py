"""Arrays of an interactive view, packed into the page: 16-bit numbers between two ends, compressed, as text.

With the ends lo and hi of an array, the number q represents lo + (hi - lo) q / 65,534; 65,535 is no value. The error is
at most (hi - lo) / 131,068.
"""

from __future__ import annotations

import base64
import gzip
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from thawslide.run_folder import Numbers

_STEPS = 65_534
_NO_VALUE = 65_535


@dataclass
class Packing:
    """Arrays one after another; `add` returns where the page finds one."""

    parts: list[bytes] = field(default_factory=list)
    count: int = 0

    def add(self, values: Numbers) -> list[float]:
        """Append an array; return its first place, its length, and its ends."""
        numbers = np.asarray(values, dtype=np.float64).ravel()
        finite = numbers[np.isfinite(numbers)]
        low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
        steps = np.full(numbers.shape, _NO_VALUE, dtype="<u2")
        scaled = (finite - low) * (_STEPS / (high - low)) if high > low else np.zeros(finite.shape)
        steps[np.isfinite(numbers)] = np.rint(scaled).astype("<u2")
        place = [self.count, numbers.size, low, high]
        self.parts.append(steps.tobytes())
        self.count += numbers.size
        return place

    def text(self) -> str:
        """Return all arrays as base64 of gzip."""
        return compressed(b"".join(self.parts))


def compressed(data: bytes) -> str:
    """Return bytes as base64 of gzip, the same for the same bytes."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def unpacked(text: str, place: list[Any]) -> Numbers:
    """Return an array of a packed text, as the script of the page does."""
    start, count, low, high = place
    steps = np.frombuffer(gzip.decompress(base64.b64decode(text)), dtype="<u2")[start : start + count]
    values = low + (high - low) * (steps / _STEPS)
    return np.where(steps == _NO_VALUE, np.nan, values)
