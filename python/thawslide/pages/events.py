"""Plot of a run among published events: H/L over volume."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from thawslide.figures.style import BLACK, BLUE, ORANGE
from thawslide.mobility import Mobility
from thawslide.number_text import number_text
from thawslide.pages.markup import json_part
from thawslide.text_files import finite_number, read_table

_COLUMNS = ("event", "kind", "volume_million_m3", "drop_height_m", "travel_distance_m", "source")
KINDS = {"rock and ice": (ORANGE, "diamond"), "rock": (BLUE, "circle")}
_NAMED = {
    "Lamplugh 2016": "middle left",
    "Kolka 2002": "top center",
    "Aru 2016": "bottom center",
    "Huascaran 1970": "middle right",
    "Mount Meager 2010": "middle left",
    "Frank 1903": "middle left",
}  # with the place of the name
_RUN_MARKERS = ("star", "cross", "x", "triangle-up", "square")


@dataclass(frozen=True)
class Event:
    """A published event: volume [m3], drop height H [m], travel distance L [m], and its source."""

    name: str
    kind: str
    volume: float
    height: float
    length: float
    source: str

    @property
    def ratio(self) -> float:
        """H/L."""
        return self.height / self.length


@cache
def published_events() -> tuple[Event, ...]:
    """Return the events of the table in the package."""
    path = Path(str(resources.files("thawslide.pages").joinpath("published_events.csv")))
    events = []
    for line, row in read_table(path, _COLUMNS).rows:
        volume, height, length = (finite_number(row[name], f"{path}:{line}") for name in _COLUMNS[2:5])
        events.append(Event(row["event"], row["kind"], volume * 1e6, height, length, row["source"]))
    return tuple(events)


def events_part(runs: Mapping[str, Mobility]) -> str:
    """Return the plot of runs, by their names, among the published events; "" if no run has the numbers."""
    shown = {name: one for name, one in runs.items() if one.volume and one.ratio is not None}
    if not shown:
        return ""
    traces = [_kind_trace(kind) for kind in KINDS]
    traces += [_run_trace(name, one, number) for number, (name, one) in enumerate(shown.items())]
    axis = {"showline": True, "linecolor": "#444444", "gridcolor": "#E4E4E4", "zeroline": False}
    lowest = min([event.volume for event in published_events()] + [one.volume or 1.0 for one in shown.values()])
    ticks = [10.0**power for power in range(math.floor(math.log10(lowest)), 10)]
    layout = {
        "xaxis": axis
        | {
            "type": "log",
            "title": {"text": "volume (million m³)"},
            "tickvals": [tick / 1e6 for tick in ticks],
            "ticktext": [number_text(tick / 1e6) for tick in ticks],
        },
        "yaxis": axis | {"title": {"text": "H/L (–)"}, "rangemode": "tozero"},
        "legend": {"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom"},
        "margin": {"l": 65, "r": 10, "t": 40, "b": 64},
        "hovermode": "closest",
        "plot_bgcolor": "#FFFFFF",
    }
    parts = json_part("events-parts", {"traces": traces, "layout": layout})
    return f'<div id="events" style="height:420px"></div>\n<p><small>{_CAPTION}</small></p>\n{parts}'


def _kind_trace(kind: str) -> dict[str, Any]:
    """Return the events of a kind as points with hover texts."""
    events = [event for event in published_events() if event.kind == kind]
    colour, symbol = KINDS[kind]
    return {
        "type": "scatter",
        "mode": "markers+text",
        "name": f"published, {kind}",
        "x": [event.volume / 1e6 for event in events],
        "y": [event.ratio for event in events],
        "text": [event.name if event.name in _NAMED else "" for event in events],
        "textposition": [_NAMED.get(event.name, "top center") for event in events],
        "textfont": {"size": 11, "color": "#555555"},
        "customdata": [[event.name, event.height, event.length, event.source] for event in events],
        "hovertemplate": "%{customdata[0]}<br>%{x:,.3~r} million m³, H/L %{y:.2f}<br>H %{customdata[1]:,.0f} m, "
        "L %{customdata[2]:,.0f} m<br>%{customdata[3]}<extra></extra>",
        "marker": {"color": colour, "symbol": symbol, "size": 8, "opacity": 0.8},
    }


def _run_trace(name: str, mobility: Mobility, number: int) -> dict[str, Any]:
    return {
        "type": "scatter",
        "mode": "markers",
        "name": name.replace("<", "&lt;"),
        "x": [(mobility.volume or 0.0) / 1e6],
        "y": [mobility.ratio],
        "customdata": [[mobility.height, mobility.length]],
        "hovertemplate": "%{fullData.name}<br>%{x:,.3~r} million m³, H/L %{y:.2f}<br>H %{customdata[0]:,.0f} m, "
        "L %{customdata[1]:,.0f} m<extra></extra>",
        "marker": {
            "color": BLACK,
            "symbol": _RUN_MARKERS[number % len(_RUN_MARKERS)],
            "size": 16,
            "line": {"color": "white", "width": 1},
        },
    }


_CAPTION = (
    "H: drop height. L: travel distance. Published values are as quoted in abstracts and excerpts of the sources "
    "named at each point; volumes of ranges are their middle. Values of Mitchell et al. (2019) are rock avalanches in "
    "Canada. An event far from its neighbours needs an explanation, for example ice, water, or a confined valley."
)
