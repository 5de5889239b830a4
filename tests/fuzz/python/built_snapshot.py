"""Snapshots of sound HDF5 with parts that no run writes: what bytes of a fuzzer name, where mere noise is no HDF5."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np

_NAMES = ("Points", "PointData", "PointData/mass", "PointData/velocity", "PointData/stress", "PointData/odd", "time")
_ROWS = (0, 1, 3, 1_000_000_000_000)
_TYPES = ("f8", "f4", "i4", "u1", ">f8", "c16", "S3", "bool")


def build(data: bytes, path: Path) -> None:
    """Write a snapshot whose parts follow from the bytes, four for each change to a sound one."""
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["time"], group.attrs["step"] = 1.0, 10
        group["Points"] = np.zeros((3, 3))
        group["PointData/mass"] = np.ones(3)
        group["PointData/velocity"] = np.ones((3, 3))
        file["base/area_m2"], file["base/position_m"] = np.ones(2), np.ones((2, 3))
        for at in range(0, min(len(data), 80) - 3, 4):
            _change(file, *data[at : at + 4])


def _change(file: h5py.File, what: int, where: int, rows: int, kind: int) -> None:
    """Do one change; those that HDF5 itself refuses leave the file as it is."""
    base, name = where & 128, _NAMES[where % len(_NAMES)]
    group = file["base"] if base and "base" in file else file.get("VTKHDF")
    if not isinstance(group, h5py.Group):
        return
    count = _ROWS[rows % len(_ROWS)]
    shape: Any = ((), (count,), (count, 3), (count, 6), (count, 0), (2, count, 2))[rows // 4 % 6]
    try:
        if what % 10 < 3 and name in group:
            del group[name]
        if what % 10 == 1:
            group.create_dataset(name, shape, _TYPES[kind % len(_TYPES)], chunks=_chunks(shape), fillvalue=_fill(kind))
        elif what % 10 == 2:
            group[name] = (h5py.SoftLink("/VTKHDF"), h5py.ExternalLink("other.h5", "/x"), h5py.Empty("f8"))[kind % 3]
        elif what % 10 == 3:
            group.attrs[name] = (np.nan, np.inf, "later", [1.0, 2.0], h5py.Empty("f8"), 2**63 - 1, b"\xff")[kind % 7]
        elif what % 10 == 4 and name in group:
            group[name].attrs["unit"] = ("m", b"\xff\xfe", 3.0, [1, 2], h5py.Empty("S1"))[kind % 5]
        elif what % 10 == 5 and name in group and "Points" in group:
            group[f"{name}{kind}"] = group["Points"]
        elif what % 10 == 6:
            layout = h5py.VirtualLayout((3, 3), "f8")
            layout[:] = h5py.VirtualSource("other.h5", "x", (3, 3))
            group.create_virtual_dataset(f"{name}{kind}", layout)
        elif what % 10 == 7:
            group.create_dataset(f"{name}{kind}", (3,), "f8", external=[("other.raw", 0, 24)])
    except (OSError, RuntimeError, KeyError, ValueError, TypeError):
        return


def _chunks(shape: Any) -> Any:
    """Return chunks, with which a huge dataset takes no room until it is written."""
    return tuple(min(max(size, 1), 4) for size in shape) if shape and 0 not in shape else None


def _fill(kind: int) -> Any:
    return None if _TYPES[kind % len(_TYPES)] in ("S3", "bool") else 1
