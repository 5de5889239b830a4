"""Pages of runs, as `thawslide report` writes them: the report of one run, its summary, or a comparison."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path

from thawslide.errors import ReportError, errors_with_parameters, nearest, quoted
from thawslide.figures import FIGURES
from thawslide.messages import LANGUAGES
from thawslide.pages.comparison import make_comparison
from thawslide.pages.summary import make_summary
from thawslide.report_page import make_report
from thawslide.run_folder import Run

__all__ = ["Pages", "figure_names", "report", "write_pages"]

LEAST_DPI, MOST_DPI = 30, 1200


@dataclass
class Pages:
    """Written pages with their kinds, and the reasons for figures that are missing because of damaged files."""

    files: list[tuple[str, Path]]
    faults: dict[str, str] = field(default_factory=dict)


def figure_names(only: str | Sequence[str] | None) -> list[str] | None:
    """Return the figure names of --only, in the order of the page; ReportError for an unknown one."""
    if not only:
        return None
    texts = [only] if isinstance(only, str) else only
    asked = [name.strip() for text in texts for name in text.split(",") if name.strip()]
    for name in asked:
        if name not in FIGURES:
            raise ReportError(
                f"--only: no figure {quoted(name)}{nearest(name, FIGURES)} Allowed: {', '.join(FIGURES)}."
            )
    if not asked:
        raise ReportError(f"--only: no figure name. Allowed: {', '.join(FIGURES)}.")
    return [name for name in FIGURES if name in asked]


def write_pages(
    runs: Sequence[Run],
    output: Path | None,
    names: list[str] | None,
    brief: bool,
    dpi: int,
    progress: Callable[[str], None] = lambda line: None,
    language: str = LANGUAGES[0],
) -> Pages:
    """Write the page of one run, its summary if `brief`, or the comparison of several runs.

    `language` is that of results and summary.
    """
    if len(runs) > 1:
        for option, value in (("--only", names), ("--brief", brief), ("--language", language != LANGUAGES[0])):
            if value:
                raise ReportError(f"{option}: allowed with one RUN only (found {len(runs)}). Remove the option.")
        return Pages([("comparison", make_comparison(list(runs), output, dpi, progress=progress))])
    if brief:
        if names:
            raise ReportError("--only: not allowed with --brief. Remove one of the options.")
        return Pages([("summary", path) for path in make_summary(runs[0], output, dpi, language)])
    made = make_report(runs[0], output, names, dpi, progress, language)
    return Pages([("report", made.page)], {name: made.missing[name] for name in made.faults})


def report(
    run: Run | str | PathLike[str],
    *others: Run | str | PathLike[str],
    output: str | PathLike[str] | None = None,
    only: str | Sequence[str] | None = None,
    brief: bool = False,
    dpi: int = 150,
    language: str = LANGUAGES[0],
) -> Path:
    """Write the page of a run with its figures, as `thawslide report`.

    Parameters
    ----------
    run : Run, str or path
        The run or its folder.
    *others : Run, str or path
        Other runs, with which the page compares the first one.
    output : str or path, optional
        The folder of the page, by default that of the first run.
    only : str or sequence of str, optional
        Names of figures to plot again; the page keeps the others.
    brief : bool
        Write a two-page summary for readers without a technical background, as a page and a PDF file.
    dpi : int
        Resolution of the figures, 30 to 1200 dots per inch.
    language : str
        Language of the results and the summary: "en", "de" or "fr".

    Returns
    -------
    Path
        The page. It names damaged files, and `Run.warnings` lists them.

    Raises
    ------
    ReportError
        For invalid parameters, and a folder that is no run or cannot be read.

    Examples
    --------
    >>> done = run("cases/block/e100.toml", "runs/report", progress=False)
    >>> report(done, only="motion").name
    'report.html'

    """
    if language not in LANGUAGES:
        allowed = ", ".join(LANGUAGES)
        raise ReportError(f"language: unknown (found {quoted(language)}; allowed {allowed}). Correct it.")
    if not LEAST_DPI <= dpi <= MOST_DPI:
        raise ReportError(f"dpi: not a valid resolution (found {dpi}; allowed {LEAST_DPI} to {MOST_DPI}). Correct it.")
    folder = None if output is None else Path(output)
    with errors_with_parameters():
        names = figure_names(only)
        runs = [each if isinstance(each, Run) else Run(Path(each), skip_damaged=True) for each in (run, *others)]
        return write_pages(runs, folder, names, brief, dpi, language=language).files[0][1]
