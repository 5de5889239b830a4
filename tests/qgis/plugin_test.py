"""The ZIP file of the plugin, the list of its algorithms, and the choice of the program."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

from conftest import LIMIT, QGIS_PROCESS, ROOT, Algorithm


def test_zip_file_has_the_same_bytes_and_one_folder_with_metadata(zip_file: Path, tmp_path: Path) -> None:
    again = tmp_path / "again.zip"
    subprocess.run([ROOT / "scripts" / "qgis-plugin", again], check=True)
    assert again.read_bytes() == zip_file.read_bytes()
    names = zipfile.ZipFile(zip_file).namelist()
    assert {name.split("/")[0] for name in names} == {"thawslide_qgis"}
    assert {"thawslide_qgis/LICENSE", "thawslide_qgis/metadata.txt", "thawslide_qgis/icon.svg"} <= set(names)


def test_provider_lists_its_algorithms(environment: dict[str, str], plugin: None) -> None:
    listed = subprocess.run(
        [QGIS_PROCESS, "list"], env=environment, capture_output=True, text=True, check=True, timeout=LIMIT
    ).stdout
    found = re.findall(r"^\s*(thawslide:\w+)\t(.+)$", listed, re.MULTILINE)
    assert sorted(found) == [
        ("thawslide:checkcase", "Check case"), ("thawslide:loadresults", "Load results with styles"),
        ("thawslide:newcase", "New case"), ("thawslide:resumerun", "Resume run"), ("thawslide:runcase", "Run case"),
    ]  # fmt: skip


def test_missing_program_is_reported_with_the_setting(algorithm: Algorithm, case: Path, tmp_path: Path) -> None:
    lost = {"THAWSLIDE_BINARY": "", "PATH": str(tmp_path)}
    message = algorithm("checkcase", environment_too=lost, CASE=case, code=None).stderr
    assert "Settings > Options > Processing > Providers > Thawslide" in message
    refused = algorithm("checkcase", environment_too={"THAWSLIDE_BINARY": str(tmp_path)}, CASE=case, code=1)
    assert f"THAWSLIDE_BINARY: {tmp_path} is not a program" in refused.stderr


def test_setting_precedes_the_environment_variable(
    algorithm: Algorithm, environment: dict[str, str], binary: Path, case: Path, tmp_path: Path
) -> None:
    profile = tmp_path / "qgis"
    shutil.copytree(environment["QGIS_CUSTOM_CONFIG_PATH"], profile)
    (file,) = profile.rglob("QGIS3.ini")
    file.write_text(file.read_text() + f"\n[Processing]\nConfiguration\\THAWSLIDE_BINARY={binary}\n")
    own = {"QGIS_CUSTOM_CONFIG_PATH": str(profile), "THAWSLIDE_BINARY": str(tmp_path)}
    algorithm("checkcase", environment_too=own, CASE=case)
