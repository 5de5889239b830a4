"""Reading of runs: histories, maps and key numbers."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT, CommandLine

import thawslide
from thawslide import Case, NotInRunError, ReportError, Run, UserError

VALLEY = ROOT / "cases" / "valley3d"


@pytest.fixture(scope="module")
def map_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("map") / "run"
    case = Case(VALLEY, {"time.end": 0.4, "time.output_interval": 0.2, "grid.cell": 40.0})
    return thawslide.run(case, folder, threads=1, progress=False)


def test_a_2d_run_has_a_table_and_no_maps(slope: Path, tmp_path: Path) -> None:
    run = thawslide.run(slope, tmp_path / "run", threads=1, progress=False)
    expected = pd.read_csv(run.folder / "history.csv").astype(float)
    pd.testing.assert_frame_equal(run.history, expected, check_exact=True)
    shot = run.snapshot(-1)
    assert shot.time == pytest.approx(1.0) and shot.points.shape == (len(shot["mass"]), 3)
    assert shot.unit("temperature") == "degC"
    with pytest.raises(NotInRunError, match="Only a 3D run on a DEM writes maps"):
        _ = run.maps


def test_key_numbers_are_in_the_units_of_their_names(slope: Path, tmp_path: Path) -> None:
    run = thawslide.run(Case(slope, {"case.width": 50.0}), tmp_path / "run", threads=1, progress=False)
    numbers = run.key_numbers
    assert numbers["release_volume_m3"] == pytest.approx(40_000.0, rel=0.01)  # 40 m long, 20 m high, 50 m wide
    assert numbers["simulated_time_s"] == pytest.approx(1.0)
    assert numbers["peak_mean_velocity_m_s"] == run.history["mean_velocity_m_s"].max()
    assert math.isnan(numbers["stop_time_s"])
    assert all(isinstance(number, float) for number in numbers.values())


def test_maps_are_arrays_with_coordinates(map_run: Run) -> None:
    assert "max_thickness" in map_run.maps and len(map_run.maps) == len(list(map_run.maps))
    thickness = map_run.maps["max_thickness"]
    assert thickness.unit == "m" and map_run.key_numbers["peak_thickness_m"] == np.nanmax(thickness.values)
    with pytest.raises(NotInRunError, match="no such map"):
        map_run.maps["thickness"]
    (area,) = map_run.features("affected_area")
    assert area.parts[0].shape[1] == 2
    with pytest.raises(NotInRunError, match="no layer"):
        map_run.features("area")


def test_a_map_is_an_array_of_xarray(map_run: Run) -> None:
    pytest.importorskip("rioxarray")
    thickness = map_run.maps["max_thickness"]
    array = thickness.to_xarray()
    assert array.dims == ("y", "x") and array.attrs["units"] == "m"
    np.testing.assert_array_equal(array.values, thickness.values)
    assert float(array.sel(x=array.x[3]).y[-1]) == thickness.grid.y[-1]
    assert array.rio.resolution() == (thickness.grid.cell_x, thickness.grid.cell_y)


def test_a_report_is_that_of_the_command_line(slope: Path, tmp_path: Path) -> None:
    run = thawslide.run(slope, tmp_path / "run", threads=1, progress=False)
    page = thawslide.report(run, only="motion", dpi=40)
    assert page == tmp_path / "run" / "report.html" and (tmp_path / "run" / "figures" / "motion.png").is_file()
    assert thawslide.report(run.folder, only=["motion"], output=tmp_path / "other", dpi=40).parent == tmp_path / "other"
    with pytest.raises(ReportError, match="no figure 'notion'; did you mean motion"):
        thawslide.report(run, only="notion")
    with pytest.raises(ReportError, match="found 10; allowed 30 to 1200"):
        thawslide.report(run, dpi=10)


def test_a_report_of_two_runs_compares_them(slope: Path, tmp_path: Path) -> None:
    runs = [
        thawslide.run(Case(slope, {"basal.friction_angle": angle}), tmp_path / name, threads=1, progress=False)
        for name, angle in (("smooth", 5.0), ("rough", 20.0))
    ]
    page = thawslide.report(*runs, dpi=40)
    assert page.name == "comparison.html" and "rough" in page.read_text()


def test_a_new_case_is_that_of_the_command_line(tmp_path: Path, command_line: CommandLine) -> None:
    files = {"dem": VALLEY / "valley.tif", "release": VALLEY / "release.geojson"}
    lines: list[str] = []
    case = thawslide.new_case(
        **files, folder=tmp_path / "python", thickness=12.0, cell=20.0, cut=True, glacier=files["release"],
        on_message=lines.append,
    )  # fmt: skip
    words = ("--thickness=12", "--cell=20", "--cut", f"--glacier={files['release']}", "shell")
    done = command_line("new", f"--dem={files['dem']}", f"--release={files['release']}", *words)
    assert done.returncode == 0, done.stderr
    assert case["grid.cell"] == 20.0 and case.name == "python"
    assert case["substrate.glacier.friction_coefficient"] == 0.1
    made, other = ((tmp_path / name / "case.toml").read_text() for name in ("python", "shell"))
    assert made.replace('"python"', '"shell"') == other
    assert any("a release of" in line for line in lines)
    with pytest.raises(UserError, match=r"^thickness: -1"):
        thawslide.new_case(**files, folder=tmp_path / "wrong", thickness=-1.0)
    assert not (tmp_path / "wrong").exists()
