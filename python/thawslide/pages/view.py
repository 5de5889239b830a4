"""Interactive view of a page: fields, their colours and ranges, and the arrays of each snapshot."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib import resources
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_hex

from thawslide.errors import NotInRunError
from thawslide.figures.colours import colour_range
from thawslide.number_text import prefixed
from thawslide.pages.markup import json_part
from thawslide.pages.packing import Packing, compressed
from thawslide.run_folder import Numbers

MOST_SNAPSHOTS = 60
_SHADES = 17  # of a colour scale


@dataclass
class Field:
    """A field of a view: label, unit, colours, and its values in each snapshot (once if `is_static`)."""

    words: str
    unit: str
    colours: str
    has_zero_base: bool = False
    is_static: bool = False
    points: str = ""  # name of the points that have the values
    values: list[Numbers] = field(default_factory=list)

    def packed(self, packing: Packing) -> dict[str, Any]:
        """Return the field as a part of the page's JSON, with its arrays in the packing."""
        everything = np.concatenate([np.ravel(each) for each in self.values])
        divisor, unit = prefixed(everything, self.unit) if self.unit == "Pa" else (1.0, self.unit)
        low, high, _ = colour_range(everything / divisor, self.has_zero_base)
        return {
            "words": self.words,
            "unit": unit,
            "colours": colour_scale(self.colours),
            "low": low,
            "high": high,
            "isStatic": self.is_static,
            "points": self.points,
            "values": [packing.add(each / divisor) for each in self.values],
        }

    @property
    def has_values(self) -> bool:
        """Whether any value is finite."""
        return any(np.isfinite(each).any() for each in self.values)


@dataclass
class View:
    """An interactive view: its parts as JSON, its arrays, and sentences on what it shows."""

    parts: dict[str, Any]
    packing: Packing
    caption: str

    def markup(self) -> str:
        """Return the controls, the place of the plot, and the data."""
        shown = '<div id="view" style="height:560px"></div>'
        caption = f"<p><small>{self.caption}</small></p>"
        data = f'<script type="text/plain" id="view-data">{self.packing.text()}</script>'
        return f"{_CONTROLS}\n{shown}\n{caption}\n{json_part('view-parts', self.parts)}\n{data}"


def fields_with_values(fields: list[Field], packing: Packing) -> list[dict[str, Any]]:
    """Return the fields that have any value, packed; NotInRunError if none has."""
    found = [each.packed(packing) for each in fields if each.has_values]
    if not found:
        raise NotInRunError("no values in any snapshot.")
    return found


def colour_scale(name: str) -> list[list[Any]]:
    """Return a colour map of matplotlib as a colour scale of Plotly."""
    mapped = ScalarMappable(cmap=name).get_cmap()
    places = np.linspace(0.0, 1.0, _SHADES)
    return [[round(float(place), 4), to_hex(mapped(place))] for place in places]


def scripts() -> str:
    """Return the scripts of a page with a view or other interactive plots: Plotly, once, and those of this package."""
    plotly = resources.files("plotly").joinpath("package_data", "plotly.min.js").read_bytes()
    own = resources.files("thawslide.pages").joinpath("page.js").read_text(encoding="utf-8")
    return (
        f'<script type="text/plain" id="plotly">{compressed(plotly)}</script>\n'
        f"<script>\n{own}</script>\n"
        "<noscript><p>The interactive plots need JavaScript.</p></noscript>"
    )


_CONTROLS = """<div class="controls">
<label>Field <select id="view-field"></select></label>
<button id="view-play" type="button">Play</button>
<label for="view-time">Time</label>
<input id="view-time" type="range" min="0" step="1" value="0">
<output id="view-time-text" for="view-time"></output>
<label id="view-follow-label" hidden><input id="view-follow" type="checkbox"> follow the sliding mass</label>
<span id="view-exaggeration-text" hidden>vertical exaggeration <span id="view-exaggeration"></span>×</span>
</div>"""
