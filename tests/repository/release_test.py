"""Files of a release: notes, metadata for a DOI, and one version in all places."""

import json
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def version() -> str:
    found = re.search(r"project\(thawslide VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert found
    return found[1]


def test_notes_are_the_newest_section_of_the_changelog() -> None:
    made = subprocess.run([ROOT / "scripts" / "release", "notes"], capture_output=True, text=True, check=True)
    notes = (ROOT / made.stdout.strip()).read_text()
    sections = re.split(r"^(?=## )", (ROOT / "CHANGELOG.md").read_text(), flags=re.MULTILINE)
    assert notes == sections[1] and notes.startswith(f"## {version()}\n")


def test_metadata_for_a_doi_are_those_of_the_citation() -> None:
    made = subprocess.run([ROOT / "scripts" / "doi-metadata"], capture_output=True, text=True, check=True)
    metadata = json.loads(made.stdout)["metadata"]
    assert metadata["version"] == version() and metadata["title"] == f"Thawslide {version()}"
    assert metadata["creators"] == [{"name": "The Thawslide authors"}]
    assert metadata["license"] == "bsd-3-clause" and len(metadata["keywords"]) == 3
    assert metadata["description"].startswith("A simulator of rock-ice avalanches")


def test_unknown_parts_of_a_release_are_refused() -> None:
    made = subprocess.run([ROOT / "scripts" / "release", "sources"], capture_output=True, text=True)
    assert made.returncode == 2 and "scripts/release archive" in made.stderr
