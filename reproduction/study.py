"""Studies: pages of results with the runs, inputs and functions that make them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cached_property
from pathlib import Path

from reproduction.engine import Report, Task, perform, version_of
from thawslide.errors import ReportError

ROOT = Path(__file__).resolve().parents[1]


class StudyError(ReportError):
    """Study whose pages cannot be written; the other studies continue."""


@dataclass(frozen=True)
class Job:
    """A run of `thawslide`: name of its folder, words for tables, changes by --set, and case file.

    The subcommand is `run`, with a folder as output, or `block`, with a CSV file. `cost` is the relative run time.
    """

    key: str
    words: str = ""
    sets: tuple[str, ...] = ()
    case: str = "case.toml"
    subcommand: str = "run"
    cost: float = 1.0
    until_rest: bool = False


@dataclass(frozen=True)
class Place:
    """The program, data and folders of a study, and the options of the command line."""

    program: Path
    runs: Path
    pages: Path  # root of the pages: the repository, or a separate folder for --quick
    data: Path = ROOT.parent / "shared" / "data"
    cases: Path = ROOT
    report: Report = print
    at_a_time: int = 2
    is_quick: bool = False
    draws_only: bool = False
    corrects: bool = False
    tolerates_failures: bool = False
    avaframe: Path | None = None
    parts: tuple[str, ...] = ()  # patterns of selected runs or parts; empty: all

    @cached_property
    def version(self) -> str:
        """The version of the program."""
        return version_of(self.program)

    def page(self, name: str) -> Path:
        """Return the path of a page or a figure; its folder exists."""
        path = self.pages / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def is_chosen(self, name: str) -> bool:
        """Return whether a run or a part is selected."""
        return not self.parts or any(fnmatch(name, part) for part in self.parts)

    def task(self, job: Job) -> Task:
        """Return the process of a job, on one thread."""
        results = self.runs / (job.key if job.subcommand == "run" else f"{job.key}.csv")
        case = self.cases / job.case
        words = [str(self.program), job.subcommand, str(case), "--output", str(results)]
        words += ["--threads", "1"] if job.subcommand == "run" else []
        words += [word for key in job.sets for word in ("--set", key)]
        return Task(job.key, tuple(words), results, self.version, (case,), job.cost, job.until_rest)

    def perform(self, jobs: Sequence[Job | Task]) -> list[str]:
        """Execute the selected runs that are missing; return a message for each failed one.

        StudyError if one failed, unless the study tolerates failures.
        """
        tasks = [job if isinstance(job, Task) else self.task(job) for job in jobs]
        chosen = [task for task in tasks if self.is_chosen(task.key)]
        failed = perform(chosen, self.at_a_time, self.report) if chosen else []
        if failed and not self.tolerates_failures:
            raise StudyError("; ".join(failed) + f". The logs are in {self.runs}.")
        return failed


Stage = Callable[[Place], Sequence[Job | Task]]


def nothing(_: Place) -> list[Path]:
    """Return no inputs."""
    return []


@dataclass(frozen=True)
class Study:
    """Pages of results: the stages of runs, and the function that writes pages and figures from finished runs.

    A stage writes its inputs and returns its runs, which may depend on the runs of the stages before. `write` returns
    problems that it found, such as numbers that differ.
    """

    name: str
    pages: tuple[str, ...]  # below the root of the repository
    minutes: float  # of processor time
    write: Callable[[Place], Sequence[str] | None]
    stages: tuple[Stage, ...] = ()
    needs: Callable[[Place], list[Path]] = nothing  # files and folders that must exist
    remedy: str = ""  # if one is absent
    cases: Path = ROOT  # folder of the case files
    folder: str = ""  # of the runs; default: pages/NAME
    tolerates_failures: bool = False  # its page states failed runs
    is_frozen: bool = False  # made only if it is named

    def absent(self, place: Place) -> list[Path]:
        """Return the inputs that do not exist."""
        return [path for path in self.needs(place) if not path.exists()]

    def make(self, place: Place) -> list[str]:
        """Perform the missing runs and write the pages; return problems."""
        for stage in () if place.draws_only else self.stages:
            place.perform(stage(place))
        try:
            return list(self.write(place) or ())
        except (LookupError, OSError) as error:
            if not place.draws_only:
                raise
            raise StudyError(f"runs are missing ({error}). Repeat without --draw-only.") from error
