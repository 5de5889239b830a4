"""One snapshot of the particles, as HDF5 holds it: checked before it is read, since a kill or a disk may damage it."""

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

_COMPONENTS = {"velocity": {3}, "displacement": {3}, "stress": {6}, "mass": {1}, "volume": {1}, "in_band": {1}}
_ANY = {1, 3, 6}  # of other fields: scalars, vectors and tensors
_FAULTS = (OSError, RuntimeError, KeyError, ValueError, TypeError, MemoryError)  # what h5py says of a damaged file
_MOST_MEMORY = 2**29  # bytes that reading may take beside a few times those of the file: HDF5 trusts sizes in it
_BOUNDING = threading.RLock()  # the bound is the whole process's: the thread that set it lifts it
_AGAIN = "it is damaged; remove it or run the case again"


class Snapshot(Mapping[str, NDArray[Any]]):
    """Every particle at one time: points [m] of shape (n, 3) and the fields by name, rows sorted by id.

    `base` has what each piece of base with a band column holds, by name with its unit, of shape (pieces,), and
    "position_m" of shape (pieces, 3); it is empty where the band is not of columns.
    """

    def __init__(self, path: Path, fields: Collection[str] | None = None) -> None:
        """Read one snapshot file, all its fields or those named; ReportError when it is damaged or incomplete."""
        self.path = path
        with _opened(path) as file:
            self.time, self.step = file.time, file.step
            if not {"Points", "PointData"} <= set(file.names("VTKHDF")):
                raise ReportError(f"{path}: snapshot without Points or PointData; {_AGAIN}")
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
            for name in file.names("base"):
                components = {3} if name == "position_m" else {1}
                self.base[name] = file.array(f"base/{name}", components).astype(np.float64)
        if len({len(values) for values in self.base.values()}) > 1:
            raise ReportError(f"{path}: columns of the base differ in their numbers of rows; {_AGAIN}")

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._fields:
            raise NotInRunError(f"{self.path}: no field {name}; it has {', '.join(self._fields) or 'none'}")
        return self._fields[name]

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def with_velocity(self, velocity: Numbers) -> Snapshot:
        """Return the same snapshot with other velocities [m/s], shape (n, 3)."""
        other = copy(self)
        other._fields = self._fields | {"velocity": velocity}
        return other

    def unit(self, name: str) -> str:
        """Return the unit of a field as the file states it, "" where it states none."""
        self[name]
        return self._units[name]


def snapshot_time(path: Path) -> float:
    """Return the time [s] of a snapshot without reading its particles; ReportError when it is damaged."""
    with _opened(path) as file:
        return file.time


class _SnapshotFile:
    """An open snapshot. The simulator writes plain datasets, uncompressed, each in one place.

    Links to other files, virtual datasets and those larger than their file are refused: they could read any file, or
    claim any amount of memory.
    """

    def __init__(self, file: h5py.File, path: Path) -> None:
        self._file = file
        self._path = path
        self._bytes_left = path.stat().st_size
        group = self._inside(file, "VTKHDF")
        if not isinstance(group, h5py.Group) or "time" not in group.attrs:
            raise ReportError(f"{path}: not a snapshot, it has no group VTKHDF with an attribute time")
        self.time = float(group.attrs["time"])
        self.step = int(group.attrs.get("step", -1))
        if not math.isfinite(self.time):
            raise ReportError(f"{path}: its time is {self.time}; {_AGAIN}")

    def names(self, place: str) -> list[str]:
        """Return what a group holds, nothing where there is no such group."""
        group = self._at(place)
        return [str(name) for name in group] if isinstance(group, h5py.Group) else []

    def array(self, place: str, components: Collection[int], rows: int | None = None) -> NDArray[Any]:
        """Read a dataset of shape (rows,) or (rows, n), with n, 1 or more, among those that are allowed."""
        data, name = self._at(place), place.rpartition("/")[2]
        if not isinstance(data, h5py.Dataset):
            raise ReportError(f"{self._path}: {quoted(place)} is no dataset; {_AGAIN}")
        if data.is_virtual or data.external or data.dtype.kind not in "fiu":
            raise ReportError(f"{self._path}: {quoted(place)} does not hold plain numbers; {_AGAIN}")
        shape: tuple[int, ...] = data.shape or ()
        if not (len(shape) == 1 and 1 in components) and not (
            len(shape) == 2 and shape[1] > 1 and shape[1] in components
        ):
            raise ReportError(f"{self._path}: {quoted(place)} has the shape {shape}; {_AGAIN}")
        if rows is not None and shape[0] != rows:
            raise ReportError(f"{self._path}: field {quoted(name)} has {shape[0]} rows for {rows} particles; {_AGAIN}")
        self._bytes_left -= math.prod(shape) * data.dtype.itemsize
        if self._bytes_left < 0:
            raise ReportError(f"{self._path}: {quoted(place)} has more numbers than the file has room for; {_AGAIN}")
        return np.asarray(data)

    def unit(self, place: str) -> str:
        """Return the unit that a dataset states, "" where it states none."""
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
            raise ReportError(f"{self._path}: {quoted(name)} is a link to another place, which no snapshot has")
        return None if link is None else group[name]


@contextmanager
def _bounded_memory(extra: int) -> Iterator[None]:
    """Let this process take so many bytes more and no further, where that can be asked for (Linux).

    A damaged file of some kilobytes makes HDF5 ask for tens of gigabytes.
    """
    if sys.platform != "linux":
        yield
        return
    import resource  # other systems lack it

    with _BOUNDING:
        most = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE") + extra
        before = resource.getrlimit(resource.RLIMIT_AS)
        allowed = [limit for limit in before if limit != resource.RLIM_INFINITY]
        resource.setrlimit(resource.RLIMIT_AS, (min([most, *allowed]), before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, before)


def _give_back_memory() -> None:
    """Give the system back what HDF5 and malloc keep after a damaged file, where they can be asked to (Linux).

    Kept, it would add to what the bound allows for the next such file, without end.
    """
    if sys.platform == "linux":
        with suppress(OSError, AttributeError), h5py.h5.phil:  # what serialises calls of HDF5
            ctypes.CDLL(h5py.h5.__file__).H5garbage_collect()
            ctypes.CDLL(None).malloc_trim(0)


@contextmanager
def _opened(path: Path) -> Iterator[_SnapshotFile]:
    """Open a snapshot; what h5py says of damage, also while it is read, becomes a ReportError."""
    if not is_file(path) and path.exists():  # a pipe would wait for ever
        raise ReportError(f"{path}: not a file; {_AGAIN}")
    try:
        with _bounded_memory(4 * path.stat().st_size + _MOST_MEMORY), h5py.File(path, "r") as file:
            yield _SnapshotFile(file, path)
    except ReportError:
        _give_back_memory()
        raise
    except _FAULTS as error:
        _give_back_memory()
        raise ReportError(f"{path}: cannot be read as HDF5 ({error}); remove it or run the case again") from error
