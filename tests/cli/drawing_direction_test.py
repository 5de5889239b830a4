"""Results do not depend on the direction in which paths, cross sections, outlines and rasters were drawn or stored."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasterio
from conftest import ROOT, Program, columns_of, history, run_facts, sets, with_profile
from terrain_files import EAST, NORTH, place, toml, write_dem, write_geojson, write_line

FAULTS = ROOT.parent / "shared" / "data" / "faults"
RING = [(105.0, 105.0), (205.0, 105.0), (205.0, 195.0), (105.0, 195.0)]
PATH = [(35.0, 150.0), (400.0, 150.0), (765.0, 155.0)]
ACROSS = [(300.0, 40.0), (310.0, 260.0)]
CELL = 10.0
COLUMNS, ROWS = 80, 30
COULOMB = {"heat__enabled": "false", "pressure__enabled": "false", "basal__friction": "constant"}

CASE = toml(f"""
[case] dimension = 3
[time] end = 1.5 | step = 0.01 | output_interval = 1.5 | history_interval = 0.5
[grid] cell = {CELL} | min = [{EAST + 15.0}, {NORTH + 15.0}, 550.0] | max = [{EAST + 775.0}, {NORTH + 285.0}, 1050.0]
[terrain] type = "dem" | file = "dem.tif"
[maps] path = "path.geojson"
[probe.across] line = "across.geojson"
[material.rock] law = "elastic" | youngs_modulus = 2.0e7 | poisson_ratio = 0.2 | viscosity_time = 0.02
[body.slide] material = "rock" | shape = "release" | release = "release.geojson" | thickness = 20.0
  temperature = -5.0
[basal] friction_angle = 12.0
""")


def valley(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return elevations that fall for 450 m and then rise above the start, with slopes on both sides."""
    return 1000.0 - 0.7 * np.minimum(x, 450.0) + 1.2 * np.maximum(0.0, x - 450.0) + 0.001 * (y - 150.0) ** 2


def write_case(folder: Path, *, is_reversed: bool = False, path: list[tuple[float, float]] = PATH) -> Path:
    """Write the case, or the same with every line, ring and raster reversed."""
    folder.mkdir()
    (folder / "case.toml").write_text(CASE)
    write_dem(folder / "dem.tif", valley, columns=COLUMNS, rows=ROWS, cell=CELL)
    ring = [place(*corner) for corner in [*RING, RING[0]]]
    if is_reversed:
        turn_rows(folder / "dem.tif")
    for name, line in (("path", path), ("across", ACROSS)):
        write_line(folder / f"{name}.geojson", line[::-1] if is_reversed else line)
    write_geojson(folder / "release.geojson", "Polygon", [ring[::-1] if is_reversed else ring])
    return folder


def turn_rows(file: Path) -> None:
    with rasterio.open(file) as raster:
        values, profile = raster.read(1), raster.profile
    there = profile["transform"]
    profile["transform"] = rasterio.Affine(there.a, 0.0, there.c, 0.0, -there.e, there.f + values.shape[0] * there.e)
    with rasterio.open(file, "w", **profile) as raster:
        raster.write(values[::-1], 1)


def assert_alike(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> None:
    assert one.keys() == other.keys()
    for name, values in one.items():
        scale = np.abs(values[np.isfinite(values)]).max(initial=1e-9)
        assert other[name] == pytest.approx(values, rel=1e-6, abs=1e-7 * scale, nan_ok=True), name


def test_run_block_and_probes_do_not_depend_on_the_drawing_direction(thawslide: Program, tmp_path: Path) -> None:
    runs: dict[bool, dict[str, Any]] = {}
    for is_reversed in (False, True):
        case = write_case(tmp_path / f"case-{is_reversed}", is_reversed=is_reversed)
        run = tmp_path / f"run-{is_reversed}"
        printed = thawslide.ok("run", case, "--output", run, "--threads", 1, *sets(**COULOMB))
        reported = "maps.path: path.geojson was drawn against the direction of the slide; distances count from its last"
        assert (reported in printed) == is_reversed
        thawslide.ok("block", case, "--output", tmp_path / "block.csv", *sets(**COULOMB, time__end=20))
        runs[is_reversed] = {
            "history": history(run),
            "probes": columns_of(run / "probes.csv"),
            "block": columns_of(tmp_path / "block.csv"),
            "facts": {key: value for key, value in run_facts(run).items() if key.endswith(("distance_m", "degrees"))},
        }
    plain, turned = runs[False], runs[True]
    for name in ("history", "probes", "block"):
        assert_alike(plain[name], turned[name])
    assert turned["facts"] == pytest.approx(plain["facts"], rel=1e-6) and len(plain["facts"]) == 3
    front = plain["history"]["front_position_m"]
    assert 150.0 < front[0] < 190.0 and front[-1] > front[0] + 1.0
    assert plain["block"]["velocity_m_s"].max() > 10.0 and plain["block"]["displacement_m"][-1] > 100.0
    assert (plain["block"]["driving_traction_Pa"][:1] > 0.0).all()


@pytest.mark.parametrize("start", [60.0, 105.0, 150.0, 201.0, 205.0, 231.7, 260.0, 320.0])
def test_the_path_start_does_not_affect_the_safety_factor(thawslide: Program, tmp_path: Path, start: float) -> None:
    """The release extends from 105 to 205 m; paths start before, within and below it."""

    def safety_factor(name: str, **more: Any) -> float:
        printed = thawslide.ok("block", write_case(tmp_path / name, **more), *sets(**COULOMB))
        (found,) = re.findall(r"safety factor at the start: (\S+) ", printed)
        return float(found)

    complete = safety_factor("complete")
    for is_reversed in (False, True):
        path = [(start, 150.0), (400.0, 150.0)]
        found = safety_factor(f"case-{is_reversed}", is_reversed=is_reversed, path=path)
        assert found == pytest.approx(complete, rel=0.02)


@pytest.mark.parametrize("is_reversed", [False, True])
def test_section_keeps_its_direction(thawslide: Program, tmp_path: Path, is_reversed: bool) -> None:
    case = write_case(tmp_path / "case", is_reversed=is_reversed)
    words = ["--dem", case / "dem.tif", "--release", case / "release.geojson", "--thickness", 20]
    printed = thawslide.ok("section", tmp_path / "section", *words, "--line", case / "path.geojson")
    note = "warning: --line: path.geojson was drawn against the direction of the slide"
    assert (note in printed) == is_reversed
    lines = (tmp_path / "section" / "profile.csv").read_text().splitlines()
    rows = np.array([line.split(",") for line in lines if line[0].isdigit()], dtype=float)
    assert rows[0, 1] < rows[-1, 1], "the opposite slope rises above the start"
    assert rows[np.argmax(rows[:, 2] - rows[:, 1]), 0] < 200.0, "the release is at the beginning"


def test_points_of_a_profile_that_coincide_in_the_domain_are_refused(thawslide: Program, small_case: Path) -> None:
    with_profile(small_case, "distance_m,terrain_elevation_m\n0,0\n200,0\n200.00000000000003,0\n400,0\n")
    words = sets(grid__min="[-4100,-2]", grid__max="[400,10]", terrain__extend="true")
    for command in ("check", "block"):
        message = thawslide.error(command, small_case, *words)
        assert "profile.csv:4: distance_m is 200.00000000000003 after 200; allowed: steps of 1e-06 m " in message


def data_folder(name: str) -> Path:
    folder = FAULTS / name
    if not folder.is_dir():
        pytest.skip(f"the inputs of {name} are not next to this checkout")
    return folder


def test_the_block_moves_alike_on_paths_with_different_starts(thawslide: Program, tmp_path: Path) -> None:
    folder = data_folder("g19-path-start")
    slides = {}
    for line in ("s150", "s105", "s305", "s333.3", "s360", "s420"):
        file = tmp_path / f"{line}.csv"
        words = sets(maps__path=folder / f"line-{line}.gpkg")
        printed = thawslide.ok("block", folder / "case.toml", *words, "--output", file)
        assert f"{line}.gpkg was drawn against" not in printed
        slides[line] = columns_of(file)
    expected = slides["s150"]
    strength, traction = (expected[name][0] for name in ("sliding_strength_Pa", "driving_traction_Pa"))
    assert strength / traction == pytest.approx(0.464, abs=0.0005)
    assert expected["displacement_m"][-1] > 700.0
    for slide in slides.values():
        assert slide["displacement_m"] == pytest.approx(expected["displacement_m"], rel=0.01, abs=0.5)
        assert slide["velocity_m_s"].max() == pytest.approx(expected["velocity_m_s"].max(), rel=0.01)


def test_a_path_next_to_the_release_measures_the_front_only(thawslide: Program, tmp_path: Path) -> None:
    folder = data_folder("g03-path-uphill")
    side, ends = folder / "line-side.gpkg", {}
    for line in ("down", "side"):
        words = sets(maps__path=folder / f"line-{line}.gpkg", time__end=2)
        thawslide.ok("run", folder / "case-3d.toml", *words, "--output", tmp_path / line, "--threads", 1)
        ends[line] = {name: history(tmp_path / line)[name] for name in ("front_position_m", "runout_m")}
    for name, values in ends["down"].items():
        assert ends["side"][name] == pytest.approx(values, abs=1e-6)
        assert values[-1] > values[0] + 4.0
    message = thawslide.error("block", folder / "case-3d.toml", *sets(maps__path=side))
    assert "the path misses the release of body 'slide' by 155 m. Draw it through the release." in message
    ground = ["--dem", folder / "dem.tif", "--release", folder / "release.gpkg", "--thickness", 10]
    for line in ("side", "late"):
        message = thawslide.error("section", tmp_path / "section", *ground, "--line", folder / f"line-{line}.gpkg")
        assert not (tmp_path / "section").exists()
        assert f"line-{line}.gpkg: the line does not cross the release" in message
