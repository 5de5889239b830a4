"""Maximum flow thickness of several runs, maps of one scale next to each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from thawslide.errors import NotInRunError, ReportError
from thawslide.figures.colours import THICKNESS, label_bar, thickness_norm, thickness_words
from thawslide.figures.map_page import MapPage
from thawslide.figures.map_panel import Scene, colour_map, make_scene, paint, quiet_corner, scale_bar
from thawslide.figures.site import Site, make_site
from thawslide.figures.style import styled
from thawslide.maps import Box, Map, on_map
from thawslide.number_text import number_text
from thawslide.run_folder import Run

_FOOT = 0.95  # inches below the maps, for the colour bar and the legend


@styled
def run_maps(runs: Mapping[str, Run]) -> Figure:
    """Map the maximum flow thickness of the runs that have maps, by their names.

    Runs with overlapping areas in one reference system have the same section of the terrain, that of the first run.
    """
    sites = {name: site for name, run in runs.items() if on_map(run) and (site := _site(run)) is not None}
    if not sites:
        raise NotInRunError("no maps of the maximum flow thickness in any run.")
    scene = _common_scene(list(sites.values()))
    fields = {name: _covered(site, scene or site.scene) for name, site in sites.items()}
    values = np.concatenate([field.values.ravel() for field in fields.values()])
    if not np.isfinite(values).any():
        raise NotInRunError("no map cell above maps.arrival_thickness in any run.")
    norm, extend = thickness_norm(values)
    painter = ScalarMappable(norm, colour_map(THICKNESS.colours))
    first = next(iter(sites.values()))
    note = f"Outline: {first.outline_words}. {(scene or first.scene).note()}"
    page = MapPage(
        "Maximum flow thickness", scene or first.scene, len(sites), note=note, foot=_FOOT, has_own_scenes=scene is None
    )
    panels = []
    for number, (name, site) in enumerate(sites.items()):
        axes = page.panel(number, labels=False, scene=scene or site.scene)
        paint(axes, fields[name], painter)
        site.draw_release(axes, 1.0)
        site.draw_outline(axes)
        finite = fields[name].values[np.isfinite(fields[name].values)]
        remark = f"max {number_text(float(finite.max()))} m" if finite.size else "not covered"
        panels.append((axes, name, remark))
        if number == 0 or scene is None:
            scale_bar(axes, quiet_corner(site.reached, (scene or site.scene).box))
    page.set_titles(panels)
    bar = page.figure.colorbar(painter, cax=page.common_bar(), orientation="horizontal", extend=extend)
    label_bar(bar, norm)
    bar.set_label(f"maximum {thickness_words(norm)}", labelpad=1)
    page.legend(first.legend(path=False, probes=False), 3)
    return page.figure


def _site(run: Run) -> Site | None:
    """Return the site of a run, None if its maps are missing or damaged."""
    try:
        site = make_site(run)
        _ = site.scene
    except ReportError:
        return None
    return site


def _common_scene(sites: list[Site]) -> Scene | None:
    """Return one scene around all, None if they are in different reference systems or far from each other."""
    boxes, systems = [site.scene.box for site in sites], {site.scene.terrain.crs for site in sites}
    if len(systems) > 1 or not all(_overlap(boxes[0], box) for box in boxes):
        return None
    box = (
        min(box[0] for box in boxes),
        max(box[1] for box in boxes),
        min(box[2] for box in boxes),
        max(box[3] for box in boxes),
    )
    return make_scene(sites[0].maps["terrain"], box)


def _overlap(one: Box, other: Box) -> bool:
    return one[0] < other[1] and other[0] < one[1] and one[2] < other[3] and other[2] < one[3]


def _covered(site: Site, scene: Scene) -> Map:
    """Return the maximum thickness in a scene, without cells below the threshold."""
    field = site.maps["max_thickness"].cropped(scene.box).thinned(_MOST_CELLS, "maximum")
    return replace(field, values=np.where(field.values > site.threshold, field.values, np.nan))


_MOST_CELLS = 400  # per side
