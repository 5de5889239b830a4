"""Cases are valid: those of the project, of comparisons with other codes, and random ones.

The files of `cases/` run for their first seconds. Of a comparison, a short run conserves the volume of the pile.
"""

import os
import re
import tomllib
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from conftest import ROOT, Program, history, run_facts
from random_cases import draw, exit_code

from reproduction.studies import frank, joffre, joffre_judged, refinement
from reproduction.study import Job, Place
from thawslide import Case

CASES = sorted((ROOT / "cases").glob("*/*.toml"))
STEPS = 40
ADAPTIVE_STEP = 0.02  # s

# Cases that need terrain and release of the user, and their folder next to the checkout.
DATA = ROOT.parent / "shared" / "data"
USER_DATA = {
    "alr": ("alr/alr.tif", "alr/release.shp"),
    "fluchthorn": ("fluchthorn/fluchthorn.tif", "fluchthorn/POLYGONS/scarpFluchthorn_perimeter.shp"),
}
STEEP = "grid.steepest: the terrain is steeper than 65 degrees. Columns of nodes lowered: 450, "
WEAK = "the base is stronger than the broken material of body slide (shear strength 0."
FITTED = [  # to a force record
    "material.rock_ice.residual_friction_angle is 35.3 degrees, outside the usual 20 to 35",
    "substrate.glacier.friction_coefficient is 0.034, outside the usual 0.05 to 0.3 on glacier",
]
KNOWN_WARNINGS = {
    "valley3d/case": [STEEP], "valley3d/columns": [WEAK, STEEP], "valley3d/weak": [WEAK, STEEP],
    "lamplugh-columns/two-parts": FITTED,
}  # fmt: skip


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.parent.name}/{case.stem}")
def test_case_runs_shortened(thawslide: Program, run: Path, case: Path) -> None:
    user_data = keys_of_user_data(case)
    notes = re.findall(r"^warning: (.*)$", thawslide.ok("check", case, *options(user_data)), re.MULTILINE)
    if not user_data:
        expected = KNOWN_WARNINGS.get(f"{case.parent.name}/{case.stem}", [])
        assert len(notes) == len(expected), notes
        assert all(words in note for words, note in zip(expected, notes, strict=True)), notes
    tables = tomllib.loads(Case(case, user_data).to_toml())
    is_adaptive = tables["time"]["stepping"] == "adaptive"
    end = STEPS * (ADAPTIVE_STEP if is_adaptive else tables["time"]["step"])
    later = {f"body.{name}.release_time": 0.5 * end for name, body in tables["body"].items() if body["release_time"]}
    shortened = {key: f"{time:.12g}" for key, time in ({"time.end": end} | later).items()}
    thawslide.ok("run", case, *options(user_data | shortened), "--output", run)
    assert run_facts(run)["status"] == "done"
    columns = history(run)
    last = {name: values[-1] for name, values in columns.items()}
    assert last["step"] == STEPS or is_adaptive
    for name, values in columns.items():
        empty = name.startswith("band_")  # no band, or no contact before the first step
        # Without a path, the front follows the track of the centre of mass, which does not exist before motion.
        known = values[-1:] if user_data and name in ("front_position_m", "runout_m") else values
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


def keys_of_user_data(case: Path) -> dict[str, object]:
    """Return the keys with terrain and release of a case without its own, and an eighth of its particles.

    Skips the test if the data are absent.
    """
    if case.parent.name not in USER_DATA:
        return {}
    needs(*USER_DATA[case.parent.name])
    terrain, release = (str(DATA / name) for name in USER_DATA[case.parent.name])
    return {"terrain.file": terrain, "body.slide.release": release, "body.slide.particles_per_axis": 1}


def options(keys: Mapping[str, object]) -> list[str]:
    return [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]


def options_of(job: Job) -> list[str]:
    return [word for key in job.sets for word in ("--set", key)]


def needs(*names: str) -> None:
    absent = [name for name in names if not (DATA / name).exists()]
    if absent:
        pytest.skip(f"the case needs data that are not in the repository: {', '.join(absent)} in ../shared/data")


@pytest.mark.parametrize(
    ("study", "data", "volume"),
    [(frank, "frank", "36,000,000 m3"), (refinement, "alr", "particles")],
    ids=["frank", "cells"],
)
def test_each_run_of_a_comparison_is_a_valid_case(
    thawslide: Program, binary: Path, tmp_path: Path, study: ModuleType, data: str, volume: str
) -> None:
    needs(data)
    for job in study.jobs(Place(binary, tmp_path, tmp_path, parts=("*",))):
        assert volume in thawslide.ok("check", job.case, *options_of(job))


def test_each_case_of_the_blind_forecast_is_valid_and_releases_its_volume(thawslide: Program, tmp_path: Path) -> None:
    needs("joffre")
    joffre.prepare(DATA / "joffre", tmp_path)
    for case in [tmp_path / release / f"{law}.toml" for release in joffre.RELEASES for law in joffre.LAWS]:
        assert "2,500,000 m3" in thawslide.ok("check", case)


def test_each_case_of_the_judged_forecast_is_valid(thawslide: Program, binary: Path, tmp_path: Path) -> None:
    needs("joffre", "frank")
    for job in joffre_judged.jobs(Place(binary, tmp_path, tmp_path)):
        if job.subcommand == "run":
            assert "2,500,000 m3" in thawslide.ok("check", job.case, *options_of(job))
    for name, volume in (("lower", "2,500,000 m3"), ("upper", "2,500,000 m3"), ("frank", "36,000,000 m3")):
        assert volume in thawslide.ok("check", tmp_path / name)
        prior = (tmp_path / name / "sweep.toml").read_text(encoding="utf-8")
        assert prior == joffre_judged.PRIOR.read_text(encoding="utf-8")


def test_short_run_of_the_frank_slide_has_the_pile_on_the_grid_of_shaltop(thawslide: Program, tmp_path: Path) -> None:
    needs("frank")
    data = DATA / "frank"
    terrain, pile = (frank.read_grid(data / f"Frankslide_{kind}.asc") for kind in ("topography", "pile"))
    job = frank.job(frank.BASE, 15, data, ("time.end=0.12", "time.output_interval=0.12"))
    thawslide.ok("run", job.case, *options_of(job), "--threads", "1", "--output", tmp_path / job.key)
    deposit = frank.read_run(tmp_path / job.key, terrain.grid)
    found = frank.figures(deposit, terrain, pile)
    assert found.volume == pytest.approx(36.0, rel=2e-3)
    released = frank.figures(frank.Deposit(pile, pile, pile), terrain, pile)
    assert (found.x, found.y) == pytest.approx((released.x, released.y), abs=1.0)
    assert found.area == pytest.approx(released.area, rel=0.05)


def test_random_cases_end_with_a_result_or_a_refusal_and_most_with_a_result(binary: Path, tmp_path: Path) -> None:
    """They never end in an internal error. Refused cases test little."""
    codes: Counter[tuple[str, int]] = Counter()
    seeds = range(*map(int, os.environ.get("RANDOM_CASES", "0:16").split(":")))
    for seed in seeds:
        for words in draw(seed, tmp_path / str(seed)):
            codes[words[0], exit_code(binary, words)] += 1
    for command in ("check", "run", "block"):
        assert codes[command, 0] >= len(seeds) / 2, codes
