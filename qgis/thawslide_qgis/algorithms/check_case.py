"""Check case: `thawslide check`."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProcessingParameterFileDestination

from ..parameters import case_file, number_arguments, setting_arguments, settings, threads
from ..program import run_program
from .base import ThawslideAlgorithm


class CheckCase(ThawslideAlgorithm):
    """Validate a case and show its properties and warnings."""

    NAME = "checkcase"
    TITLE = "Check case"
    HELP = (
        "Validates a case. The log shows the properties of the release, warnings, and the memory, disk space and time "
        "that the run needs.\n\n"
        "The figure shows the terrain, the domain and the release. It needs the Python package of Thawslide."
    )

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:  # noqa: N802
        """Declare the parameters."""
        picture = QgsProcessingParameterFileDestination(
            "PICTURE", "Figure of the setup", "PNG images (*.png)", optional=True, createByDefault=False
        )
        for parameter in (case_file(), settings(), threads(), picture):
            self.addParameter(parameter)

    def processAlgorithm(  # noqa: N802
        self, parameters: dict[str, Any], context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict[str, Any]:
        """Call the program."""
        picture = self.parameterAsFileOutput(parameters, "PICTURE", context)
        arguments = ["check", self.parameterAsFile(parameters, "CASE", context)]
        arguments += setting_arguments(self, parameters, context)
        arguments += number_arguments(self, parameters, {"THREADS": "--threads"}, context)
        run_program([*arguments, *(["--picture", picture] if picture else [])], feedback)
        return {"PICTURE": picture} if picture else {}
