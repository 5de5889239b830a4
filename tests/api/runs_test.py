"""Runs in folders and their results, the block model from Python, and cases."""

import json
import math
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import VALLEY, CommandLine

import thawslide
from thawslide import Case, NotInRunError, ReportError, Run, RunError, UserError


def test_runs_and_blocks_are_those_of_the_command_line(slope: Path, tmp_path: Path, command_line: CommandLine) -> None:
    command_line("run", slope, "--output", tmp_path / "shell")
    run = thawslide.run(slope, tmp_path / "python", threads=1, progress=False)
    names = sorted(path.name for path in (tmp_path / "shell").rglob("*"))
    assert sorted(path.name for path in (tmp_path / "python").rglob("*")) == names
    for name in ("history.csv", "terrain.csv"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "shell" / name).read_bytes()
    assert run.history["time_s"].iloc[-1] == pytest.approx(1.0)
    command_line("block", slope, "--output", tmp_path / "block.csv")
    expected = pd.read_csv(tmp_path / "block.csv")
    pd.testing.assert_frame_equal(thawslide.block(slope), expected, check_exact=True, check_dtype=False)


@pytest.mark.usefixtures("interrupts")
def test_control_c_stops_a_run_that_resume_continues(slope: Path, tmp_path: Path) -> None:
    case = Case(slope, {"time.end": 9.0, "time.step": 0.0001})
    history = tmp_path / "run" / "history.csv"

    def interrupt() -> None:
        deadline = time.monotonic() + 600.0
        while time.monotonic() < deadline and (not history.is_file() or history.read_text().count("\n") < 3):
            time.sleep(0.01)
        signal.raise_signal(signal.SIGINT)

    interrupter = threading.Thread(target=interrupt)
    interrupter.start()
    with pytest.raises(KeyboardInterrupt, match="To continue: thawslide resume"):
        thawslide.run(case, tmp_path / "run", threads=1, progress=False)
    interrupter.join()
    facts = json.loads((tmp_path / "run" / "run.json").read_text())
    assert facts["status"] == "stopped" and 0.0 < facts["simulated_time_s"] < 9.0
    end = facts["simulated_time_s"] + 0.5
    run = thawslide.resume(tmp_path / "run", {"time.end": end}, threads=1, progress=False)
    assert run.history["time_s"].iloc[-1] == pytest.approx(end, abs=0.0002)


def fail(*_: object) -> None:
    raise LookupError("no more")


def observer(**methods: Callable[..., None]) -> thawslide._core.Observer:
    """Return an observer that ignores everything else."""
    silent = dict.fromkeys(("text", "error", "progress"), lambda *_: None)
    return type("Observer", (thawslide._core.Observer,), silent | methods)()


def test_an_exception_of_an_observer_ends_a_run_that_resume_continues(slope: Path, tmp_path: Path) -> None:
    case = Case(slope, {"time.end": 9.0, "time.step": 0.0001})
    with pytest.raises(LookupError, match="no more"):
        thawslide._core.start_run(case._core, str(tmp_path / "run"), False, "cpu", 1, observer(progress=fail))
    facts = json.loads((tmp_path / "run" / "run.json").read_text())
    assert facts["status"] == "stopped" and facts["message"] == "LookupError" and facts["simulated_time_s"] < 9.0
    assert (tmp_path / "run" / "checkpoint.bin").is_file()


def test_an_exception_of_an_observer_replaces_that_of_a_failed_run(slope: Path, tmp_path: Path) -> None:
    """It is raised when the run, which has failed, ends its progress line."""
    case, folder = Case(slope, {"body.block.velocity": [0.0, 300.0]}), str(tmp_path / "run")
    with pytest.raises(LookupError, match="no more") as found:
        thawslide._core.start_run(case._core, folder, False, "cpu", 1, observer(end_progress=fail))
    assert isinstance(found.value.__context__, RunError)
    assert "the run failed at t = " in str(found.value.__context__)
    assert json.loads((tmp_path / "run" / "run.json").read_text())["status"] == "failed"
    with pytest.raises(LookupError, match="no more") as found:
        thawslide._core.resume_run(folder, [], "cpu", 1, observer(end_progress=fail))
    assert isinstance(found.value.__context__, RunError)


def test_an_exception_of_on_message_leaves_a_simulation_usable(slope: Path) -> None:
    is_failing: list[bool] = []

    def on_message(line: str) -> None:
        if is_failing:
            raise LookupError(line)

    simulation = thawslide.Simulation(slope, threads=1, on_message=on_message)
    is_failing.append(True)
    with pytest.raises(LookupError, match="warning: "):
        simulation.change({"basal.friction_angle": 12.0})
    is_failing.clear()
    simulation.run(until=0.1)
    assert simulation.time == pytest.approx(0.1)


def test_runs_print_lines_may_be_replaced_and_may_fail(
    slope: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    thawslide.run(slope, tmp_path / "run", threads=1)
    shown = capfd.readouterr().err
    assert "Block on a slope: " in shown and f"results in {tmp_path / 'run'}" in shown
    with pytest.raises(UserError, match="overwrite"):
        thawslide.run(slope, tmp_path / "run", threads=1, progress=False)
    failing = Case(slope, {"body.block.velocity": [0.0, 300.0]})
    with pytest.raises(RunError, match="the run failed at t = "):
        thawslide.run(failing, tmp_path / "run", overwrite=True, threads=1, progress=False)
    assert json.loads((tmp_path / "run" / "run.json").read_text())["status"] == "failed"


def test_a_case_reads_and_replaces_keys_and_its_copy_is_independent(slope: Path) -> None:
    case = Case(slope)
    assert case.title == "Block on a slope" and case.dimension == 2 and case.end == 1.0
    assert case["grid.cell"] == 5.0 and case["band"]["thickness"] == 0.1 and case["time.stepping"] == "fixed"
    case["band.thickness"] = 0.3
    case.change({"body.block.velocity": (1.0, -0.5), "time.stop_at_rest": 0.1, "heat.enabled": True})
    assert case["band.thickness"] == 0.3 and case["body.block.velocity"] == [1.0, -0.5]
    with pytest.raises(UserError, match=r"band\.thickness is -1"):
        case["band.thickness"] = -1.0
    assert case["band.thickness"] == 0.3
    with pytest.raises(KeyError):
        case["band.width"]
    with pytest.raises(TypeError, match="no value of type object"):
        case["band.thickness"] = object()
    other = case.copy()
    other["grid.cell"] = 10.0
    assert case["grid.cell"] == 5.0 and other["grid.cell"] == 10.0
    title = 'Gletscher \u00e4\u00f6\u00fc \U0001f3d4 "A"'
    assert Case(slope, {"case.title": title}).title == title


def test_a_negative_number_of_threads_is_refused(slope: Path, tmp_path: Path) -> None:
    with pytest.raises(UserError, match="threads is -1; allowed: at least 0"):
        thawslide.run(slope, tmp_path / "run", threads=-1)
    with pytest.raises(UserError, match="threads is -2"):
        thawslide.block(slope, threads=-2)
    assert not (tmp_path / "run").exists()


def test_texts_of_cases_give_the_same_case(slope: Path, tmp_path: Path) -> None:
    text, profile = slope.read_text(), {"terrain.file": slope.parent / "profile.csv"}
    assert Case.from_text(text, profile)["grid"] == Case(slope)["grid"]
    with pytest.raises(UserError, match=r"'grid\.cel' is not known in"):
        Case.from_text(text.replace("cell = 5.0", "cel = 5.0"), profile)
    case = Case(slope, {"basal.friction_angle": 12.5})
    (tmp_path / "written.toml").write_text(case.to_toml())
    again = Case(tmp_path / "written.toml", profile)
    assert again["basal"] == case["basal"] and again["band"] == case["band"]


@pytest.fixture(scope="module")
def map_run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    folder = tmp_path_factory.mktemp("map") / "run"
    case = Case(VALLEY, {"time.end": 0.4, "time.output_interval": 0.2, "grid.cell": 40.0})
    return thawslide.run(case, folder, threads=1, progress=False)


def test_a_2d_run_has_a_table_and_no_maps(run: Run) -> None:
    expected = pd.read_csv(run.folder / "history.csv").astype(float)
    pd.testing.assert_frame_equal(run.history, expected, check_exact=True)
    with pytest.raises(NotInRunError, match="Only a 3D run on a DEM writes maps"):
        _ = run.maps


def test_key_numbers_are_in_the_units_of_their_names(slope: Path, tmp_path: Path) -> None:
    run = thawslide.run(Case(slope, {"case.width": 50.0}), tmp_path / "run", threads=1, progress=False)
    numbers = run.key_numbers
    assert numbers["release_volume_m3"] == pytest.approx(40_000.0, rel=0.01)  # 40 m long, 20 m high, 50 m wide
    assert numbers["simulated_time_s"] == pytest.approx(1.0)
    assert numbers["peak_mean_velocity_m_s"] == run.history["mean_velocity_m_s"].max()
    assert math.isnan(numbers["stop_time_s"]) and all(isinstance(number, float) for number in numbers.values())


def test_maps_are_arrays_with_coordinates(map_run: Run) -> None:
    assert "max_thickness" in map_run.maps and len(map_run.maps) == len(list(map_run.maps))
    thickness = map_run.maps["max_thickness"]
    assert thickness.unit == "m" and map_run.key_numbers["peak_thickness_m"] == np.nanmax(thickness.values)


def test_a_map_is_an_array_of_xarray(map_run: Run) -> None:
    pytest.importorskip("rioxarray")
    thickness = map_run.maps["max_thickness"]
    array = thickness.to_xarray()
    assert array.dims == ("y", "x") and array.attrs["units"] == "m"
    np.testing.assert_array_equal(array.values, thickness.values)
    assert float(array.sel(x=array.x[3]).y[-1]) == thickness.grid.y[-1]
    assert array.rio.resolution() == (thickness.grid.cell_x, thickness.grid.cell_y)


def test_a_report_is_that_of_the_command_line(tmp_path: Path, run: Run, slope: Path) -> None:
    page = thawslide.report(run, only="motion", dpi=40)
    assert page == tmp_path / "run" / "report.html" and (tmp_path / "run" / "figures" / "motion.png").is_file()
    assert thawslide.report(run.folder, only=["motion"], output=tmp_path / "other", dpi=40).parent == tmp_path / "other"
    with pytest.raises(ReportError, match="no figure 'notion'; did you mean motion"):
        thawslide.report(run, only="notion")
    with pytest.raises(ReportError, match="found 10; allowed 30 to 1200"):
        thawslide.report(run, dpi=10)
    short = thawslide.run(Case(slope, {"time.end": 0.5}), tmp_path / "short", threads=1, progress=False)
    page = thawslide.report(run, short, dpi=40)
    assert page.name == "comparison.html" and "short" in page.read_text()


def test_a_new_case_is_that_of_the_command_line(tmp_path: Path, command_line: CommandLine) -> None:
    files = {"dem": VALLEY / "valley.tif", "release": VALLEY / "release.geojson"}
    lines: list[str] = []
    case = thawslide.new_case(
        **files, folder=tmp_path / "python", thickness=12.0, cell=20.0, cut=True, glacier=files["release"],
        on_message=lines.append,
    )  # fmt: skip
    words = ("--thickness=12", "--cell=20", "--cut", f"--glacier={files['release']}", "shell")
    command_line("new", f"--dem={files['dem']}", f"--release={files['release']}", *words)
    assert case["grid.cell"] == 20.0 and case.name == "python"
    assert case["substrate.glacier.friction_coefficient"] == 0.1
    made, other = ((tmp_path / name / "case.toml").read_text() for name in ("python", "shell"))
    assert made.replace('"python"', '"shell"') == other
    assert any("a release of" in line for line in lines)
    with pytest.raises(UserError, match=r"^thickness: -1"):
        thawslide.new_case(**files, folder=tmp_path / "wrong", thickness=-1.0)
    assert not (tmp_path / "wrong").exists()
