"""Files of a release: notes, metadata for a DOI, and one version in all places."""

import configparser
import json
import re
import subprocess
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def version() -> str:
    found = re.search(r"project\(thawslide VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found
    return found[1]


def test_notes_are_the_newest_section_of_the_changelog_and_other_parts_are_refused() -> None:
    made = subprocess.run([ROOT / "scripts" / "release", "notes"], capture_output=True, text=True, check=True)
    notes = (ROOT / made.stdout.strip()).read_text()
    sections = re.split(r"^(?=## )", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)
    assert notes == sections[1] and notes.startswith(f"## {version()}\n")
    made = subprocess.run([ROOT / "scripts" / "release", "sources"], capture_output=True, text=True)
    assert made.returncode == 2 and "scripts/release archive" in made.stderr


def test_metadata_for_a_doi_are_those_of_the_citation() -> None:
    made = subprocess.run([ROOT / "scripts" / "doi-metadata"], capture_output=True, text=True, check=True)
    metadata = json.loads(made.stdout)["metadata"]
    assert metadata["version"] == version() and metadata["title"] == f"Thawslide {version()}"
    assert metadata["creators"] == [{"name": "The Thawslide authors"}]
    assert metadata["license"] == "bsd-3-clause" and len(metadata["keywords"]) == 3
    assert metadata["description"].startswith("A simulator of rock-ice avalanches")


def test_plugin_with_metadata_of_the_publisher_meets_the_rules_of_the_plugin_repository(tmp_path: Path) -> None:
    rest = [f"{key}=https://example.org/{key}" for key in ("repository", "tracker", "homepage")]
    made = tmp_path / "plugin.zip"
    words = [ROOT / "scripts" / "qgis-plugin", made]
    alone = subprocess.run(words, capture_output=True, text=True, check=True)
    assert "requires email, repository, tracker, homepage" in alone.stderr
    called = subprocess.run([*words, "email=name@example.org", *rest], capture_output=True, text=True, check=True)
    assert called.stderr == ""
    with zipfile.ZipFile(made) as archive:
        entries = archive.infolist()
        metadata = configparser.ConfigParser()
        metadata.read_string(archive.read("thawslide_qgis/metadata.txt").decode())
    names = [entry.filename for entry in entries]
    assert {"thawslide_qgis/LICENSE", "thawslide_qgis/__init__.py"} <= set(names)
    assert {Path(name).suffix for name in names} == {"", ".py", ".svg", ".txt"}
    assert not any(part.startswith((".", "__MACOSX", "__pycache__")) for name in names for part in Path(name).parts)
    assert not any(entry.external_attr >> 16 & 0o111 for entry in entries)
    assert made.stat().st_size < 25e6
    general = dict(metadata["general"])
    assert general["version"] == version() and general["tracker"] == "https://example.org/tracker"
    assert "/" not in general["author"]
