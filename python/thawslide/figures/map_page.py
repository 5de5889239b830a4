"""A page of maps of equal size: how many stand side by side, where colourbars, titles and notes go."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.figures.map_panel import HALO, Scene, draw_scene
from thawslide.figures.style import COLUMN_WIDTH, NOTE

# Inches.
WIDTH, HIGHEST, NARROWEST = COLUMN_WIDTH, 9.2, COLUMN_WIDTH  # of a page
TALLEST = 5.2  # of a map
_LEFT, _RIGHT, _GAP, _HEAD, _TITLE, _TICKS, _LINE = 0.62, 0.2, 0.28, 0.38, 0.3, 0.5, 0.15
_NOTE_CHARACTERS = 17.0  # of a note in one inch
_NAME_CHARACTERS = 13.5  # of the page's title in one inch
_TITLE_CHARACTERS = 12.8  # of a panel's titles in one inch


@dataclass(frozen=True)
class Layout:
    """How many maps stand side by side, and the size of each [inches]."""

    columns: int
    width: float
    height: float


def layout(count: int, aspect: float, bar: float, head: float, beside: float) -> Layout:
    """Return the arrangement that makes `count` maps of an aspect (width over height) largest on a page.

    `bar` inches right of each map, `head` above it and `beside` inches of the page's height are for other things.
    """
    found: list[Layout] = []
    for columns in range(1, count + 1):
        rows = -(-count // columns)
        width = (WIDTH - _LEFT - _RIGHT - (columns - 1) * _GAP) / columns - bar
        height = min(width / aspect, TALLEST, (HIGHEST - beside) / rows - head)
        found.append(Layout(columns, height * aspect, height))
    # Somewhat smaller maps are better than empty places, and than a long page.
    largest = max(each.width for each in found)
    return min(
        (each for each in found if each.width > 0.65 * largest),
        key=lambda each: (-count % each.columns > 1, -(-count // each.columns) * (each.height + head), -each.columns),
    )


class MapPage:
    """A page of maps; places are in inches from its top left corner."""

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
        own_scenes: bool = False,
    ) -> None:
        """Lay out `count` maps with `bar` inches for a colourbar right of each, `foot` inches below, then the note.

        With `own_scenes` each map has its own coordinates, and room for them.
        """
        self.own_scenes = own_scenes
        self.head = _TITLE + (0.18 if own_scenes else 0.0)
        self.scene, self.count, self.bar, self.left = scene, count, bar, _LEFT
        lines = 2  # of the note, on a page of common width
        found = layout(count, scene.aspect, bar, self.head, _HEAD + _TICKS + foot + lines * _LINE)
        self.columns, self.map_width, self.map_height = found.columns, found.width, found.height
        needed = _LEFT + found.columns * (found.width + bar + _GAP) - _GAP + _RIGHT
        self.width = max(needed, narrowest)
        wrapped = textwrap.wrap(note, int(_NOTE_CHARACTERS * (self.width - _LEFT - _RIGHT)), break_on_hyphens=False)
        self.note_height = 0.06 + len(wrapped) * _LINE
        rows = -(-count // found.columns)
        titles = textwrap.wrap(title, int(_NAME_CHARACTERS * (self.width - _LEFT - _RIGHT)))
        self.top = _HEAD + 0.17 * (len(titles) - 1)
        self.below = self.top + rows * (found.height + self.head) + _TICKS  # where the maps end
        self.height = self.below + foot + self.note_height
        self.figure = Figure(figsize=(self.width, self.height))
        self.figure.suptitle(
            "\n".join(titles), x=_LEFT / self.width, y=1 - 0.14 / self.height, ha="left", va="top", size=10
        )
        self.figure.text(
            _LEFT / self.width,
            0.06 / self.height,
            "\n".join(wrapped),
            size=7.5,
            color=NOTE,
            va="bottom",
            linespacing=1.3,
        )

    def place(self, left: float, top: float, width: float, height: float) -> Axes:
        """Return axes at a place."""
        return self.figure.add_axes(
            (left / self.width, 1 - (top + height) / self.height, width / self.width, height / self.height)
        )

    def panel(self, number: int, labels: bool, scene: Scene | None = None) -> Axes:
        """Return the map of a number with the terrain of the page, or of a scene of its own.

        Coordinates that all maps share stand at the left and lower ends of the page only.
        """
        row, column = divmod(number, self.columns)
        left = _LEFT + column * (self.map_width + self.bar + _GAP)
        top = self.top + row * (self.map_height + self.head) + self.head
        axes = self.place(left, top, self.map_width, self.map_height)
        draw_scene(axes, scene or self.scene, labels)
        if column == 0:
            axes.set_ylabel("northing (km)")
        elif not self.own_scenes:
            axes.tick_params(labelleft=False)
        if number + self.columns >= self.count:
            axes.set_xlabel("easting (km)")
        elif not self.own_scenes:
            axes.tick_params(labelbottom=False)
        return axes

    def name(self, panels: Sequence[tuple[Axes, str, str]]) -> None:
        """Title maps (axes, words, remark) with their letters; remarks stand beside titles, or all in the maps.

        In the maps where the title line of one of them has no room.
        """
        titles = [f"({chr(ord('a') + number)}) {words}" for number, (_, words, _) in enumerate(panels)]
        room = _TITLE_CHARACTERS * self.map_width
        beside = all(len(title) + len(panel[2]) + 2 <= room for title, panel in zip(titles, panels, strict=True))
        for title, (axes, _, remark) in zip(titles, panels, strict=True):
            axes.set_title(title, loc="left")
            if beside:
                axes.set_title(remark, loc="right", color=NOTE, size=8)
            else:
                axes.text(
                    0.97, 0.985, remark, transform=axes.transAxes, ha="right", va="top", size=7.5, path_effects=HALO,
                    zorder=9,
                )  # fmt: skip

    def panel_bar(self, axes: Axes) -> Axes:
        """Return axes for the colourbar right of a map."""
        box = axes.get_position()
        width = 0.13 / self.width
        return self.figure.add_axes((box.x1 + 0.08 / self.width, box.y0 + 0.1 * box.height, width, 0.8 * box.height))

    def common_bar(self) -> Axes:
        """Return axes for one colourbar below all maps."""
        width = min(4.8, self.width - 2.0)
        return self.place(0.5 * (self.width - width), self.below + 0.12, width, 0.14)

    def legend(self, handles: Sequence[Artist], columns: int) -> None:
        """Place a legend below the maps, above the note."""
        self.figure.legend(
            handles=list(handles), loc="lower left", ncols=columns, borderaxespad=0.0,
            bbox_to_anchor=(_LEFT / self.width, (self.note_height + 0.05) / self.height),
        )  # fmt: skip
