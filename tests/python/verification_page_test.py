"""The pages of verification: every test that makes a record is on them, and an error deletes no figure."""

import json
import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from reproduction.studies import verification
from reproduction.study import ROOT, Place, StudyError

CONSTRUCTION = r"\bRecord\s+\w+\s*[({=]|\breturn Record\("
HEAD = re.compile(r"^TEST(?:_[FP])?\((\w+), (\w+)\)")
FUNCTION = re.compile(r"^[A-Za-z].*?\b(\w+)\([^;]*?\) \{$", re.MULTILINE)


def recorded_tests() -> Iterator[tuple[str, str]]:
    """Yield the program and the name of each test that makes a record, itself or by a function of its file."""
    for path in sorted((ROOT / "tests" / "cpp").rglob("*_test.cpp")):
        makers: list[str] = []
        for block in re.split(r"^}\n|^(?=TEST)", path.read_text(encoding="utf-8"), flags=re.M):
            calls = rf"|\b(?:{'|'.join(makers)})(?:<\w+>)?\(" if makers else ""
            if not re.search(CONSTRUCTION + calls, block):
                continue
            if head := HEAD.search(block):
                yield f"test_{path.parent.name}", f"{head[1]}.{head[2]}"
            else:
                makers.append(FUNCTION.findall(block)[-1])


def test_recorded_tests_are_found() -> None:
    found = dict(reversed(pair) for pair in recorded_tests())
    assert len(found) > 100
    direct = {
        "FollowingCells.ReproduceLinearFields": "test_verification",
        "RoughDems.FilteredAddNoFriction": "test_long",
    }
    by_function = {"Bar.UgimpFlip": "test_sim", "Entrainment.BlockEntrainsALayerInThePlane": "test_verification"}
    assert (direct | by_function).items() <= found.items()


def test_every_test_with_a_record_is_run_and_has_a_topic() -> None:
    filters = dict(verification.PROGRAMS)
    for program, name in recorded_tests():
        patterns = filters.get(program, "").split(":")
        assert any(fnmatchcase(name, pattern) for pattern in patterns), f"{name}: not in PROGRAMS of {program}"
        assert verification.topic_of({"test": name})


@pytest.fixture
def place(tmp_path: Path) -> Place:
    return Place(tmp_path / "program", tmp_path / "runs", tmp_path / "pages")


def record(test: str) -> str:
    return json.dumps({"test": test, "title": "A", "problem": "b", "solution": "c", "source": ""}) + "\n"


def test_a_record_without_a_topic_changes_no_page(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a valid record, the figures that the page does not use are removed."""
    known, unknown = "FreeFall.KeepsMomentumToRoundOff", "Unknown.Test"
    monkeypatch.setattr(verification, "names_of", lambda *_: [known, unknown])
    old = place.page("docs/verification/old.png")
    old.touch()
    place.runs.mkdir()
    records = place.runs / "test_sim.jsonl"
    records.write_text(record(known) + record(unknown))
    with pytest.raises(StudyError, match="Unknown: this suite has no topic"):
        verification.write(place)
    assert old.exists() and not (place.pages / "docs" / "verification.md").exists()
    records.write_text(record(known))
    verification.write(place)
    assert not old.exists() and "### A" in (place.runs / verification.DETAILS).read_text()


def test_the_appendix_without_records_has_every_topic_and_every_stored_figure() -> None:
    figures = ROOT / "docs" / "verification"
    text = verification.stand_in(figures)
    assert set(re.findall(r"^## (.+)$", text, re.MULTILINE)) == set(verification.TOPICS)
    assert set(re.findall(r"\(verification/(.+)\)", text)) == {path.name for path in figures.glob("*.png")}
