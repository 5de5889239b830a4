"""A session of QGIS without a window, with the algorithms of Processing and of the plugin."""

import sys
from pathlib import Path
from typing import Any

from qgis.core import QgsApplication


def start() -> QgsApplication:
    """Return the application; it must be kept until the end of the script."""
    application = QgsApplication([], True)
    application.initQgis()
    python = Path(QgsApplication.pkgDataPath()) / "python"
    own = Path(QgsApplication.qgisSettingsDirPath()) / "python" / "plugins"
    sys.path += [str(python), str(python / "plugins"), str(own)]
    return application


def start_processing() -> tuple[QgsApplication, Any]:
    """Return the application and the plugin, which owns the provider."""
    application = start()
    from processing.core.Processing import Processing

    Processing.initialize()
    from thawslide_qgis import classFactory

    plugin = classFactory(None)
    plugin.initProcessing()
    return application, plugin
