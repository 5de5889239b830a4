"""The mistakes that new users make most, and word for word what they are told: for tests and the page of reliability."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class CommonMistake:
    """One change of a sound case (conftest.SMALL_CASE), and the message; {case} stands for its folder."""

    name: str
    said: str
    old: str = ""
    new: str = ""
    words: tuple[str, ...] = ()
    files: dict[str, str] = field(default_factory=dict)
