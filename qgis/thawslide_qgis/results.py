"""Layers of the results of a run, as a group of the project."""

from __future__ import annotations

from pathlib import Path

from qgis.core import (
    QgsBilinearRasterResampler,
    QgsHillshadeRenderer,
    QgsMapLayer,
    QgsProcessingException,
    QgsProject,
    QgsProviderRegistry,
    QgsRasterLayer,
    QgsVectorLayer,
)

SHOWN = {"affected_area", "release_area", "path", "front", "max_thickness", "terrain"}  # others would cover them
SUN_AZIMUTH = 315.0  # degrees
SUN_HEIGHT = 45.0  # degrees


def load_run(run: Path, project: QgsProject) -> list[QgsMapLayer]:
    """Add the outlines and maps of a run to the project, above all other layers; the first layer is the top one."""
    layers = [*_outlines(run / "maps" / "results.gpkg"), *_maps(run / "maps")]
    group = project.layerTreeRoot().insertGroup(0, run.name)
    for layer in layers:
        project.addMapLayer(layer, False)
        node = group.addLayer(layer)
        node.setItemVisibilityChecked(layer.name() in SHOWN)
        node.setExpanded(layer.name() == "max_thickness")
    group.setExpanded(False)  # the window shows changes only
    group.setExpanded(True)
    return layers


def _outlines(file: Path) -> list[QgsVectorLayer]:
    """Return the layers of the GeoPackage, points and lines above polygons, in the styles that it contains."""
    if not file.is_file():
        return []
    names = [found.name() for found in QgsProviderRegistry.instance().querySublayers(str(file))]
    layers = [QgsVectorLayer(f"{file}|layername={name}", name, "ogr") for name in names if name != "layer_styles"]
    return sorted((layer for layer in layers if layer.isValid()), key=lambda layer: int(layer.geometryType()))


def _maps(folder: Path) -> list[QgsRasterLayer]:
    """Return the maps in the styles next to them; the terrain is the last, as a hillshade."""
    files = sorted(folder.glob("*.tif"), key=lambda file: (file.stem == "terrain", file.stem))
    if not files:
        raise QgsProcessingException(f"RUN: {folder} contains no maps. Choose the folder of a 3D run.")
    layers = [QgsRasterLayer(str(file), file.stem) for file in files]
    damaged = [layer.source() for layer in layers if not layer.isValid()]
    if damaged:
        raise QgsProcessingException(f"RUN: {damaged[0]} cannot be read. Run the case again.")
    if layers[-1].name() == "terrain":
        _shade(layers[-1])
    return layers


def _shade(terrain: QgsRasterLayer) -> None:
    """Render a terrain as a hillshade, smooth at scales that show single cells."""
    shade = QgsHillshadeRenderer(terrain.dataProvider(), 1, SUN_AZIMUTH, SUN_HEIGHT)
    shade.setMultiDirectional(True)  # no slope is black
    terrain.setRenderer(shade)
    terrain.resampleFilter().setZoomedInResampler(QgsBilinearRasterResampler())
    terrain.resampleFilter().setZoomedOutResampler(QgsBilinearRasterResampler())
