"""Noise on a DEM: facts and warnings of check, and the same terrain for every command."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
import rasterio
from conftest import Program, Ran, history, run_facts, sets
from terrain_files import write_dem, write_line, write_release

NOISE = 1.0  # m rms, a tenth of the points' distance of 10 m
WIDTH = 7.0  # m, of the filter for it
RELEASE = [(105.0, 155.0), (205.0, 155.0), (205.0, 245.0), (105.0, 245.0)]


@pytest.fixture
def rough_case(thawslide: Program, tmp_path: Path) -> Path:
    """Make a case on a plane with white noise on its points."""
    random = np.random.default_rng(1)
    dem = write_dem(tmp_path / "dem.tif", lambda x, _: 1e3 - 0.5 * x + NOISE * random.standard_normal(x.shape), 160)
    release = write_release(tmp_path / "release.geojson", RELEASE, thickness=20.0)
    case = tmp_path / "case"
    assert "smoothed" not in thawslide.ok("new", case, "--dem", dem, "--release", release, "--cell", 10)
    file = case / "case.toml"
    kept = [line for line in file.read_text().splitlines() if not line.startswith("smooth = ")]
    file.write_text("\n".join(kept) + "\n")
    return case


@pytest.mark.parametrize(("thickness", "width"), [(8.0, WIDTH), (40.0, 20.0)], ids=["noise", "cell"])
def test_new_writes_the_filter(
    thawslide: Program, rough_case: Path, tmp_path: Path, thickness: float, width: float
) -> None:
    """It is that against noise, or half the thickness, which is a cell of `quick`, on any cells."""
    release = write_release(tmp_path / "other.geojson", RELEASE, thickness=thickness)
    for resolution in ("quick", "standard"):
        case = tmp_path / resolution
        words = ("--dem", rough_case.parent / "dem.tif", "--release", release, "--resolution", resolution)
        thawslide.ok("new", case, *words)
        assert tomllib.loads((case / "case.toml").read_text())["terrain"]["smooth"] == width


def test_check_reports_noise_filter_and_remaining_friction(thawslide: Program, rough_case: Path) -> None:
    printed = thawslide.ok("check", rough_case)
    reported = f"smoothed with a standard deviation of {WIDTH:g} m; remaining friction by noise and bumps about "
    assert reported in printed
    facts = thawslide.json("check", rough_case)["roughness"]
    assert facts["noise_m"] == pytest.approx(NOISE, rel=0.2)
    assert facts["apparent_friction"] < 0.03
    left = thawslide.json("check", rough_case, *sets(terrain__smooth=0))
    note = next(note for note in left["warnings"] if note.startswith("terrain.smooth: "))
    assert note.endswith('at most 0.06 is intended). Set terrain.smooth = "auto".')
    assert 0.1 < left["roughness"]["apparent_friction"] < 0.25


def test_run_resolved_case_and_resume_have_the_same_terrain(ran: Ran, thawslide: Program, rough_case: Path) -> None:
    short = sets(time__end=0.5, time__output_interval=0.5)
    run = ran(*short, case=rough_case)
    facts = run_facts(run)["roughness"]
    assert facts == thawslide.json("check", rough_case, *short)["roughness"]
    assert 'smooth = "auto"' in (run / "case.toml").read_text()
    again = ran(case=run, name="again")
    assert (again / "history.csv").read_bytes() == (run / "history.csv").read_bytes()
    assert run_facts(again)["roughness"] == facts
    with rasterio.open(run / "maps" / "terrain.tif") as ground:
        noise = ground.read(1, masked=True)
    across = np.diff(noise, axis=0)
    assert np.ma.std(across) < 0.5 * NOISE
    thawslide.ok("resume", run, "--end", 1.0)
    assert run_facts(run)["roughness"] == facts
    assert history(run)["time_s"][-1] == pytest.approx(1.0, abs=0.1)


def test_section_has_the_terrain_of_a_3d_run(thawslide: Program, rough_case: Path, tmp_path: Path) -> None:
    line = write_line(tmp_path / "line.geojson", [(15.0, 200.0), (1500.0, 200.0)])
    folder = tmp_path / "section"
    printed = thawslide.ok("section", folder, "--dem", rough_case.parent / "dem.tif", "--line", line)
    note = (
        f"dem.tif was smoothed with a standard deviation of {WIDTH:g} m, as for a 3D run on 10 m cells "
        "whose domain is the whole DEM. It has noise of 1 m rms and bumps with an rms slope of "
    )
    assert f"note: {note}" in printed
    text = (folder / "profile.csv").read_text()
    assert f"# {note}" in text
    rows = np.array([row.split(",")[:2] for row in text.splitlines() if row[:1].isdigit()], dtype=float)
    fall = rows[:, 1] + 0.5 * rows[:, 0]
    assert np.std(fall) < 0.5 * NOISE
