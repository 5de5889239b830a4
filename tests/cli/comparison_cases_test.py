"""Cases of the comparisons with other codes and of cells are valid; a short run conserves the volume of the pile."""

import sys
from pathlib import Path

import pytest
from conftest import ROOT, Program

sys.path.append(str(ROOT))

from reproduction.studies import frank, joffre, joffre_judged, refinement
from reproduction.study import Job, Place

DATA = ROOT.parent / "shared" / "data"


def options(job: Job) -> list[str]:
    return [word for key in job.sets for word in ("--set", key)]


def needs(*names: str) -> None:
    absent = [name for name in names if not (DATA / name).exists()]
    if absent:
        pytest.skip(f"the comparison needs data that are not in the repository: {', '.join(absent)} in ../shared/data")


def test_each_run_of_the_frank_slide_is_a_valid_case(thawslide: Program, binary: Path, tmp_path: Path) -> None:
    needs("frank")
    for job in frank.jobs(Place(binary, tmp_path, tmp_path, parts=("*",))):
        assert "36,000,000 m3" in thawslide.ok("check", job.case, *options(job))


def test_each_run_on_refined_cells_is_a_valid_case(thawslide: Program, binary: Path, tmp_path: Path) -> None:
    needs("alr/alr.tif", "alr/release.shp")
    for job in refinement.jobs(Place(binary, tmp_path, tmp_path)):
        thawslide.ok("check", job.case, *options(job))


def test_each_case_of_the_blind_forecast_is_valid_and_releases_its_volume(thawslide: Program, tmp_path: Path) -> None:
    needs("joffre")
    joffre.prepare(DATA / "joffre", tmp_path)
    for case in [tmp_path / release / f"{law}.toml" for release in joffre.RELEASES for law in joffre.LAWS]:
        assert "2,500,000 m3" in thawslide.ok("check", case)


def test_each_case_of_the_judged_forecast_is_valid(thawslide: Program, binary: Path, tmp_path: Path) -> None:
    needs("joffre", "frank")
    for job in joffre_judged.jobs(Place(binary, tmp_path, tmp_path)):
        if job.subcommand == "run":
            assert "2,500,000 m3" in thawslide.ok("check", job.case, *options(job))
    for name, volume in (("lower", "2,500,000 m3"), ("upper", "2,500,000 m3"), ("frank", "36,000,000 m3")):
        assert volume in thawslide.ok("check", tmp_path / name)
        prior = (tmp_path / name / "sweep.toml").read_text(encoding="utf-8")
        assert prior == joffre_judged.PRIOR.read_text(encoding="utf-8")


def test_short_run_of_the_frank_slide_has_the_pile_on_the_grid_of_shaltop(thawslide: Program, tmp_path: Path) -> None:
    needs("frank")
    data = DATA / "frank"
    terrain, pile = (frank.read_grid(data / f"Frankslide_{kind}.asc") for kind in ("topography", "pile"))
    job = frank.job(frank.BASE, 15, data, ("time.end=0.12", "time.output_interval=0.12"))
    thawslide.ok("run", job.case, *options(job), "--threads", "1", "--output", tmp_path / job.key)
    deposit = frank.read_run(tmp_path / job.key, terrain.grid)
    found = frank.figures(deposit, terrain, pile)
    assert found.volume == pytest.approx(36.0, rel=2e-3)
    released = frank.figures(frank.Deposit(pile, pile, pile), terrain, pile)
    assert (found.x, found.y) == pytest.approx((released.x, released.y), abs=1.0)
    assert found.area == pytest.approx(released.area, rel=0.05)
