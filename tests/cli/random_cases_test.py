"""Random valid cases end with a result or a refusal, never in an internal error."""

from collections import Counter
from pathlib import Path

from random_cases import attempt, draw

SEEDS = range(16)


def test_random_cases_end_with_a_result_or_a_refusal_and_most_with_a_result(binary: Path, tmp_path: Path) -> None:
    """Refused cases test little."""
    codes: Counter[tuple[str, int]] = Counter()
    for seed in SEEDS:
        tested = attempt(binary, draw(seed, tmp_path / str(seed)))
        assert tested.faults == []
        codes += tested.codes
    for command in ("check", "run", "block"):
        assert codes[command, 0] >= len(SEEDS) / 2, codes
