"""Runs AvaFrame's com1DFA with plain Coulomb friction: run_com1dfa.py FOLDER FRICTION_ANGLE NAME [KEY=VALUE ...].

scripts/pages --only avaframe starts it with the Python of AvaFrame. FOLDER contains dem.tif and release.json:
the corners of the outline [m] and the thickness along the normal [m]. Writes FOLDER/NAME (AvaFrame's own folders) and
FOLDER/NAME.facts.json (version, particles, times and volumes, AvaFrame's report). KEY=VALUE are settings of com1DFA.
"""

import json
import math
import shutil
import sys
from importlib.metadata import version
from pathlib import Path

import shapefile
from avaframe.com1DFA import com1DFA
from avaframe.in3Utils import cfgUtils, logUtils

# Changes to AvaFrame's defaults, which are: cells of 5 m, SPH kernels of 5 m, steps of 0.1 s, and an end at 1 % of the
# maximum kinetic energy.
SETTINGS = {
    "simTypeList": "null",  # no entrainment, no resistance
    "frictModel": "Coulomb",
    "rho": "2063",  # kg/m3: rock with 37.5 % of ice, as in the case of Thawslide
    "relThFromFile": "True",
    "secRelArea": "False",
    "dam": "False",
    "resType": "pft|pfv|FT",
}


def prepare(folder: Path, friction_angle: float, name: str, changes: list[str]) -> Path:
    """Write AvaFrame's folders; return the one of the run."""
    place = folder / name
    shutil.rmtree(place, ignore_errors=True)
    inputs = place / "Inputs"
    (inputs / "REL").mkdir(parents=True)
    (inputs / "CFGs").mkdir()
    shutil.copy(folder / "dem.tif", inputs / "dem.tif")
    release = json.loads((folder / "release.json").read_text())
    with shapefile.Writer(str(inputs / "REL" / "release"), shapeType=shapefile.POLYGON) as file:
        file.field("name", "C")
        file.field("thickness", "N", decimal=3)
        file.poly([release["corners"]])
        file.record("slide", release["thickness"])
    settings = {**SETTINGS, "mucoulomb": f"{math.tan(math.radians(friction_angle)):.9g}"}
    settings |= dict(change.split("=", 1) for change in changes)
    lines = ["[GENERAL]", *(f"{key} = {value}" for key, value in settings.items())]
    (inputs / "CFGs" / "com1DFACfg.ini").write_text("\n".join(lines) + "\n")
    return place


def main() -> None:
    """Run AvaFrame and write the facts that the comparison needs in addition to the maps."""
    folder, friction_angle, name = Path(sys.argv[1]).resolve(), float(sys.argv[2]), sys.argv[3]
    place = prepare(folder, friction_angle, name, sys.argv[4:])
    general = cfgUtils.getGeneralConfig()
    general["MAIN"]["avalancheDir"] = str(place)
    general["MAIN"]["nCPU"] = "1"
    for flag in ("savePlot", "createReport", "ReportDir"):
        general["FLAGS"][flag] = "False"
    logUtils.initiateLogger(str(place), "com1DFA")
    _, _, reports, _ = com1DFA.com1DFAMain(general, cfgInfo=cfgUtils.getModuleConfig(com1DFA, str(place)))
    report = reports[0]["Simulation Parameters"]
    facts = {
        "version": version("avaframe"),
        "left_share": 1.0 - float(report["Final mass [kg]"]) / float(report["Initial mass [kg]"]),
        "report": reports[0],
    }
    (folder / f"{name}.facts.json").write_text(json.dumps(facts, indent=1, default=str) + "\n")


if __name__ == "__main__":
    main()
