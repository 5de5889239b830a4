"""Notebooks of the documentation: they run in a copy of the repository's layout, and have outputs."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def code_of(notebook: Path) -> list[dict[str, Any]]:
    return [cell for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(notebook: Path, tmp_path: Path) -> None:
    copy = tmp_path / "docs" / "notebooks" / notebook.name
    copy.parent.mkdir(parents=True)
    shutil.copy(notebook, copy)
    (tmp_path / "cases").symlink_to(ROOT / "cases")
    (tmp_path / "runs").mkdir()
    environment = os.environ | {"PYTHONPATH": f"{ROOT}:{ROOT / 'python'}", "JUPYTER_PLATFORM_DIRS": "1"}
    words = f"import pathlib; from reproduction.studies import notebooks as n; n.execute(pathlib.Path({str(copy)!r}))"
    command = [sys.executable, "-c", words]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert [len(cell["outputs"]) for cell in code_of(copy)] == [len(cell["outputs"]) for cell in code_of(notebook)]


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_outputs_and_is_small(notebook: Path) -> None:
    assert any(cell["outputs"] for cell in code_of(notebook))
    assert notebook.stat().st_size < 200_000


def test_the_friction_of_a_run_changes_halfway_in_under_20_lines() -> None:
    (cell,) = code_of(ROOT / "docs" / "notebooks" / "change-friction-halfway.ipynb")
    assert len(cell["source"]) < 20
