"""Maps from a DEM and a polygon with two commands."""

import re
import signal
import tomllib
from pathlib import Path

import pytest
import rasterio
from conftest import (
    Interrupted,
    Program,
    Ran,
    Slope,
    assert_identical,
    columns_of,
    history,
    release_volume,
    run_facts,
    sets,
)  # fmt: skip
from terrain_files import CELL, DEPTH, SOUTH, THICKNESS, WEST, WIDTH, write_rectangle, write_thickness


def test_two_commands_produce_maps(ran: Ran, tmp_path: Path, slope: Slope) -> None:
    slope.ok()
    case = tomllib.loads((slope.case / "case.toml").read_text())
    assert THICKNESS / (case["grid"]["cell"] / case["body"]["slide"]["particles_per_axis"]) >= 4.0
    run = ran("--set", "time.end=1.5", case=slope.case)

    volume = WIDTH * DEPTH * THICKNESS
    with rasterio.open(run / "maps" / "final_thickness.tif") as file:
        assert file.crs.to_epsg() == 32632
        assert file.units == ("m",)
        assert file.block_shapes == [(256, 256)] and file.compression.value == "DEFLATE"
        thickness = file.read(1, masked=True)
        # Particles 6 m apart: three distances are wider than a cell of the DEM.
        assert file.res == (2.0 * CELL, 2.0 * CELL)
    facts, columns = run_facts(run), history(run)
    assert facts["crs"] == "EPSG:32632"
    # Elastic volume changes in 1.5 s are far below 1 %.
    assert thickness.sum() * 4.0 * CELL**2 == pytest.approx(volume, rel=0.01)
    assert abs(columns["mass_residual_kg"][-1]) <= 1e-13 * columns["mass_kg"][0]
    assert release_volume(run) == pytest.approx(volume, rel=1e-9)
    maxima = ("thickness", "speed", "momentum_flux", "pressure", "basal_temperature", "melt", "pore_pressure")
    times, grounds = ("arrival_time", "max_pressure_time"), ("terrain", "ground", "release")
    others = ("final_thickness", *times, "elevation_change", *grounds)
    names = {path.stem for path in (run / "maps").glob("*.tif")}
    assert names == {*(f"max_{name}" for name in maxima), *others}
    assert (run / "maps" / "results.gpkg").is_file()


@pytest.mark.parametrize(("degrees", "thickness"), [(35.0, 60.0), (12.0, 24.0)])
def test_the_band_is_the_thinnest_that_friction_does_not_boil(
    thawslide: Program, tmp_path: Path, slope: Slope, degrees: float, thickness: float
) -> None:
    slope(degrees=degrees, foot=800.0)
    printed = slope.ok(thickness=thickness)
    text = (tmp_path / "slide" / "case.toml").read_text()
    proposed = tomllib.loads(text)["band"]["thickness"]

    def block(band: float, *words: str) -> tuple[float, float]:
        rows, dry = tmp_path / "block.csv", ["--set", "mechanisms.pressurization=false"]
        words = (*sets(band__thickness=band), *dry, *words)
        thawslide.ok("block", tmp_path / "slide", "--output", rows, *words)
        columns = columns_of(rows)
        strength, driving = (columns[name][0] for name in ("sliding_strength_Pa", "driving_traction_Pa"))
        return float(columns["band_temperature_C"].max()), float(strength / driving)

    series = [0.1, 0.2, 0.5, 1.0, 2.0]
    warmest, safety = block(proposed)
    stated = re.search(r"above 210 C: (-?[0-9]+) C\n# here", text)
    assert stated and warmest == pytest.approx(float(stated[1]), abs=10.0) and warmest <= 210.0
    assert f"a band of {proposed:.1f} m, which a rigid block without pore pressure heats to {stated[1]} C" in printed
    assert (proposed > 0.1) == (degrees == 35.0)
    for thinner in series[: series.index(proposed)][-1:]:
        assert block(thinner)[0] > 210.0
    found = re.search(r"safety factor ([0-9.]+) at the start: ([0-9,.]+) Pa of cohesion", printed)
    assert (found is None) == (safety >= 1.0) == ("could not have stood" not in text)
    if found:
        assert safety == pytest.approx(float(found[1]), abs=0.006)
        cohesion = float(found[2].replace(",", ""))
        held = block(proposed, *sets(basal__cohesion=cohesion, basal__slip_distance=20.0))
        assert held[1] == pytest.approx(1.0, abs=0.02)


def test_a_run_ends_at_rest_of_its_slide(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    """Without the key the run continues to time.end, with the same front and deposit."""
    slope.ok("--cell", 12)
    words = sets(time__end=40, time__rest_time=2, basal__friction="constant", basal__friction_angle=20)
    facts = {}
    for name, more in (("rest", []), ("complete", sets(time__stop_at_rest=0))):
        run = tmp_path / name
        thawslide.ok("run", slope.case, "--output", run, *words, *more)
        facts[name] = run_facts(run)
        assert facts[name]["at_rest"] is True and facts[name]["status"] == "done"
    rest, complete = facts["rest"], facts["complete"]
    assert complete["simulated_time_s"] == 40.0
    assert 20.0 < rest["simulated_time_s"] < 35.0
    assert rest["simulated_time_s"] == pytest.approx(rest["rest_since_s"] + 2.0, abs=0.5)
    assert rest["message"].startswith("the slide is at rest: since t = ") and complete["message"] == ""
    for key in ("travel_distance_m", "covered_area_m2", "affected_area_m2", "deposit_area_m2", "inundated_area_m2"):
        assert rest[key] == pytest.approx(complete[key], rel=5e-3), key
    ends = [history(tmp_path / name)["mean_displacement_m"][-1] for name in ("rest", "complete")]
    assert ends[0] > 200.0 and ends[0] == pytest.approx(ends[1], abs=0.1)


@pytest.mark.parametrize(("number", "percent"), [(signal.SIGTERM, 20), (signal.SIGINT, 50)])
def test_a_run_stopped_by_a_signal_ends_bitwise_identical(
    ran: Ran, thawslide: Program, interrupted: Interrupted, tmp_path: Path, slope: Slope, number: int, percent: int
) -> None:
    folder, parts = tmp_path / "slide", tmp_path / "parts"
    slope.ok()
    case = folder / "case.toml"
    text = case.read_text().replace("temperature = ", "velocity = [10.0, 0.0, -5.0]\ntemperature = ", 1)
    case.write_text(f"{text}\n[probe.gauge]\npoint = [{WEST + 330.0}, {SOUTH + 300.0}]\n")
    # Rows, snapshots and checkpoints have different times.
    words = sets(time__end=2, time__history_interval=0.07, time__output_interval=0.45, checkpoint__interval=0.3)
    complete = ran(*words, case=folder, name="complete")
    assert interrupted(folder, parts, words, number, percent) == 4
    facts = run_facts(parts)
    assert facts["status"] == "stopped" and percent / 50 <= facts["simulated_time_s"] < 2.0
    thawslide.ok("resume", parts)
    assert_identical(complete, parts)
    after, expected = run_facts(parts), run_facts(complete)
    keys = ("steps", "covered_volume_m3", "covered_area_m2", "affected_area_m2")
    for key in (*keys, "travel_distance_m", "reach_angle_degrees"):
        assert expected[key] is not None and after[key] == expected[key], key
    for name in ("checkpoint.bin", "probes.csv"):
        assert (complete / name).read_bytes() == (parts / name).read_bytes(), name
    maps = sorted((complete / "maps").glob("*.tif"))
    assert len(maps) == 14
    for file in maps:
        with rasterio.open(file) as one, rasterio.open(parts / "maps" / file.name) as other:
            assert one.read(1).tobytes() == other.read(1).tobytes(), file.name


def test_new_accepts_a_raster_of_the_thickness(ran: Ran, tmp_path: Path, slope: Slope) -> None:
    dem = slope()
    raster = write_thickness(tmp_path / "elsewhere" / "dem.tif", dem, THICKNESS)
    slope.ok(release=raster, thickness=None)
    assert {path.name for path in slope.case.iterdir()} == {"case.toml", "sweep.toml", "dem.tif", "terrain.tif"}
    assert (slope.case / "dem.tif").read_bytes() == raster.read_bytes()
    case = tomllib.loads((slope.case / "case.toml").read_text())
    assert case["terrain"]["file"] == "terrain.tif"
    assert case["body"]["slide"]["thickness"] == {"raster": "dem.tif"} and "release" not in case["body"]["slide"]
    run = ran("--set", "time.end=0.01", case=slope.case)
    assert release_volume(run) == pytest.approx(WIDTH * DEPTH * THICKNESS, rel=1e-9)


def test_polygons_of_the_ground_become_substrates(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    note = "\npath:        [basal] everywhere. Polygons of other ground: --glacier, --snow, --valley-floor\n"
    plain = slope.ok(folder=tmp_path / "rock")
    # The proposed base is that of [basal], also if other ground is below the release.
    below = slope.ok("--glacier", slope.release(), folder=tmp_path / "glacier")
    bases = [re.findall(r"^base: .*\n.*", printed, re.MULTILINE) for printed in (plain, below)]
    assert note in plain and bases[0] and bases[0] == bases[1]
    ground = write_rectangle(tmp_path / "ground.geojson", WEST + 400.0, SOUTH + 100.0)
    assert note not in slope.ok("--valley-floor", ground)
    key, value = "substrate.valley_floor.friction_coefficient", 0.2
    case = tomllib.loads((slope.case / "case.toml").read_text())["substrate"]
    assert case == {"valley_floor": {"outline": ground.name, "friction": "coefficient", "friction_coefficient": value}}
    sweep = tomllib.loads((slope.case / "sweep.toml").read_text())["sweep"]["range"]
    assert sweep[key][0] < value < sweep[key][1]
    assert "valley_floor: within its polygons, " in thawslide.ok("check", slope.case)
    message = slope.error("--snow", tmp_path / "no.geojson", folder=tmp_path / "none")
    assert message == "error: --snow: no.geojson: there is no such file. Correct the path.\n"
