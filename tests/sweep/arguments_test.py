"""Arguments of a sweep that are no values of keys or no addresses: each ends with a message."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import Capture

import thawslide
from thawslide.errors import ReportError
from thawslide.sweeps.command import main
from thawslide.sweeps.variables import levels, parse_levels, toml_value


@pytest.mark.parametrize(
    "address", ["tcp://127.0.0.1:9", "127.0.0.1:9", "nonsense://node:1", "tcp://127.0.0.1:x", "tls://127.0.0.1:9"]
)
def test_a_scheduler_without_an_answer_is_an_error(
    slope: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Capture, address: str
) -> None:
    monkeypatch.setattr("thawslide.sweeps.engine._CONNECT_TIMEOUT", 0.5)
    command = [str(slope), "--block", "--vary", "basal.friction_angle=10,12", "--output", str(tmp_path / "sweep")]
    assert main([*command, "--scheduler", address]) == 2
    errors = capfd.readouterr().err
    assert f"error: --scheduler {address}: no connection (" in errors and "correct the address" in errors
    if address == "tcp://127.0.0.1:9":
        assert main(command) == 0  # the sweep continues without it


@pytest.mark.parametrize("text", ["2025-05-28", "2025-05-28T10:00:00Z", "2025-05-28 10:00:00.5", "12:30:00"])
def test_dates_and_times_are_texts(text: str) -> None:
    assert toml_value(text) == text
    assert parse_levels(f"case.title={text},a").values == (text, "a")


def test_dates_are_titles_of_members(slope: Path, tmp_path: Path) -> None:
    command = [str(slope), "--block", "--vary", "case.title=2025-05-28,2025-06-01", "--set", "time.end=0.1"]
    assert main([*command, "--output", str(tmp_path / "sweep")]) == 0


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('[sweep.vary]\n"case.title" = [2025-05-28]', "case.title: a case has no value of type date"),
        ('[sweep.vary]\n"time.end" = 5', "sweep.vary.'time.end': not a list (found '5')"),
        ("[sweep.vary.time]\nend = [1, 2]", "sweep.vary.'time': not a list"),
        ('seed = -1\n[sweep.range]\n"basal.friction_angle" = [1, 2]', "--seed: negative (found -1)"),
        ('[sweep.set]\n"case.title" = 2025-05-28', "case.title: a case has no value of type date"),
    ],
)
def test_values_in_a_file_are_checked(slope: Path, tmp_path: Path, capfd: Capture, content: str, message: str) -> None:
    file = tmp_path / "sweep.toml"
    sample = 'sample = "lhs:4"\n' if "range" in content else ""
    file.write_text(f'[sweep]\nblock = true\ncases = ["slope"]\n{sample}{content}\n')
    assert main([str(file), "--output", str(tmp_path / "sweep")]) == 2
    assert message in capfd.readouterr().err


def test_numbers_of_numpy_and_paths_are_values(slope: Path, tmp_path: Path) -> None:
    profiles = [slope.parent / "profile.csv"]
    vary: dict[str, Any] = {"basal.friction_angle": np.array([10.0, 12.0]), "terrain.file": profiles}
    table = thawslide.sweep(slope, tmp_path / "sweep", vary=vary, block=True, progress=False)
    assert list(table["basal.friction_angle"]) == [10.0, 12.0]


def test_values_of_other_types_are_refused() -> None:
    for value in (object(), {1, 2}, 1j, None):
        with pytest.raises(ReportError, match=r"a: a case has no value of type"):
            levels("a", [value])
