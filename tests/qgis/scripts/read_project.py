"""Draws the visible layers of a project and prints its groups, layers and styles: read_project.py PROJECT PICTURE."""

import json
import sys
from typing import Any

from qgis.core import QgsMapLayer, QgsMapRendererParallelJob, QgsMapSettings, QgsProject
from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtGui import QColor
from qgis_session import start


def style(layer: QgsMapLayer) -> dict[str, Any]:
    """Return the renderer of a layer and its colours."""
    renderer = layer.renderer()
    found: dict[str, Any] = {"renderer": renderer.type()}
    if renderer.type() == "singlebandpseudocolor":
        stops = renderer.shader().rasterShaderFunction().colorRampItemList()
        found["stops"] = [[stop.value, stop.color.name()] for stop in stops]
    elif renderer.type() == "singleSymbol":
        found["color"] = renderer.symbol().symbolLayer(0).strokeColor().name()
    return found


application = start()
project = QgsProject.instance()
project.read(sys.argv[1])
groups = {
    group.name(): [
        {"name": node.name(), "is_visible": node.isVisible(), "is_valid": node.layer().isValid(), **style(node.layer())}
        for node in group.findLayers()
    ]
    for group in project.layerTreeRoot().findGroups()
}
visible = [node.layer() for node in project.layerTreeRoot().findLayers() if node.isVisible()]
settings = QgsMapSettings()
settings.setLayers(visible)
settings.setOutputSize(QSize(900, 600))
settings.setBackgroundColor(QColor("white"))
settings.setDestinationCrs(visible[-1].crs())
settings.setExtent(visible[-1].extent())
job = QgsMapRendererParallelJob(settings)
job.start()
job.waitForFinished()
job.renderedImage().save(sys.argv[2])
print(json.dumps({"groups": groups, "errors": [error.message for error in job.errors()]}))
project.clear()
