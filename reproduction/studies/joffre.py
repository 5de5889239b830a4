"""The blind forecast of a rock avalanche at Joffre Peak: releases, ensembles, and quantiles of their members."""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import rasterio

from reproduction.study import ROOT, StudyError

CASES = ROOT / "docs" / "blind" / "joffre"
DEM, TERRAIN = "joffre.asc", "terrain.tif"
CRS = "EPSG:26910"
FILTER = 13.3  # m: standard deviation, that of terrain.smooth = "auto" on this DEM
LAWS = ("coulomb", "voellmy")
# Planes: a point, the dip and its direction [degrees]. The volume determines the depth of the plane.
RELEASES = {"lower": "x=539670,y=5576820,dip=35,direction=30", "upper": "x=539510,y=5576840,dip=35,direction=30"}
VOLUME = 2_500_000  # m3
QUANTILES = (0.1, 0.5, 0.9)
Changes = tuple[tuple[str, str], ...]  # texts of a file, and their replacements
COARSE: Changes = (
    ("cell = 12.0", "cell = 24.0"),
    ("max = [542960.0, 5581956.0, 2800.0]", "max = [542960.0, 5581944.0, 2800.0]"),
)
FEW: Changes = (('sample = "lhs:24"', 'sample = "lhs:2"'),)


def call(module: str, *words: str | Path) -> None:
    """Run a command of the Python package with one thread per process; StudyError if it fails."""
    paths = [str(ROOT / "python"), *filter(None, [os.environ.get("PYTHONPATH")])]
    surroundings = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": os.pathsep.join(paths)}
    command = [sys.executable, "-m", module, *map(str, words)]
    code = subprocess.run(command, env=surroundings, check=False).returncode
    if code != 0:
        raise StudyError(f"{module}: exit code {code}")


def prepare(data: Path, runs: Path, changes: Changes = ()) -> None:
    """Build the releases, and copy the cases and the ensembles next to them, with changes."""
    for name, plane in RELEASES.items():
        folder = runs / name
        build_release(data / DEM, folder, CASES / f"{name}.geojson", plane)
        shutil.copyfile(CASES / "path.geojson", folder / "path.geojson")
        for law in LAWS:
            copy_text(CASES / f"{law}.toml", folder / f"{law}.toml", changes)
    for law in LAWS:
        copy_text(CASES / f"{law}-sweep.toml", runs / f"{law}-sweep.toml", changes)


def build_release(dem: Path, folder: Path, outline: Path, plane: str) -> None:
    """Write the filtered DEM, and the release above a plane within an outline, unless they exist."""
    release = folder / "release.tif"
    if release.exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    write_filtered(dem, folder / TERRAIN)
    words = ("--plane", plane, "--within", outline, "--volume", str(VOLUME), "--output", release, "--overwrite")
    call("thawslide.scarps.command", folder / TERRAIN, *words)


def write_filtered(dem: Path, path: Path) -> None:
    """Filter a DEM without voids, as `terrain.smooth` would: the release is then cut out of the filtered surface."""
    from scipy.ndimage import gaussian_filter  # installed with ensembles only

    with rasterio.open(dem) as file:
        heights, profile = file.read(1).astype(np.float64), file.profile
    profile.update(driver="GTiff", dtype="float64", crs=CRS, nodata=None)
    with rasterio.open(path, "w", **profile) as file:
        file.write(gaussian_filter(heights, FILTER / profile["transform"].a, mode="nearest"), 1)


def copy_text(source: Path, target: Path, changes: Changes) -> None:
    """Copy a file, with changes."""
    text = source.read_text(encoding="utf-8")
    for old, new in changes:
        text = text.replace(old, new)
    target.write_text(text, encoding="utf-8")


def end() -> float:
    """Return the time at which members end that do not come to rest [s]."""
    return float(tomllib.loads((CASES / f"{LAWS[0]}.toml").read_text(encoding="utf-8"))["time"]["end"])


def run_ensemble(law: str, runs: Path, workers: int) -> None:
    """Run the members of a law that have not finished."""
    words = ("--output", runs / law, "--workers", str(workers), "--thickness", "1", "--speed", "10", "--csv")
    call("thawslide.sweeps.command", runs / f"{law}-sweep.toml", *words)


def map_probabilities(runs: Path) -> Path:
    """Map the probabilities of all members of both laws; return the folder of the maps."""
    folder = runs / "probability"
    words = ("--thickness", "1", "--speed", "10", "--output", folder)
    call("thawslide.sweeps.probability_command", *(runs / law for law in LAWS), *words)
    return folder


def members(runs: Path) -> pd.DataFrame:
    """Return the finished members of both laws, with the columns `law` and `release`."""
    tables = [pd.read_parquet(runs / law / "members.parquet").assign(law=law) for law in LAWS]
    table = pd.concat(tables, ignore_index=True)
    table["release"] = [Path(case).parent.name for case in table["case"]]
    done: pd.DataFrame = table[table["status"] == "done"]
    return done


def quantiles(values: pd.Series) -> tuple[float, ...]:
    """Return the quantiles of a column: the smallest value that this fraction of the members does not exceed."""
    known = values.dropna().to_numpy(dtype=float)
    if not known.size:
        return tuple(math.nan for _ in QUANTILES)
    return tuple(float(each) for each in np.quantile(known, QUANTILES, method="inverted_cdf"))
