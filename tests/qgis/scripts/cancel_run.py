"""Cancels 'Run case' at its first progress: cancel_run.py CASE FOLDER."""

import json
import sys

from qgis.core import QgsProcessingFeedback
from qgis_session import start_processing

session = start_processing()
import processing  # noqa: E402

feedback = QgsProcessingFeedback()
feedback.progressChanged.connect(lambda _: feedback.cancel())
case, folder = sys.argv[1:3]
processing.run("thawslide:runcase", {"CASE": case, "OUTPUT": folder, "THREADS": 1}, feedback=feedback)
print(json.dumps({"progress": feedback.progress(), "log": feedback.textLog()}))
