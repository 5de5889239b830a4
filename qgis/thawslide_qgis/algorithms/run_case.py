"""Run case: `thawslide run`."""

from __future__ import annotations

from typing import Any

from qgis.core import (
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFolderDestination,
)

from ..parameters import advanced, case_file, number_arguments, setting_arguments, settings, threads
from ..program import run_program
from .base import ThawslideAlgorithm


class RunCase(ThawslideAlgorithm):
    """Run a case."""

    NAME = "runcase"
    TITLE = "Run case"
    HELP = (
        "Runs a case. The results are in the run folder.\n\n"
        "If you cancel, the run writes a checkpoint and stops. 'Resume run' continues it."
    )

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:  # noqa: N802
        """Declare the parameters."""
        for parameter in (
            case_file(),
            settings(),
            threads(),
            advanced(QgsProcessingParameterBoolean("OVERWRITE", "Replace the run in the folder", defaultValue=False)),
            QgsProcessingParameterFolderDestination("OUTPUT", "Run folder"),
        ):
            self.addParameter(parameter)

    def processAlgorithm(  # noqa: N802
        self, parameters: dict[str, Any], context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict[str, Any]:
        """Call the program."""
        folder = self.parameterAsString(parameters, "OUTPUT", context)
        arguments = ["run", self.parameterAsFile(parameters, "CASE", context), "--output", folder]
        if self.parameterAsBoolean(parameters, "OVERWRITE", context):
            arguments.append("--overwrite")
        arguments += setting_arguments(self, parameters, context)
        run_program([*arguments, *number_arguments(self, parameters, {"THREADS": "--threads"}, context)], feedback)
        return {"OUTPUT": folder}
