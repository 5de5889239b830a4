"""Fixtures that run the algorithms of the plugin in QGIS, with a profile into which its ZIP file is installed."""

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from terrain_files import SOUTH, WEST, write_rectangle, write_slope

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = Path(__file__).parent / "scripts"
PYTHON = "/usr/bin/python3"  # that of Debian, with python3-qgis
LIMIT = 600.0  # s, of a command

# The script qgis_process of Debian 12 adds an option that the program does not know.
QGIS_PROCESS = shutil.which("qgis_process.bin") or "qgis_process"

Outcome = subprocess.CompletedProcess[str]
Algorithm = Callable[..., Outcome]
Script = Callable[..., Any]


@pytest.fixture(scope="session")
def binary() -> Path:
    path = ROOT / os.environ.get("THAWSLIDE_BINARY", "build/release/thawslide")
    if not path.is_file():
        pytest.fail(f"program not found: {path}. Build it, or set THAWSLIDE_BINARY.")
    return path


@pytest.fixture(scope="session")
def environment(binary: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    home = tmp_path_factory.mktemp("home")
    home.chmod(0o700)
    own = {"HOME": home, "QGIS_CUSTOM_CONFIG_PATH": home / "qgis", "XDG_RUNTIME_DIR": home}
    kept = {key: os.environ[key] for key in ("LANG", "LC_ALL") if key in os.environ}
    # Another Python in PATH would become that of QGIS, and crash it.
    settings = {"PATH": os.defpath, "QT_QPA_PLATFORM": "offscreen", "PYTHONDONTWRITEBYTECODE": "1"}
    return {**kept, **settings, "THAWSLIDE_BINARY": str(binary), **{key: str(path) for key, path in own.items()}}


@pytest.fixture(scope="session")
def zip_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("zip") / "thawslide_qgis.zip"
    subprocess.run([ROOT / "scripts" / "qgis-plugin", path], check=True)
    return path


@pytest.fixture(scope="session")
def plugin(environment: dict[str, str], zip_file: Path) -> None:
    subprocess.run([PYTHON, SCRIPTS / "install_plugin.py", zip_file], env=environment, check=True, timeout=LIMIT)
    subprocess.run([QGIS_PROCESS, "plugins", "enable", "thawslide_qgis"], env=environment, check=True, timeout=LIMIT)


@pytest.fixture(scope="session")
def algorithm(environment: dict[str, str], plugin: None) -> Algorithm:
    """Return a function that runs an algorithm with parameters by `qgis_process`, and checks its exit code."""

    def run(
        name: str, *options: str, code: int | None = 0, environment_too: Any = None, **parameters: object
    ) -> Outcome:
        words = [f"{key}={value}" for key, value in parameters.items()]
        command = [QGIS_PROCESS, "run", f"thawslide:{name}", *options, "--", *words]
        together = {**environment, **(environment_too or {})}
        outcome = subprocess.run(command, env=together, capture_output=True, text=True, timeout=LIMIT)
        assert code in (outcome.returncode, None), outcome.stdout + outcome.stderr
        return outcome

    return run


@pytest.fixture(scope="session")
def script(environment: dict[str, str], plugin: None) -> Script:
    """Return a function that runs a script in the Python of QGIS, and returns the JSON of its last line."""

    def run(name: str, *words: object) -> Any:
        command = [PYTHON, SCRIPTS / name, *map(str, words)]
        outcome = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=LIMIT)
        assert outcome.returncode == 0, outcome.stdout + outcome.stderr
        return json.loads(outcome.stdout.splitlines()[-1])

    return run


@pytest.fixture(scope="session")
def slope(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with dem.tif and release.geojson: a slope of 30 degrees."""
    folder = tmp_path_factory.mktemp("slope")
    write_slope(folder / "dem.tif")
    write_rectangle(folder / "release.geojson", WEST + 50.0, SOUTH + 250.0)
    return folder


@pytest.fixture(scope="session")
def case(algorithm: Algorithm, slope: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("cases") / "slope"
    algorithm("newcase", DEM=slope / "dem.tif", RELEASE=slope / "release.geojson", THICKNESS=24, OUTPUT=folder)
    return folder / "case.toml"


@pytest.fixture(scope="session")
def finished(algorithm: Algorithm, case: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Outcome]:
    """Return the folder of a run of two seconds, and the outcome of 'Run case'."""
    folder = tmp_path_factory.mktemp("runs") / "slope"
    return folder, algorithm("runcase", CASE=case, OUTPUT=folder, THREADS=1, SETTINGS="time.end=2")
