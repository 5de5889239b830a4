"""Every case of the project runs, shortened: the first seconds of each file of `cases/`."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Program, history, run_facts

CASES = sorted((ROOT / "cases").glob("*/*.toml"))
STEPS = 40
ADAPTIVE_STEP = 0.02  # s

# Cases that need terrain and release of the user, and their folder next to the checkout.
DATA = ROOT.parent / "shared" / "data"
USER_DATA = {
    "alr": ("alr/alr.tif", "alr/release.shp"),
    "fluchthorn": ("fluchthorn/fluchthorn.tif", "fluchthorn/POLYGONS/scarpFluchthorn_perimeter.shp"),
}


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.parent.name}/{case.stem}")
def test_case_runs_shortened(thawslide: Program, tmp_path: Path, case: Path) -> None:
    data_options = options_of_user_data(case)
    thawslide.ok("check", case, *data_options)
    step = step_of(case)
    run = tmp_path / "run"
    shortened = ["--set", f"time.end={STEPS * step:.12g}", "--output", run, "--overwrite"]
    for body in held_bodies(case):
        shortened += ["--set", f"body.{body}.release_time={0.5 * STEPS * step:.12g}"]
    thawslide.ok("run", case, *data_options, *shortened)
    assert run_facts(run)["status"] == "done"
    columns = history(run)
    last = {name: values[-1] for name, values in columns.items()}
    assert last["step"] == STEPS or is_adaptive(case)
    for name, values in columns.items():
        empty = name.startswith("band_")  # no band, or no contact before the first step
        # Without a path, the front follows the track of the centre of mass, which does not exist before motion.
        known = values[-1:] if data_options and name in ("front_position_m", "runout_m") else values
        assert empty or np.isfinite(known).all(), name
    # Particles of a release differ in mass: sums in another order differ by round-off.
    round_off = 1e-13 if (run / "maps" / "release.tif").is_file() else 0.0
    assert abs(last["mass_residual_kg"]) <= round_off * last["mass_kg"]
    up = "z" if "gravity_impulse_z_N_s" in last else "y"
    impulse = abs(last[f"gravity_impulse_{up}_N_s"])
    assert impulse > 0.0 or case.parent.name == "freezing-bar"
    assert abs(last[f"momentum_residual_{up}_N_s"]) <= 1e-9 * impulse
    heat = abs(last["friction_heat_J"]) + abs(last["boundary_heat_J"]) + abs(last["band_rescale_J"])
    start = abs(columns["latent_J"][0] + columns["sensible_J"][0])
    assert abs(last["thermal_residual_J"]) <= 1e-12 * start + 1e-9 * heat


def options_of_user_data(case: Path) -> list[str]:
    """Return the options with terrain and release of a case without its own, and an eighth of its particles.

    Skips the test if the data are absent.
    """
    if case.parent.name not in USER_DATA:
        return []
    terrain, release = (DATA / name for name in USER_DATA[case.parent.name])
    absent = [str(path.relative_to(DATA)) for path in (terrain, release) if not path.is_file()]
    if absent:
        pytest.skip(f"the case needs data that are not in the repository: {', '.join(absent)} in ../shared/data")
    chosen = [f"terrain.file={terrain}", f"body.slide.release={release}", "body.slide.particles_per_axis=1"]
    return [word for key in chosen for word in ("--set", key)]


def step_of(case: Path) -> float:
    """Return the time step of a case [s]; for adaptive steps, about the maximum."""
    return ADAPTIVE_STEP if is_adaptive(case) else float(time_of(case)["step"])


def held_bodies(case: Path) -> set[str]:
    """Return the bodies of a case that leave later."""
    tables = tomllib.loads(case.read_text())
    base = tables["case"].get("based_on")
    held = {name for name, body in tables.get("body", {}).items() if "release_time" in body}
    return held | (held_bodies(case.parent / base) if base else set())


def is_adaptive(case: Path) -> bool:
    return bool(time_of(case).get("stepping") == "adaptive")


def time_of(case: Path) -> dict[str, object]:
    tables = tomllib.loads(case.read_text())
    base = tables["case"].get("based_on")
    return {**(time_of(case.parent / base) if base else {}), **tables.get("time", {})}
