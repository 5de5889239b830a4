#!/usr/bin/env python3
"""Writes a synthetic mountain valley: valley.tif, release.geojson (what comes down) and path.geojson (its way).

The valley's floor falls as the long profile of cases/lamplugh: a face of 48 degrees, a ramp of 8, a glacier of 1.3
degrees. That profile is swept along a centre line that bends to the left at the foot of the face. Across, the floor is
1 km wide and gently concave, the sides rise as a parabola and then straight, 280 m above the floor where the valley is
2.5 km wide; up on the face the sides are a shallow hollow only. Ribs and gullies on the sides, which begin beyond the
floor, are waves of random phases, none shorter than 200 m. All of it is synthetic, the place on the map too.

Needs rasterio:   .venv/bin/python cases/valley3d/make_valley.py
"""

import json
from pathlib import Path

import numpy as np
import rasterio
from rasterio.transform import from_origin

FOLDER = Path(__file__).resolve().parent
PROFILE = FOLDER.parent / "lamplugh" / "lamplugh_profile.csv"

CRS = "EPSG:32608"  # UTM zone 8 north, Lamplugh's; the origin is made up
WEST, SOUTH = 400_000.0, 6_500_000.0  # lower left corner of the DEM [m]
POINT = 20.0  # distance of the DEM's points [m]
COLUMNS, ROWS = 500, 220

START = (WEST + 1_000.0, SOUTH + 3_200.0)  # of the centre line: the ridge, distance 0 of the profile [m]
START_DIRECTION = -32.0  # of the face against east, anticlockwise [degrees]
BEND = 55.0  # to the left [degrees]
BEND_FROM, BEND_TO = 1_300.0, 6_300.0  # distances along the centre line between which it bends [m]
RIDGE_ROUNDING = 80.0  # half the width of the parabola that replaces the profile's sharp ridge [m]

# Slope across the valley over the distance from the centre line [m]: straight lines between these, so that the section
# is a chain of parabolas without a kink.
ACROSS = [0.0, 500.0, 950.0, 1_250.0, 2_400.0, 3_200.0, 6_000.0]
SLOPE_ACROSS = [0.0, 0.03, 0.50, 0.50, 0.50, 0.0, 0.0]
HOLLOW = 0.2  # share of those slopes on the face
HOLLOW_TO, WALLS_FROM = 700.0, 2_000.0  # distances along between which the share rises from HOLLOW to 1 [m]
CIRQUE_FROM = 500.0  # distance across from which on the ridge curves forward [m]
CIRQUE_RADIUS = 1_800.0  # of that curve [m]

RIBS_FROM, RIBS_WHOLE = 550.0, 1_300.0  # distances across between which ribs and gullies grow to their full height [m]
RIBS_HEIGHT = 140.0  # [m]
SHORTEST_WAVE, LONGEST_WAVE = 200.0, 2_400.0  # of the ribs [m]
SEED = 20160628

RELEASE_FROM, RELEASE_TO = 50.0, 1_045.0  # along [m]
RELEASE_WIDTH = 600.0  # [m]
RELEASE_ROUNDING = 150.0  # radius of its corners [m]
RELEASE_THICKNESS = 90.0  # vertical [m]: 60 m across a slope of 48 degrees, as the source of the profile


def smooth_step(values: np.ndarray, first: float, last: float) -> np.ndarray:
    """Return 0 up to the first value, 1 from the last one on, and a cubic without a kink between."""
    share = np.clip((values - first) / (last - first), 0.0, 1.0)
    return share**2 * (3.0 - 2.0 * share)


def long_profile(along: np.ndarray) -> np.ndarray:
    """Return the elevation of the floor [m] at distances along the centre line [m], the ridge rounded."""
    distance, elevation = np.loadtxt(PROFILE, delimiter=",", skiprows=2, usecols=(0, 1), unpack=True)
    back = (elevation[1] - elevation[0]) / (distance[1] - distance[0])
    ridge = np.searchsorted(distance, 0.0)
    face = (elevation[ridge + 1] - elevation[ridge]) / (distance[ridge + 1] - distance[ridge])
    found = np.interp(along, distance, elevation)
    found = np.where(along < distance[0], elevation[0] + back * (along - distance[0]), found)
    near = np.clip(along, -RIDGE_ROUNDING, RIDGE_ROUNDING) + RIDGE_ROUNDING
    parabola = elevation[ridge] - back * RIDGE_ROUNDING + back * near + (face - back) * near**2 / (4 * RIDGE_ROUNDING)
    return np.where(np.abs(along) < RIDGE_ROUNDING, parabola, found)


def centre_line() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return distances along the centre line [m], shape [n], its points [m], shape [n, 2], and its directions."""
    step = 1.0
    along = np.arange(-2_000.0, 12_000.0, step)
    share = np.clip((along - BEND_FROM) / (BEND_TO - BEND_FROM), 0.0, 1.0)
    turned = share - np.sin(2 * np.pi * share) / (2 * np.pi)  # curvature sin^2: it comes and goes without a jump
    angle = np.radians(START_DIRECTION + BEND * turned)
    direction = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.cumsum(direction, axis=0) * step
    points += np.array(START) - points[np.searchsorted(along, 0.0)]
    return along, points, angle


def valley_coordinates(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for places [m], shape [n], the distance along the centre line and that across it, to the left [m]."""
    along, points, angle = centre_line()
    coarse = slice(None, None, 20)
    squares = (x[:, None] - points[coarse, 0]) ** 2 + (y[:, None] - points[coarse, 1]) ** 2
    foot = along[coarse][squares.argmin(axis=1)]
    for _ in range(4):  # Newton's method for the foot of the perpendicular
        east, north = x - np.interp(foot, along, points[:, 0]), y - np.interp(foot, along, points[:, 1])
        turn = np.interp(foot, along, angle)
        across = np.cos(turn) * north - np.sin(turn) * east
        curvature = np.interp(foot, along, np.gradient(angle, along))
        foot += (np.cos(turn) * east + np.sin(turn) * north) / (1.0 - curvature * across)
    return foot, across


def ribs(across: np.ndarray, down: np.ndarray, seed: int) -> np.ndarray:
    """Return a field between about 0 and 1.5, with gullies that run down; distances across and down the slope in m."""
    random = np.random.RandomState(seed)
    field = np.zeros_like(across)
    strength = 0.0
    for wave in np.geomspace(SHORTEST_WAVE, LONGEST_WAVE, 28):
        aside = random.uniform(-0.7, 0.7)
        phase = 2 * np.pi * ((across + aside * down) / wave + random.uniform())
        field += wave**1.1 * np.cos(phase)
        strength += wave**2.2 / 2.0
    return np.hypot(field / np.sqrt(strength), 0.15)


def valley() -> np.ndarray:
    """Return the elevation [m] at the points of the DEM, rows from north to south."""
    x = WEST + POINT * (np.arange(COLUMNS) + 0.5)
    y = SOUTH + POINT * (np.arange(ROWS)[::-1] + 0.5)
    east, north = np.meshgrid(x - WEST, y - SOUTH)
    rows = [valley_coordinates(x, np.full(COLUMNS, row)) for row in y]
    along, across = np.array(rows).swapaxes(0, 1)
    aside = np.abs(across)
    valley_share = smooth_step(along, HOLLOW_TO, WALLS_FROM)
    ahead = np.maximum(aside - CIRQUE_FROM, 0.0) ** 2 / (2 * CIRQUE_RADIUS) * (1.0 - valley_share)
    distance = np.arange(0.0, ACROSS[-1], 1.0)
    side = np.interp(aside, distance + 1.0, np.cumsum(np.interp(distance + 0.5, ACROSS, SLOPE_ACROSS)))
    smooth = long_profile(along - ahead) + (HOLLOW + (1.0 - HOLLOW) * valley_share) * side
    on_walls, on_face = ribs(east, north, SEED), ribs(across, along, SEED + 1)
    beyond = np.maximum(smooth_step(aside, RIBS_FROM, RIBS_WHOLE), smooth_step(-along, 100.0, 600.0))
    return smooth + RIBS_HEIGHT * beyond * (valley_share * on_walls + 0.5 * (1.0 - valley_share) * on_face)


def release() -> list[list[float]]:
    """Return the corners of the outline, a rectangle with rounded corners on the face, closed [m]."""
    middle = (RELEASE_FROM + RELEASE_TO) / 2.0
    half = ((RELEASE_TO - RELEASE_FROM) / 2.0, RELEASE_WIDTH / 2.0)
    direction = np.radians(START_DIRECTION)
    corners = []
    for quarter, (ahead, left) in enumerate([(1, 1), (-1, 1), (-1, -1), (1, -1)]):
        for turn in np.radians(90.0 * quarter + np.arange(0.0, 91.0, 15.0)):
            along = middle + ahead * (half[0] - RELEASE_ROUNDING) + RELEASE_ROUNDING * np.cos(turn)
            across = left * (half[1] - RELEASE_ROUNDING) + RELEASE_ROUNDING * np.sin(turn)
            corners.append(
                [
                    round(START[0] + along * np.cos(direction) - across * np.sin(direction), 1),
                    round(START[1] + along * np.sin(direction) + across * np.cos(direction), 1),
                ]
            )
    return [*corners, corners[0]]


def path() -> list[list[float]]:
    """Return the corners of the centre line from the ridge on, as long as it lies in the DEM [m]."""
    along, points, _ = centre_line()
    inside = (along >= 0.0) & (points < [WEST + POINT * COLUMNS, SOUTH + POINT * ROWS]).all(axis=1)
    return points[inside][::50].round(1).tolist()


def write_map(name: str, kind: str, coordinates: list, properties: dict) -> None:
    """Write a GeoJSON file of one feature in the CRS of the DEM."""
    feature = {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}
    crs = {"type": "name", "properties": {"name": f"urn:ogc:def:crs:EPSG::{CRS.split(':')[1]}"}}
    collection = {"type": "FeatureCollection", "crs": crs, "features": [feature]}
    (FOLDER / name).write_text(json.dumps(collection) + "\n")


def write() -> None:
    """Write the three files."""
    elevation = valley().round(1).astype(np.float32)  # to the decimetre, which packs well
    options = {"compress": "deflate", "predictor": 3, "zlevel": 9, "nodata": -9999.0, "tiled": True}
    with rasterio.open(
        FOLDER / "valley.tif",
        "w",
        driver="GTiff",
        width=COLUMNS,
        height=ROWS,
        count=1,
        dtype="float32",
        crs=CRS,
        transform=from_origin(WEST, SOUTH + POINT * ROWS, POINT, POINT),
        **options,
    ) as file:
        file.write(elevation, 1)
    write_map("release.geojson", "Polygon", [release()], {"name": "slide", "thickness": RELEASE_THICKNESS})
    write_map("path.geojson", "LineString", path(), {"name": "centre line"})


if __name__ == "__main__":
    write()
