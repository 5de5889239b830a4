"""Valid cases drawn at random end with a result or a refusal, never in an internal error."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from random_cases import attempt, draw

SEEDS = range(16)


def test_random_cases_end_with_a_result_or_a_refusal_and_most_with_a_result(binary: Path, tmp_path: Path) -> None:
    """A case that is refused at once tests little."""
    codes: Counter[tuple[str, int]] = Counter()
    for seed in SEEDS:
        tried = attempt(binary, draw(seed, tmp_path / str(seed)))
        assert tried.faults == []
        codes += tried.codes
    for command in ("check", "run", "block"):
        assert codes[command, 0] >= len(SEEDS) / 2, codes
