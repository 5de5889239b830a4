"""Interactive view of a 3D run on a DEM: hillshade, and fields on the cells of a map."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from contourpy import contour_generator
from matplotlib.image import imsave

from thawslide.binning import FIELDS, gather, gather_base
from thawslide.errors import NotInRunError
from thawslide.figures.map_panel import SHADES
from thawslide.figures.moments import shown_snapshot, shown_time
from thawslide.figures.site import Site, make_site
from thawslide.figures.slide_on_map import cell_of, where_thick
from thawslide.figures.style import TIME_LABEL
from thawslide.maps import Grid, Map
from thawslide.number_text import exact_text
from thawslide.pages.markup import data_address
from thawslide.pages.packing import Packing
from thawslide.pages.view import MOST_SNAPSHOTS, Field, View, fields_with_values
from thawslide.run_folder import Numbers, Run
from thawslide.section_thickness import spaced

MOST_CELLS = 200  # per side
_STATIC = (
    ("max_thickness", "maximum flow thickness", "m", "YlOrRd", True),
    ("max_speed", "maximum speed", "m/s", "viridis", True),
    ("arrival_time", "arrival time", "s", "cividis", False),
    ("max_pressure", "maximum dynamic pressure", "Pa", "magma_r", True),
)


def map_view(run: Run) -> View:
    """Return the view of a 3D run; NotInRunError without maps or snapshots."""
    site = make_site(run)
    if not len(run.times):
        raise NotInRunError(f"{run.folder}: no snapshots. Set time.output_interval and repeat the run.")
    grid = site.maps["max_thickness"].grid.cropped(site.scene.box)
    grid = grid.thinned(grid.factor(MOST_CELLS))
    indices = spaced(len(run.times), MOST_SNAPSHOTS)
    packing = Packing()
    fields, times = _moving_fields(run, site, grid, indices)
    east, north = np.meshgrid(grid.x, grid.y)
    parts: dict[str, Any] = {
        "kind": "map",
        "times": times,
        "timeWords": TIME_LABEL,
        "fields": fields_with_values([*fields, *_static_fields(run, site)], packing),
        "grid": {"x": grid.x0, "y": grid.y0, "dx": grid.cell_x, "dy": grid.cell_y, "columns": grid.columns},
        "elevation": packing.add(site.ground.at(east, north)),
        "shade": _shade(site),
        "shadeBox": site.scene.terrain.grid.box,
        "box": site.scene.box,
        "lines": _lines(site, packing),
        "probes": {name: list(place) for name, place in site.probes.items()},
    }
    return View(parts, packing, _caption(run, site, grid, len(indices)))


def _moving_fields(run: Run, site: Site, grid: Grid, indices: list[int]) -> tuple[list[Field], list[str]]:
    """Return the fields of the snapshots, and their times as text."""
    thickness = Field("flow thickness", "m", "YlOrRd", has_zero_base=True)
    speed = Field("depth-averaged speed", "m/s", "viridis", has_zero_base=True)
    heat = Field("basal temperature", "°C", "plasma")
    band = Field("band temperature", "°C", "plasma")
    ratio = Field("pore pressure ratio P/N", "–", "viridis", has_zero_base=True)
    pressure = Field("pore pressure at the base", "Pa", "viridis", has_zero_base=True)
    has_heat = bool(run.section("heat").get("enabled", True)) and not run.has_band_columns
    times = []
    for index in indices:
        shot = shown_snapshot(run, index, (*FIELDS, "pore_pressure"))
        columns = gather(grid, shot, cell_of(run))
        times.append(shown_time(run, shot.time))

        def shown(field: Map, columns: Any = columns) -> Numbers:
            return where_thick(field, columns, site.threshold).values

        thickness.values.append(shown(columns.thickness))
        speed.values.append(shown(columns.speed))
        if has_heat:
            heat.values.append(shown(columns.temperature))
            if columns.pore_pressure is not None:
                pressure.values.append(shown(columns.pore_pressure))
        if run.has_band_columns:
            base = gather_base(grid, shot, cell_of(run))
            band.values.append(shown(base.temperature))
            ratio.values.append(shown(base.pressure_ratio))
    return [each for each in (thickness, speed, heat, pressure, band, ratio) if each.values], times


def _static_fields(run: Run, site: Site) -> list[Field]:
    """Return maxima and first times of the whole run, on cells reduced to their maxima."""
    fields = []
    for name, words, unit, colours, has_zero_base in _STATIC:
        if name not in site.maps:
            continue
        values = site.maps[name].cropped(site.scene.box).thinned(MOST_CELLS, "maximum").values
        if has_zero_base:
            values = np.where(values > (site.threshold if name == "max_thickness" else 0.0), values, np.nan)
        fields.append(Field(words, unit, colours, has_zero_base, is_static=True, values=[values]))
    return fields


def _shade(site: Site) -> str:
    """Return the hillshade as an image, north at the top."""
    image = BytesIO()
    imsave(image, np.nan_to_num(site.scene.shade[::-1], nan=1.0), cmap=SHADES, vmin=0.0, vmax=1.0, format="png")
    return data_address(image.getvalue(), "image/png")


def _lines(site: Site, packing: Packing) -> list[dict[str, Any]]:
    """Return release, affected area and flow path as lines with gaps between their parts."""
    release = _contours(site.release, 1e-6) if site.release is not None else []
    affected = _contours(site.reached, site.threshold) if site.affected is None else site.affected
    path = [] if site.path is None else [site.path]
    found = (("release", release, "dash"), ("affected area", affected, "solid"), ("flow path", path, "solid"))
    lines = []
    for words, parts, dash in found:
        if parts:
            gap = np.full((1, 2), np.nan)
            points = np.concatenate([np.concatenate((part, gap)) for part in parts])
            lines.append({"words": words, "dash": dash, "x": packing.add(points[:, 0]), "y": packing.add(points[:, 1])})
    return lines


def _contours(field: Map, level: float) -> list[Numbers]:
    """Return the contour lines of a field at a level, each of shape (n, 2); cells without data are below it."""
    grid = field.grid
    x = grid.x0 + grid.cell_x * np.arange(-1, grid.columns + 1)
    y = grid.y0 + grid.cell_y * np.arange(-1, grid.rows + 1)
    values = np.pad(np.nan_to_num(field.values, nan=0.0), 1)
    return [np.asarray(line) for line in contour_generator(x, y, values).lines(level)]


def _caption(run: Run, site: Site, grid: Grid, snapshots: int) -> str:
    full = site.maps["max_thickness"].grid
    size = f"{exact_text(round(grid.cell_x, 2))} m"
    merged = "" if grid.cell_x <= full.cell_x else f" (cells of {exact_text(full.cell_x)} m in the map files)"
    return (
        f"Shown: {grid.columns:,} × {grid.rows:,} cells of {size}{merged}, {snapshots} of {len(run.times)} snapshots. "
        f"Cells below {site.threshold:g} m have no colour. Fields named maximum, and the arrival time, are those of "
        "the whole run. Drag to zoom, double-click to reset."
    )
