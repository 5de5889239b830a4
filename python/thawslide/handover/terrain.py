"""Terrain after an event: a DEM without the release and with the deposit, for the next event."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from thawslide import _core
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.map_files import read_raster, write_raster
from thawslide.run_folder import Run

_COVERED = 0.99  # of the deposit: less has a note
DESCRIPTION = "elevation of the terrain after the event"


@dataclass(frozen=True)
class TerrainAfter:
    """Elevations after an event [m], shape (rows, columns) of the DEM, rows from south to north; nan: no data."""

    raster: _core.Raster  # of the DEM
    heights: Numbers
    deposit: float  # volume added to the DEM [m3]
    deposit_of_run: float  # volume of the deposit on the map cells of the run [m3]
    removed: float  # volume of the release taken out of the DEM [m3]; 0 if it lay on top
    notes: list[str]

    def write(self, path: Path) -> None:
        """Write a GeoTIFF on the points of the DEM."""
        write_raster(path, self.raster, self.heights, "m", DESCRIPTION)


def terrain_after(run: Run, dem: Path | None = None) -> TerrainAfter:
    """Return the terrain after a 3D run on a DEM; ReportError if the DEM does not fit, NotInRunError without maps.

    dem: terrain before the event, in the coordinate reference system of the run; by default the terrain of the run,
    which is filtered. A release that the case cuts out of its DEM (`placement = "cut"`) is cut out of this one, too.
    The deposit is interpolated bilinearly between the map cells of the run.
    """
    deposit = run.maps["final_thickness"]
    deposit = replace(deposit, values=np.nan_to_num(deposit.values))
    raster, notes = read_raster(dem or run.maps.folder / "terrain.tif", "")
    heights = np.array(raster.values, dtype=np.float64)
    x = raster.x + raster.cell_x * np.arange(raster.columns, dtype=np.float64)
    y = raster.y + raster.cell_y * np.arange(raster.rows, dtype=np.float64)
    area = raster.cell_x * raster.cell_y
    removed = 0.0
    if dem is not None:
        _require_system(dem, raster.crs, deposit.wkt)
        _require_overlap(dem, x, y, deposit.grid.box)
        if _is_cut(run):
            release = run.maps["release"]
            release = replace(release, values=np.nan_to_num(release.values))
            taken = np.nan_to_num(release.at(x[None, :], y[:, None]))
            heights -= taken
            removed = float(np.sum(taken)) * area
    added = np.where(np.isfinite(heights), np.nan_to_num(deposit.at(x[None, :], y[:, None])), 0.0)
    heights += added
    on_dem, on_map = float(np.sum(added)) * area, deposit.volume()
    if on_dem < _COVERED * on_map:
        notes = [*notes, f"note: the DEM covers {100.0 * on_dem / on_map:.0f} % of the deposit."]
    if not run.is_at_rest:
        notes = [*notes, f"note: the slide still moves at {run.last_time:g} s, the end of the run."]
    if run.section("bed").get("law", "none") != "none":
        notes = [*notes, "note: the run eroded its bed; the terrain does not include the eroded depth."]
    return TerrainAfter(raster, heights, on_dem, on_map, removed, notes)


def _is_cut(run: Run) -> bool:
    """Return whether the release is cut out of the DEM; ReportError if only some bodies are."""
    placements = {body.get("placement", "on_top") for body in run.section("body").values()}
    if len(placements) > 1:
        raise ReportError(
            f"{run.folder}: some bodies lie on the DEM, others are cut out of it (body.NAME.placement), and the map of "
            "the release contains them together. Omit --dem to use the terrain of the run."
        )
    return placements == {"cut"}


def _require_system(dem: Path, own: str, of_run: str) -> None:
    if own and of_run and not _core.is_same_system(own, of_run):
        raise ReportError(
            f"--dem {dem}: another coordinate reference system than the run (found {own}). Use a DEM in that of the "
            "run."
        )


def _require_overlap(dem: Path, x: Numbers, y: Numbers, box: tuple[float, float, float, float]) -> None:
    west, east, south, north = box
    if x[-1] < west or x[0] > east or y[-1] < south or y[0] > north:
        raise ReportError(
            f"--dem {dem}: does not overlap the maps of the run (found x = {x[0]:.10g} to {x[-1]:.10g}, "
            f"y = {y[0]:.10g} to {y[-1]:.10g}; allowed {west:.10g} to {east:.10g}, {south:.10g} to {north:.10g}). Use "
            "a DEM in the coordinate reference system of the run."
        )
