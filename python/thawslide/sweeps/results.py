"""Table of a sweep: one row per member, as Parquet and CSV."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from thawslide.atomic_file import atomic_file
from thawslide.case import toml_text
from thawslide.errors import ReportError
from thawslide.sweeps.design import Member
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.variables import CASE

TABLE, CSV = "members.parquet", "members.csv"
WEIGHT = "weight"  # column of the table, only of members that are not equally probable
_ABOUT = ("status", "starts", "seed", "wall_s")


def table_of(folder: SweepFolder, members: Sequence[Member]) -> pd.DataFrame:
    """Return the table of all members; those that have not finished have no numbers."""
    records = [folder.record(member.number) for member in members]
    names: dict[str, None] = dict.fromkeys(name for record in records for name in record.get("numbers", {}))
    columns: dict[str, Any] = {"member": [member.number for member in members]}
    if len({member.case_file for member in members}) > 1:
        columns[CASE] = [member.case_file for member in members]
    for key in members[0].changes:
        columns[key] = _scalars(member.changes[key] for member in members)
    columns |= {name: [record.get(name) for record in records] for name in _ABOUT}
    if (weights := folder.weights()) is not None:
        columns[WEIGHT] = [weights.get(member.number, 0.0) for member in members]
    for name in names:
        values = [record.get("numbers", {}).get(name) for record in records]
        columns[name] = pd.array([float("nan") if value is None else value for value in values], dtype="float64")
    columns["error"] = [record.get("error", "") for record in records]
    found = pd.DataFrame(columns)
    return found.astype({"seed": "Int64", "starts": "int64", "wall_s": "float64"})


def write_table(table: pd.DataFrame, folder: Path, has_csv: bool) -> list[Path]:
    """Write the table into a folder; return the written files."""
    written = [folder / TABLE]
    try:
        with atomic_file(folder / TABLE) as temporary:
            table.to_parquet(temporary, engine="pyarrow", index=False)
        if has_csv:
            with atomic_file(folder / CSV) as temporary:
                table.to_csv(temporary, index=False)
            written.append(folder / CSV)
    except OSError as error:
        raise ReportError(
            f"{folder / TABLE}: cannot be written ({error.strerror or error}). Free disk space, or correct the "
            f"permissions. To write it, repeat the command."
        ) from error
    return written


def _scalars(values: Iterable[Any]) -> list[Any]:
    """Return the values of a key in one type of column: numbers, or text."""
    found = list(values)
    if all(isinstance(value, bool) for value in found) or all(isinstance(value, int) for value in found):
        return found
    if all(isinstance(value, int | float) and not isinstance(value, bool) for value in found):
        return [float(value) for value in found]
    return [value if isinstance(value, str) else toml_text(value) for value in found]
