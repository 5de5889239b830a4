"""Results at the top of a report: one screen for a client, in one of several languages."""

from __future__ import annotations

import html

from thawslide.figures.class_maps import class_map, thickness_classes
from thawslide.figures.section_results import section_extent
from thawslide.figures.site import Site, make_site
from thawslide.maps import on_map
from thawslide.messages import Messages
from thawslide.pages.client_text import ClientText, PlainNumber, client_text
from thawslide.pages.logo import logo_html
from thawslide.pages.markup import drawn_data, figure_part, items
from thawslide.run_folder import Run

_WIDTH, _HEIGHT = 5.6, 4.3  # inches, of the map or section


def results(run: Run, say: Messages, extent: str) -> str:
    """Return the results of a run as HTML: extent (HTML, "" if missing), numbers, scenario, assumptions and limits."""
    text = client_text(run, say, "warning_below")
    heading = say("head_area" if on_map(run) else "head_section")
    shown = extent or f"<p>{html.escape(say('not_drawn'))}</p>"
    return "\n".join(
        [
            *logo_html(run),
            f"<h1>{html.escape(run.title)}</h1>",
            f'<p class="where">{html.escape(say("results"))}, {html.escape(text.computed)}</p>',
            *(f'<p class="note">{html.escape(alert)}</p>' for alert in text.alerts),
            '<div class="results">',
            f"<div>\n{_heading(heading)}\n{shown}\n</div>",
            f"<div>\n{_numbers(text, say)}\n</div>",
            f"<div>\n{_heading(say('head_limits'))}\n{items(text.limits)}\n</div>",
            f"<div>\n{_heading(say('head_assumptions'))}\n{items(text.assumptions)}\n</div>",
            "</div>",
        ]
    )


def extent(run: Run, say: Messages, dpi: int) -> str:
    """Return the map or the section with the affected area as HTML; ReportError without its data."""
    if on_map(run):
        site = make_site(run)
        figure, caption = class_map(site, thickness_classes(site, say), say, _WIDTH, _HEIGHT), map_note(site, say)
    else:
        figure, caption = section_extent(run, say, _WIDTH, _HEIGHT), say("section_caption")
    return figure_part(caption, drawn_data(figure, dpi), caption)


def map_note(site: Site, say: Messages) -> str:
    """Return sentences on the coordinates of a map and on its outline."""
    note = say("map_note", crs=site.scene.terrain.crs or say("unknown_crs"))
    return note if site.affected is None else f"{note} {say('edge_note')}"


def _heading(words: str) -> str:
    return f"<h2>{html.escape(words)}</h2>"


def _numbers(text: ClientText, say: Messages) -> str:
    shown = "\n".join(_number(each) for each in text.numbers)
    sentences = html.escape(" ".join(text.scenario))
    return (
        f"{_heading(say('head_scenario'))}\n<p>{sentences}</p>\n{_heading(say('head_numbers'))}\n"
        f'<dl class="plain">\n{shown}\n</dl>\n<p>{html.escape(text.ranges)}</p>'
    )


def _number(number: PlainNumber) -> str:
    spread = f' <span class="range">({html.escape(number.spread)})</span>' if number.spread else ""
    return (
        f'<div><dt>{html.escape(number.name)}</dt><dd><span class="value">{html.escape(number.value)}</span>{spread}'
        f"</dd><dd>{html.escape(number.meaning)}</dd></div>"
    )
