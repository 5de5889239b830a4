"""Complete cases on the GPU code path.

The program is thawslide_rehearsal, which emulates the GPU on the CPU; with THAWSLIDE_ON_GPU=1 it is thawslide on a GPU.
"""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "release"
ON_CPU = Path(os.environ.get("THAWSLIDE_BINARY", BUILD / "thawslide"))
LIMIT = 900.0  # s, also of the build
CASES = ROOT / "cases"
# Cases with settings that make them small: the emulation executes one thread at a time.
SMALL = {
    "lamplugh": (CASES / "lamplugh", ("grid.cell=40", "time.end=20")),
    "lamplugh-columns": (CASES / "lamplugh-columns", ("grid.cell=40", "time.end=20")),
    "incline": (CASES / "incline" / "DLP.toml", ("time.end=0.2",)),
    "entrainment": (CASES / "entrainment", ("time.end=4",)),
    "valley3d": (CASES / "valley3d", ("grid.cell=60", "time.end=1.2")),
    "valley3d-columns": (CASES / "valley3d" / "columns.toml", ("grid.cell=60", "time.end=1.2")),
}
# Of each column of the history, relative to the maximum value of its unit. The slide amplifies round-off, here to
# 1.8e-7.
TOLERANCE = 1e-6


@pytest.fixture(scope="session")
def on_gpu() -> Path:
    if os.environ.get("THAWSLIDE_ON_GPU"):
        return ON_CPU
    command = ["cmake", "--build", str(BUILD), "--target", "thawslide_rehearsal"]
    built = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    assert built.returncode == 0, built.stdout[-4000:]
    return BUILD / "tests" / "thawslide_rehearsal"


def run(program: Path, *words: object) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=LIMIT, check=False)
    assert done.returncode == 0, done.stderr
    return done


def settings(name: str) -> list[str]:
    return [word for setting in SMALL[name][1] for word in ("--set", setting)]


def history(folder: Path) -> dict[str, np.ndarray]:
    columns = np.genfromtxt(folder / "history.csv", delimiter=",", names=True, deletechars="")
    return {name: np.atleast_1d(columns[name]) for name in columns.dtype.names}


def expect_same_history(found: Path, expected: Path) -> None:
    of_gpu, of_cpu = history(found), history(expected)
    assert list(of_gpu) == list(of_cpu)
    largest: dict[str, float] = {}
    for name, values in of_cpu.items():
        unit = name.rsplit("_", 1)[-1]
        largest[unit] = np.nanmax(np.abs(values), initial=largest.get(unit, 0.0))
    for name, values in of_cpu.items():
        allowed = TOLERANCE * largest[name.rsplit("_", 1)[-1]]
        np.testing.assert_allclose(of_gpu[name], values, rtol=0.0, atol=allowed, err_msg=name)


def devices(folder: Path) -> list[str]:
    return [part["device"] for part in json.loads((folder / "run.json").read_text())["parts"]]


@pytest.mark.parametrize("name", SMALL)
def test_a_case_has_the_same_history_on_gpu_and_cpu(on_gpu: Path, tmp_path: Path, name: str) -> None:
    case, sets = SMALL[name][0], settings(name)
    run(ON_CPU, "run", case, *sets, "--output", tmp_path / "cpu")
    run(on_gpu, "run", case, *sets, "--output", tmp_path / "gpu", "--device", "gpu")
    assert all(devices(tmp_path / "gpu"))
    expect_same_history(tmp_path / "gpu", tmp_path / "cpu")
    files = [{path.relative_to(run) for path in run.rglob("*")} for run in (tmp_path / "cpu", tmp_path / "gpu")]
    assert files[0] == files[1]


@pytest.mark.parametrize("name", ["incline", "valley3d-columns"])
def test_a_run_continues_from_cpu_to_gpu_and_back(on_gpu: Path, tmp_path: Path, name: str) -> None:
    end = float(SMALL[name][1][-1].split("=")[1])
    case, sets = SMALL[name][0], [*settings(name), "--set", f"time.history_interval={end / 4}"]
    run(ON_CPU, "run", case, *sets, "--output", tmp_path / "complete")
    run(ON_CPU, "run", case, *sets, "--set", f"time.end={end / 4}", "--output", tmp_path / "parts")
    run(on_gpu, "resume", tmp_path / "parts", "--end", end / 2, "--device", "gpu")
    run(ON_CPU, "resume", tmp_path / "parts", "--end", end)
    assert [device != "" for device in devices(tmp_path / "parts")] == [False, True, False]
    expect_same_history(tmp_path / "parts", tmp_path / "complete")


# Adaptive steps follow from particles at the start of a part, and heights above the ground from their positions.
@pytest.mark.parametrize(
    ("name", "rows", "checkpoints"), [("incline", 0.05, 0.02), ("valley3d", 0.1, 0.2), ("lamplugh-columns", 1.0, 2.0)]
)
def test_a_killed_run_on_a_gpu_ends_bitwise_identical(
    on_gpu: Path, tmp_path: Path, name: str, rows: float, checkpoints: float
) -> None:
    every = (f"time.history_interval={rows}", f"checkpoint.interval={checkpoints}")
    case, sets = SMALL[name][0], [*settings(name), *(word for key in every for word in ("--set", key))]
    run(on_gpu, "run", case, *sets, "--output", tmp_path / "complete", "--device", "gpu")
    words = [on_gpu, "run", case, *sets, "--output", tmp_path / "killed", "--device", "gpu"]
    process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    written = tmp_path / "killed" / "history.csv"
    while not written.exists() or written.read_text().count("\n") < 5:  # four rows: after the second checkpoint
        assert process.poll() is None
        time.sleep(0.005)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    outcome = run(on_gpu, "resume", tmp_path / "killed", "--device", "gpu")
    assert "continuing from t = " in outcome.stdout
    assert "continuing from t = 0 s" not in outcome.stdout
    for file in ("history.csv", "checkpoint.bin"):
        assert (tmp_path / "killed" / file).read_bytes() == (tmp_path / "complete" / file).read_bytes()
