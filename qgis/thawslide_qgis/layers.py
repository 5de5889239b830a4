"""Files of layers in formats that the program reads."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import processing
from osgeo import gdal
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsRasterLayer,
)

READABLE = {"GTiff", "AAIGrid"}  # GDAL drivers of the rasters that the program reads


def dem_file(layer: QgsRasterLayer, folder: Path) -> Path:
    """Return the file of a DEM, or a GeoTIFF in the folder if the program does not read its format."""
    source = gdal.Open(layer.source()) if layer.providerType() == "gdal" else None
    if source is None:
        raise QgsProcessingException(f"DEM: {layer.name()} is not a raster file. Export it as GeoTIFF.")
    if source.GetDriver().ShortName in READABLE and Path(layer.source()).is_file():
        return Path(layer.source())
    written = folder / "dem.tif"
    if gdal.Translate(str(written), source, format="GTiff") is None:
        raise QgsProcessingException(f"DEM: {layer.name()} cannot be written: {gdal.GetLastErrorMsg()}")
    return written


def assigned_system(layer: QgsRasterLayer) -> str | None:
    """Return the coordinate system assigned to a layer in QGIS, or None if it is that of the file."""
    system: QgsCoordinateReferenceSystem = layer.crs()
    if not system.isValid() or system == layer.dataProvider().crs():
        return None
    return str(system.authid() or system.toWkt(QgsCoordinateReferenceSystem.WKT_PREFERRED))


def polygon_file(source: Any, folder: Path, context: QgsProcessingContext) -> Path:
    """Return a GeoPackage in the folder with the features of a source: a layer of any kind, or its selection."""
    written = folder / "release.gpkg"
    processing.run(
        "native:savefeatures",
        {"INPUT": source, "OUTPUT": str(written), "LAYER_NAME": "release"},
        context=context,
        feedback=QgsProcessingFeedback(False),  # the log shows the program only
        is_child_algorithm=True,
    )
    return written
