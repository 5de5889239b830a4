"""All runs of the figures of the paper: cases, settings, shortened versions, and their execution."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from thawslide.errors import ReportError
from thawslide.run_folder import Run

NOTHING_COMPUTED = 2  # exit code for an error of the user


@dataclass(frozen=True)
class PaperRun:
    """One run: name, case file below cases/, changes by --set, and end [s] of the shortened version."""

    name: str
    case: str
    sets: tuple[str, ...] = ()
    short_end: float = 0.2
    cost: float = 1.0  # relative run time: the longest start first

    def command(self, program: Path, cases: Path, output: Path, quick: bool) -> list[str]:
        """Return its command line."""
        words = [str(program), "run", str(cases / self.case), "--output", str(output), "--overwrite", "--threads", "1"]
        sets = (*self.sets, f"time.end={self.short_end}") if quick else self.sets
        return words + [word for key in sets for word in ("--set", key)]


@dataclass(frozen=True)
class BlockRun:
    """Run of the rigid block on the Lamplugh case: name, changes by --set, and words for the legend."""

    name: str
    sets: tuple[str, ...]
    words: str

    def command(self, program: Path, cases: Path, folder: Path, quick: bool) -> list[str]:
        """Return its command line; it writes NAME.csv."""
        words = [str(program), "block", str(cases / "lamplugh" / "case.toml"), "--output", f"{folder / self.name}.csv"]
        sets = (*self.sets, "time.end=1.0") if quick else self.sets
        return words + [word for key in sets for word in ("--set", key)]


# He et al. (2023) use 0.561 MPa for equilibrium; a block with the 0.6 MPa of the paper does not move.
LAMPLUGH_BLOCKS = (
    BlockRun("lamplugh-block", (), "rigid block, 0.6 MPa"),
    BlockRun("lamplugh-block-561", ("basal.cohesion=5.61e5",), "rigid block, 0.561 MPa"),
)

BARS = ("m025", "m050", "m100", "m050-no-latent")
BLOCKS = ("e050", "e100", "e200", "e100-L5", "e100-L20", "k0", "k10", "k9", "k8")
INCLINES = ("D", "DL", "DLP", "PL")
NO_LATENT = "-no-latent"
PRINTED = "-printed"
NO_VISCOSITY = ("material.rock_ice.viscosity_time=0.0",)
POINTS = 'terrain.representation="rigid_points"'
_COSTS = {"block-e200": 8.0, "block-e100-L5": 12.0, "block-e100": 4.0, "block-e100-L20": 3.0}


def all_runs() -> list[PaperRun]:
    """Return all runs, in the order of the paper."""
    runs = [PaperRun(f"freezing-bar-{name}", f"freezing-bar/{name}.toml", (), 864.0, 0.5) for name in BARS]
    printed = ('heat.update="apparent_capacity"',)
    runs += [
        PaperRun(f"freezing-bar-{name}{PRINTED}", f"freezing-bar/{name}.toml", printed, 864.0, 0.5) for name in BARS
    ]
    for name in BLOCKS:
        cost = _COSTS.get(f"block-{name}", 2.0)
        runs.append(PaperRun(f"block-{name}", f"block/{name}.toml", (), 0.2, cost))
        without = ("heat.latent=false",)
        runs.append(PaperRun(f"block-{name}{NO_LATENT}", f"block/{name}.toml", without, 0.2, cost))
    runs.append(PaperRun("block-e050-no-viscosity", "block/e050.toml", NO_VISCOSITY, 0.2, 2.0))
    runs += [PaperRun(f"incline-{name}", f"incline/{name}.toml", (), 0.1, 6.0) for name in INCLINES]
    runs += [
        PaperRun(f"incline-{name}-no-viscosity", f"incline/{name}.toml", NO_VISCOSITY, 0.1, 6.0) for name in ("D", "PL")
    ]
    ice_only = ("pressure.thermal_pressurization=false",)
    runs.append(PaperRun("incline-DLP-ice", "incline/DLP.toml", ice_only, 0.1, 6.0))
    # Terrain of the paper: two layers of points in Sec. 3.3, three layers of cells with two each in Sec. 4.
    runs.append(PaperRun("incline-DLP-points", "incline/DLP.toml", (POINTS, "terrain.layers=2"), 0.1, 6.0))
    six = (POINTS, "terrain.layers=6", "time.end=60.0")
    runs.append(PaperRun("lamplugh-points", "lamplugh/case.toml", six, 1.0, 5.0))
    weaker = (*six, "basal.cohesion=5.4e5")
    runs.append(PaperRun("lamplugh-points-540", "lamplugh/case.toml", weaker, 1.0, 5.0))
    # The paper states values at 200 s, the end of its run: these runs do not stop at rest.
    whole = ("time.stop_at_rest=0",)
    runs.append(PaperRun("lamplugh", "lamplugh/case.toml", whole, 1.0, 20.0))
    runs.append(PaperRun("lamplugh-no-pressurization", "lamplugh/no-pressurization.toml", whole, 1.0, 15.0))
    return runs


def run_all(
    runs: Iterable[PaperRun], program: Path, cases: Path, folder: Path, quick: bool, progress: Callable[[str], None]
) -> None:
    """Run all, two at a time on one thread each; ReportError for a run without results."""
    waiting = sorted(runs, key=lambda run: -run.cost)
    environment = os.environ | {"OMP_NUM_THREADS": "1"}

    def start(run: PaperRun) -> None:
        words = run.command(program, cases, folder / run.name, quick)
        done = subprocess.run(words, env=environment, capture_output=True, text=True, check=False)
        if done.returncode == NOTHING_COMPUTED or not (folder / run.name / "history.csv").is_file():
            raise ReportError(f"{run.name}: {(done.stderr or done.stdout).strip()}")
        progress(f"{run.name}: done" if done.returncode == 0 else f"{run.name}: {done.stderr.strip()}")

    folder.mkdir(parents=True, exist_ok=True)
    run_blocks(program, cases, folder, quick)
    with ThreadPoolExecutor(max_workers=2) as pool:
        list(pool.map(start, waiting))


def run_blocks(program: Path, cases: Path, folder: Path, quick: bool) -> None:
    """Run the rigid blocks of Lamplugh; ReportError for one without results."""
    for block in LAMPLUGH_BLOCKS:
        words = block.command(program, cases, folder, quick)
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0 or not (folder / f"{block.name}.csv").is_file():
            raise ReportError(f"{block.name}: {(done.stderr or done.stdout).strip()}")


def read_runs(runs: Iterable[PaperRun], folder: Path) -> dict[str, Run]:
    """Return the run folders by name; print a warning for each incomplete run."""
    found = {}
    for run in runs:
        found[run.name] = Run(folder / run.name)
        if found[run.name].facts.get("status") != "done":
            print(f"warning: {run.name}: incomplete run", file=sys.stderr)
    return found
