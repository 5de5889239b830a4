"""Load results: the maps and outlines of a run in the project."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsProcessingOutputMultipleLayers,
)

from ..parameters import run_folder
from ..results import load_run
from .base import ThawslideAlgorithm


class LoadResults(ThawslideAlgorithm):
    """Add the results of a run to the project."""

    NAME = "loadresults"
    TITLE = "Load results with styles"
    HELP = (
        "Adds the maps and outlines of a 3D run to the project, in their styles. The layers form a group with the name "
        "of the run. The maximum thickness, the outlines and the terrain are visible."
    )

    def flags(self) -> Any:
        """Run in the main thread, because the project is changed."""
        return super().flags() | QgsProcessingAlgorithm.FlagNoThreading

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:  # noqa: N802
        """Declare the parameter and the layers."""
        self.addParameter(run_folder())
        self.addOutput(QgsProcessingOutputMultipleLayers("LAYERS", "Layers"))

    def processAlgorithm(  # noqa: N802
        self, parameters: dict[str, Any], context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict[str, Any]:
        """Add the layers."""
        project = context.project()
        if project is None:
            raise QgsProcessingException("The results need an open project. Open or create one.")
        layers = load_run(Path(self.parameterAsFile(parameters, "RUN", context)), project)
        feedback.pushInfo(f"{len(layers)} layers: {', '.join(layer.name() for layer in layers)}")
        return {"LAYERS": [layer.id() for layer in layers]}
