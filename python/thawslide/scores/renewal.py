"""Score of a sweep whose members or weights may have changed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from thawslide._core import UserError
from thawslide.errors import ReportError
from thawslide.scores.forecast import read_forecast
from thawslide.scores.observed import read_observed
from thawslide.scores.output import FILES, JSON, write_score
from thawslide.scores.score import compute_score
from thawslide.text_files import MEGABYTE, read_json


def renew_score(folder: Path, report: Callable[[str], None]) -> None:
    """Compute the score in a folder again with its observations, or remove it if that is impossible."""
    path = folder / JSON
    if not path.is_file():
        return
    try:
        observed = read_observed(Path(str(read_json(path, MEGABYTE).get("observed", ""))))
        write_score(compute_score(read_forecast(folder), observed), folder)
        report(f"score: {path}")
    except (ReportError, UserError, AttributeError) as error:
        for name in FILES:
            (folder / name).unlink(missing_ok=True)
        report(
            f"warning: {path}: removed, because it is of other members or weights ({error}). Repeat thawslide score."
        )
