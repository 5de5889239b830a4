"""Common part of the algorithms."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessing, QgsProcessingAlgorithm, QgsProcessingContext


class ThawslideAlgorithm(QgsProcessingAlgorithm):
    """An algorithm with its name, title and help as attributes of the class."""

    NAME = ""
    TITLE = ""
    HELP = ""

    def name(self) -> str:
        """Return the name for scripts."""
        return self.NAME

    def displayName(self) -> str:  # noqa: N802
        """Return the title in the toolbox."""
        return self.TITLE

    def shortHelpString(self) -> str:  # noqa: N802
        """Return the help of the dialog."""
        return self.HELP

    def createInstance(self) -> ThawslideAlgorithm:  # noqa: N802
        """Return a new instance."""
        return type(self)()

    def checkParameterValues(self, parameters: dict[str, Any], context: QgsProcessingContext) -> tuple[bool, str]:  # noqa: N802
        """Refuse a temporary folder for results."""
        if parameters.get("OUTPUT") == QgsProcessing.TEMPORARY_OUTPUT:
            return False, "OUTPUT: a temporary folder is deleted when QGIS is closed. Select another folder."
        is_valid, message = super().checkParameterValues(parameters, context)
        return is_valid, message
