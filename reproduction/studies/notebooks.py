"""The notebooks of docs/notebooks: executes them and stores their outputs, which the site and the tests use."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from reproduction.study import ROOT, Place, Study

NOTEBOOKS = ROOT / "docs" / "notebooks"
LIMIT = 600  # s, of a cell and of the start of a kernel


def execute(path: Path) -> None:
    """Execute a notebook in its folder, and store its outputs without messages of the program."""
    import nbformat  # installed for developers only
    from nbclient import NotebookClient

    os.environ.pop("MPLBACKEND", None)  # the kernel selects the one that stores figures
    notebook = nbformat.read(path, as_version=4)
    resources = {"metadata": {"path": str(path.parent)}}
    NotebookClient(notebook, timeout=LIMIT, startup_timeout=LIMIT, record_timing=False, resources=resources).execute()
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = [each for each in cell.outputs if each.get("name") != "stderr"]
    notebook.metadata = {name: notebook.metadata[name] for name in ("kernelspec",)}
    nbformat.write(notebook, path)


def copied(path: Path, root: Path) -> Path:
    """Copy a notebook into a folder with the layout of the repository; return the copy."""
    copy = root / path.relative_to(ROOT)
    copy.parent.mkdir(parents=True, exist_ok=True)
    (root / "runs").mkdir(exist_ok=True)
    if not (root / "cases").exists():
        (root / "cases").symlink_to(ROOT / "cases")
    return Path(shutil.copy(path, copy))


def write(place: Place) -> None:
    """Execute the selected notebooks; with --quick a copy of the first one."""
    found = [path for path in sorted(NOTEBOOKS.glob("*.ipynb")) if place.is_chosen(path.stem)]
    for path in [] if place.draws_only else found[: 1 if place.is_quick else None]:
        execute(copied(path, place.runs) if place.is_quick else path)
        place.report(f"{path.stem}: executed")


STUDY = Study("notebooks", ("docs/notebooks",), 5.0, write)
