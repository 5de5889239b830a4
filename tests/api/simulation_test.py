"""Simulations in memory: they are those of the command line."""

import signal
import threading
from pathlib import Path

import numpy as np
import pytest
from conftest import CommandLine, assert_identical, history_of, silent

from thawslide import Case, RunError, Simulation, UserError


@pytest.mark.parametrize("stepping", ["fixed", "adaptive"])
def test_history_is_that_of_the_command(slope: Path, tmp_path: Path, command_line: CommandLine, stepping: str) -> None:
    command_line("run", slope, "--output", tmp_path / "run", "--set", f"time.stepping={stepping}")
    simulation = Simulation(Case(slope, {"time.stepping": stepping}), threads=2, on_message=silent)
    simulation.run()
    assert simulation.is_done and simulation.time == pytest.approx(1.0)
    assert_identical(simulation.history, history_of(tmp_path / "run"))


def test_a_changed_run_is_that_of_resume(slope: Path, tmp_path: Path, command_line: CommandLine) -> None:
    run = tmp_path / "run"
    command_line("run", slope, "--output", run, "--set", "time.end=0.5")
    command_line("resume", run, "--end", 1, "--set", "basal.friction_angle=45")
    simulation = Simulation(Case(slope, {"time.end": 0.5}), threads=1, on_message=silent)
    simulation.run()
    simulation.change({"time.end": 1.0, "basal.friction_angle": 45.0})
    simulation.run()
    assert_identical(simulation.history, history_of(run))


def test_a_damaged_checkpoint_and_one_of_another_case_are_refused(slope: Path, simulation: Simulation) -> None:
    checkpoint = simulation.checkpoint()
    with pytest.raises(UserError, match="the checkpoint is damaged"):
        simulation.restore(checkpoint[:-1] + b"x")
    other = Simulation(Case(slope, {"basal.friction_angle": 12.0}), threads=1, on_message=silent)
    with pytest.raises(UserError, match=r"of another case: basal\.friction_angle is 12\.0, was 10\.0"):
        other.restore(checkpoint)
    assert other.time == 0.0 and len(other.history) == 1


def test_fields_are_read_only_views(simulation: Simulation) -> None:
    simulation.step(20)
    assert simulation.step_number == 20
    temperature = simulation.field("temperature")
    assert temperature.shape == (simulation.particle_count,) and temperature.base is not None
    assert not temperature.flags.writeable and simulation.field("temperature").ctypes.data == temperature.ctypes.data
    blocks = simulation.blocks("velocity")
    assert blocks.ndim == 3 and blocks.shape[1:] == (8, 2) and not blocks.flags.writeable
    velocity, mass = simulation.field("velocity"), simulation.field("mass")
    assert velocity.shape == (simulation.particle_count, 2)
    mean = np.linalg.norm((mass[:, None] * velocity).sum(axis=0) / mass.sum())
    simulation.run(until=simulation.time + 0.01)
    row = simulation.history.iloc[2]
    assert row["step"] == 20 and mean == pytest.approx(row["mean_velocity_m_s"], rel=1e-12)
    position = simulation.field("position")
    assert position[:, 0].min() > 0.0 and sorted(simulation.field("id")) == list(range(simulation.particle_count))
    assert simulation.fields["velocity"].unit == "m/s" and simulation.fields["stress"].components == 4
    with pytest.raises(UserError, match=r"there is no particle field 'speed'; allowed: id, "):
        simulation.field("speed")


def test_a_restored_simulation_continues_bitwise_with_its_views(slope: Path, simulation: Simulation) -> None:
    temperature = simulation.field("temperature")
    expected = temperature.copy()
    simulation.restore(simulation.checkpoint())
    filled = [np.full(temperature.size, 7.7) for _ in range(100)]  # in memory that the restored state has freed
    np.testing.assert_array_equal(temperature, expected)
    del filled
    whole = Simulation(slope, threads=1, on_message=silent)
    whole.run(until=0.4)
    checkpoint = whole.checkpoint()
    whole.run()
    other = Simulation(slope, threads=2, on_message=silent)
    other.restore(checkpoint)
    assert other.time == pytest.approx(0.4)
    other.run()
    assert_identical(other.history, whole.history)


def test_another_thread_may_not_use_a_simulation_at_work(slope: Path) -> None:
    simulation = Simulation(Case(slope, {"time.end": 9.0, "time.step": 0.0001}), threads=1, on_message=silent)
    worker = threading.Thread(target=lambda: simulation.step(20000))
    worker.start()
    refused = 0
    while worker.is_alive():
        try:
            assert len(simulation.history) >= 1
        except UserError as error:
            assert "another thread uses this simulation" in str(error)
            refused += 1
    worker.join()
    assert refused > 0


def test_a_callback_is_called_at_intervals_and_may_stop(slope: Path) -> None:
    times: list[float] = []
    Simulation(slope, threads=1, on_message=silent).run(callback=lambda now: times.append(now.time), every=0.25)
    assert times == pytest.approx([0.25, 0.5, 0.75, 1.0])
    steps: list[int] = []

    def stop(now: Simulation) -> bool:
        steps.append(now.step_number)
        return len(steps) == 3

    other = Simulation(slope, threads=1, on_message=silent)
    other.run(callback=stop, every_steps=40)
    assert steps == [40, 80, 120] and not other.is_done
    with pytest.raises(UserError, match="one of `every`"):
        other.run(callback=stop)
    with pytest.raises(UserError, match="above 0 s"):
        other.run(callback=stop, every=0.0)


def test_a_restored_end_at_rest_remains_one(slope: Path) -> None:
    case = Case(slope, {"basal.friction_angle": 60.0, "time.end": 9.0, "time.stop_at_rest": 1.0})
    case.change({"time.rest_time": 0.1, "body.block.velocity": [5.0, -2.5]})
    simulation = Simulation(case, threads=1, on_message=silent)
    simulation.run()
    assert simulation.is_done and simulation.time < 9.0 and "rest" in simulation.end_text
    other = Simulation(case, threads=1, on_message=silent)
    other.restore(simulation.checkpoint())
    assert other.is_done and other.time == simulation.time
    other.change({"basal.friction_angle": 5.0})
    assert not other.is_done


def test_a_failure_has_the_message_of_the_command_line(slope: Path, tmp_path: Path, command_line: CommandLine) -> None:
    changes = {"body.block.velocity": [0.0, 300.0]}
    words = ("--output", tmp_path / "run", "--set", "body.block.velocity=[0.0, 300.0]")
    shown = command_line("run", slope, *words, code=3)
    simulation = Simulation(Case(slope, changes), threads=1, on_message=silent)
    with pytest.raises(RunError) as error:
        simulation.run()
    assert shown.stderr.splitlines()[-1] == f"error: {error.value}"
    assert_identical(simulation.history, history_of(tmp_path / "run"))
    with pytest.raises(UserError, match="the simulation has failed"):
        simulation.step()


@pytest.mark.usefixtures("interrupts")
def test_control_c_stops_between_two_steps(slope: Path) -> None:
    simulation = Simulation(Case(slope, {"time.end": 9.0, "time.step": 0.0001}), threads=1, on_message=silent)
    timer = threading.Timer(0.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.run()
    timer.join()
    at = simulation.step_number
    simulation.step()
    assert simulation.step_number == at + 1
