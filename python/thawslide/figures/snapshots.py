"""Particles on the terrain at the report times, coloured by one field (paper Figs. 14, 15, 18 and 19)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from thawslide.figures.colours import (
    PLASTIC_STRAIN,
    PORE_PRESSURE,
    SPEED,
    TEMPERATURE,
    Painting,
    label_bar,
    normalization,
    painted_values,
    scale_words,
)
from thawslide.figures.load import overburden
from thawslide.figures.moments import LETTERS, chosen_snapshots, shown_time, window_words
from thawslide.figures.style import (
    COLUMN_WIDTH,
    GROUND_LINE,
    NOTE,
    NOTE_LINE,
    note_above,
    styled,
    title_over_note,
    vertical_exaggeration,
    warn,
    wrapped,
)
from thawslide.figures.window import Window, extent, fill_terrain, fit, squares
from thawslide.number_text import number_text, prefixed
from thawslide.run_folder import Numbers, Run, Snapshot
from thawslide.unphysical import EDGES, too_hot, too_much_for_overburden


@dataclass(frozen=True)
class Zone:
    """A named range of distance [m], with dotted lines at its ends in figures."""

    name: str
    start: float
    end: float


_OF_WARNINGS = {"temperature": ("liquid_saturation", "pore_pressure"), "pore_pressure": ("mass",)}

# Layout of the page, in inches.
_WIDTH, _LEFT, _RIGHT, _GAP = COLUMN_WIDTH, 0.65, 0.12, 0.7
_PANEL_HEIGHT, _STRIP_HEIGHT, _STRIP_GAP, _ROW_GAP, _BAR_HEIGHT = 1.45, 0.65, 0.08 + NOTE_LINE, 0.75 + NOTE_LINE, 0.13
_MOST_TIMES = 3  # of speed and plastic strain, in one column of panels
_SAME_SCALE = 0.1  # relative difference of scales below which a strip repeats its panel
_OVERVIEW_MARGINS = (1.0, 1.15)
_TITLE_LINE, _TITLE_CHARACTERS = 0.17, 12.5  # inches; characters in one inch


def time_text(run: Run, shot: Snapshot) -> str:
    """Return the time of a snapshot as figures show it."""
    return f"t = {shown_time(run, shot.time)} s"


@styled
def velocity(run: Run, zones: Sequence[Zone] = ()) -> Figure:
    """Plot the speed (Fig. 14)."""
    return plot_field(run, SPEED, zones, _MOST_TIMES)


@styled
def plastic_strain(run: Run, zones: Sequence[Zone] = ()) -> Figure:
    """Plot the equivalent plastic strain (Fig. 15)."""
    return plot_field(run, PLASTIC_STRAIN, zones, _MOST_TIMES)


@styled
def temperature(run: Run) -> Figure:
    """Plot the temperature (Fig. 18)."""
    return plot_field(run, TEMPERATURE)


@styled
def pore_pressure(run: Run) -> Figure:
    """Plot the pore pressure (Fig. 19)."""
    return plot_field(run, PORE_PRESSURE)


def plot_field(run: Run, painting: Painting, zones: Sequence[Zone] = (), most: int = len(LETTERS)) -> Figure:
    """Plot an overview of the whole profile, a panel for each of at most `most` times and one colour bar.

    Zones are between grey dotted lines, with their names in the overview and in panels.
    """
    shots = chosen_snapshots(run, ("volume", *_OF_WARNINGS.get(painting.field, ()), painting.field), most)
    values = [painted_values(shot, painting.field) for shot in shots]
    divisor, unit = prefixed(np.concatenate(values), "Pa") if painting.unit == "Pa" else (1.0, painting.unit)
    values = [value / divisor for value in values]
    unit = "" if unit == "1" else unit
    norm, extend = normalization(np.concatenate(values), painting)
    painter = ScalarMappable(norm, painting.colours)

    page = _Page(run, shots, painting.words)
    windows = page.windows
    figure = page.figure
    figure.suptitle("\n".join(page.title), x=_LEFT / _WIDTH, y=1 - 0.16 / page.height, ha="left", va="top", size=10)
    _draw_zones(_plot_overview(page, run, shots, windows), zones)
    for number, (shot, value, window) in enumerate(zip(shots, values, windows, strict=True)):
        panel, strip = page.panel(number)
        note = _plot_particles(panel, run, shot, value, window, painter, page.panel_width, _PANEL_HEIGHT)
        largest = f"max {number_text(np.nanmax(value))} {unit}" if np.isfinite(value).any() else "no values"
        title = f"({LETTERS[number]}) {time_text(run, shot)}"
        title_over_note(panel, title, note, largest.strip().replace("-", "−"))
        _draw_zones(panel, zones)
        warn(panel, _warning(run, shot, painting), high=False)
        if strip is not None:
            _plot_strip(strip, run, shot, value, window, painter, page.panel_width, page.highest)
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)
    bar = figure.colorbar(painter, cax=page.colourbar(), orientation="horizontal", extend=extend)
    label_bar(bar, norm)
    averaging = window_words(run, shots) if painting is SPEED else ""
    over = f", {averaging}" if averaging else ""
    bar.set_label(f"{painting.words} ({unit or '–'}){scale_words(norm)}{over}", labelpad=1)
    return figure


def _warning(run: Run, shot: Snapshot, painting: Painting) -> str:
    """Return a warning for unphysical values in a panel, "" for none."""
    if painting is TEMPERATURE:
        wet = np.asarray(shot["liquid_saturation"]) > 0.0
        return too_hot(run, np.asarray(shot["temperature"])[wet], np.asarray(shot["pore_pressure"])[wet])
    if painting is PORE_PRESSURE and run.dimension == 2:
        ratio = np.asarray(shot["pore_pressure"]) / np.maximum(overburden(run, shot), 1.0)
        return too_much_for_overburden(ratio, EDGES)
    return ""


class _Page:
    """Positions on the page, in inches from the top left corner."""

    def __init__(self, run: Run, shots: list[Snapshot], words: str) -> None:
        columns = 1 if len(shots) in (1, _MOST_TIMES) else 2
        self.columns = columns
        self.full = _WIDTH - _LEFT - _RIGHT
        self.panel_width = (self.full - (columns - 1) * _GAP) / columns
        self.windows = [_window(run, shot, self.panel_width / _PANEL_HEIGHT) for shot in shots]
        self.highest = max(extent(heights)[1] for heights in (above_ground(run, shot) for shot in shots))
        self.strips = run.terrain is not None and not self._strips_repeat_panels(run, shots)
        (left, right), (low, high) = _whole(run, shots)
        shape = (high - low) * _OVERVIEW_MARGINS[1] / ((right - left) * _OVERVIEW_MARGINS[0])
        self.overview_height = float(np.clip(self.full * shape, 0.75, 1.7))
        self.bars_height = _BAR_HEIGHT * len(shots)
        title = f"{run.title}: {words}" + (f". {run.end_note.rstrip()}" if run.end_note else "")
        self.title = wrapped(title, _TITLE_CHARACTERS * self.full)
        self.top = 0.6 + _TITLE_LINE * (len(self.title) - 1)
        self.head = self.top + self.overview_height + self.bars_height + 0.95
        self.row = _PANEL_HEIGHT + _ROW_GAP + (_STRIP_HEIGHT + _STRIP_GAP if self.strips else 0.0)
        self.foot = self.head + self.row * -(-len(shots) // columns)
        self.height = self.foot + 0.55
        self.figure = Figure(figsize=(_WIDTH, self.height))

    def _strips_repeat_panels(self, run: Run, shots: list[Snapshot]) -> bool:
        """Return whether all strips would have about the scale of their panels, on even terrain."""
        assert run.terrain is not None
        repeated = np.ptp(run.terrain[1]) == 0.0
        for shot, window in zip(shots, self.windows, strict=True):
            flat = _strip_window(run, shot, window, self.highest)
            times = (flat.right - flat.left) / self.panel_width / ((flat.top - flat.bottom) / _STRIP_HEIGHT)
            repeated = repeated and abs(times / window.exaggeration - 1.0) < _SAME_SCALE
        return bool(repeated)

    def place(self, left: float, top: float, width: float, height: float) -> Axes:
        return self.figure.add_axes(
            (left / _WIDTH, 1 - (top + height) / self.height, width / _WIDTH, height / self.height)
        )

    def panel(self, number: int) -> tuple[Axes, Axes | None]:
        row, column = divmod(number, self.columns)
        left, top = _LEFT + column * (self.panel_width + _GAP), self.head + row * self.row
        panel = self.place(left, top, self.panel_width, _PANEL_HEIGHT)
        strip = None
        if self.strips:
            strip = self.place(left, top + _PANEL_HEIGHT + _STRIP_GAP, self.panel_width, _STRIP_HEIGHT)
        return panel, strip

    def colourbar(self) -> Axes:
        return self.place(2.5, self.foot - 0.12, _WIDTH - 5.0, 0.14)


def _domain(run: Run) -> tuple[float, float] | None:
    """Return the range of x [m] that has terrain and is within the grid."""
    grid = run.section("grid")
    ends = []
    if isinstance(grid.get("min"), list) and isinstance(grid.get("max"), list):
        ends.append((float(grid["min"][0]), float(grid["max"][0])))
    if run.terrain is not None:
        ends.append((float(run.terrain[0].min()), float(run.terrain[0].max())))
    if not ends:
        return None
    low, high = max(end[0] for end in ends), min(end[1] for end in ends)
    return (low, high) if high > low else None


def _window(run: Run, shot: Snapshot, box: float) -> Window:
    return fit(extent(shot.points[:, 0]), extent(shot.points[:, run.vertical]), box, _domain(run))


def particle_size(run: Run, shot: Snapshot) -> Numbers:
    """Return the side [m] of each particle as a square (2D) or cube (3D), shape (n,)."""
    size = run.section_areas(shot) if run.dimension == 2 else np.asarray(shot["volume"], dtype=np.float64)
    return np.asarray(np.maximum(np.nan_to_num(size), 0.0) ** (1.0 / run.dimension))


def above_ground(run: Run, shot: Snapshot) -> Numbers:
    """Return the height [m] of each particle above the terrain below it; its elevation without terrain."""
    heights: Numbers = shot.points[:, run.vertical]
    return heights if run.terrain is None else heights - np.interp(shot.points[:, 0], *run.terrain)


def _painted(
    run: Run,
    shot: Snapshot,
    heights: Numbers,
    values: Numbers,
    window: Window,
    painter: ScalarMappable,
    inches: tuple[float, float],
) -> PolyCollection:
    # Gaps narrower than a cell are not resolved by the model.
    cell = float(run.section("grid").get("cell", 0.0))
    # In 3D the nearest particles (smallest y) are in front.
    order = np.argsort(-shot.points[:, 1], kind="stable") if run.dimension == 3 else np.arange(len(heights))
    particles = squares(shot.points[order, 0], heights[order], particle_size(run, shot)[order], window, inches, cell)
    particles.set_array(values[order])
    particles.set_cmap(painter.get_cmap())
    particles.set_norm(painter.norm)
    return particles


def _plot_particles(
    axes: Axes,
    run: Run,
    shot: Snapshot,
    values: Numbers,
    window: Window,
    painter: ScalarMappable,
    width: float,
    height: float,
) -> str:
    """Plot particles on the terrain; return the scale of the panel, and the number of particles outside."""
    x, z = shot.points[:, 0], shot.points[:, run.vertical]
    fill_terrain(axes, run.terrain, window.bottom)
    axes.add_collection(_painted(run, shot, z, values, window, painter, (width, height)), autolim=False)
    _apply(axes, run, window)
    outside = int(np.sum((x < window.left) | (x > window.right) | (z < window.bottom) | (z > window.top)))
    return window.note() + (f", {outside:,} of {len(x):,} particles outside" if outside else "")


def _strip_window(run: Run, shot: Snapshot, window: Window, highest: float) -> Window:
    lowest = min(0.0, extent(above_ground(run, shot))[0])
    highest = max(highest, lowest + 1e-6)
    return Window(window.left, window.right, lowest - 0.03 * (highest - lowest), highest * 1.08, 1)


def _apply(axes: Axes, run: Run, window: Window) -> None:
    """Apply a window to a panel. With tilted gravity, the vertical axis is normal to the slope."""
    if run.gravity_tilt:
        window.apply(axes, "height above\nslope")
        axes.yaxis.label.set_fontsize(7.5)
    else:
        window.apply(axes)


def _plot_strip(
    axes: Axes,
    run: Run,
    shot: Snapshot,
    values: Numbers,
    window: Window,
    painter: ScalarMappable,
    width: float,
    highest: float,
) -> None:
    """Plot particles by their height above the terrain, which shows the layers of a long and thin deposit."""
    heights = above_ground(run, shot)
    flat = _strip_window(run, shot, window, highest)
    axes.add_collection(_painted(run, shot, heights, values, flat, painter, (width, _STRIP_HEIGHT)), autolim=False)
    axes.axhline(0.0, color=GROUND_LINE, linewidth=0.9)
    flat.apply(axes)
    axes.set_ylabel("height above\nterrain (m)", size=7)
    note_above(axes, f"vertical exaggeration {vertical_exaggeration(axes):.2g}×")


def _draw_zones(axes: Axes, zones: Sequence[Zone]) -> None:
    """Draw a grey dotted line at each end of a zone, and its name at the top of its visible part."""
    left, right = axes.get_xlim()
    for place in sorted({end for each in zones for end in (each.start, each.end)}):
        if left < place < right:
            axes.axvline(place, color="#8A8A8A", linestyle=":", linewidth=1.1, zorder=2)
    for each in zones:
        low, high = max(left, each.start), min(right, each.end)
        if high - low > 0.03 * (right - left):
            middle = 0.5 * (low + high)
            axes.annotate(each.name, (middle, 0.97), xycoords=("data", "axes fraction"), ha="center", va="top",
                          size=8, color=NOTE)  # fmt: skip


def _whole(run: Run, shots: list[Snapshot]) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ranges of x and of elevation [m] of the overview."""
    ends = [extent(shot.points[:, 0]) for shot in shots]
    domain = _domain(run) or (min(end[0] for end in ends), max(end[1] for end in ends))
    heights = [extent(shot.points[:, run.vertical]) for shot in shots]
    low, high = min(height[0] for height in heights), max(height[1] for height in heights)
    if run.terrain is not None:
        inside = (run.terrain[0] >= domain[0]) & (run.terrain[0] <= domain[1])
        if inside.any():
            low, high = min(low, float(run.terrain[1][inside].min())), max(high, float(run.terrain[1][inside].max()))
    return (domain[0], max(domain[1], domain[0] + 1e-9)), (low, high)


def _plot_overview(page: _Page, run: Run, shots: list[Snapshot], views: list[Window]) -> Axes:
    """Plot the profile with the first and last state, and below it the range of each panel; return its axes."""
    axes = page.place(_LEFT, page.top, page.full, page.overview_height)
    bars = page.place(_LEFT, page.top + page.overview_height, page.full, page.bars_height)
    inches = (page.full, page.overview_height)
    domain, heights = _whole(run, shots)
    window = fit(domain, heights, inches[0] / inches[1], None, _OVERVIEW_MARGINS)
    fill_terrain(axes, run.terrain, window.bottom)
    for shot, colour in ((shots[0], "#8C8C8C"), (shots[-1], "#C0392B")):
        body = squares(shot.points[:, 0], shot.points[:, run.vertical], particle_size(run, shot), window, inches)
        body.set_facecolor(colour)
        axes.add_collection(body, autolim=False)
    _apply(axes, run, window)
    axes.set_xlabel("")
    axes.tick_params(labelbottom=False)
    states = f"grey: {time_text(run, shots[0])}, red: {time_text(run, shots[-1])}" if len(shots) > 1 else ""
    axes.set_title(
        "; ".join(filter(None, (f"whole profile, {window.note()}", states))),
        loc="left",
        color=NOTE,
    )

    for number, (shot, view) in enumerate(zip(shots, views, strict=True)):
        covered = extent(shot.points[:, 0])
        bars.plot([view.left, view.right], [number, number], color="#D0D0D0", linewidth=4, solid_capstyle="butt")
        bars.plot(covered, [number, number], color=GROUND_LINE, linewidth=4, solid_capstyle="butt")
    window.apply(bars)
    bars.set_ylim(len(shots) - 0.4, -0.6)
    bars.set_yticks(range(len(shots)), [f"({LETTERS[number]})" for number in range(len(shots))], size=6.5)
    bars.tick_params(axis="y", length=0)
    bars.set_ylabel("")
    bars.xaxis.label.set_text(f"{bars.get_xlabel()}; bars: range of each panel (light), sliding mass (dark)")
    return axes
