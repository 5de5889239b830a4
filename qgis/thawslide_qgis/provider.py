"""The provider of the Processing toolbox, with the setting that specifies the program."""

from __future__ import annotations

from pathlib import Path

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import QgsProcessingProvider
from qgis.PyQt.QtGui import QIcon

from .algorithms import ALGORITHMS
from .program import SETTING

ICON = Path(__file__).parent / "icon.svg"


class ThawslideProvider(QgsProcessingProvider):
    """Algorithms that start the program `thawslide`."""

    def id(self) -> str:
        """Return the first part of the names of the algorithms."""
        return "thawslide"

    def name(self) -> str:
        """Return the name in the toolbox."""
        return "Thawslide"

    def icon(self) -> QIcon:
        """Return the icon in the toolbox."""
        return QIcon(str(ICON))

    def load(self) -> bool:
        """Add the setting and the algorithms."""
        ProcessingConfig.settingIcons[self.name()] = self.icon()
        setting = Setting(self.name(), SETTING, "Program thawslide", "", valuetype=Setting.FILE)
        ProcessingConfig.addSetting(setting)
        setting.read()
        self.refreshAlgorithms()
        return True

    def unload(self) -> None:
        """Remove the setting."""
        ProcessingConfig.removeSetting(SETTING)

    def loadAlgorithms(self) -> None:  # noqa: N802
        """Add the algorithms."""
        for algorithm in ALGORITHMS:
            self.addAlgorithm(algorithm())
