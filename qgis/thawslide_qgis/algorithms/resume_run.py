"""Resume run: `thawslide resume`."""

from __future__ import annotations

from typing import Any

from qgis.core import QgsProcessingContext, QgsProcessingFeedback, QgsProcessingOutputFolder

from ..parameters import number, number_arguments, run_folder, setting_arguments, settings, threads
from ..program import run_program
from .base import ThawslideAlgorithm


class ResumeRun(ThawslideAlgorithm):
    """Continue a run from its checkpoint."""

    NAME = "resumerun"
    TITLE = "Resume run"
    HELP = (
        "Continues a run from its checkpoint, or extends it to a later end time.\n\n"
        "Settings change keys from now on. The results are in the same folder."
    )

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:  # noqa: N802
        """Declare the parameters."""
        for parameter in (run_folder(), number("END", "End time [s]"), settings(), threads()):
            self.addParameter(parameter)
        self.addOutput(QgsProcessingOutputFolder("OUTPUT", "Run folder"))

    def processAlgorithm(  # noqa: N802
        self, parameters: dict[str, Any], context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict[str, Any]:
        """Call the program."""
        folder = self.parameterAsFile(parameters, "RUN", context)
        options = {"END": "--end", "THREADS": "--threads"}
        arguments = ["resume", folder, *setting_arguments(self, parameters, context)]
        run_program([*arguments, *number_arguments(self, parameters, options, context)], feedback)
        return {"OUTPUT": folder}
