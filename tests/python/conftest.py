"""Constructed run folders, with the files and shapes of a run."""

import functools
import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from thawslide import Run
from thawslide.command_line import main
from thawslide.key_numbers import key_numbers
from thawslide.report_page import make_report

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))  # for `reproduction`
sys.path.append(str(ROOT / "tests" / "cli"))  # for `terrain_files`

TARGETS = """# reported values, made up
quantity,time_s,value,unit,source
mean_velocity,4,9,m/s,seismic
mean_velocity,6,11,m/s,seismic
mean_displacement,10,80,m,model
front_distance,10,160,m,field
band_SL,4,0.3,-,model
max_seismic_force,5,2.8e11,N,seismic
max_seismic_force_2_8_s,5,1.1e11,N,waves
"""
SLOPE = 0.5


def ground(x: np.ndarray) -> np.ndarray:
    """Return the elevation [m] of the straight slope of all runs."""
    return 100.0 - SLOPE * x


def history_columns(rows: int, dimension: int) -> dict[str, np.ndarray]:
    """Return all columns of a history over 0..10 s."""
    t = np.linspace(0.0, 10.0, rows) if rows > 1 else np.zeros(1)
    band = np.where(t < 2.0, np.nan, 1.0)  # no contact in the first two seconds
    columns = {
        "time_s": t, "step": t * 100, "dt_s": np.full(rows, 0.01),
        "mean_velocity_m_s": 12.0 * np.sin(np.pi * t / 10.0) ** 2,
        "max_velocity_m_s": 15.0 * np.sin(np.pi * t / 10.0) ** 2, "mean_displacement_m": 8.0 * t,
        "front_position_m": 40.0 + 12.0 * t, "runout_m": 40.0 + 12.0 * t,
        "band_temperature_C": band * (-30.0 + 14.0 * t), "band_saturation": band * (0.1 + 0.08 * t),
        "band_pore_pressure_Pa": band * 1.5e6 * np.sin(np.pi * t / 10.0),
        "band_friction_coefficient": band * (0.8 - 0.05 * t), "mean_plastic_strain": 0.03 * t,
    }  # fmt: skip
    for number, axis in enumerate("xyz"[:dimension]):
        columns[f"basal_force_{axis}_N"] = 1e11 * (number + 1) * t
        columns[f"seismic_force_{axis}_N"] = 1e11 * (number - 0.5) * np.sin(t)
    fallen = 1e12 * t
    columns |= {
        "kinetic_J": 0.4 * fallen, "potential_J": 5e13 - fallen, "strain_J": 0.05 * fallen,
        "plastic_J": 0.05 * fallen, "viscous_J": np.zeros(rows), "damping_J": np.zeros(rows),
        "friction_work_J": 0.5 * fallen, "contact_loss_J": np.zeros(rows), "frame_work_J": np.zeros(rows),
        "friction_heat_J": 0.2 * fallen, "converted_J": 0.3 * fallen, "sensible_J": -7e13 + 0.15 * fallen,
        "latent_J": 0.05 * fallen, "boundary_heat_J": np.zeros(rows), "band_rescale_J": np.zeros(rows),
        "advection_J": np.zeros(rows), "numerical_J": np.zeros(rows), "mechanical_residual_J": 1e3 * t,
        "thermal_residual_J": -2e2 * t,
    }  # fmt: skip
    columns |= {f"{phase}_kg": np.full(rows, 1e6) for phase in ("mass", "rock", "ice", "water")}
    return columns


def column_history(rows: int = 101) -> dict[str, np.ndarray]:
    """Return the columns of a 2D history with band columns."""
    columns = history_columns(rows, 2)
    t = columns["time_s"]
    return columns | {
        "band_normal_pressure_Pa": np.full(rows, 1.0e6), "band_shear_Pa": 4.0e5 - 2.0e4 * t,
        "band_thickness_m": np.full(rows, 0.55), "dilation_fraction": 0.003 * t, "band_max_temperature_C": 17.0 * t,
        "band_max_pressure_ratio": 0.1 * t, "base_area_m2": np.full(rows, 1.0e6), "column_heat_J": -3e12 + 0.1e12 * t,
        "column_intake_J": -3e12 - 0.1e12 * t, "column_drained_J": 0.05e12 * t, "column_steam_J": 0.15e12 * t,
        "column_left_J": np.zeros(rows), "column_water_kg": 3e9 + 1e7 * t, "column_intake_kg": 3e9 + 4e7 * t,
        "column_drained_kg": 2e7 * t, "column_steam_kg": 1e7 * t, "column_left_kg": np.zeros(rows),
        "column_water_residual_kg": 1e-3 * t, "column_opening_m3": 50.0 * t, "column_void_m3": 2e4 - 100.0 * t,
    }  # fmt: skip


def write_history(path: Path, columns: dict[str, np.ndarray]) -> None:
    """Write a table: the header, one line a row, shortest round-trip numbers."""
    lines = [",".join(columns)]
    lines += [",".join(repr(float(value)) for value in row) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join(lines) + "\n")


def write_snapshot(path: Path, time: float, dimension: int) -> None:
    """Write one snapshot: a block of 20 x 4 particles of 1 m, moved 12 m/s along the slope."""
    along, up = (grid.ravel() for grid in np.meshgrid(np.arange(0.5, 20.0), np.arange(0.5, 4.0)))
    x, n = 20.0 + along + 12.0 * time, len(along)
    z, across = ground(x) + up, np.arange(n) % 3 + 0.5
    points = np.stack([x, z, np.zeros(n)] if dimension == 2 else [x, across, z], axis=1)
    velocity = np.zeros((n, 3))
    velocity[:, 0], velocity[:, 1 if dimension == 2 else 2] = 3.0 * time, -4.0 * time
    fields: dict[str, tuple[Any, str]] = {
        "id": (np.arange(n), "1"), "body": (np.zeros(n, dtype=np.int32), "1"), "mass": (np.full(n, 2000.0), "kg"),
        "volume": (np.ones(n), "m3"), "velocity": (velocity, "m/s"), "displacement": (np.zeros((n, 3)), "m"),
        "path_length": (np.full(n, 12.0 * time), "m"), "stress": (np.zeros((n, 6)), "Pa"),
        "plastic_strain": (0.1 * time * np.exp(-up), "1"), "temperature": (-10.0 + 2.0 * time * np.exp(-up), "C"),
        "liquid_saturation": (np.full(n, 0.2), "1"), "porosity": (np.full(n, 0.3), "1"),
        "ice_pressure": (np.zeros(n), "Pa"), "liquid_pressure": (np.zeros(n), "Pa"),
        "pore_pressure": (2.0e5 * time * np.exp(-up), "Pa"), "slip": (np.full(n, 12.0 * time), "m"),
        "in_band": ((up < 1.0).astype(np.int32), "1"),
    }  # fmt: skip
    with h5py.File(path, "w") as file:
        group = file.create_group("VTKHDF")
        group.attrs["time"], group.attrs["step"] = time, int(100 * time)
        group["Points"] = points
        for name, (values, unit) in fields.items():
            group.create_dataset(f"PointData/{name}", data=values).attrs["unit"] = unit


def snapshot_file(folder: Path, number: int) -> Path:
    return folder / "snapshots" / f"{number:06d}.vtkhdf"


def change_snapshot(folder: Path, number: int, rows: Any = slice(None), points: Any = None, **fields: Any) -> None:
    """Replace the points and fields of some particles of a snapshot."""
    with h5py.File(snapshot_file(folder, number), "r+") as file:
        if points is not None:
            file["VTKHDF/Points"][rows] = points
        for name, values in fields.items():
            file[f"VTKHDF/PointData/{name}"][rows] = values


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def write_facts(folder: Path, **facts: Any) -> None:
    """Write run.json with a status, `done` by default, and these facts only."""
    (folder / "run.json").write_text(json.dumps({"status": "done"} | facts))


def update_facts(folder: Path, **facts: Any) -> None:
    (folder / "run.json").write_text(json.dumps(json.loads((folder / "run.json").read_text()) | facts))


def page_of(folder: Path, *names: str) -> str:
    """Return the page of a run with the figure `motion` or those named."""
    return make_report(Run(folder), names=names or ["motion"], dpi=50).page.read_text(encoding="utf-8")


def numbers(run: Run) -> dict[str, tuple[str, str]]:
    """Return values and remarks of the key numbers."""
    return {row.words: (row.value, row.remark) for row in key_numbers(run)}


Fails = Callable[[list[str], str], None]


@pytest.fixture
def fails(capsys: pytest.CaptureFixture[str]) -> Fails:
    """Return a function that checks a refused command of thawslide-report: exit code 2, and its message."""

    def check(arguments: list[str], text: str) -> None:
        assert main(arguments) == 2
        assert text in capsys.readouterr().err

    return check


MakeRun = Callable[..., Path]


@pytest.fixture(scope="session")
def snapshots_of(tmp_path_factory: pytest.TempPathFactory) -> Callable[[int, int], Path]:
    """Return a function that writes a number of snapshots once per session, and returns their folder."""

    @functools.cache
    def write(dimension: int, count: int) -> Path:
        folder = tmp_path_factory.mktemp("snapshots")
        for number in range(count):
            write_snapshot(folder / f"{number:06d}.vtkhdf", float(number), dimension)
        (folder / "notes.vtkhdf").write_text("not one of the numbered ones")
        return folder

    return write


@pytest.fixture
def make_run(tmp_path: Path, snapshots_of: Callable[[int, int], Path]) -> MakeRun:
    """Return a function that writes a whole run folder and returns it.

    `history` replaces columns, `targets` the reported values, `case_keys` adds lines to [case], `tables` to the end of
    the case.
    """

    def make(
        *, name: str = "slope", dimension: int = 2, rows: int = 101, snapshots: int = 11, width: float | str = 10.0,
        terrain: bool = True, targets: bool | str = True, times: str = "[0.0, 4.0, 7.4]", case_keys: str = "",
        tables: str = "", history: dict[str, np.ndarray] | None = None, facts: dict[str, Any] | None = None,
    ) -> Path:  # fmt: skip
        folder = tmp_path / name
        shutil.copytree(snapshots_of(dimension, snapshots), folder / "snapshots")
        (folder / "inputs").mkdir()
        corners = ("[0.0, 0.0]", "[200.0, 150.0]") if dimension == 2 else ("[0.0, 0.0, 0.0]", "[200.0, 9.0, 150.0]")
        (folder / "case.toml").write_text(
            f'[case]\ntitle = "Block on a slope & <more>"\ndimension = {dimension}\nwidth = {width}\n{case_keys}'
            f"[grid]\ncell = 2.0\nmin = {corners[0]}\nmax = {corners[1]}\n"
            f'[report]\ntimes = {times}\ntargets = "{"inputs/targets.csv" if targets else ""}"\n{tables}'
        )
        (folder / "inputs" / "targets.csv").write_text(targets if isinstance(targets, str) else TARGETS)
        write_history(folder / "history.csv", history_columns(rows, dimension) | (history or {}))
        if terrain:
            x = np.linspace(0.0, 200.0, 21)
            write_history(folder / "terrain.csv", {"distance_m": x, "terrain_elevation_m": ground(x)})
        of_run = {"version": "0.1.0", "threads": 2, "particle_steps_per_second": 3.1e6}
        write_facts(folder, **(of_run | {"seconds_per_stage": {"momentum_to_grid": 1.25}} if facts is None else facts))
        return folder

    return make


@pytest.fixture(scope="session")
def whole_map_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a 3D run on a DEM, with six snapshots, which tests copy."""
    import map_runs  # which imports this module

    folder = tmp_path_factory.mktemp("map") / "slab"
    map_runs.write_map_run(folder, 6)
    return folder


@pytest.fixture
def map_run(tmp_path: Path, whole_map_run: Path) -> Path:
    return shutil.copytree(whole_map_run, tmp_path / "slab")
