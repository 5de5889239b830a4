"""Figure of a release: thickness on the hillshade of the DEM, and a cross section down the mean slope."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from thawslide.arrays import Numbers
from thawslide.atomic_file import atomic_file
from thawslide.errors import ReportError
from thawslide.figures.style import COLUMN_WIDTH, GROUND, GROUND_LINE, ORANGE, RED, save_figure, styled
from thawslide.relief import contour_levels, hillshade
from thawslide.scarps.release import Release

_MARGIN = 0.5  # around the release, relative to its larger side
_POINTS = 400  # of the cross section
_CONTOURS = 15
_DARKEST = -0.7  # brightness of black: shaded slopes remain grey
_DPI = 150


def write_picture(release: Release, path: Path) -> None:
    """Write the figure of a release as a PNG file."""
    try:
        with atomic_file(path) as temporary:
            save_figure(_plotted(release), temporary, dpi=_DPI)
    except OSError as error:
        raise ReportError(
            f"{path}: cannot be written ({error.strerror or error}). Select another --picture."
        ) from error


@styled
def _plotted(release: Release) -> Figure:
    figure = Figure(figsize=(COLUMN_WIDTH, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    line = _section_line(release)
    _plot_map(figure, left, release, line)
    _plot_section(right, release, line)
    return figure


def _plot_map(figure: Figure, axes: Axes, release: Release, line: Numbers) -> None:
    dem, window = release.dem, _window(release)
    heights, thickness = dem.heights[window], release.thickness[window]
    x0, y0 = dem.centre(window[0].start, window[1].start)
    x = (x0 + dem.cell_x * np.arange(heights.shape[1])) / 1000.0
    y = (y0 - dem.cell_y * np.arange(heights.shape[0])) / 1000.0
    shade = hillshade(heights[::-1], dem.cell_x, dem.cell_y)[::-1]
    axes.pcolormesh(x, y, shade, cmap="gray", vmin=_DARKEST, vmax=1.0, shading="nearest", rasterized=True)
    levels = contour_levels(heights, _CONTOURS)
    if levels.size:
        axes.contour(x, y, heights, levels=levels, colors="white", linewidths=0.5, alpha=0.6)
    shown = np.ma.masked_equal(thickness, 0.0)
    mesh = axes.pcolormesh(
        x, y, shown, cmap="viridis_r", vmin=0.0, shading="nearest", alpha=0.85, linewidth=0.0, rasterized=True
    )
    figure.colorbar(mesh, ax=axes, location="bottom", shrink=0.8, label="vertical thickness (m)")
    axes.plot(*line.T / 1000.0, color=RED, linewidth=1.2)
    for point, letter in zip(line, "AB", strict=True):
        axes.annotate(letter, point / 1000.0, color=RED, weight="bold", xytext=(3, 3), textcoords="offset points")
    axes.set(aspect="equal", xlim=(x[0], x[-1]), ylim=(y[-1], y[0]), xlabel="easting (km)", ylabel="northing (km)")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4))


def _plot_section(axes: Axes, release: Release, line: Numbers) -> None:
    distance = np.linspace(0.0, float(np.hypot(*(line[1] - line[0]))), _POINTS)
    points = line[0] + np.outer(np.linspace(0.0, 1.0, _POINTS), line[1] - line[0])
    ground = _interpolated(release, release.dem.heights, points)
    failure = _interpolated(release, release.failure_surface, points)
    axes.fill_between(distance, failure, np.nanmin(failure) - 0.1 * np.ptp(failure), color=GROUND, linewidth=0.0)
    axes.fill_between(distance, failure, ground, color=ORANGE, alpha=0.7, linewidth=0.0, label="release")
    axes.plot(distance, failure, color=RED, label="failure surface")
    axes.plot(distance, ground, color=GROUND_LINE, label="DEM")
    axes.set(xlabel="distance from A to B (m)", ylabel="elevation (m)", aspect="equal", xlim=(0.0, distance[-1]))
    axes.legend(loc="upper right")


def _window(release: Release) -> tuple[slice, slice]:
    """Return the rows and columns of the release with a margin."""
    rows, columns = np.nonzero(release.cells)
    margin = 2 + int(_MARGIN * max(np.ptp(rows), np.ptp(columns)))
    height, width = release.thickness.shape
    return (
        slice(max(rows.min() - margin, 0), min(rows.max() + margin + 1, height)),
        slice(max(columns.min() - margin, 0), min(columns.max() + margin + 1, width)),
    )


def _section_line(release: Release) -> Numbers:
    """Return the ends of a line down the mean slope of the DEM through the centre of the release, shape (2, 2) [m]."""
    dem, cells = release.dem, release.cells
    x0, y0 = dem.centre(0, 0)
    x, y = (np.broadcast_to(each, cells.shape)[cells] for each in dem.offsets(x0, y0))
    centre = np.average(np.column_stack([x, y]), axis=0, weights=release.thickness[cells])
    x, y = x - centre[0], y - centre[1]
    slope = np.linalg.lstsq(np.column_stack([np.ones(x.size), x, y]), dem.heights[cells], rcond=None)[0][1:]
    steepness = float(np.hypot(*slope))
    down = -slope / steepness if steepness > 0.0 else np.array([1.0, 0.0])
    along = down[0] * x + down[1] * y
    margin = 0.25 * np.ptp(along) + 2.0 * max(dem.cell_x, dem.cell_y)
    return np.array([x0, y0]) + centre + np.outer([along.min() - margin, along.max() + margin], down)


def _interpolated(release: Release, values: Numbers, points: Numbers) -> Numbers:
    """Return values at points (n, 2), bilinear between the centres of cells; nan outside the DEM."""
    dem = release.dem
    rows, columns = values.shape
    x0, y0 = dem.centre(0, 0)
    column, row = (points[:, 0] - x0) / dem.cell_x, (y0 - points[:, 1]) / dem.cell_y
    left, top = np.clip(column.astype(int), 0, columns - 2), np.clip(row.astype(int), 0, rows - 2)
    right, down = column - left, row - top
    upper = values[top, left] * (1.0 - right) + values[top, left + 1] * right
    lower = values[top + 1, left] * (1.0 - right) + values[top + 1, left + 1] * right
    outside = (column < 0.0) | (column > columns - 1) | (row < 0.0) | (row > rows - 1)
    return np.where(outside, np.nan, upper * (1.0 - down) + lower * down)
