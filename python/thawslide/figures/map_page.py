"""Layout of a page of maps of equal size, with colour bars, titles and notes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.figures.map_panel import HALO, Scene, draw_scene
from thawslide.figures.style import COLUMN_WIDTH, NOTE, wrapped

# Inches.
WIDTH, HIGHEST, NARROWEST = COLUMN_WIDTH, 9.2, COLUMN_WIDTH  # of a page
TALLEST = 5.2  # of a map
_LEFT, _RIGHT, _GAP, _HEAD, _TITLE, _TICKS, _LINE = 0.62, 0.2, 0.28, 0.38, 0.3, 0.5, 0.15
_NOTE_CHARACTERS = 17.0  # of a note in one inch
_NAME_CHARACTERS = 13.5  # of the page's title in one inch
_TITLE_CHARACTERS = 12.8  # of a panel's titles in one inch
_ACROSS, _LOWEST = 3, 2.6  # small maps below a large one, and their maximum height
_TWO_LINES, _BAR_BELOW = 0.4, 0.6  # above and below the small maps, for their titles and colour bars


@dataclass(frozen=True)
class Layout:
    """Number of columns, and size of each map [inches]."""

    columns: int
    width: float
    height: float


def layout(count: int, aspect: float, bar: float, head: float, reserved: float) -> Layout:
    """Return the layout that maximizes `count` maps of an aspect (width over height) on a page.

    The page needs `bar` inches right of each map, `head` above it, and `reserved` inches of its height.
    """
    found: list[Layout] = []
    for columns in range(1, count + 1):
        rows = -(-count // columns)
        width = (WIDTH - _LEFT - _RIGHT - (columns - 1) * _GAP) / columns - bar
        height = min(width / aspect, TALLEST, (HIGHEST - reserved) / rows - head)
        found.append(Layout(columns, height * aspect, height))
    # Slightly smaller maps are better than empty places or a long page, but not than a page of which half is empty.
    largest = max(each.width for each in found)
    broadest = max(each.columns * (each.width + bar) for each in found)
    return min(
        (
            each
            for each in found
            if each.width == largest
            or (each.width > 0.65 * largest and each.columns * (each.width + bar) > 0.6 * broadest)
        ),
        key=lambda each: (-count % each.columns > 1, -(-count // each.columns) * (each.height + head), -each.columns),
    )


class MapPage:
    """A page of maps; positions are in inches from its top left corner."""

    def __init__(
        self,
        title: str,
        scene: Scene,
        count: int,
        *,
        note: str,
        foot: float,
        bar: float = 0.0,
        narrowest: float = NARROWEST,
        has_own_scenes: bool = False,
    ) -> None:
        """Place `count` maps with `bar` inches for a colour bar right of each, `foot` inches below, then the note.

        With `has_own_scenes`, each map has its own coordinates and space for their labels.
        """
        self.has_own_scenes = has_own_scenes
        self.head = _TITLE + (0.18 if has_own_scenes else 0.0)
        self.scene, self.count, self.bar, self.left = scene, count, bar, _LEFT
        lines = 2  # of the note, on a page of common width
        found = layout(count, scene.aspect, bar, self.head, _HEAD + _TICKS + foot + lines * _LINE)
        self.columns, self.map_width, self.map_height = found.columns, found.width, found.height
        needed = _LEFT + found.columns * (found.width + bar + _GAP) - _GAP + _RIGHT
        rows = -(-count // found.columns)
        self._start(title, note, foot, max(needed, narrowest), rows * (found.height + self.head) + _TICKS)

    def _start(self, title: str, note: str, foot: float, width: float, maps_height: float) -> None:
        """Create the figure with title and note around the height of the maps."""
        self.width = width
        note_lines = wrapped(note, _NOTE_CHARACTERS * (self.width - _LEFT - _RIGHT))
        self.note_height = 0.06 + len(note_lines) * _LINE
        titles = wrapped(title, _NAME_CHARACTERS * (self.width - _LEFT - _RIGHT))
        self.top = _HEAD + 0.17 * (len(titles) - 1)
        self.below = self.top + maps_height  # end of the maps
        self.height = self.below + foot + self.note_height
        self.figure = Figure(figsize=(self.width, self.height))
        self.figure.suptitle(
            "\n".join(titles), x=_LEFT / self.width, y=1 - 0.14 / self.height, ha="left", va="top", size=10
        )
        self.figure.text(
            _LEFT / self.width,
            0.06 / self.height,
            "\n".join(note_lines),
            size=7.5,
            color=NOTE,
            va="bottom",
            linespacing=1.3,
        )

    def place(self, left: float, top: float, width: float, height: float) -> Axes:
        """Return axes at a position."""
        return self.figure.add_axes(
            (left / self.width, 1 - (top + height) / self.height, width / self.width, height / self.height)
        )

    def panel(self, number: int, labels: bool, scene: Scene | None = None) -> Axes:
        """Return the axes of a map with the terrain of the page, or of a separate scene.

        Coordinates common to all maps are labelled at the left and lower edges of the page only.
        """
        row, column = divmod(number, self.columns)
        left = _LEFT + column * (self.map_width + self.bar + _GAP)
        top = self.top + row * (self.map_height + self.head) + self.head
        axes = self.place(left, top, self.map_width, self.map_height)
        draw_scene(axes, scene or self.scene, labels)
        if column == 0:
            axes.set_ylabel("northing (km)")
        elif not self.has_own_scenes:
            axes.tick_params(labelleft=False)
        if number + self.columns >= self.count:
            axes.set_xlabel("easting (km)")
        elif not self.has_own_scenes:
            axes.tick_params(labelbottom=False)
        return axes

    def set_titles(self, panels: Sequence[tuple[Axes, str, str]]) -> None:
        """Set titles of maps (axes, words, remark) with letters.

        Remarks are right of the titles, or inside all maps if one of the titles is too long.
        """
        titles = [f"({chr(ord('a') + number)}) {words}" for number, (_, words, _) in enumerate(panels)]
        space = _TITLE_CHARACTERS * self.map_width
        fits = all(len(title) + len(panel[2]) + 2 <= space for title, panel in zip(titles, panels, strict=True))
        for title, (axes, _, remark) in zip(titles, panels, strict=True):
            axes.set_title(title, loc="left")
            if fits:
                axes.set_title(remark, loc="right", color=NOTE, size=8)
            else:
                axes.text(
                    0.97, 0.985, remark, transform=axes.transAxes, ha="right", va="top", size=7.5, path_effects=HALO,
                    zorder=9,
                )  # fmt: skip

    def panel_bar(self, axes: Axes) -> Axes:
        """Return axes for the colour bar right of a map."""
        box = axes.get_position()
        width = 0.13 / self.width
        return self.figure.add_axes((box.x1 + 0.08 / self.width, box.y0 + 0.1 * box.height, width, 0.8 * box.height))

    def common_bar(self) -> Axes:
        """Return axes for a common colour bar below all maps."""
        width = min(4.8, self.width - 2.0)
        return self.place(0.5 * (self.width - width), self.below + 0.12, width, 0.14)

    def legend(self, handles: Sequence[Artist], columns: int) -> None:
        """Place a legend below the maps, above the note."""
        self.figure.legend(
            handles=list(handles), loc="lower left", ncols=columns, borderaxespad=0.0,
            bbox_to_anchor=(_LEFT / self.width, (self.note_height + 0.05) / self.height),
        )  # fmt: skip


class LeadPage(MapPage):
    """A page of one large map, with the others in a row below it."""

    def __init__(self, title: str, scene: Scene, count: int, *, note: str, foot: float, bar: float) -> None:
        """Place up to four maps; the large one has `bar` inches for a colour bar at its right, the others below."""
        self.has_own_scenes = False
        self.head, self.scene, self.count, self.bar, self.left = _TITLE, scene, count, bar, _LEFT
        inside = WIDTH - _LEFT - _RIGHT
        self.columns = _ACROSS
        self.map_height = min((inside - (_ACROSS - 1) * _GAP) / _ACROSS / scene.aspect, _LOWEST)
        self.map_width = self.map_height * scene.aspect
        row = _TWO_LINES + self.map_height + _BAR_BELOW
        self.lead_height = min((inside - bar) / scene.aspect, TALLEST)
        self._start(title, note, foot, WIDTH, _TITLE + self.lead_height + _TICKS + row)

    def panel(self, number: int, labels: bool, scene: Scene | None = None) -> Axes:
        """Return the axes of the large map, number 0, or of one in the row below, without coordinates."""
        top = self.top + _TITLE
        if number == 0:
            axes = self.place(_LEFT, top, self.lead_height * self.scene.aspect, self.lead_height)
        else:
            top += self.lead_height + _TICKS + _TWO_LINES
            left = _LEFT + (number - 1) * (self.map_width + _GAP)
            axes = self.place(left, top, self.map_width, self.map_height)
        draw_scene(axes, scene or self.scene, labels)
        if number == 0:
            axes.set_ylabel("northing (km)")
            axes.set_xlabel("easting (km)")
        else:
            axes.tick_params(left=False, bottom=False, labelleft=False, labelbottom=False)
        return axes

    def set_titles(self, panels: Sequence[tuple[Axes, str, str]]) -> None:
        """Set titles with letters: a remark is right of that of the large map, and inside the others."""
        for number, (axes, words, remark) in enumerate(panels):
            title = f"({chr(ord('a') + number)}) {words}"
            if number == 0:
                axes.set_title(title, loc="left")
                axes.set_title(remark, loc="right", color=NOTE, size=8)
            else:
                axes.set_title("\n".join(wrapped(title, _TITLE_CHARACTERS * self.map_width)), loc="left")
                axes.text(
                    0.97, 0.97, remark, transform=axes.transAxes, ha="right", va="top", size=7.5, path_effects=HALO,
                    zorder=9,
                )  # fmt: skip

    def bar_below(self, axes: Axes) -> Axes:
        """Return axes for a horizontal colour bar below a map of the row."""
        box = axes.get_position()
        height = 0.12 / self.height
        return self.figure.add_axes((box.x0, box.y0 - 0.1 / self.height - height, box.width, height))
