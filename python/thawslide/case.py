"""Cases: a case file with changed keys, checked as by the command line."""

from __future__ import annotations

import copy
import json
import math
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from functools import cached_property
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from thawslide import _core
from thawslide.errors import errors_with_parameters

__all__ = ["Case"]

_NAMED_TABLES = ("body", "contact", "frame", "material", "probe", "substrate")  # of tables with names of the user


def toml_text(value: object) -> str:
    """Return a value as TOML: a number, text, path, list or table; TypeError for anything else."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return str(value) if math.isfinite(value) else ("nan" if math.isnan(value) else "inf" if value > 0 else "-inf")
    if isinstance(value, str | PathLike):
        return json.dumps(fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(key)} = {toml_text(item)}" for key, item in value.items()) + " }"
    if hasattr(value, "tolist"):  # arrays and numbers of numpy
        return toml_text(value.tolist())
    if isinstance(value, list | tuple):
        return "[" + ", ".join(toml_text(item) for item in value) + "]"
    raise TypeError(
        f"a case has no value of type {type(value).__name__}: {value!r}. Give a number, text, list or table."
    )


def _keys(table: str, part: Mapping[str, object]) -> Iterator[tuple[str, object]]:
    """Yield the keys of a table with their values, and those of the tables in it."""
    for key, value in part.items():
        if isinstance(value, Mapping) and table in _NAMED_TABLES:
            yield from _keys(f"{table}.{key}", value)
        else:
            yield f"{table}.{key}", value


class Case:
    """A valid case: the keys of a case file, some of them replaced.

    `case["band.thickness"]` reads a key with its default, and `case["band.thickness"] = 0.3` replaces it. A key or
    value that a case file may not have raises UserError with the message of the command line, and changes nothing.
    """

    def __init__(self, file: str | PathLike[str], changes: Mapping[str, object] | None = None) -> None:
        """Read a case file, or the case.toml of a folder.

        The case keeps the text of its files, and the absolute paths of all others: later changes of these files or of
        the working directory do not affect it.

        Parameters
        ----------
        file : str or path
            Case file, or its folder.
        changes : mapping, optional
            Keys to replace, with their values. Paths in it may lie anywhere.

        Raises
        ------
        UserError
            If the case is not valid; the message names file and line.

        """
        self._files = _core.read_case_files(str(Path(file).absolute()))
        self._sets: dict[str, tuple[str, str]] = {}  # values as TOML, and the folders of their paths
        self.change(changes or {})

    @classmethod
    def from_text(cls, text: str, changes: Mapping[str, object] | None = None) -> Case:
        """Read a case from the text of a case file.

        Parameters
        ----------
        text : str
            The text. Files that it names must be given in `changes` instead, with paths.
        changes : mapping, optional
            Keys to replace.

        Returns
        -------
        Case
            The case.

        Raises
        ------
        UserError
            If the case is not valid.

        """
        with tempfile.TemporaryDirectory(prefix="thawslide-") as folder:
            file = Path(folder) / "case" / "case.toml"  # the folder names the case
            file.parent.mkdir()
            file.write_text(text, encoding="utf-8")
            return cls(file, changes)

    @classmethod
    def from_dict(cls, values: Mapping[str, Mapping[str, object]]) -> Case:
        """Make a case from its tables.

        Parameters
        ----------
        values : mapping
            Tables by name, such as {"grid": {"cell": 5.0}}. Paths are relative to the working directory.

        Returns
        -------
        Case
            The case.

        Raises
        ------
        UserError
            If the case is not valid.
        TypeError
            For a value that no case file has.

        Examples
        --------
        >>> case = Case("cases/block/e100.toml")
        >>> Case.from_dict(tomllib.loads(case.to_toml()))["grid.cell"] == case["grid.cell"]
        True

        """
        for table, part in values.items():
            if not isinstance(part, Mapping):
                raise TypeError(f"{table} is {part!r}, and not a table. Give a dictionary of its keys.")
        changes = {key: value for table, part in values.items() for key, value in _keys(table, part)}
        return cls.from_text("[case]\n", changes)

    @cached_property
    def _core(self) -> _core.Case:
        sets = [(f"{key}={text}", folder) for key, (text, folder) in self._sets.items()]
        with errors_with_parameters():
            return _core.case_of(self._files, sets)

    @cached_property
    def _values(self) -> dict[str, Any]:
        return tomllib.loads(self.to_toml())

    def __getstate__(self) -> dict[str, Any]:
        return {"_files": self._files, "_sets": dict(self._sets)}

    def __getitem__(self, key: str) -> Any:
        """Return the value of a key such as "band.thickness", or a table such as "band"; KeyError if it has none."""
        value: Any = self._values
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                raise KeyError(key)
            value = value[part]
        return value

    def __setitem__(self, key: str, value: object) -> None:
        """Replace the value of a key; UserError if the case would not be valid."""
        self.change({key: value})

    def change(self, changes: Mapping[str, object]) -> None:
        """Replace several keys at once.

        Parameters
        ----------
        changes : mapping
            Keys such as "band.thickness", with their values. Paths are relative to the working directory.

        Raises
        ------
        UserError
            If the case would not be valid; it is then unchanged.

        """
        other = copy.copy(self)  # by __getstate__: without the values read
        other._sets |= {key: (toml_text(value), str(Path.cwd())) for key, value in changes.items()}
        _ = other._core  # UserError
        self.__dict__ = other.__dict__

    def copy(self) -> Case:
        """Return an independent copy."""
        other = object.__new__(Case)
        other.__dict__.update(self.__dict__, _sets=dict(self._sets))
        return other

    @property
    def changes(self) -> dict[str, str]:
        """The replaced keys, with their values as TOML."""
        return {key: text for key, (text, _) in self._sets.items()}

    @property
    def name(self) -> str:
        """The name of the case, from its folder and file."""
        return self._core.name

    @property
    def title(self) -> str:
        """The key case.title; empty by default."""
        return self._core.title

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._core.dimension

    @property
    def end(self) -> float:
        """The key time.end [s]."""
        return self._core.end

    @property
    def case_files(self) -> list[str]:
        """The paths of the case file and of those that it is based on."""
        return [path for path, _ in self._files]

    @property
    def input_files(self) -> list[Path]:
        """Absolute paths of the files that the case names; a raster or vector file with all files that belong to it."""
        return [Path(file) for file in _core.input_files(self._core) if file not in self.case_files]

    def to_toml(self) -> str:
        """Return the case file with all defaults."""
        return _core.resolved_toml(self._core)

    def __repr__(self) -> str:
        changes = ", ".join(f"{key}={text}" for key, text in self.changes.items())
        return f"Case({self.case_files[0]!r}{', ' if changes else ''}{changes})"
