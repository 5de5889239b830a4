"""Makes a case from layers that the program cannot read: new_from_layers.py DEM.vrt FOLDER WEST SOUTH.

The DEM gets its coordinate system from QGIS. The release is the selected one of two polygons in memory.
"""

import json
import sys

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsProcessingFeatureSourceDefinition,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis_session import start_processing

session = start_processing()
import processing  # noqa: E402

file, folder = sys.argv[1:3]
west, south = map(float, sys.argv[3:5])
dem = QgsRasterLayer(file, "dem")
dem.setCrs(QgsCoordinateReferenceSystem("EPSG:32632"))
release = QgsVectorLayer("Polygon?crs=EPSG:32632&field=thickness:double", "release", "memory")
for x in (west, west + 300.0):
    feature = QgsFeature(release.fields())
    feature.setGeometry(QgsGeometry.fromRect(QgsRectangle(x, south, x + 120.0, south + 100.0)))
    feature.setAttributes([24.0])
    release.dataProvider().addFeatures([feature])
release.selectByIds([1])
QgsProject.instance().addMapLayers([dem, release])
source = QgsProcessingFeatureSourceDefinition(release.id(), True)
print(json.dumps(processing.run("thawslide:newcase", {"DEM": dem.id(), "RELEASE": source, "OUTPUT": folder})))
