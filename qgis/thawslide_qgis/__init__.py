"""QGIS plugin of Thawslide: algorithms of the Processing toolbox that start the program in a separate process."""

from __future__ import annotations

from typing import Any

from .plugin import ThawslidePlugin


def classFactory(iface: Any) -> ThawslidePlugin:  # noqa: N802
    """Return the plugin; QGIS calls this function."""
    return ThawslidePlugin()
