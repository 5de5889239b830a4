"""Snapshot of the particles in HDF5, checked before it is read, because a kill or a disk can damage it."""

from __future__ import annotations

import ctypes
import math
import os
import sys
import threading
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from copy import copy
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from thawslide.arrays import Numbers
from thawslide.errors import NotInRunError, ReportError, quoted
from thawslide.text_files import is_file
from thawslide.units import cf_unit

_COMPONENTS = {"velocity": {3}, "displacement": {3}, "stress": {6}, "mass": {1}, "volume": {1}, "in_band": {1}}
_ANY = {1, 3, 6}  # other fields: scalars, vectors and tensors
_FAULTS = (OSError, RuntimeError, KeyError, ValueError, TypeError, MemoryError)  # of h5py for a damaged file
_MOST_MEMORY = 2**29  # bytes, in addition to four times the file size: HDF5 trusts sizes in the file
_LIMIT_LOCK = threading.RLock()  # the limit applies to the process: the thread that sets it removes it
_REMEDY = "Remove it, or repeat the run."


class Snapshot(Mapping[str, NDArray[Any]]):
    """All particles at one time: points [m] of shape (n, 3) and fields by name, rows sorted by id.

    `base` contains the quantities of basal segments, by name with unit, of shape (segments,), and "position_m" of shape
    (segments, 3). It is empty without band columns.
    """

    def __init__(self, path: Path, fields: Collection[str] | None = None) -> None:
        """Read one snapshot file; ReportError if it is damaged or incomplete.

        Parameters
        ----------
        path : path
            The file.
        fields : collection of str, optional
            Fields to read, by default all.

        """
        self.path = path
        with _opened(path) as file:
            self.time, self.step = file.time, file.step
            if not {"Points", "PointData"} <= set(file.names("VTKHDF")):
                raise ReportError(f"{path}: damaged (found no Points or PointData). {_REMEDY}")
            self.points: Numbers = file.array("VTKHDF/Points", {3}).astype(np.float64)
            self._fields: dict[str, NDArray[Any]] = {}
            self._units: dict[str, str] = {}
            for name in file.names("VTKHDF/PointData"):
                if fields is not None and name not in fields:
                    continue
                place = f"VTKHDF/PointData/{name}"
                self._fields[name] = file.array(place, _COMPONENTS.get(name, _ANY), len(self.points))
                self._units[name] = file.unit(place)
            self.base: dict[str, Numbers] = {}
            for name in file.names("basal_segments"):
                components = {3} if name == "position_m" else {1}
                self.base[name] = file.array(f"basal_segments/{name}", components).astype(np.float64)
        if len({len(values) for values in self.base.values()}) > 1:
            raise ReportError(f"{path}: damaged (found different numbers of rows in the base). {_REMEDY}")

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._fields:
            raise NotInRunError(f"{self.path}: no field {name} (found: {', '.join(self._fields) or 'none'}).")
        return self._fields[name]

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"Snapshot(t = {self.time:g} s, {len(self.points)} particles: {', '.join(self._fields)})"

    def with_velocity(self, velocity: Numbers) -> Snapshot:
        """Return the same snapshot with other velocities.

        Parameters
        ----------
        velocity : array
            Velocities [m/s], shape (n, 3).

        """
        other = copy(self)
        other._fields = self._fields | {"velocity": velocity}
        return other

    def unit(self, name: str) -> str:
        """Return the unit of a field as in the CF conventions, "1" without one.

        Parameters
        ----------
        name : str
            The field.

        """
        self[name]
        return cf_unit(self._units[name])


def snapshot_time(path: Path) -> float:
    """Return the time [s] of a snapshot without reading its particles; ReportError if it is damaged."""
    with _opened(path) as file:
        return file.time


class _SnapshotFile:
    """An open snapshot. The simulator writes plain, uncompressed and contiguous datasets.

    Links to other files, virtual datasets and those larger than their file are errors: they could read any file, or
    need any amount of memory.
    """

    def __init__(self, file: h5py.File, path: Path) -> None:
        self._file = file
        self._path = path
        self._bytes_left = path.stat().st_size
        group = self._inside(file, "VTKHDF")
        if not isinstance(group, h5py.Group) or "time" not in group.attrs:
            raise ReportError(f"{path}: not a snapshot (found no group VTKHDF with an attribute time). {_REMEDY}")
        self.time = float(group.attrs["time"])
        self.step = int(group.attrs.get("step", -1))
        if not math.isfinite(self.time):
            raise ReportError(f"{path}: damaged (found the time {self.time}). {_REMEDY}")

    def names(self, place: str) -> list[str]:
        """Return the names in a group, none if it does not exist."""
        group = self._at(place)
        return [str(name) for name in group] if isinstance(group, h5py.Group) else []

    def array(self, place: str, components: Collection[int], rows: int | None = None) -> NDArray[Any]:
        """Read a dataset of shape (rows,) or (rows, n), with an allowed number n of components."""
        data, name = self._at(place), place.rpartition("/")[2]
        if not isinstance(data, h5py.Dataset):
            raise ReportError(f"{self._path}: damaged (found no dataset {quoted(place)}). {_REMEDY}")
        if data.is_virtual or data.external or data.dtype.kind not in "fiu":
            raise ReportError(f"{self._path}: damaged (found no plain numbers in {quoted(place)}). {_REMEDY}")
        shape: tuple[int, ...] = data.shape or ()
        if not (len(shape) == 1 and 1 in components) and not (
            len(shape) == 2 and shape[1] > 1 and shape[1] in components
        ):
            raise ReportError(f"{self._path}: damaged (found the shape {shape} of {quoted(place)}). {_REMEDY}")
        if rows is not None and shape[0] != rows:
            raise ReportError(
                f"{self._path}: damaged (found {shape[0]} rows of {quoted(name)} for {rows} particles). {_REMEDY}"
            )
        self._bytes_left -= math.prod(shape) * data.dtype.itemsize
        if self._bytes_left < 0:
            raise ReportError(f"{self._path}: damaged (found {quoted(place)} larger than the file). {_REMEDY}")
        return np.asarray(data)

    def unit(self, place: str) -> str:
        """Return the unit of a dataset, "" without one."""
        stated = self._at(place).attrs.get("unit", "")
        return stated.decode() if isinstance(stated, bytes) else str(stated)

    def _at(self, place: str) -> Any:
        found: Any = self._file
        for name in place.split("/"):
            if not isinstance(found, h5py.Group):
                return None
            found = self._inside(found, name)
        return found

    def _inside(self, group: h5py.Group, name: str) -> Any:
        link = group.get(name, getlink=True)
        if link is not None and not isinstance(link, h5py.HardLink):
            raise ReportError(f"{self._path}: damaged (found {quoted(name)} as a link). {_REMEDY}")
        return None if link is None else group[name]


@contextmanager
def _limited_memory(extra: int) -> Iterator[None]:
    """Limit the additional memory of this process to so many bytes (Linux only).

    With a damaged file of a few kilobytes, HDF5 can allocate tens of gigabytes.
    """
    if sys.platform != "linux":
        yield
        return
    import resource  # not available on other systems

    with _LIMIT_LOCK:
        most = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE") + extra
        before = resource.getrlimit(resource.RLIMIT_AS)
        allowed = [limit for limit in before if limit != resource.RLIM_INFINITY]
        resource.setrlimit(resource.RLIMIT_AS, (min([most, *allowed]), before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, before)


def _release_memory() -> None:
    """Release the memory that HDF5 and malloc retain after a damaged file (Linux only).

    Otherwise it would add to the limit for each further damaged file.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError), h5py.h5.phil:  # serializes calls of HDF5
            ctypes.CDLL(h5py.h5.__file__).H5garbage_collect()
            ctypes.CDLL(None).malloc_trim(0)


@contextmanager
def _opened(path: Path) -> Iterator[_SnapshotFile]:
    """Open a snapshot; errors of h5py, also during reading, become a ReportError."""
    if not is_file(path) and path.exists():  # a pipe would block forever
        raise ReportError(f"{path}: not a file. {_REMEDY}")
    try:
        with _limited_memory(4 * path.stat().st_size + _MOST_MEMORY), h5py.File(path, "r") as file:
            yield _SnapshotFile(file, path)
    except ReportError:
        _release_memory()
        raise
    except _FAULTS as error:
        _release_memory()
        raise ReportError(f"{path}: cannot be read as HDF5 ({error}). {_REMEDY}") from error
