"""The figures of docs/tutorials: of single runs, and of the sweep in probability-maps.md."""

from __future__ import annotations

import base64
import re
import shutil
import subprocess
import sys
from pathlib import Path

from reproduction.engine import Task
from reproduction.study import ROOT, Job, Place, Study, StudyError
from thawslide.report_page import make_report
from thawslide.run_folder import Run

VALLEY = ROOT / "cases" / "valley3d"
# Runs by name: their case below cases, the figure, its file, and the settings.
RUNS: dict[str, tuple[str, str, str, tuple[str, ...]]] = {
    "incline-DLP": ("incline/DLP.toml", "band", "incline-band", ()),
    "thin": ("lamplugh-columns/case.toml", "motion", "thin-band-motion", ("band.thickness=0.2",)),
    "my-mountain": ("", "extent_maps", "my-mountain", (f"maps.path={VALLEY / 'path.geojson'}",)),
}
SWEEP = "valley3d-sweep"
SWEEP_OPTIONS = (
    "--set grid.cell=50 --set maps.cell=50 --range basal.friction_angle=35:45 "
    "--range basal.residual_cohesion=0.9e5:2e5 --range basal.slip_distance=300:900 --seed 1"
)
SWEEP_FIGURES = {"Probability maps": "valley-probability", "Sensitivity of travel distance": "valley-sensitivity"}
QUICK = "time.end=2"


def my_mountain(place: Place) -> str:
    """Create the case of your-own-mountain.md; return its file."""
    folder = place.runs / "cases" / "my-mountain"
    shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    files = ["--dem", str(VALLEY / "valley.tif"), "--release", str(VALLEY / "release.geojson")]
    done = subprocess.run([place.program, "new", folder, *files], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise StudyError(f"{folder.name}: {done.stderr.strip()}")
    return str(folder / "case.toml")


def sweep(place: Place) -> Task:
    """Return the sweep of probability-maps.md."""
    results = place.runs / SWEEP
    more = ["--sample", "lhs:4", "--set", QUICK] if place.is_quick else ["--sample", "lhs:16"]
    command = [sys.executable, "-m", "thawslide.sweeps.command", str(VALLEY), *SWEEP_OPTIONS.split(), *more]
    inputs = tuple(VALLEY / name for name in ("case.toml", "valley.tif", "release.geojson", "path.geojson"))
    environment = {"THAWSLIDE_PROGRAM": str(place.program)}
    return Task(SWEEP, (*command, "--output", str(results), "--workers", "1"), results, place.version, inputs, 5.0,
                environment=environment)  # fmt: skip


def tasks(place: Place) -> list[Job | Task]:
    """Return all runs."""
    more = (QUICK,) if place.is_quick else ()
    jobs = [
        Job(name, "", (*sets, *more), f"cases/{case}" if case else my_mountain(place))
        for name, (case, _, _, sets) in RUNS.items()
    ]
    return [*jobs, sweep(place)]


def image_of(page: str, heading: str) -> bytes:
    """Return the image below a heading of a page; StudyError without one."""
    found = re.search(rf'<h2>{re.escape(heading)}[^<]*</h2>\s*<figure><img src="data:image/png;base64,([^"]+)"', page)
    if found is None:
        raise StudyError(f"no figure {heading} in the page of the sweep")
    return base64.b64decode(found[1])


def write(place: Place) -> None:
    """Write the figures of the selected runs."""
    for name, (_, figure, file, _) in RUNS.items():
        if place.is_chosen(name):
            make_report(Run(place.runs / name), names=[figure])
            source = place.runs / name / "figures" / f"{figure}.png"
            shutil.copy(source, place.page(f"docs/tutorials/{file}.png"))
    if place.is_chosen(SWEEP):
        page = Path(place.runs / SWEEP / "sweep.html").read_text(encoding="utf-8")
        for heading, file in SWEEP_FIGURES.items():
            place.page(f"docs/tutorials/{file}.png").write_bytes(image_of(page, heading))


STUDY = Study("tutorials", ("docs/tutorials (figures)",), 8.0, write, (tasks,))
