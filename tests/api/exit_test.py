"""Processes that have used the package end without messages about leaks, whatever they keep until then."""

import subprocess
import sys
from pathlib import Path

import pytest

STEPS = ("simulation = Simulation(case, on_message=silent)", "simulation.step(3)")
WITH_LAW = "simulation = Simulation(case, on_message=silent, basal_law=law)"


def in_function(*lines: str) -> str:
    return "\n    ".join(["def main():", *lines]) + "\nmain()"


SCRIPTS = {
    "observer": "simulation = Simulation(case, on_message=lines.append); simulation.step(3)",
    "observer that refers to the simulation": in_function(
        "class Study:", "    def __init__(self):", "        self.simulation = Simulation(case, on_message=self.note)",
        "        self.simulation.step(3)", "    def note(self, line):", "        lines.append(self)", "study = Study()",
    ),
    "views": "simulation = Simulation(case, on_message=silent); view = simulation.blocks('velocity'); keep = [view]",
    "law": in_function(
        "def law(nodes):", "    return simulation.time + nodes.strength", WITH_LAW, "simulation.step(3)",
    ),
    "callback": "Simulation(case, on_message=silent).run(callback=lines.append, every_steps=5)",
    "end by sys.exit in a function": in_function(*STEPS, "sys.exit()"),
    "failed law": "\n".join((
        "def law(nodes):", "    raise ValueError", WITH_LAW, "try:", "    simulation.step()",
        "except ValueError as error:", "    lines.append(error)",
    )),
    "run in a folder": "done = thawslide.run(case, folder / 'run', progress=False); lines.append(done)",
    "child of multiprocessing": "\n".join((
        *STEPS, "child = multiprocessing.get_context('fork').Process(target=simulation.step, args=(3,))",
        "child.start()", "child.join()", "assert child.exitcode == 0",
    )),
    "child of os.fork": in_function(
        *STEPS, "child = os.fork()", "if child == 0:", "    simulation.step(3)", "    sys.exit()",
        "assert os.waitpid(child, 0)[1] == 0",
    ),
}  # fmt: skip
BEGIN = """
import multiprocessing, os, sys
from pathlib import Path
import thawslide
from thawslide import Case, Simulation
folder = Path(sys.argv[1])
case, lines = Case(folder, {"grid.cell": 2.0, "time.end": 0.1}), []
def silent(line):
    pass
"""


@pytest.mark.parametrize("name", SCRIPTS)
def test_a_script_ends_without_messages_about_leaks(slope: Path, name: str) -> None:
    words = [sys.executable, "-c", BEGIN + SCRIPTS[name], slope.parent]
    done = subprocess.run(words, capture_output=True, text=True, timeout=600.0, check=False)
    assert done.returncode == 0 and "nanobind" not in done.stderr, done.stderr
