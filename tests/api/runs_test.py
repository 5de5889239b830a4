"""Runs in folders and the block model from Python, and cases."""

import json
import signal
import threading
import time
from pathlib import Path

import pandas as pd
import pytest
from conftest import CommandLine

import thawslide
from thawslide import Case, RunError, UserError


def test_a_run_has_the_files_of_the_command_line(slope: Path, tmp_path: Path, command_line: CommandLine) -> None:
    assert command_line("run", slope, "--output", tmp_path / "shell").returncode == 0
    run = thawslide.run(slope, tmp_path / "python", threads=1, progress=False)
    names = sorted(path.name for path in (tmp_path / "shell").rglob("*"))
    assert sorted(path.name for path in (tmp_path / "python").rglob("*")) == names
    for name in ("history.csv", "terrain.csv"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "shell" / name).read_bytes()
    assert run.history["time_s"].iloc[-1] == pytest.approx(1.0)


def test_a_failed_run_keeps_its_results(slope: Path, tmp_path: Path) -> None:
    with pytest.raises(RunError, match="the run failed at t = "):
        thawslide.run(Case(slope, {"body.block.velocity": [0.0, 300.0]}), tmp_path / "run", threads=1, progress=False)
    assert json.loads((tmp_path / "run" / "run.json").read_text())["status"] == "failed"


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


class _Failing(thawslide._core.Observer):
    """Raises an exception of its own at the first progress."""

    def text(self, line: str) -> None:
        """Ignore a line."""

    def error(self, line: str) -> None:
        """Ignore a reason."""

    def progress(self, state: thawslide._core.ProgressState) -> None:
        """Fail."""
        raise LookupError("no more")


def test_an_exception_of_an_observer_ends_a_run_that_resume_continues(slope: Path, tmp_path: Path) -> None:
    case = Case(slope, {"time.end": 9.0, "time.step": 0.0001})
    with pytest.raises(LookupError, match="no more"):
        thawslide._core.start_run(case._core, str(tmp_path / "run"), False, "cpu", 1, _Failing())
    facts = json.loads((tmp_path / "run" / "run.json").read_text())
    assert facts["status"] == "stopped" and facts["message"] == "LookupError" and facts["simulated_time_s"] < 9.0
    assert (tmp_path / "run" / "checkpoint.bin").is_file()


class _FailingAtTheEnd(_Failing):
    """Raises an exception of its own when the run, which has failed, ends its progress line."""

    def progress(self, state: thawslide._core.ProgressState) -> None:
        """Ignore a progress."""

    def end_progress(self) -> None:
        """Fail."""
        raise LookupError("no more")


def test_an_exception_of_an_observer_replaces_that_of_a_failed_run(slope: Path, tmp_path: Path) -> None:
    case = Case(slope, {"body.block.velocity": [0.0, 300.0]})
    folder, observer = str(tmp_path / "run"), _FailingAtTheEnd()
    with pytest.raises(LookupError, match="no more") as found:
        thawslide._core.start_run(case._core, folder, False, "cpu", 1, observer)
    assert isinstance(found.value.__context__, RunError)
    assert "the run failed at t = " in str(found.value.__context__)
    assert json.loads((tmp_path / "run" / "run.json").read_text())["status"] == "failed"
    with pytest.raises(LookupError, match="no more") as found:
        thawslide._core.resume_run(folder, [], "cpu", 1, _FailingAtTheEnd())
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


def test_runs_and_resume_end_within_half_a_step(slope: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    case = Case(slope, {"time.step": 0.003, "time.end": 0.199, "time.history_interval": 0.0})
    run = thawslide.run(case, tmp_path / "run", threads=1, progress=False)
    simulation = thawslide.Simulation(case, threads=1)
    simulation.run()
    assert run.history["time_s"].iloc[-1] == pytest.approx(0.198) and simulation.time == pytest.approx(0.198)
    thawslide.resume(tmp_path / "run", {"time.end": 0.1994}, threads=1)
    assert "has reached its end at 0.198 s; nothing to do" in capfd.readouterr().err
    simulation.change({"time.end": 0.1994})
    assert simulation.is_done
    simulation.change({"time.end": 0.2})
    simulation.run()
    run = thawslide.resume(tmp_path / "run", {"time.end": 0.2}, threads=1, progress=False)
    assert run.history["time_s"].iloc[-1] == pytest.approx(0.2) and simulation.time == pytest.approx(0.2)


def test_a_run_prints_lines_and_may_be_replaced(slope: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    thawslide.run(slope, tmp_path / "run", threads=1)
    shown = capfd.readouterr().err
    assert "Block on a slope: " in shown and f"results in {tmp_path / 'run'}" in shown
    with pytest.raises(UserError, match="overwrite"):
        thawslide.run(slope, tmp_path / "run", threads=1, progress=False)
    thawslide.run(slope, tmp_path / "run", overwrite=True, threads=1, progress=False)


def test_a_block_is_that_of_the_command_line(slope: Path, tmp_path: Path, command_line: CommandLine) -> None:
    assert command_line("block", slope, "--output", tmp_path / "block.csv").returncode == 0
    expected = pd.read_csv(tmp_path / "block.csv")
    pd.testing.assert_frame_equal(thawslide.block(slope), expected, check_exact=True, check_dtype=False)


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
    case = Case(slope)
    other = case.copy()
    other["grid.cell"] = 10.0
    assert case["grid.cell"] == 5.0 and other["grid.cell"] == 10.0
    case = Case(slope, {"case.title": 'Gletscher \u00e4\u00f6\u00fc \U0001f3d4 "A"'})
    assert case.title == 'Gletscher \u00e4\u00f6\u00fc \U0001f3d4 "A"'


def test_a_negative_number_of_threads_is_refused(slope: Path, tmp_path: Path) -> None:
    with pytest.raises(UserError, match="threads is -1; allowed: at least 0"):
        thawslide.run(slope, tmp_path / "run", threads=-1)
    with pytest.raises(UserError, match="threads is -2"):
        thawslide.block(slope, threads=-2)
    assert not (tmp_path / "run").exists()


def test_a_case_from_text_is_that_of_its_file(slope: Path) -> None:
    text = slope.read_text()
    assert Case.from_text(text, {"terrain.file": slope.parent / "profile.csv"})["grid"] == Case(slope)["grid"]
    with pytest.raises(UserError, match=r"'grid\.cel' is not known in"):
        Case.from_text(text.replace("cell = 5.0", "cel = 5.0"), {"terrain.file": slope.parent / "profile.csv"})


def test_the_written_case_gives_the_same_case(slope: Path, tmp_path: Path) -> None:
    case = Case(slope, {"basal.friction_angle": 12.5})
    (tmp_path / "written.toml").write_text(case.to_toml())
    again = Case(tmp_path / "written.toml", {"terrain.file": slope.parent / "profile.csv"})
    assert again["basal"] == case["basal"] and again["band"] == case["band"]
