"""Unpacks a ZIP file into the profile with the function of QGIS: install_plugin.py FILE."""

import sys
from pathlib import Path

from qgis.core import QgsApplication
from qgis_session import start

application = start()
from pyplugin_installer.unzip import unzip  # noqa: E402

target = Path(QgsApplication.qgisSettingsDirPath()) / "python" / "plugins"
target.mkdir(parents=True, exist_ok=True)
unzip(sys.argv[1], str(target))
