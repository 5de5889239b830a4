"""Writes the files dem.tif and release.geojson that a page requires into a folder: a slope of 30 degrees.

python slope_and_release.py FOLDER
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "cli"))
from terrain_files import SOUTH, WEST, write_rectangle, write_slope

folder = Path(sys.argv[1])
folder.mkdir(exist_ok=True)
write_slope(folder / "dem.tif")
write_rectangle(folder / "release.geojson", WEST + 50.0, SOUTH + 250.0)
