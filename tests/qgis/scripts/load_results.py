"""Loads a run into a project and saves it: load_results.py RUN PROJECT."""

import json
import sys

from qgis.core import QgsProject
from qgis_session import start_processing

session = start_processing()
import processing  # noqa: E402

run, file = sys.argv[1:3]
result = processing.run("thawslide:loadresults", {"RUN": run})
print(json.dumps({"layers": len(result["LAYERS"]), "is_saved": QgsProject.instance().write(file)}))
