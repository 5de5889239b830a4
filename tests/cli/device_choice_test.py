"""Selection of the device of a run: --device."""

import json
from pathlib import Path

import pytest
from conftest import Program


def test_a_missing_gpu_is_reported_before_writing(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    run = tmp_path / "run"
    outcome = thawslide("run", small_case, "--output", run, "--device", "gpu")
    if outcome.returncode == 0:
        assert json.loads((run / "run.json").read_text())["parts"][0]["device"]
        pytest.skip("a GPU is available, and the run used it")
    assert outcome.returncode == 2
    assert outcome.stderr.startswith("error: --device gpu: ")
    assert outcome.stderr.endswith("un the case on the CPU: --device cpu\n")
    assert not run.exists()


def test_auto_and_cpu_run_and_resume(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    for device in ("auto", "cpu"):
        run = tmp_path / device
        thawslide.ok("run", small_case, "--output", run, "--device", device)
        reported = json.loads((run / "run.json").read_text())["parts"][0]["device"]
        assert device == "auto" or reported == ""
        thawslide.ok("resume", run, "--device", device)


def test_another_device_is_refused(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    message = thawslide.error("run", small_case, "--output", tmp_path / "run", "--device", "tpu")
    assert "--device: tpu not in {cpu,gpu,auto}" in message
