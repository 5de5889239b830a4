"""The blind forecast of Joffre Peak against the observations, causes of its errors, and a forecast with a frozen prior.

The blind members run again on coarse cells. The frozen prior forecasts Joffre Peak, from both releases, and Frank.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import rasterio

from reproduction.studies import frank, joffre
from reproduction.study import Job, Place
from thawslide.arrays import Numbers
from thawslide.pages.events import Event
from thawslide.run_folder import Run
from thawslide.scores.baseline import baseline_values
from thawslide.scores.ensemble import crps, quantiles
from thawslide.scores.forecast import Forecast, read_forecast
from thawslide.scores.observed import Observed, read_observed
from thawslide.scores.output import CSV, write_score
from thawslide.scores.quantities import QUANTITIES
from thawslide.scores.score import compute_score
from thawslide.sweeps.folder import PRIOR as PRIOR_FOLDER
from thawslide.sweeps.folder import PRIOR_FILE
from thawslide.sweeps.probability import rasters_in, write_probability_maps
from thawslide.sweeps.results import TABLE

Rows = list[dict[str, Any]]
CASES = Path(__file__).resolve().parent / "cases"
PRIOR = CASES / "frozen-prior.toml"
EVENTS = Path("events") / "rock_avalanches_canada.csv"  # in the folder of the data
SIMILAR = (1.0, 6.0)  # million m3: volumes of the events in the table of the blind forecast
REACH = (541600.0, 5579600.0)  # m: observed end of the deposit
WHOLE = 'sample = "lhs:40"', 'sample = "lhs:32"'  # and of --quick
APIC = ("[material.rock]", '[mechanics]\ntransfer = "apic"\n\n[material.rock]')
MEMBERS = (*joffre.COARSE, APIC)  # changes of the blind cases
# Changes of their Voellmy case for the frozen prior: cells that `thawslide new` selects, and more time along the creek
QUICK = (("cell = 24.0", "cell = 40.0"), ("5581944.0", "5581960.0"), ("end = 240.0", "end = 400.0"))
HIGH = "x=539680,y=5576800,dip=20,direction=30"  # plane of the release that is as high as observed
HALF_WIDTH, CREEK_BELOW, BED = 100.0, 1450.0, 3.0  # m: of the creek about the path, its highest ground, erodible depth
ANGLES = (12.0, 20.5)  # degrees, of rigid blocks
BEND, SPAN = (2000.0, 2600.0), 200.0  # m along the path: before and after the bend into the creek; span of a speed

CREEK = (
    "substrate.creek.raster={runs}/creek.tif",
    "substrate.creek.code=1",
    "substrate.creek.friction=voellmy",
    "substrate.creek.turbulent_friction=500",
)
WET, WETTER = (f"substrate.creek.friction_coefficient={value}" for value in (0.05, 0.02))
DEBRIS = (
    "bed.law=momentum",
    'bed.depth={{ raster = "{runs}/bed.tif" }}',
    "bed.strength=0",
    "bed.friction_angle=3",
    "bed.depth_per_slip=0.05",
    "bed.material=rock",
    "bed.porosity=0.3",
    "bed.temperature=1",
)
VARIANTS = (
    frank.Variant("middle", "middle of the blind ranges: 0.125, 500 m/s²"),
    frank.Variant("fine", "cells of 12 m", ("grid.cell=12", "grid.max=[542960.0, 5581956.0, 2800.0]")),
    frank.Variant("quick", "cells of 40 m", ("grid.cell=40", "grid.max=[542960.0, 5581960.0, 2800.0]")),
    frank.Variant("high", "higher release", ('body.slide.thickness={{ raster = "{runs}/release-high/release.tif" }}',)),
    frank.Variant("low", "friction coefficient 0.05 everywhere", ("basal.friction_coefficient=0.05",)),
    frank.Variant("creek", "0.05 in the creek only", (*CREEK, WET)),
    frank.Variant("wetter", "0.02 in the creek only", (*CREEK, WETTER)),
    frank.Variant("bed", "erodible bed in the creek", DEBRIS),
)  # fmt: skip


def jobs(place: Place) -> list[Job]:
    """Write all cases; return the runs and rigid blocks that separate causes."""
    runs = place.runs
    changes = (*MEMBERS, *joffre.FEW) if place.is_quick else MEMBERS
    joffre.prepare(place.data / "joffre", runs, changes)
    joffre.build_release(place.data / "joffre" / joffre.DEM, runs / "release-high", CASES / "joffre-high.geojson", HIGH)
    write_creek(runs)
    write_frank(place)
    for name in ("lower", "upper", "frank"):
        if name != "frank":
            joffre.copy_text(runs / name / "voellmy.toml", runs / name / "case.toml", QUICK)
        joffre.copy_text(PRIOR, runs / name / "sweep.toml", (WHOLE,) if place.is_quick else ())
    case = str(runs / "lower" / "voellmy.toml")
    found = [
        Job(each.name, each.words, tuple(change.format(runs=runs) for change in each.changes), case)
        for each in VARIANTS
        if each.name != "fine" or not place.is_quick
    ]
    for angle in ANGLES:
        for bends in ("true", "false"):
            sets = (f"basal.friction_angle={angle}", f"block.bends={bends}")
            found.append(Job(f"block-{angle:g}-{bends}", "", sets, str(runs / "lower" / "coulomb.toml"), "block"))
    return found


def write_creek(runs: Path) -> None:
    """Write the code of the creek and the depth of its bed, within a distance of the low part of the path."""
    from scipy.ndimage import distance_transform_edt  # installed with ensembles only

    path = json.loads((runs / "lower" / "path.geojson").read_text(encoding="utf-8"))
    line = np.array(path["features"][0]["geometry"]["coordinates"])[:, :2]
    steps = np.arange(0.0, len(line) - 1.0, 0.05)
    x, y = (np.interp(steps, np.arange(len(line)), line[:, axis]) for axis in (0, 1))
    with rasterio.open(runs / "lower" / joffre.TERRAIN) as file:
        heights, profile, transform = file.read(1), file.profile, file.transform
    columns, rows = ((x - transform.c) / transform.a).astype(int), ((transform.f - y) / transform.a).astype(int)
    is_low = heights[rows, columns] < CREEK_BELOW
    is_away = np.ones(heights.shape, dtype=bool)
    is_away[rows[is_low], columns[is_low]] = False
    is_creek = distance_transform_edt(is_away, transform.a) <= HALF_WIDTH
    for name, kind, values in (("creek", "uint8", is_creek), ("bed", "float64", BED * is_creek)):
        with rasterio.open(runs / f"{name}.tif", "w", **{**profile, "dtype": kind}) as file:
            file.write(values.astype(kind), 1)


def write_frank(place: Place) -> None:
    """Write the case of the Frank slide with Voellmy friction, on cells of 60 m and until rest."""
    folder = place.runs / "frank"
    folder.mkdir(parents=True, exist_ok=True)
    for name, file in (("topography", "Frankslide_topography.asc"), ("pile", "Frankslide_pile.asc")):
        shutil.copyfile(place.data / "frank" / file, folder / f"{name}.asc")
    shutil.copyfile(CASES / "frank-path.geojson", folder / "path.geojson")
    changes = (
        ("cell = 20.0  # that of the DEM; particles 10 m apart", "cell = 60.0"),
        ("max = [4020.0, 4020.0, 2320.0]", "max = [4000.0, 4000.0, 2340.0]"),
        ("end = 100.0", "end = 400.0"),
        ("output_interval = 5.0", "output_interval = 20.0"),
        (
            'friction = "constant"\nfriction_angle = 15.0',
            'friction = "voellmy"\nfriction_coefficient = 0.125\nturbulent_friction = 500.0',
        ),
        ("[maps]\ncell = 20.0", '[maps]\narrival_thickness = 0.5\npath = "path.geojson"'),
    )
    joffre.copy_text(frank.CASE, folder / "case.toml", changes)


def run_forecasts(place: Place) -> None:
    """Run the members that have not finished."""
    for law in joffre.LAWS:
        joffre.run_ensemble(law, place.runs, place.at_a_time)
    for name in ("lower", "upper", "frank"):
        words = ["--prior", "events", "--kind", "rock", "--workers", str(place.at_a_time)]
        words += ["--event", "Frank 1903"] if name == "frank" else []
        call = "thawslide.forecasts.command"
        joffre.call(call, place.runs / name, *words, "--output", place.runs / f"{name}-forecast")


def joined(folder: Path, parts: Sequence[Forecast]) -> Forecast:
    """Return one forecast of several equally probable ones, each with its own weights."""
    common = set.intersection(*(set(part.columns) for part in parts))
    return Forecast(
        folder=folder,
        is_sweep=True,
        members=list(range(sum(len(part.members) for part in parts))),
        weights=np.concatenate([part.weights for part in parts]) / len(parts),
        columns={name: np.concatenate([part.columns[name] for part in parts]) for name in sorted(common)},
        run_folders=[run for part in parts for run in part.run_folders],
    )


def forecasts(runs: Path) -> dict[str, tuple[Forecast, Observed]]:
    """Return the finished forecasts by name, with the observations of their event."""
    observed = {name: read_observed(CASES / f"{name}-observed.toml") for name in ("joffre", "frank")}
    parts = {
        "blind": [runs / law for law in joffre.LAWS],
        "frozen": [runs / "lower-forecast", runs / "upper-forecast"],
        "frank": [runs / "frank-forecast"],
    }
    return {
        name: (
            joined(runs / f"score-{name}", [read_forecast(each) for each in folders]),
            observed.get(name, observed["joffre"]),
        )
        for name, folders in parts.items()
        if all((each / TABLE).exists() for each in folders)
    }


def events_of_table(data: Path) -> list[Event]:
    """Return the events in the table of the blind forecast: other events of similar volume."""
    table = pd.read_csv(data / EVENTS, encoding="latin-1")
    rows = table[table["Volume"].between(*SIMILAR)][["Event Name", "Volume", "H", "L"]].itertuples(index=False)
    return [Event(name, "rock", 1e6 * volume, height, length, "") for name, volume, height, length in rows]


def scores(runs: Path, data: Path) -> Rows:
    """Write the score of each forecast; return its rows, those of Joffre Peak with the table of the blind forecast."""
    found: Rows = []
    for name, (forecast, observed) in forecasts(runs).items():
        write_score(compute_score(forecast, observed), forecast.folder)
        rows = pd.read_csv(forecast.folder / CSV).replace({np.nan: None}).to_dict("records")
        for row in rows if name != "frank" else ():
            values = of_table(row["quantity"], data, forecast)
            if values is not None:
                factor = QUANTITIES[row["quantity"]].units[row["unit"]][0]
                row["table_crps"] = crps(values / factor, np.ones(len(values)), row["observed"])
        found += [{"forecast": name, **row} for row in rows if row["quantity"] != "release_volume"]
    return found


def of_table(quantity: str, data: Path, forecast: Forecast) -> Numbers | None:
    """Return a quantity of the events of the blind forecast, as `thawslide score` does; None if unknown."""
    height = quantiles(forecast.columns["drop_height_m"], forecast.weights)[1]
    return baseline_values(quantity, events_of_table(data), height)


def front_speed(run: Path, start: float) -> float:
    """Return the mean speed of the front [m/s] over a span from a position [m]; nan if it does not pass it."""
    series = Run(run).series
    front = np.maximum.accumulate(series["front_position_m"])
    first, last = np.interp((start, start + SPAN), front, series["time_s"], right=np.nan)
    return float(SPAN / (last - first))


def numbers(place: Place) -> dict[str, Rows]:
    """Return all numbers of the page: scores, runs, rigid blocks and prior checks."""
    runs, found = place.runs, dict[str, Rows]()
    found["scores"] = scores(runs, place.data)
    found["runs"] = []
    for each in VARIANTS:
        if (runs / each.name / "run.json").exists():
            known = {name: float(values[0]) for name, values in read_forecast(runs / each.name).columns.items()}
            speeds = zip(("before", "after"), (front_speed(runs / each.name, start) for start in BEND), strict=True)
            found["runs"].append({"name": each.name, "words": each.words, **known, **dict(speeds)})
    found["blocks"] = []
    for angle in ANGLES:
        for bends in ("true", "false"):
            last = pd.read_csv(runs / f"block-{angle:g}-{bends}.csv").iloc[-1]
            length, height = float(last["travel_distance_m"]), float(last["drop_height_m"])
            found["blocks"].append({"name": f"{angle:g}-{bends}", "length": length, "ratio": height / length})
    found["priors"] = []
    for name in [name for name in ("lower", "upper", "frank") if (runs / f"{name}-forecast" / TABLE).exists()]:
        forecast = read_forecast(runs / f"{name}-forecast")
        prior = json.loads((forecast.folder / PRIOR_FOLDER / PRIOR_FILE).read_text(encoding="utf-8"))
        rows = dict(zip(("sweep", "weighted", "events"), ([*row[2:]] for row in prior["rows"]), strict=True))
        rows["runs"] = quantiles(forecast.columns["h_over_l"], forecast.weights)
        effective = prior["rows"][1][1]
        for part, (low, median, high) in rows.items():
            row = {"name": f"{name}.{part}", "low": low, "median": median, "high": high, "effective": effective}
            found["priors"].append(row)
    return found


def map_reached(forecast: Forecast) -> Path:
    """Write the probability maps of a forecast with its weights; return that of being reached."""
    folder = forecast.folder / "probability"
    rasters = rasters_in(forecast.run_folders)
    write_probability_maps(rasters, folder, weights=[float(each) for each in forecast.weights])
    return folder / "reached.tif"
