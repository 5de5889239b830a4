"""Registration of the provider in QGIS."""

from __future__ import annotations

from qgis.core import QgsApplication

from .provider import ThawslideProvider


class ThawslidePlugin:
    """The plugin, which consists of the provider."""

    def __init__(self) -> None:
        self.provider: ThawslideProvider | None = None

    def initProcessing(self) -> None:  # noqa: N802
        """Add the provider; `qgis_process` calls this method only."""
        self.provider = ThawslideProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self) -> None:  # noqa: N802
        """Start the plugin in the window of QGIS."""
        self.initProcessing()

    def unload(self) -> None:
        """Remove the provider."""
        QgsApplication.processingRegistry().removeProvider(self.provider)
