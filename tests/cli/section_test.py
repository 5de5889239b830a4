"""thawslide section cuts a 2D case out of a DEM; thawslide block computes a 3D case along its path."""

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from conftest import Program, Ran, columns_of, history, sets
from terrain_files import place, write_dem, write_line, write_release

SLOPE = 0.5  # fall per metre of x
RELEASE = [(105.0, 155.0), (205.0, 155.0), (205.0, 245.0), (105.0, 245.0)]
STRAIGHT = [(15.0, 200.0), (775.0, 200.0)]


@dataclass(frozen=True)
class Maps:
    """The files of a plane that falls towards +x, with a release on it and a line down it."""

    dem: Path
    release: Path
    line: Path

    def words(self, folder: Path, *more: object) -> list[object]:
        """Return the arguments for the section without a release."""
        return ["section", folder, "--dem", self.dem, "--line", self.line, *more]

    def words_with_release(self, folder: Path, *more: object) -> list[object]:
        """Return the arguments with the release."""
        return self.words(folder, "--release", self.release, *more)


@pytest.fixture
def maps(tmp_path: Path) -> Maps:
    return Maps(
        dem=write_dem(tmp_path / "dem.tif", lambda x, y: 1000.0 - SLOPE * x),
        release=write_release(tmp_path / "release.geojson", RELEASE, thickness=20.0),
        line=write_line(tmp_path / "line.geojson", STRAIGHT),
    )


def profile(folder: Path) -> tuple[list[str], dict[str, np.ndarray]]:
    file = folder / "profile.csv"
    return [line for line in file.read_text().splitlines() if line.startswith("#")], columns_of(file)


def test_section_of_a_plane_runs_unchanged(ran: Ran, thawslide: Program, maps: Maps, tmp_path: Path) -> None:
    folder = tmp_path / "case"
    printed = thawslide.ok(*maps.words_with_release(folder))
    assert sorted(file.name for file in folder.iterdir()) == ["case.toml", "profile.csv"]
    assert "a release of 2,000 m3 per metre of width, 18.7 m thick, on 8 m cells: about 130 particles" in printed
    comments, columns = profile(folder)
    assert comments == [
        "# Cut by `thawslide section` out of dem.tif along line.geojson: its triangles below the line.",
        "# From x = 300015, y = 400200 to x = 300775, y = 400200 in EPSG:31287.",
        "# The terrain is that of the DEM; the surface is higher by the vertical thickness of release.geojson.",
    ]
    distance, terrain = columns["distance_m"], columns["terrain_elevation_m"]
    assert distance[0] == 0.0 and distance[-1] == pytest.approx(760.0) and np.diff(distance).max() <= 5.0 + 1e-9
    assert terrain == pytest.approx(1000.0 - SLOPE * (15.0 + distance), abs=1e-9)
    thickness = columns["surface_elevation_m"] - terrain
    inside = (distance >= 100.0) & (distance <= 180.0)
    assert thickness[inside] == pytest.approx(20.0, abs=1e-9)
    assert (thickness[(distance < 80.0) | (distance > 200.0)] == 0.0).all()
    assert np.trapezoid(thickness, distance) == pytest.approx(2000.0, rel=1e-6)

    text = (folder / "case.toml").read_text()
    case = tomllib.loads(text)
    assert "has no side walls and does not spread" in text and 2 * 18.7 / case["grid"]["cell"] >= 4.0
    assert case["body"]["slide"]["shape"] == "surface" and case["terrain"]["type"] == "profile"
    columns = history(ran(*sets(time__end=2), case=folder))
    assert columns["mean_velocity_m_s"][-1] > 0.5
    assert columns["front_position_m"][-1] > columns["front_position_m"][0] + 0.5


def test_section_shares_its_physics_with_new_or_is_a_profile(thawslide: Program, maps: Maps, tmp_path: Path) -> None:
    thawslide.ok(*maps.words_with_release(tmp_path / "flat"))
    thawslide.ok("new", tmp_path / "space", "--dem", maps.dem, "--release", maps.release)
    flat, space = (tomllib.loads((tmp_path / name / "case.toml").read_text()) for name in ("flat", "space"))
    for table in ("material", "basal", "band"):
        assert flat[table] == space[table]
    for key in ("temperature", "porosity", "particles_per_axis", "material"):
        assert flat["body"]["slide"][key] == space["body"]["slide"][key]
    folder = tmp_path / "case"
    printed = thawslide.ok(*maps.words(folder))
    assert [file.name for file in folder.iterdir()] == ["profile.csv"]
    assert "note: without --release there is no body, and no case.toml was written" in printed
    assert set(profile(folder)[1]) == {"distance_m", "terrain_elevation_m"}


def test_corners_are_kept_and_a_line_uphill_is_reversed(thawslide: Program, maps: Maps, tmp_path: Path) -> None:
    write_line(maps.line, [(703.0, 351.0), (403.0, 200.0), (53.0, 200.0)])
    printed = thawslide.ok(*maps.words_with_release(tmp_path / "case"))
    assert (
        "warning: --line: line.geojson was drawn against the direction of the slide; distances count from its last "
        "corner" in printed
    )
    comments, columns = profile(tmp_path / "case")
    assert comments[1].startswith("# From x = 300053, y = 400200 to x = 300703, y = 400351 ")
    distance, terrain = columns["distance_m"], columns["terrain_elevation_m"]
    corner = np.flatnonzero(np.isclose(distance, 350.0, rtol=0.0, atol=1e-9))
    assert len(corner) == 1 and terrain[corner[0]] == pytest.approx(1000.0 - SLOPE * 403.0)
    assert distance[-1] == pytest.approx(350.0 + np.hypot(300.0, 151.0))
    assert terrain[-1] == pytest.approx(1000.0 - SLOPE * 703.0)


def test_invalid_lines_and_options_are_reported(thawslide: Program, maps: Maps, tmp_path: Path) -> None:
    folder = tmp_path / "case"

    def error(*words: object) -> str:
        message = thawslide.error(*words)
        assert not folder.exists()
        return message.strip()

    write_line(maps.line, [(15.0, 200.0), (815.0, 200.0)])
    x, y = place(800.0, 200.0)
    assert error(*maps.words(folder)) == (
        f"error: --line: {maps.line}: the line is outside the DEM 785 m from its beginning, at x = {x:g}, "
        f"y = {y:g}; its points reach from x = 300005 to 300795 and from y = 400005 to 400395. Draw the line within "
        "them, or take a larger DEM."
    )
    write_line(maps.line, [(15.0, 300.0), (775.0, 300.0)])
    assert error(*maps.words_with_release(folder)) == (
        f"error: --line: {maps.line}: the line does not cross the release of {maps.release}. Draw it through the "
        "release, or leave --release out for the profile alone."
    )
    write_line(maps.line, [(150.0, 200.0), (775.0, 200.0)])
    assert error(*maps.words_with_release(folder)) == (
        f"error: --line: {maps.line}: the section begins 0 m before the release; needed: at least 40 m, 5 cells. Make "
        "the line longer there."
    )
    write_line(maps.line, STRAIGHT)
    assert "--thickness requires --release" in error(*maps.words(folder, "--thickness", 5))
    assert "--line is required" in error("section", folder, "--dem", maps.dem)
    message = thawslide.error(*maps.words_with_release(tmp_path))
    assert message == f"error: {tmp_path}: it exists and is not an empty folder. Choose another name.\n"


def test_block_moves_a_3d_case_along_its_path(thawslide: Program, maps: Maps, tmp_path: Path) -> None:
    folder = tmp_path / "space"
    thawslide.ok("new", folder, "--dem", maps.dem, "--release", maps.release)
    file = tmp_path / "block.csv"
    coulomb = sets(basal__friction="constant", basal__friction_angle=20, pressure__enabled="false")
    coulomb += sets(maps__path=maps.line, time__end=6)
    printed = thawslide.ok("block", folder, "--output", file, *coulomb)
    assert "a section along maps.path, with the mean thickness of the release across the path" in printed
    acceleration = 9.81 * (np.sin(np.arctan(SLOPE)) - np.tan(np.radians(20.0)) * np.cos(np.arctan(SLOPE)))
    assert columns_of(file)["velocity_m_s"] == pytest.approx(acceleration * columns_of(file)["time_s"], abs=1e-6)
    assert "the front leaves the DEM" not in printed
    printed = thawslide.ok("block", folder, *coulomb, *sets(maps__path='""'))
    assert "the line of steepest descent from the centre of the release, because maps.path is not set" in printed
    printed = thawslide.ok("block", folder, "--output", file, *coulomb, *sets(time__end=40))
    reported = re.search(
        r"warning: maps\.path: the front leaves the DEM after 760 m, at (\S+) s, and the table ends there\. Use a "
        r"longer maps\.path, or a larger DEM, to follow it further\n",
        printed,
    )
    assert reported and float(reported[1]) == pytest.approx(
        np.sqrt(2.0 * (760.0 - 190.0) * np.hypot(1.0, SLOPE) / acceleration), rel=0.05
    )
    columns = columns_of(file)
    assert 700.0 < columns["front_position_m"][-1] <= 760.0
    assert columns["time_s"][-1] < float(reported[1])
