"""Every case of the project runs, shortened: the first seconds of each file of `cases/`."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program, history, run_facts

CASES = sorted((ROOT / "cases").glob("*/*.toml"))
STEPS = 40


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.parent.name}/{case.stem}")
def test_case_runs_shortened(thawslide: Program, tmp_path: Path, case: Path) -> None:
    """The run is whole, nothing in it is not a number, and its ledgers of mass, momentum and heat close."""
    checked = thawslide("check", case)
    assert checked.returncode == 0, checked.stderr
    step = step_of(case)
    run = tmp_path / "run"
    done = thawslide("run", case, "--set", f"time.end={STEPS * step:.12g}", "--output", run, "--overwrite")
    assert done.returncode == 0, done.stderr
    assert run_facts(run)["status"] == "done"
    columns = history(run)
    last = {name: values[-1] for name, values in columns.items()}
    assert last["step"] == STEPS
    for name, values in columns.items():
        empty = name.startswith(("band_", "basal_", "seismic_"))  # no band, no contact, no force before the first step
        assert empty or np.isfinite(values).all(), name
    assert last["mass_residual_kg"] == 0.0
    impulse = abs(last["gravity_impulse_y_N_s"])
    assert abs(last["momentum_residual_y_N_s"]) <= 1e-9 * impulse
    heat = abs(last["friction_heat_J"]) + abs(last["boundary_heat_J"]) + abs(last["band_rescale_J"])
    start = abs(columns["latent_J"][0] + columns["sensible_J"][0])
    assert abs(last["thermal_residual_J"]) <= 1e-12 * start + 1e-9 * heat


def step_of(case: Path) -> float:
    """Return the time step of a case file or of the one it is based on [s]."""
    tables = tomllib.loads(case.read_text())
    step = tables.get("time", {}).get("step")
    return float(step) if step is not None else step_of(case.parent / tables["case"]["based_on"])
