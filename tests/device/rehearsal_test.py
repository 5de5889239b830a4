"""Whole cases by the code of a card, from start to end.

On thawslide_rehearsal, whose card is the processor; or, with THAWSLIDE_ON_GPU=1, on the program itself and a card.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "release"
PROCESSOR = Path(os.environ.get("THAWSLIDE_BINARY", BUILD / "thawslide"))
LIMIT = 900.0  # s, also of the build
CASES = ROOT / "cases"
# Each with what makes it small: the code of a card goes thread after thread here.
SMALL = {
    "lamplugh": (CASES / "lamplugh", ("grid.cell=40", "time.end=20")),
    "lamplugh-columns": (CASES / "lamplugh-columns", ("grid.cell=40", "time.end=20")),
    "incline": (CASES / "incline" / "DLP.toml", ("time.end=0.2",)),
    "entrainment": (CASES / "entrainment", ("time.end=4",)),
    "valley3d": (CASES / "valley3d", ("grid.cell=60", "time.end=1.2")),
    "valley3d-columns": (CASES / "valley3d" / "columns.toml", ("grid.cell=60", "time.end=1.2")),
}
# Of each column of the history, as a share of the largest value of its unit: round-off that the slide makes larger,
# up to 1.8e-7 in these.
TOLERANCE = 1e-6


@pytest.fixture(scope="session")
def on_card() -> Path:
    """Return the program, built if need be; skip where there is no nvcc."""
    if os.environ.get("THAWSLIDE_ON_GPU"):
        return PROCESSOR
    if shutil.which("nvcc") is None and not Path(os.environ.get("CUDA_HOME", "/usr/local/cuda"), "bin/nvcc").exists():
        pytest.skip("no nvcc")
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


def expect_the_same_history(found: Path, expected: Path) -> None:
    of_card, of_processor = history(found), history(expected)
    assert list(of_card) == list(of_processor)
    largest: dict[str, float] = {}
    for name, values in of_processor.items():
        unit = name.rsplit("_", 1)[-1]
        largest[unit] = np.nanmax(np.abs(values), initial=largest.get(unit, 0.0))
    for name, values in of_processor.items():
        allowed = TOLERANCE * largest[name.rsplit("_", 1)[-1]]
        np.testing.assert_allclose(of_card[name], values, rtol=0.0, atol=allowed, err_msg=name)


def devices(folder: Path) -> list[str]:
    return [part["device"] for part in json.loads((folder / "run.json").read_text())["parts"]]


@pytest.mark.parametrize("name", SMALL)
def test_a_case_goes_from_start_to_end(on_card: Path, tmp_path: Path, name: str) -> None:
    case, sets = SMALL[name][0], settings(name)
    run(PROCESSOR, "run", case, *sets, "--output", tmp_path / "processor")
    run(on_card, "run", case, *sets, "--output", tmp_path / "card", "--device", "gpu")
    assert all(devices(tmp_path / "card"))
    expect_the_same_history(tmp_path / "card", tmp_path / "processor")
    files = [{path.relative_to(run) for path in run.rglob("*")} for run in (tmp_path / "processor", tmp_path / "card")]
    assert files[0] == files[1]


@pytest.mark.parametrize("name", ["incline", "valley3d-columns"])
def test_checkpoints_go_from_the_processor_to_a_card_and_back(on_card: Path, tmp_path: Path, name: str) -> None:
    end = float(SMALL[name][1][-1].split("=")[1])
    case, sets = SMALL[name][0], [*settings(name), "--set", f"time.history_interval={end / 4}"]
    run(PROCESSOR, "run", case, *sets, "--output", tmp_path / "whole")
    run(PROCESSOR, "run", case, *sets, "--set", f"time.end={end / 4}", "--output", tmp_path / "parts")
    run(on_card, "resume", tmp_path / "parts", "--end", end / 2, "--device", "gpu")
    run(PROCESSOR, "resume", tmp_path / "parts", "--end", end)
    assert [device != "" for device in devices(tmp_path / "parts")] == [False, True, False]
    expect_the_same_history(tmp_path / "parts", tmp_path / "whole")


def test_a_killed_run_on_a_card_ends_with_the_same_bits(on_card: Path, tmp_path: Path) -> None:
    case, sets = SMALL["incline"][0], [*settings("incline"), "--set", "checkpoint.interval=0.02"]
    run(on_card, "run", case, *sets, "--output", tmp_path / "whole", "--device", "gpu")
    words = [on_card, "run", case, *sets, "--output", tmp_path / "killed", "--device", "gpu"]
    process = subprocess.Popen([str(word) for word in words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    rows = tmp_path / "killed" / "history.csv"
    while not rows.exists() or rows.read_text().count("\n") < 3:  # a header and two rows: some checkpoints later
        assert process.poll() is None
        time.sleep(0.005)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    outcome = run(on_card, "resume", tmp_path / "killed", "--device", "gpu")
    assert "continuing from t = " in outcome.stdout
    for file in ("history.csv", "checkpoint.bin"):
        assert (tmp_path / "killed" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()
