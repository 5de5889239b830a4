"""Constructed run folders of 3D runs on a DEM: a slab that slides down a plane to the east."""

import sqlite3
import struct
from contextlib import closing
from pathlib import Path

import h5py
import numpy as np
import rasterio
from conftest import history_columns, write_facts, write_history

WEST, SOUTH, CELL = 400_000.0, 380_000.0, 10.0
COLUMNS, ROWS = 60, 30
LENGTH, WIDTH, THICKNESS = 80.0, 60.0, 6.0  # of the slab [m]
VOLUME = LENGTH * WIDTH * THICKNESS  # m3
SPEED = 20.0  # m/s to the east
MIDDLE = SOUTH + 150.0
CRS = "EPSG:31287"


def ground(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the elevation [m] of the plane, which falls to the east and a little to the south."""
    return 2000.0 - 0.4 * (x - WEST) + 0.1 * (y - SOUTH)


def centres(columns: int = COLUMNS, rows: int = ROWS, cell: float = CELL) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y [m] of the cells of a map, shape (rows, columns), rows from south to north."""
    x, y = np.meshgrid(WEST + cell * (np.arange(columns) + 0.5), SOUTH + cell * (np.arange(rows) + 0.5))
    return x, y


def slab(x: np.ndarray, y: np.ndarray, time: float) -> np.ndarray:
    """Return the thickness [m] of the slab at a time [s]."""
    start = WEST + 60.0 + SPEED * time
    return np.where((x > start) & (x < start + LENGTH) & (np.abs(y - MIDDLE) < 0.5 * WIDTH), THICKNESS, 0.0)


def write_map(
    path: Path, values: np.ndarray, unit: str = "m", description: str = "", cell: float = CELL, crs: str | None = CRS
) -> None:
    """Write a GeoTIFF as the simulator does; nan becomes nodata, rows go from south to north."""
    rows, columns = values.shape
    with rasterio.open(
        path, "w", driver="GTiff", width=columns, height=rows, count=1, dtype="float64", nodata=-9999.0, crs=crs,
        transform=rasterio.Affine(cell, 0.0, WEST, 0.0, -cell, SOUTH + rows * cell), compress="deflate", tiled=True,
    ) as file:  # fmt: skip
        file.write(np.where(np.isnan(values), -9999.0, values)[::-1], 1)
        file.units = (unit,)
        file.set_band_description(1, description)


def line_blob(points: np.ndarray, envelope: bool = False) -> bytes:
    """Return a line as a GeoPackage geometry."""
    low, high = points.min(axis=0), points.max(axis=0)
    box = struct.pack("<4d", low[0], high[0], low[1], high[1]) if envelope else b""
    head = b"GP\0" + bytes([1 | (2 if envelope else 0)]) + struct.pack("<i", 31287) + box
    return head + struct.pack("<BII", 1, 2, len(points)) + np.asarray(points, "<f8").tobytes()


def write_layer(path: Path, layer: str, blobs: list[bytes]) -> None:
    """Write a layer of a GeoPackage, as far as readers of its geometries need it."""
    with closing(sqlite3.connect(path)) as database:
        database.execute("CREATE TABLE IF NOT EXISTS gpkg_geometry_columns (table_name TEXT, column_name TEXT)")
        database.execute("INSERT INTO gpkg_geometry_columns VALUES (?, 'geom')", (layer,))
        database.execute(f'CREATE TABLE "{layer}" (fid INTEGER PRIMARY KEY, geom BLOB, time_s REAL)')
        database.executemany(f'INSERT INTO "{layer}" (geom, time_s) VALUES (?, 1.5)', [(blob,) for blob in blobs])
        database.commit()


def write_maps(folder: Path, end: float) -> None:
    """Write all maps of a slab that slides from t = 0 to `end` [s]."""
    x, y = centres()
    times = np.linspace(0.0, end, 101)
    largest = np.max([slab(x, y, time) for time in times], axis=0)
    touched = np.where(largest > 0.0, 1.0, np.nan)
    arrival = np.full(x.shape, np.nan)
    for time in times[::-1]:
        arrival[slab(x, y, time) > 0.0] = time
    for name, values, unit in (
        ("terrain", ground(x, y), "m"), ("release", slab(x, y, 0.0), "m"), ("max_thickness", largest, "m"),
        ("final_thickness", slab(x, y, end), "m"), ("max_speed", SPEED * np.nan_to_num(touched), "m/s"),
        ("arrival_time", arrival, "s"), ("max_pressure", 1900.0 * SPEED**2 * np.nan_to_num(touched), "Pa"),
        ("max_pressure_time", arrival, "s"), ("elevation_change", slab(x, y, end) - slab(x, y, 0.0), "m"),
        ("max_momentum_flux", THICKNESS * SPEED**2 * np.nan_to_num(touched), "m3/s2"),
        ("max_basal_temperature", touched * (-5.0 + 0.02 * (x - WEST)), "C"), ("max_melt", np.zeros(x.shape), "m"),
        ("max_pore_pressure", 4e4 * np.nan_to_num(touched), "Pa"),
    ):  # fmt: skip
        write_map(folder / f"{name}.tif", values, unit, name.replace("_", " "))
    path = np.array([[WEST + 20.0, MIDDLE], [WEST + 580.0, MIDDLE]])
    write_layer(folder / "results.gpkg", "path", [line_blob(path, envelope=True)])


def write_particles(path: Path, time: float) -> None:
    """Write a snapshot of the slab: particles 5 m apart in plan, 2 m in height."""
    x, y, up = (
        grid.ravel()
        for grid in np.meshgrid(
            WEST + 62.5 + SPEED * time + 5.0 * np.arange(LENGTH / 5.0),
            MIDDLE - 0.5 * WIDTH + 2.5 + 5.0 * np.arange(WIDTH / 5.0), 1.0 + 2.0 * np.arange(THICKNESS / 2.0),
        )
    )  # fmt: skip
    count = len(x)
    velocity = np.zeros((count, 3))
    velocity[:, 0], velocity[:, 2] = 0.6 * SPEED, 0.8 * SPEED
    fields = {
        "id": np.arange(count), "body": np.zeros(count, dtype=np.int32), "mass": np.full(count, 1e5),
        "volume": np.full(count, 50.0), "velocity": velocity, "temperature": np.where(up < 2.0, time, -50.0),
        "in_band": (up < 2.0).astype(np.int32), "plastic_strain": np.zeros(count), "pore_pressure": np.zeros(count),
    }  # fmt: skip
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["time"], group.attrs["step"] = time, int(100 * time)
        group["Points"] = np.stack([x, y, ground(x, y) + up], axis=1)
        for name, values in fields.items():
            group.create_dataset(f"PointData/{name}", data=values)


def write_map_run(folder: Path, snapshots: int) -> None:
    """Write a whole run folder over 10 s."""
    (folder / "snapshots").mkdir(parents=True)
    (folder / "maps").mkdir()
    (folder / "case.toml").write_text(
        '[case]\ntitle = "Slab on a plane"\ndimension = 3\n[grid]\ncell = 10.0\n[terrain]\ntype = "dem"\n'
        '[maps]\narrival_thickness = 0.1\npath = "path.gpkg"\n'
        f"[heat]\nenabled = true\n[probe.gate]\npoint = [{WEST + 300.0}, {MIDDLE}]\n"
    )
    write_history(folder / "history.csv", history_columns(21, 3))
    (folder / "probes.csv").write_text(
        "time_s,gate_thickness_m,gate_speed_m_s,"
        "weir_flow_area_m2,weir_discharge_m3_s,weir_mean_speed_m_s,weir_max_thickness_m\n"
        "0.0,0.0,0.0,0.0,0.0,0.0,0.0\n5.0,6.0,20.0,360.0,-6480.0,18.0,5.0\n10.0,6.0,20.0,0.0,0.0,0.0,0.0\n"
    )
    write_facts(
        folder, covered_volume_m3=28800.0, covered_area_m2=4900.0, deposit_area_m2=4800.0,
        affected_area_m2=16800.0, at_rest=True,
        rest_since_s=8.5, travel_distance_m=280.0, drop_height_m=112.0, reach_angle_degrees=21.8,
        crs="MGI / Austria Lambert",
    )  # fmt: skip
    write_maps(folder / "maps", 10.0)
    for number, time in enumerate(np.linspace(0.0, 10.0, snapshots)):
        write_particles(folder / "snapshots" / f"{number:06d}.vtkhdf", float(time))
