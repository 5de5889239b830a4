"""GeoTIFF files with their QGIS styles."""

from __future__ import annotations

import html
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import rasterio
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_hex
from rasterio.errors import RasterioError

from thawslide.arrays import Numbers
from thawslide.atomic_file import atomic_file
from thawslide.sweeps.raster_stack import RasterGrid

NO_DATA = -9999.0
_TILE = 256
_STOPS = 9  # colours of a style


@contextmanager
def written_raster(path: Path, grid: RasterGrid, unit: str, description: str, threshold: str) -> Iterator[Any]:
    """Yield an open GeoTIFF of one band, complete or absent at the end. An empty threshold has no tag."""
    with (
        atomic_file(path) as temporary,
        rasterio.open(
            temporary,
            "w",
            driver="GTiff",
            dtype="float64",
            count=1,
            width=grid.columns,
            height=grid.rows,
            transform=grid.transform,
            crs=grid.crs or None,
            nodata=NO_DATA,
            compress="deflate",
            tiled=True,
            blockxsize=_TILE,
            blockysize=_TILE,
        ) as file,
    ):
        file.set_band_description(1, description)
        file.set_band_unit(1, unit)
        if threshold:
            file.update_tags(THRESHOLD=threshold)
        yield file


def threshold_of(path: Path) -> str:
    """Return the threshold of a probability map, with its unit; "" if it has none."""
    try:
        with rasterio.open(path) as file:
            return str(file.tags().get("THRESHOLD", ""))
    except (RasterioError, OSError):
        return ""


def write_window(file: Any, window: tuple[slice, slice], values: Numbers) -> None:
    """Write finite values into a window; other values become cells without data."""
    rows, columns = window
    part = rasterio.windows.Window(columns.start, rows.start, columns.stop - columns.start, rows.stop - rows.start)
    file.write(np.where(np.isfinite(values), values, NO_DATA), 1, window=part)


def write_style(path: Path, low: float, high: float, unit: str, colours: str, hides_zero: bool) -> None:
    """Write the QGIS style of a raster: colours from low to high; zero is transparent if `hides_zero`."""
    high = high if high > low else low + 1.0
    colour_map = ScalarMappable(cmap=colours).get_cmap()
    items = []
    for fraction in np.linspace(0.0, 1.0, _STOPS):
        value = low + fraction * (high - low)
        label = html.escape(f"{value:.4g}{' ' if unit else ''}{unit}")
        colour = to_hex(colour_map(float(fraction)))
        items.append(f'     <item value="{value:.9g}" label="{label}" color="{colour}" alpha="255"/>\n')
    transparent = _TRANSPARENT if hides_zero else ""
    text = _STYLE.format(low=low, high=high, transparent=transparent, items="".join(items))
    with atomic_file(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


_TRANSPARENT = """   <rasterTransparency>
    <singleValuePixelList>
     <pixelListEntry min="-1e+38" max="0" percentTransparent="100"/>
    </singleValuePixelList>
   </rasterTransparency>
"""
_STYLE = """<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
 <pipe>
  <rasterrenderer type="singlebandpseudocolor" band="1" opacity="0.85" classificationMin="{low:.9g}" \
classificationMax="{high:.9g}" nodataColor="" alphaBand="-1">
{transparent}   <rastershader>
    <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="{low:.9g}" \
maximumValue="{high:.9g}">
{items}    </colorrampshader>
   </rastershader>
  </rasterrenderer>
 </pipe>
</qgis>
"""
