"""Parameters that several algorithms have, and their arguments of the command line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)


def case_file() -> QgsProcessingParameterFile:
    """Return the parameter of a case file."""
    return QgsProcessingParameterFile("CASE", "Case file", extension="toml")


def run_folder() -> QgsProcessingParameterFile:
    """Return the parameter of an existing run."""
    return QgsProcessingParameterFile("RUN", "Run folder", behavior=QgsProcessingParameterFile.Folder)


def threads() -> QgsProcessingParameterNumber:
    """Return the parameter of the number of threads."""
    return QgsProcessingParameterNumber("THREADS", "Threads (all cores if not set)", optional=True)


def number(name: str, text: str, is_advanced: bool = False) -> QgsProcessingParameterNumber:
    """Return an optional number without limits: the program checks it."""
    parameter = QgsProcessingParameterNumber(name, text, type=QgsProcessingParameterNumber.Double, optional=True)
    return advanced(parameter) if is_advanced else parameter


def choice(name: str, text: str, options: Sequence[str]) -> QgsProcessingParameterEnum:
    """Return the parameter of a choice between keywords; the first is the default."""
    return QgsProcessingParameterEnum(
        name, text, options=list(options), defaultValue=options[0], usesStaticStrings=True
    )


def settings() -> QgsProcessingParameterString:
    """Return the parameter of keys that replace those of the case."""
    text = "Settings: one KEY=VALUE per line"
    return advanced(QgsProcessingParameterString("SETTINGS", text, multiLine=True, optional=True))


def advanced(parameter: QgsProcessingParameterDefinition) -> QgsProcessingParameterDefinition:
    """Return the parameter, shown among the advanced ones only."""
    parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
    return parameter


def number_arguments(
    algorithm: QgsProcessingAlgorithm,
    parameters: Mapping[str, Any],
    options: Mapping[str, str],
    context: QgsProcessingContext,
) -> list[str]:
    """Return the options, by name of the parameter, whose numbers are set."""
    arguments = []
    for name, option in options.items():
        if parameters.get(name) is not None:
            arguments += [option, f"{algorithm.parameterAsDouble(parameters, name, context):.15g}"]
    return arguments


def setting_arguments(
    algorithm: QgsProcessingAlgorithm, parameters: Mapping[str, Any], context: QgsProcessingContext
) -> list[str]:
    """Return an option for each line of the settings."""
    lines = algorithm.parameterAsString(parameters, "SETTINGS", context).splitlines()
    return [argument for line in lines if line.strip() for argument in ("--set", line.strip())]
