"""Processes that have used the package end without messages about leaks, whatever they keep until then."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = {
    "observer": "simulation = Simulation(case, on_message=lines.append); simulation.step(3)",
    "observer that refers to the simulation": (
        "class Study:\n"
        "    def __init__(self):\n"
        "        self.simulation = Simulation(case, on_message=self.note)\n"
        "        self.simulation.step(3)\n"
        "    def note(self, line):\n"
        "        lines.append(self)\n"
        "def main():\n"
        "    study = Study()\n"
        "main()"
    ),
    "views": "simulation = Simulation(case, on_message=silent); view = simulation.blocks('velocity'); keep = [view]",
    "law": (
        "def main():\n"
        "    def law(nodes):\n"
        "        return simulation.time + nodes.strength\n"
        "    simulation = Simulation(case, on_message=silent, basal_law=law)\n"
        "    simulation.step(3)\n"
        "main()"
    ),
    "callback": "Simulation(case, on_message=silent).run(callback=lines.append, every_steps=5)",
    "end by sys.exit in a function": (
        "def main():\n"
        "    simulation = Simulation(case, on_message=silent)\n"
        "    simulation.step(3)\n"
        "    sys.exit()\n"
        "main()"
    ),
    "failed law": (
        "def law(nodes):\n"
        "    raise ValueError\n"
        "simulation = Simulation(case, on_message=silent, basal_law=law)\n"
        "try:\n"
        "    simulation.step()\n"
        "except ValueError as error:\n"
        "    lines.append(error)"
    ),
    "run in a folder": "done = thawslide.run(case, folder / 'run', progress=False); lines.append(done)",
    "child of multiprocessing": (
        "simulation = Simulation(case, on_message=silent)\n"
        "simulation.step(3)\n"
        "child = multiprocessing.get_context('fork').Process(target=simulation.step, args=(3,))\n"
        "child.start()\n"
        "child.join()\n"
        "assert child.exitcode == 0"
    ),
    "child of os.fork": (
        "def main():\n"
        "    simulation = Simulation(case, on_message=silent)\n"
        "    simulation.step(3)\n"
        "    child = os.fork()\n"
        "    if child == 0:\n"
        "        simulation.step(3)\n"
        "        sys.exit()\n"
        "    assert os.waitpid(child, 0)[1] == 0\n"
        "main()"
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
