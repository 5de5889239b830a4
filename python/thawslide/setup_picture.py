"""Figure of the setup of a 2D case: terrain, grid, bodies, boundaries and frames."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import FigureCanvasBase
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.figures.style import (
    BLUE,
    GREEN,
    GROUND,
    GROUND_LINE,
    NOTE,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    save_figure,
    styled,
)
from thawslide.figures.window import Window, fill_terrain, fit, squares
from thawslide.setup_map import SetupOnMap, check_domain, numbers_of, plot_setup_on_map, setup_on_map
from thawslide.text_files import MEGABYTE, read_json

_BODY_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, SKY)
_SUBSTRATE_COLOURS = (SKY, RED, GREEN, PURPLE)
_SIDE_LINES: dict[str, Any] = {"fixed": "-", "roller": "--", "open": ":"}
_SMALLEST_CELL = 0.05  # inches on the page: for smaller cells, grid lines are omitted
_SMALLEST_GAP = 0.05  # inches between particles: without gaps if they are closer
_MARGINS = (1.03, 1.1)
_WIDTH, _LEFT, _RIGHT = 10.0, 0.8, 0.25


@dataclass(frozen=True)
class Body:
    """A body's name, material, points [m] of shape (n, 2), and the spacing [m] of its particles."""

    name: str
    material: str
    points: Numbers
    spacing: float


@dataclass(frozen=True)
class Frame:
    """A rigid frame: its corners [m], the axis and the velocity [m/s] along it that it prescribes."""

    name: str
    low: tuple[float, float]
    high: tuple[float, float]
    axis: str
    velocity: float


@dataclass(frozen=True)
class Setup:
    """Setup of a case: cell size [m], corners of the domain [m], and its contents."""

    title: str
    cell: float
    low: tuple[float, float]
    high: tuple[float, float]
    boundary: dict[str, str]
    terrain: tuple[Numbers, Numbers] | None
    bodies: list[Body]
    frames: list[Frame]
    substrates: list[str] = field(default_factory=list)
    substrate_numbers: Numbers | None = None  # at the points of the terrain, from 1; 0 for none


def read_setup(path: Path) -> Setup | SetupOnMap:
    """Read a setup file of the simulator; ReportError if it does not exist or is incomplete.

    A setup whose terrain has heights over the plane is on a DEM.
    """
    data = read_json(path, 1024 * MEGABYTE)
    try:
        terrain = data.get("terrain")
        if terrain is not None and "heights" in terrain:
            return setup_on_map(data)
        return _setup_in_section(data)
    except KeyError as error:
        raise ReportError(
            f"{path}: not a setup of the simulator (found no key {error}). Repeat `thawslide check --picture`."
        ) from error
    except (ArithmeticError, AttributeError, TypeError, ValueError, IndexError) as error:
        raise ReportError(
            f"{path}: not a setup of the simulator ({error}). Repeat `thawslide check --picture`."
        ) from error


def _setup_in_section(data: dict[str, Any]) -> Setup:
    """Return a setup from the data of the simulator; KeyError, TypeError or ValueError if a part is missing."""
    terrain, substrates = data.get("terrain"), data.get("substrates")
    low, high, cell = _pair(data["min"]), _pair(data["max"]), float(data["cell"])
    check_domain(low, high, cell)
    numbers = numbers_of(substrates["numbers"]) if substrates else None
    ground = None
    if terrain is not None:
        ground = (numbers_of(terrain["x"]), numbers_of(terrain["z"]))
        if ground[0].ndim != 1 or any(
            column is not None and column.shape != ground[0].shape for column in (ground[1], numbers)
        ):
            raise ValueError("x, z and substrates of the terrain differ in length")
    bodies = [
        Body(str(b["name"]), str(b["material"]), numbers_of(b["points"]).reshape(-1, 2), float(b["spacing"]))
        for b in data.get("bodies") or []
    ]
    frames = [
        Frame(str(f["name"]), _pair(f["min"]), _pair(f["max"]), str(f["axis"]), float(f["velocity"]))
        for f in data.get("frames") or []
    ]
    boundary = {str(side): str(kind) for side, kind in (data.get("boundary") or {}).items()}
    names = [str(name) for name in (substrates or {}).get("names", [])]
    return Setup(str(data["title"]), cell, low, high, boundary, ground, bodies, frames, names, numbers)


def plot_setup_file(setup: Path, picture: Path, dpi: int = 150) -> None:
    """Plot the setup in the file `setup` into the file `picture`."""
    kinds = FigureCanvasBase.get_supported_filetypes()
    if picture.suffix.lower().removeprefix(".") not in kinds:
        raise ReportError(
            f"{picture}: unknown file type (allowed: .{', .'.join(kinds)}). Change the ending of the name."
        )
    found = read_setup(setup)
    try:
        figure = plot_setup_on_map(found) if isinstance(found, SetupOnMap) else plot_setup(found)
        picture.parent.mkdir(parents=True, exist_ok=True)
        save_figure(figure, picture, dpi=dpi)
    except OSError as error:
        raise ReportError(f"{picture}: cannot be written ({error}). Select another file.") from error
    except (ValueError, ArithmeticError, MemoryError) as error:
        raise ReportError(f"{setup}: cannot be plotted ({error}). Check the values of the case.") from error


@styled
def plot_setup(setup: Setup) -> Figure:
    """Plot the whole domain above, and below it the bodies with the cells of the grid."""
    box_width = _WIDTH - _LEFT - _RIGHT
    shape = (setup.high[1] - setup.low[1]) * _MARGINS[1] / ((setup.high[0] - setup.low[0]) * _MARGINS[0])
    overview_height = float(np.clip(box_width * shape, 1.2, 3.4))
    zoom_height = 4.6
    legend = _legend(setup)
    height = 0.75 + overview_height + 0.95 + zoom_height + 0.65 + 0.2 * -(-len(legend) // 4)
    figure = Figure(figsize=(_WIDTH, height))
    figure.suptitle(f"{setup.title}: setup", x=_LEFT / _WIDTH, y=1 - 0.16 / height, ha="left", va="top", size=12)

    def place(top: float, high: float) -> Axes:
        return figure.add_axes((_LEFT / _WIDTH, 1 - (top + high) / height, box_width / _WIDTH, high / height))

    overview, zoom = place(0.75, overview_height), place(0.75 + overview_height + 0.95, zoom_height)
    whole = _fit_domain(setup, box_width / overview_height)
    near = _fit_bodies(setup, box_width / zoom_height)
    for axes, window, inches in ((overview, whole, overview_height), (zoom, near, zoom_height)):
        _plot_section(axes, setup, window, (box_width, inches))
    overview.add_patch(
        Rectangle(
            (near.left, near.bottom),
            near.right - near.left,
            near.top - near.bottom,
            fill=False,
            edgecolor=RED,
            zorder=7,
        )
    )
    overview.set_title(f"(a) whole domain, {whole.note()}; box: (b)", loc="left")
    lines = _draw_grid(zoom, setup, near, (box_width, zoom_height))
    zoom.set_title(f"(b) {'bodies' if setup.bodies else 'domain'}, {near.note()}, {lines}", loc="left")
    figure.legend(handles=legend, loc="lower center", ncols=4, bbox_to_anchor=(0.5, 0.0), borderaxespad=0.4)
    return figure


def _pair(values: Any) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _fit_domain(setup: Setup, box: float) -> Window:
    return fit((setup.low[0], setup.high[0]), (setup.low[1], setup.high[1]), box, None, _MARGINS)


def _fit_bodies(setup: Setup, box: float) -> Window:
    if not setup.bodies:
        return _fit_domain(setup, box)
    points = np.concatenate([body.points for body in setup.bodies])
    if not len(points):
        return _fit_domain(setup, box)
    low, high = points.min(axis=0) - 2 * setup.cell, points.max(axis=0) + 2 * setup.cell
    return fit((low[0], high[0]), (low[1], high[1]), box, (setup.low[0], setup.high[0]))


def _plot_section(axes: Axes, setup: Setup, window: Window, inches: tuple[float, float]) -> None:
    fill_terrain(axes, setup.terrain, window.bottom)
    for number, body in enumerate(setup.bodies):
        apart = body.spacing * inches[0] / (window.right - window.left)
        size = np.full(len(body.points), body.spacing * (0.8 if apart > _SMALLEST_GAP else 1.0))
        particles = squares(body.points[:, 0], body.points[:, 1], size, window, inches)
        particles.set_facecolor(_BODY_COLOURS[number % len(_BODY_COLOURS)])
        axes.add_collection(particles, autolim=False)
    _draw_substrates(axes, setup)
    for frame in setup.frames:
        corner = (frame.low[0], frame.low[1])
        size_of_frame = (frame.high[0] - frame.low[0], frame.high[1] - frame.low[1])
        axes.add_patch(
            Rectangle(corner, *size_of_frame, fill=False, edgecolor=PURPLE, hatch="///", linewidth=1.0, zorder=5)
        )
    (left, bottom), (right, top) = setup.low, setup.high
    for side, ends in {
        "x_min": ((left, bottom), (left, top)),
        "x_max": ((right, bottom), (right, top)),
        "y_min": ((left, bottom), (right, bottom)),
        "y_max": ((left, top), (right, top)),
    }.items():
        kind = setup.boundary.get(side, "open")
        (x0, z0), (x1, z1) = ends
        axes.plot([x0, x1], [z0, z1], color="black", linewidth=1.4, linestyle=_SIDE_LINES.get(kind, "-."), zorder=6)
    window.apply(axes)


def _draw_substrates(axes: Axes, setup: Setup) -> None:
    if setup.terrain is None or setup.substrate_numbers is None:
        return
    x, z = setup.terrain
    for number in range(len(setup.substrates)):
        there = np.where(setup.substrate_numbers == number + 1, z, np.nan)
        axes.plot(x, there, color=_SUBSTRATE_COLOURS[number % len(_SUBSTRATE_COLOURS)], linewidth=3.0, zorder=4)


def _draw_grid(axes: Axes, setup: Setup, window: Window, inches: tuple[float, float]) -> str:
    """Draw the cell borders in the window; return their description."""
    x = _lines(setup.low[0], setup.high[0], window.left, window.right, setup.cell)
    z = _lines(setup.low[1], setup.high[1], window.bottom, window.top, setup.cell)
    every = _every(setup.cell * min(inches[0] / (window.right - window.left), inches[1] / (window.top - window.bottom)))
    low, high = setup.low, setup.high
    segments = [[(at, low[1]), (at, high[1])] for at in x[::every]] + [
        [(low[0], at), (high[0], at)] for at in z[::every]
    ]
    axes.add_collection(LineCollection(segments, colors="#9AA0A6", linewidths=0.3, zorder=2.5), autolim=False)
    cells = f"cells of {setup.cell:g} m"
    return cells if every == 1 else f"{cells}, one grid line per {every} cells"


def _every(cell: float) -> int:
    """Return the number of cells of this size on the page [inches] between grid lines: 1, 2, 5, 10, 20, ..."""
    needed = _SMALLEST_CELL / cell
    power = 1
    while True:
        for step in (power, 2 * power, 5 * power):
            if step >= needed:
                return step
        power *= 10


def _lines(low: float, high: float, start: float, end: float, cell: float) -> Numbers:
    """Return the cell borders of low..high within start..end [m]."""
    first = max(0, int(np.ceil((start - low) / cell)))
    last = int(np.floor((min(end, high) - low) / cell + 1e-9))
    return low + cell * np.arange(first, last + 1, dtype=np.float64)


def _legend(setup: Setup) -> list[Patch | Line2D]:
    handles: list[Patch | Line2D] = []
    for number, body in enumerate(setup.bodies):
        colour = _BODY_COLOURS[number % len(_BODY_COLOURS)]
        label = f"{body.name} ({body.material}): {len(body.points):,} particles, spacing {body.spacing:g} m"
        handles.append(Patch(facecolor=colour, label=label))
    if setup.terrain is not None:
        handles.append(Patch(facecolor=GROUND, edgecolor=GROUND_LINE, label="terrain"))
    for number, name in enumerate(setup.substrates):
        colour = _SUBSTRATE_COLOURS[number % len(_SUBSTRATE_COLOURS)]
        handles.append(Line2D([], [], color=colour, linewidth=3.0, label=f"substrate {name}"))
    for frame in setup.frames:
        label = f"frame {frame.name}, {frame.velocity:g} m/s along {frame.axis}"
        handles.append(Patch(fill=False, edgecolor=PURPLE, hatch="///", label=label))
    for kind in dict.fromkeys(setup.boundary.values()):
        sides = ", ".join(side.replace("_", " ") for side, found in setup.boundary.items() if found == kind)
        handles.append(Line2D([], [], color="black", linestyle=_SIDE_LINES.get(kind, "-."), label=f"{kind}: {sides}"))
    if not handles:
        handles.append(Line2D([], [], color=NOTE, label="empty domain"))
    return handles
