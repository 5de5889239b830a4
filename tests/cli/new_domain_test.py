"""Cases by `thawslide new`: their base, releases near an edge and cut out, resolutions, and warnings."""

import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
import terrain_files
from conftest import Program, Ran, Slope, history, release_volume, sets
from terrain_files import CELL, DEPTH, SOUTH, WEST, WIDTH, write_dem, write_line, write_rectangle


@pytest.mark.parametrize(
    "corner",
    [(6.0, 7.0), ((terrain_files.COLUMNS - 1) * CELL - WIDTH - 6.0, (terrain_files.ROWS - 1) * CELL - DEPTH - 7.0)],
    ids=["low", "high"],
)
def test_a_release_at_the_edge_runs(ran: Ran, tmp_path: Path, slope: Slope, corner: tuple[float, float]) -> None:
    """The domain includes the outermost points, although their distance is no multiple of the grid's cell, 6 m."""
    release = write_rectangle(tmp_path / "edge.geojson", WEST + corner[0], SOUTH + corner[1])
    slope.ok(release=release, thickness=23)
    ran("--set", "time.end=0.01", case=slope.case)


def test_more_particles_than_memory_are_refused(slope: Slope) -> None:
    message = slope.error("--cell", 0.02, thickness=0.02)
    assert re.fullmatch(
        r"error: --cell: a release 0\.02 m thick with cells of 0\.02 m and 2\d0,000,000 particles; they need about "
        r"[34]\d0 GB of memory, and \S+ GB are [a-z -()]+\. Set --cell \S+ or more, which is coarser\.\n",
        message,
    ), message


def test_holes_in_the_flow_path_have_a_warning(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    slope.new(dem=slope(hole=slice(40, 45)))
    note = (
        r"warning: 50 of \d+ points of the DEM within the domain have no data, such as "
        r"\(412400, 5160(2[5-9]|3[0-4])0\): a slide that gets there "
    )
    assert re.search(note + r"ends the run\n", thawslide.ok("check", slope.case, "--set", 'grid.leaving="stop"'))
    printed = thawslide.ok("run", slope.case, "--output", tmp_path / "run", "--set", "time.end=0.01")
    assert re.search(note + r"is removed and counted\n", printed), printed


def test_new_prints_the_next_commands(binary: Path, tmp_path: Path, slope: Slope) -> None:
    folder = tmp_path / "a slide"
    outcome = slope.new(folder=folder)
    assert f"preview:  {binary} check '{folder}' --picture\nblock:    {binary} block '{folder}'\n" in outcome.stdout
    assert f"run:      {binary} run '{folder}'\n" in outcome.stdout
    assert f"forecast: {binary} forecast '{folder}'\n" in outcome.stdout


CELLS = {"quick": 12.0, "standard": 6.0, "fine": 3.0}  # m, for 24 m
DURATION = r"(?:\S+ (?:s|min|h|days))"


def cell_of(folder: Path) -> float:
    return float(tomllib.loads((folder / "case.toml").read_text())["grid"]["cell"])


@pytest.mark.parametrize("resolution", ["", "quick", "standard"])
def test_new_reports_the_cell_and_the_cost(thawslide: Program, tmp_path: Path, slope: Slope, resolution: str) -> None:
    words = ["--resolution", resolution] if resolution else []
    printed = slope.ok(*words)
    chosen = resolution or "quick"
    assert cell_of(slope.case) == CELLS[chosen]
    found = re.search(
        rf"^resolution:  {chosen}, cells of {CELLS[chosen]:g} m; [0-9a-z %.,:()]+\n"
        rf" +about (\S+) particles, (\S+) steps to time\.end, and {DURATION} of processor time"
        r"( \(this machine is busy: .*\))?$",
        printed,
        re.MULTILINE,
    )
    assert found, printed
    checked = thawslide.json("check", slope.case)
    assert float(found[1].replace(",", "")) == pytest.approx(checked["particles"], rel=0.1)
    assert float(found[2].replace(",", "")) == pytest.approx(checked["steps"], rel=0.05)
    pattern = rf"^ +--resolution (\w+): cells of (\S+) m, about {DURATION} of processor time; [0-9a-z %.,:()]+$"
    others = {name: float(cell) for name, cell in re.findall(pattern, printed, re.MULTILINE)}
    assert others == {name: cell for name, cell in CELLS.items() if name != chosen}
    assert "warning: " not in printed, "the text names the cells for maps"


def test_a_cell_given_by_the_user_has_no_resolution_name(tmp_path: Path, slope: Slope) -> None:
    printed = slope.ok("--cell", 15, folder=tmp_path / "own")
    assert cell_of(tmp_path / "own") == 15.0
    assert "\nresolution:  cells of 15 m\n             about " in printed
    assert printed.count("--resolution ") == 3
    assert "warning: --cell: across the median thickness" in printed


SIDE, THICK = 200.0, 20.0  # of the release [m]
VOLUME = SIDE * SIDE * THICK
# A slide on the slope of 30 degrees moves with friction of 17 degrees; with 25, the level ramp stops it at any width.
COARSE = sets(grid__cell=12, time__end=8, basal__friction="constant", basal__friction_angle=17)


def test_a_release_that_is_cut_out_leaves_the_cut(thawslide: Program, tmp_path: Path, slope: Slope) -> None:
    release = write_rectangle(tmp_path / "wide.geojson", WEST + 150.0, SOUTH + 200.0, SIDE, SIDE)
    printed = slope.ok("--cut", release=release, thickness=THICK)
    # The cell is that for most of the volume; most of the area is below ramps.
    assert printed.count("warning: --cell: across the median thickness of body slide, 10 m, there are too few ") == 1
    assert (
        "Vertical\n# edges would trap the slide. At their steepest, the ramps rise 29.7 degrees against the DEM, which "
        "falls 30.0\n# degrees here.\ntaper = 70.0  # m\n"
    ) in (slope.case / "case.toml").read_text()
    walls = sets(body__slide__taper=0)
    top = [*walls, *sets(body__slide__placement="on_top")]
    speeds = {}
    for name, words in (("ramps", []), ("walls", walls), ("top", top)):
        thawslide.ok("run", slope.case, "--output", tmp_path / name, *COARSE, *words)
        speeds[name] = history(tmp_path / name)["mean_velocity_m_s"][-1]
        assert release_volume(tmp_path / name) == pytest.approx(VOLUME, rel=1e-9), name
    assert speeds["ramps"] > 0.6 * speeds["top"]
    assert speeds["walls"] < 0.8 * speeds["ramps"]


def test_ramps_near_the_edge_of_the_dem_are_as_wide_as_possible(ran: Ran, tmp_path: Path, slope: Slope) -> None:
    release = write_rectangle(tmp_path / "edge.geojson", WEST + 23.0, SOUTH + 200.0, SIDE, SIDE)
    printed = slope.ok("--cut", release=release, thickness=THICK)
    assert printed.startswith(
        "warning: --cut: the edges of the cut are too narrow, because the release is narrow or near the edge of the "
        "known terrain (found 40 m; needed 70 m). "
    ), printed
    assert (
        "70.0 m is needed, but the release is too narrow.\ntaper = 40.0  # m\n"
        in (slope.case / "case.toml").read_text()
    )
    ran("--set", "time.end=0.01", case=slope.case)
    assert release_volume(tmp_path / "run") == pytest.approx(VOLUME, rel=1e-9)


def test_a_section_has_the_ramps_too(thawslide: Program, tmp_path: Path) -> None:
    outline = [(155.0, 105.0), (355.0, 105.0), (355.0, 305.0), (155.0, 305.0)]
    words = [
        *("--dem", write_dem(tmp_path / "dem.tif", lambda x, y: 1000.0 - 0.5 * x)),
        *("--release", terrain_files.write_release(tmp_path / "release.geojson", outline)),
        *("--line", write_line(tmp_path / "line.geojson", [(15.0, 205.0), (775.0, 205.0)])),
    ]
    thawslide.ok("section", tmp_path / "case", *words, "--thickness", THICK, "--cut")
    lines = (tmp_path / "case" / "profile.csv").read_text().splitlines()
    surface = "# The surface is that of the DEM; the terrain is lower by the vertical thickness of release.geojson."
    assert lines[2] == surface
    assert lines[3] == (
        "# The edges of the cut are ramps 80 m wide, half of it beyond the outline: vertical edges would trap "
        "the slide."
    )
    distance, terrain, surface = np.array([line.split(",") for line in lines[5:]], dtype=float).T
    assert np.trapezoid(surface - terrain, distance) == pytest.approx(SIDE * THICK, rel=1e-9)
    assert (surface - terrain).max() == pytest.approx(THICK, abs=1e-9)
    assert surface == pytest.approx(1000.0 - 0.5 * (15.0 + distance), abs=1e-9), "that of the DEM"
    thawslide.ok("check", tmp_path / "case")
    steepest = np.max(np.diff(terrain) / np.diff(distance))
    assert -0.05 < steepest < 0.01, "the base falls or is level everywhere"


def test_a_base_above_the_limit_of_temperature_has_a_warning(thawslide: Program, tmp_path: Path) -> None:
    dem = write_dem(tmp_path / "dem.tif", lambda x, y: 4000.0 - np.minimum(x, 2800.0) - 0.1 * x, 180, 60, 20.0)
    corners = [(400.0, 400.0), (900.0, 400.0), (900.0, 800.0), (400.0, 800.0)]
    release = terrain_files.write_release(tmp_path / "release.geojson", corners)
    words = ["--dem", dem, "--release", release, "--thickness"]
    printed = thawslide.ok("new", tmp_path / "thick", *words, 150)
    heated = re.search(r"a band of 2\.0 m, which a rigid block without pore pressure heats to (\d+) C\n", printed)
    assert heated and int(heated[1]) > 210, printed
    assert (
        "warning: band.thickness: friction heats the base of the rigid block above 210 C, which is not credible (found "
        f"{heated[1]} C with 2 m). Set a lower basal.friction_angle or a larger band.thickness"
    ) in printed
    assert "which is not credible" not in thawslide.ok("new", tmp_path / "thin", *words, 30)


def test_a_release_that_leaves_the_dem_at_once_has_a_case(slope: Slope) -> None:
    slope(degrees=45.0, foot=800.0)
    assert "/case.toml: a release of 1,800,000 m3, 150 m thick, on " in slope.ok(thickness=150)


@pytest.mark.parametrize(
    "words",
    ["--on-top", "--cut", "--resolution standard", "--cell 10", "--reach-angle 12", "--glacier", "--snow",
     "--valley-floor"],
)  # fmt: skip
def test_check_has_no_warning_of_values_of_new(thawslide: Program, slope: Slope, tmp_path: Path, words: str) -> None:
    """The cell is a choice, whose errors `new` states."""
    given: list[object] = list(words.split())
    if words in ("--glacier", "--snow", "--valley-floor"):
        given.append(write_rectangle(tmp_path / "ground.geojson", WEST + 400.0, SOUTH + 100.0))
    printed = slope.ok(*given)
    checked = thawslide.json("check", slope.case)
    assert math.isfinite(checked["bodies"][0]["volume_m3"])
    warnings = [text for text in checked["warnings"] if not text.startswith("note: ")]
    assert [text for text in warnings if " grid.cell: across " not in text] == [], printed
