"""All runs of the figures of the paper: cases, settings, and ends of the shortened versions."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from reproduction.study import Job
from thawslide.run_folder import Run

# He et al. (2023) use 0.561 MPa for equilibrium; a block with the 0.6 MPa of the paper does not move.
LAMPLUGH_BLOCKS = (
    Job("lamplugh-block", "rigid block, 0.6 MPa", (), "lamplugh/case.toml", "block"),
    Job("lamplugh-block-561", "rigid block, 0.561 MPa", ("basal.cohesion=5.61e5",), "lamplugh/case.toml", "block"),
)

BARS = ("m025", "m050", "m100", "m050-no-latent")
BLOCKS = ("e050", "e100", "e200", "e100-L5", "e100-L20", "k0", "k10", "k9", "k8")
INCLINES = ("D", "DL", "DLP", "PL")
NO_LATENT = "-no-latent"
PRINTED = "-printed"
NO_VISCOSITY = ("material.rock_ice.viscosity_time=0.0",)
SHORT_ENDS = {"freezing-bar": 864.0, "block": 0.2, "incline": 0.1, "lamplugh": 1.0}  # s
_COSTS = {"block-e200": 8.0, "block-e100-L5": 12.0, "block-e100": 4.0, "block-e100-L20": 3.0}


def all_runs() -> list[Job]:
    """Return all runs, in the order of the paper."""

    def job(name: str, case: str, sets: tuple[str, ...] = (), cost: float = 1.0) -> Job:
        return Job(name, "", sets, case, cost=cost)

    runs = [job(f"freezing-bar-{name}", f"freezing-bar/{name}.toml", (), 0.5) for name in BARS]
    printed = ('heat.update="apparent_capacity"',)
    runs += [job(f"freezing-bar-{name}{PRINTED}", f"freezing-bar/{name}.toml", printed, 0.5) for name in BARS]
    for name in BLOCKS:
        cost = _COSTS.get(f"block-{name}", 2.0)
        runs.append(job(f"block-{name}", f"block/{name}.toml", (), cost))
        runs.append(job(f"block-{name}{NO_LATENT}", f"block/{name}.toml", ("heat.latent=false",), cost))
    runs.append(job("block-e050-no-viscosity", "block/e050.toml", NO_VISCOSITY, 2.0))
    runs += [job(f"incline-{name}", f"incline/{name}.toml", (), 6.0) for name in INCLINES]
    runs += [job(f"incline-{name}-no-viscosity", f"incline/{name}.toml", NO_VISCOSITY, 6.0) for name in ("D", "PL")]
    ice_only = ("pressure.thermal_pressurization=false",)
    runs.append(job("incline-DLP-ice", "incline/DLP.toml", ice_only, 6.0))
    # The paper states values at 200 s, the end of its run: these runs do not stop at rest.
    whole = ("time.stop_at_rest=0",)
    runs.append(job("lamplugh", "lamplugh/case.toml", whole, 20.0))
    runs.append(job("lamplugh-no-pressurization", "lamplugh/no-pressurization.toml", whole, 15.0))
    return runs


def shortened(job: Job) -> Job:
    """Return the first time steps of a run."""
    # The last of two settings of the same key applies.
    end = next(end for start, end in SHORT_ENDS.items() if job.key.startswith(start))
    return replace(job, sets=(*job.sets, f"time.end={end}"))


def read_runs(runs: Iterable[Job], folder: Path) -> dict[str, Run]:
    """Return the run folders by name; print a warning for each incomplete run."""
    found = {}
    for run in runs:
        found[run.key] = Run(folder / run.key)
        if found[run.key].facts.get("status") != "done":
            print(f"warning: {run.key}: incomplete run", file=sys.stderr)
    return found
