"""Interactive view of a 2D run: terrain profile, particles and basal segments in colours of a field."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from thawslide.figures.colours import PLASTIC_STRAIN, PORE_PRESSURE, SPEED, TEMPERATURE, Painting, painted_values
from thawslide.figures.moments import shown_snapshot, shown_time
from thawslide.figures.style import TIME_LABEL
from thawslide.number_text import exact_text
from thawslide.pages.packing import Packing
from thawslide.pages.view import MOST_SNAPSHOTS, Field, View, fields_with_values
from thawslide.run_folder import Numbers, Run, Snapshot
from thawslide.section_thickness import particle_thickness, spaced

MOST_PARTICLES = 2000
MOST_PROFILE_POINTS = 2000
PARTICLES, SEGMENTS = "particles", "segments"
_MARGIN = 0.15  # of the terrain on both sides of the extent of the sliding mass
_THICKNESS = Painting("thickness", "flow thickness", "m", "YlOrRd")
_SATURATION = Painting("liquid_saturation", "liquid saturation", "–", "YlGnBu")
_HEAT = (TEMPERATURE, PORE_PRESSURE, _SATURATION)  # of particles: constant with band columns
_BASE = (
    replace(TEMPERATURE, field="temperature_C", words="mean band temperature"),
    replace(TEMPERATURE, field="max_temperature_C", words="maximum band temperature"),
    replace(PORE_PRESSURE, field="pore_pressure_Pa", words="band pore pressure"),
    replace(PORE_PRESSURE, field="normal_pressure_Pa", words="normal pressure on the base"),
)
_FROM_ZERO = ("velocity", "plastic_strain", "thickness", "liquid_saturation", "normal_pressure_Pa")


def chosen_particles(ids: NDArray[np.integer], total: int, most: int = MOST_PARTICLES) -> NDArray[np.intp]:
    """Return the rows of at most about `most` of `total` particles, the same ones in all snapshots.

    Fibonacci hashing of the ids distributes them evenly over the body.
    """
    if total <= most:
        return np.arange(len(ids))
    hashed = (np.asarray(ids, dtype=np.uint64) * np.uint64(2654435761)) % np.uint64(2**32)
    return np.flatnonzero(hashed < np.uint64(2**32 * most / total))


def section_view(run: Run) -> View:
    """Return the view of a 2D run; NotInRunError without snapshots."""
    indices = spaced(len(run.times), MOST_SNAPSHOTS)
    first = shown_snapshot(run, 0)
    paintings = [SPEED, _THICKNESS, replace(PLASTIC_STRAIN, unit="–")]
    paintings += [] if run.has_band_columns else _HEAT
    fields = [_field(each, PARTICLES) for each in paintings if each is _THICKNESS or each.field in first]
    bases = [_field(each, SEGMENTS) for each in _BASE] if run.has_band_columns else []
    packing = Packing()
    points: dict[str, dict[str, list[list[float]]]] = {PARTICLES: {"x": [], "y": []}, SEGMENTS: {"x": [], "y": []}}
    total = max(len(run.snapshot(index, fields=()).points) for index in {0, len(run.times) - 1})
    shown, times, extent = 0, [], (np.inf, -np.inf)
    wanted = {each.field for each in paintings if each is not _THICKNESS} | {"id", "volume"}
    for index in indices:
        shot = shown_snapshot(run, index, wanted)
        rows = chosen_particles(shot["id"], total) if "id" in shot else np.arange(min(total, MOST_PARTICLES))
        shown = max(shown, len(rows))
        times.append(shown_time(run, shot.time))
        known = shot.points[np.isfinite(shot.points[:, 0]), 0]
        extent = min(extent[0], known.min(initial=np.inf)), max(extent[1], known.max(initial=-np.inf))
        _add_points(points[PARTICLES], packing, shot.points[rows, 0], shot.points[rows, run.vertical])
        for painting, each in zip(
            [one for one in paintings if one is _THICKNESS or one.field in first], fields, strict=True
        ):
            each.values.append(_particle_values(run, shot, painting)[rows])
        _add_base(run, shot, bases, points[SEGMENTS], packing)
    profile = _profile(run, *extent)
    parts = {
        "kind": "section",
        "times": times,
        "timeWords": TIME_LABEL,
        "axes": ["distance along x", "height normal to x"] if run.gravity_tilt else ["distance", "elevation"],
        "fields": fields_with_values([*fields, *bases], packing),
        "points": points,
        "terrain": [packing.add(each) for each in profile],
    }
    return View(parts, packing, _caption(run, indices, shown, total))


def _field(painting: Painting, points: str) -> Field:
    has_zero_base = painting.field in _FROM_ZERO
    return Field(painting.words, painting.unit, painting.colours, has_zero_base, points=points)


def _particle_values(run: Run, shot: Snapshot, painting: Painting) -> Numbers:
    return particle_thickness(run, shot) if painting is _THICKNESS else painted_values(shot, painting.field)


def _add_points(points: dict[str, list[list[float]]], packing: Packing, x: Numbers, y: Numbers) -> None:
    points["x"].append(packing.add(x))
    points["y"].append(packing.add(y))


def _add_base(
    run: Run, shot: Snapshot, fields: list[Field], points: dict[str, list[list[float]]], packing: Packing
) -> None:
    """Add the basal segments of a snapshot, sorted along x; at most as many as particles."""
    place = shot.base.get("position_m", np.zeros((0, 3)))
    order = np.argsort(place[:, 0], kind="stable")[:: max(1, -(-len(place) // MOST_PARTICLES))]
    _add_points(points, packing, place[order, 0], place[order, run.vertical])
    for each, painting in zip(fields, _BASE, strict=False):
        values = shot.base.get(painting.field)
        each.values.append(np.full(len(order), np.nan) if values is None else values[order])


def _profile(run: Run, low: float, high: float) -> tuple[Numbers, Numbers]:
    """Return the terrain from the rearmost to the foremost x [m] of the sliding mass, and a margin."""
    if run.terrain is None:
        return np.zeros(0), np.zeros(0)
    distance, height = run.terrain
    margin = _MARGIN * (high - low)
    if np.isfinite(margin):
        ends = np.clip([low - margin, high + margin], distance[0], distance[-1])
        inside = distance[(distance > ends[0]) & (distance < ends[1])]
        distance = np.unique([ends[0], *inside, ends[1]])
        height = np.interp(distance, *run.terrain)
    step = max(1, -(-len(distance) // MOST_PROFILE_POINTS))
    return distance[::step], height[::step]


def _caption(run: Run, indices: list[int], shown: int, total: int) -> str:
    particles = f"all {total:,}" if shown >= total else f"{shown:,} of {total:,}"
    segments = (
        " Fields of the base are those of the basal segments; particles are then grey." if run.has_band_columns else ""
    )
    cell = run.section("grid").get("cell")
    width = f" over {exact_text(float(cell))} m" if cell else ""
    direction = "normal to x" if run.gravity_tilt else "vertical"
    return (
        f"Shown: {particles} particles, {len(indices)} of {len(run.times)} snapshots. Speeds are means between "
        f"neighbouring snapshots. Flow thickness is {direction}, a mean{width} along the section. Drag to zoom, "
        f"double-click to reset.{segments}"
    )
