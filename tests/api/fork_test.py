"""Processes that are forked from one that has run a simulation: their loops have threads and end."""

import multiprocessing
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing.connection import Connection
from pathlib import Path

import pytest
from conftest import silent

import thawslide
from thawslide import Case, Simulation

FORK = multiprocessing.get_context("fork")
HANG = 600.0  # s


def velocity_of(case: Path) -> float:
    """Return the velocity after some steps on two threads."""
    simulation = Simulation(Case(case, {"grid.cell": 2.0, "time.step": 0.001}), threads=2, on_message=silent)
    simulation.step(3)
    return float(simulation.history["mean_velocity_m_s"].iloc[-1])


def in_child(work: Callable[[], float]) -> float:
    """Return the result of a function in a forked process, which must end."""

    def send(connection: Connection) -> None:
        connection.send(work())

    receiver, sender = FORK.Pipe(duplex=False)
    process = FORK.Process(target=send, args=(sender,))
    process.start()
    process.join(HANG)
    is_alive = process.is_alive()
    process.kill()
    assert not is_alive, "the forked process hangs"
    assert process.exitcode == 0
    return float(receiver.recv())


@pytest.fixture
def parent(slope: Path) -> float:
    """Run a simulation on two threads in this process."""
    return velocity_of(slope)


def test_a_simulation_after_a_fork_is_that_of_its_parent(slope: Path, parent: float) -> None:
    assert in_child(lambda: velocity_of(slope)) == parent
    assert velocity_of(slope) == parent  # the parent has its threads again


def test_a_simulation_of_the_parent_continues_in_the_child(slope: Path) -> None:
    simulation = Simulation(slope, threads=2, on_message=silent)
    simulation.step(10)

    def go_on() -> float:
        simulation.step(10)
        return simulation.time

    assert in_child(go_on) == pytest.approx(0.1)
    assert simulation.time == pytest.approx(0.05)


def test_a_run_in_a_folder_ends_after_a_fork(slope: Path, tmp_path: Path, parent: float) -> None:
    case = Case(slope, {"time.end": 0.05})

    def run() -> float:
        return float(len(thawslide.run(case, tmp_path / "run", threads=2, progress=False).history))

    assert in_child(run) == 2.0


def test_a_fork_from_another_thread_ends(slope: Path, parent: float) -> None:
    found: list[float] = []
    thread = threading.Thread(target=lambda: found.append(in_child(lambda: velocity_of(slope))))
    thread.start()
    thread.join()
    assert found == [parent]


def test_pools_of_processes_end(slope: Path, parent: float) -> None:
    with ProcessPoolExecutor(2, mp_context=FORK) as pool:
        assert list(pool.map(velocity_of, [slope, slope], timeout=HANG)) == [parent, parent]
