"""Results depend neither on the direction in which lines and rasters were drawn or stored nor on that of the slope."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Program, Ran, columns_of, history, run_facts, sets, with_profile
from terrain_files import EAST, NORTH, place, toml, turn_rows, write_dem, write_geojson, write_line, write_release

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


def test_a_slide_on_turned_ground_moves_alike(ran: Ran, tmp_path: Path) -> None:
    """The turn by 90 degrees maps grid, particles and triangles onto themselves: only round-off differs."""
    side, ends = 300.0, {}
    for name in ("plain", "turned"):

        def turned(x: float, y: float, is_turned: bool = name == "turned") -> tuple[float, float]:
            return (side - y, x) if is_turned else (x, y)

        def height(x: np.ndarray, y: np.ndarray, is_turned: bool = name == "turned") -> np.ndarray:
            x, y = (y, side - x) if is_turned else (x, y)
            return 1000.0 - 0.7 * x + 0.001 * (y - 140.0) ** 2 + 2.0 * np.sin(0.1 * x + 0.05 * y)

        folder = tmp_path / name
        folder.mkdir()
        (folder / "case.toml").write_text(CASE.replace(f"{EAST + 775.0}", f"{EAST + 285.0}"))
        write_dem(folder / "dem.tif", height, columns=30, rows=30, cell=CELL)
        write_release(folder / "release.geojson", [turned(*corner) for corner in RING])
        for file, line in (("path", [(35.0, 150.0), (265.0, 155.0)]), ("across", [(230.0, 40.0), (235.0, 260.0)])):
            write_line(folder / f"{file}.geojson", [turned(*corner) for corner in line])
        words = sets(
            material__rock__law="mohr_coulomb", material__rock__friction_angle=30, material__rock__cohesion=1e4
        )
        run = ran("--threads", 1, *words, case=folder, name=f"run-{name}")
        ends[name] = {column: values[-1] for column, values in history(run).items()}
    plain, after = ends["plain"], ends["turned"]
    assert plain["mean_displacement_m"] > 1.0
    for column in ("front_position_m", "runout_m", "mean_displacement_m", "kinetic_J", "friction_heat_J", "plastic_J"):
        assert after[column] == pytest.approx(plain[column], rel=1e-9), column
    weight = plain["mass_kg"] * 9.81
    assert after["basal_force_y_N"] == pytest.approx(plain["basal_force_x_N"], abs=1e-9 * weight)
    assert after["basal_force_x_N"] == pytest.approx(-plain["basal_force_y_N"], abs=1e-9 * weight)


@pytest.mark.parametrize("start", [60.0, 105.0, 150.0, 201.0, 205.0, 231.7, 260.0, 320.0])
def test_the_path_start_does_not_affect_the_block(thawslide: Program, tmp_path: Path, start: float) -> None:
    """The release extends from 105 to 205 m; paths start before, within and below it."""

    def moved(name: str, **more: Any) -> dict[str, np.ndarray]:
        words = ["--output", tmp_path / "block.csv", *sets(**COULOMB, time__end=20)]
        thawslide.ok("block", write_case(tmp_path / name, **more), *words)
        columns = columns_of(tmp_path / "block.csv")
        return columns | {"safety_factor": columns["sliding_strength_Pa"] / columns["driving_traction_Pa"]}

    complete = moved("complete")
    for is_reversed in (False, True):
        found = moved(f"case-{is_reversed}", is_reversed=is_reversed, path=[(start, 150.0), (400.0, 150.0)])
        assert found["displacement_m"][-1] > 200.0
        for name in ("time_s", "displacement_m", "velocity_m_s", "safety_factor"):
            assert found[name] == pytest.approx(complete[name][: len(found[name])], rel=1e-6, abs=1e-6), name


def test_points_of_a_profile_that_coincide_in_the_domain_are_refused(thawslide: Program, small_case: Path) -> None:
    with_profile(small_case, "distance_m,terrain_elevation_m\n0,0\n200,0\n200.00000000000003,0\n400,0\n")
    words = sets(grid__min="[-4100,-2]", grid__max="[400,10]", terrain__extend="true")
    for command in ("check", "block"):
        message = thawslide.error(command, small_case, *words)
        assert "profile.csv:4: distance_m is 200.00000000000003 after 200; allowed: steps of 1e-06 m " in message


def test_a_path_next_to_the_release_measures_the_front_only(ran: Ran, tmp_path: Path) -> None:
    through, side = (write_case(tmp_path / f"{y:g}", path=[(35.0, y), (765.0, y)]) for y in (150.0, 270.0))
    words = ["--threads", 1, *sets(**COULOMB)]
    ends = [history(ran(*words, case=case, name=f"run-{case.name}")) for case in (through, side)]
    for name in ("front_position_m", "runout_m"):
        assert ends[1][name] == pytest.approx(ends[0][name], abs=1e-6) and ends[0][name][-1] > ends[0][name][0] + 3.0
