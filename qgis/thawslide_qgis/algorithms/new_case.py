"""New case: `thawslide new`."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsProcessingOutputFile,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterRasterLayer,
)

from ..layers import assigned_system, dem_file, polygon_file
from ..parameters import choice, number, number_arguments
from ..program import run_program
from .base import ThawslideAlgorithm

PLACEMENTS = ["on-top", "cut"]
RESOLUTIONS = ["quick", "standard", "fine"]
NUMBERS = {
    "THICKNESS": "--thickness",
    "CELL": "--cell",
    "REACH_ANGLE": "--reach-angle",
    "LARGEST_VOLUME": "--largest-volume",
}


class NewCase(ThawslideAlgorithm):
    """Make a case folder from a DEM and release polygons."""

    NAME = "newcase"
    TITLE = "New case"
    HELP = (
        "Makes a case folder from a DEM and release polygons. The folder contains the cropped DEM, the release, and a "
        "commented case.toml that can be run unchanged.\n\n"
        "Thickness: vertical, of all polygons. If it is not set, the attribute 'thickness' of the polygons is used.\n\n"
        "Position: 'on-top' adds the release to the DEM, which is the sliding surface. 'cut' removes it from the DEM, "
        "which is the surface before the slide.\n\n"
        "Resolution: 'quick' for travel distance and speed, 'standard' for thickness and area too. The cells of 'fine' "
        "are half as large as those of 'standard'. The log states the time that each of them needs."
    )

    def initAlgorithm(self, configuration: dict[str, Any] | None = None) -> None:  # noqa: N802
        """Declare the parameters."""
        for parameter in (
            QgsProcessingParameterRasterLayer("DEM", "DEM in projected metres"),
            QgsProcessingParameterFeatureSource("RELEASE", "Release", [QgsProcessing.TypeVectorPolygon]),
            number("THICKNESS", "Vertical thickness [m]"),
            choice("PLACEMENT", "Position of the release", PLACEMENTS),
            choice("RESOLUTION", "Resolution", RESOLUTIONS),
            number("CELL", "Cell size, replaces that of the resolution [m]", is_advanced=True),
            number("REACH_ANGLE", "Reach angle that bounds the domain [degrees]", is_advanced=True),
            number("LARGEST_VOLUME", "Largest volume, confirms a large release [m3]", is_advanced=True),
            QgsProcessingParameterFolderDestination("OUTPUT", "Case folder"),
        ):
            self.addParameter(parameter)
        self.addOutput(QgsProcessingOutputFile("CASE", "Case file"))

    def processAlgorithm(  # noqa: N802
        self, parameters: dict[str, Any], context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ) -> dict[str, Any]:
        """Write the inputs to files and call the program."""
        dem = self.parameterAsRasterLayer(parameters, "DEM", context)
        if dem is None:
            raise QgsProcessingException(self.invalidRasterError(parameters, "DEM"))
        folder = self.parameterAsString(parameters, "OUTPUT", context)
        arguments = ["new", folder, f"--{self.parameterAsEnumString(parameters, 'PLACEMENT', context)}"]
        if parameters.get("CELL") is None:
            arguments += ["--resolution", self.parameterAsEnumString(parameters, "RESOLUTION", context)]
        arguments += number_arguments(self, parameters, NUMBERS, context)
        system = assigned_system(dem)
        if system:
            arguments += ["--crs", system]
        with tempfile.TemporaryDirectory() as temporary:
            arguments += ["--dem", str(dem_file(dem, Path(temporary)))]
            arguments += ["--release", str(polygon_file(parameters["RELEASE"], Path(temporary), context))]
            run_program(arguments, feedback)
        return {"OUTPUT": folder, "CASE": str(Path(folder) / "case.toml")}
