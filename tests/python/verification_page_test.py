"""Pages of studies: records of verification, the judged forecast, and figures of the tutorials."""

import json
import re
from collections.abc import Iterator
from fnmatch import fnmatchcase
from pathlib import Path

import numpy as np
import pytest

from reproduction.studies import verification
from reproduction.studies.joffre_judged import front_speed, joined
from reproduction.studies.joffre_judged_page import FOLDER, PAGE, page_text, run_table
from reproduction.studies.tutorials import SWEEP_FIGURES, image_of
from reproduction.study import ROOT, Place, StudyError
from thawslide.pages.markup import data_address, figure_part
from thawslide.scores.forecast import Forecast

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


def test_every_test_with_a_record_is_found_run_and_has_a_topic() -> None:
    filters = dict(verification.PROGRAMS)
    for program, name in recorded_tests():
        patterns = filters.get(program, "").split(":")
        assert any(fnmatchcase(name, pattern) for pattern in patterns), f"{name}: not in PROGRAMS of {program}"
        assert verification.topic_of({"test": name})
    found = dict(reversed(pair) for pair in recorded_tests())
    assert len(found) > 100
    direct = {
        "FollowingCells.ReproduceLinearFields": "test_verification",
        "RoughDems.FilteredAddNoFriction": "test_long",
    }
    by_function = {"Bar.UgimpFlip": "test_sim", "Entrainment.BlockEntrainsALayerInThePlane": "test_verification"}
    assert (direct | by_function).items() <= found.items()


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


def test_page_has_the_committed_numbers_and_limits_for_runs_in_motion() -> None:
    text = page_text(json.loads((ROOT / FOLDER / "numbers.json").read_text(encoding="utf-8")))
    assert text == (ROOT / PAGE).read_text(encoding="utf-8") and "@" not in text
    prose = [line for line in text.splitlines() if not line.startswith("|")]
    assert sum(len(line.split()) for line in prose) <= 700
    row = {"travel_distance_m": 5e3, "h_over_l": 0.25, "mean_speed_m_s": 20.0, "duration_s": 237.0}
    found = run_table([{**row, "words": words, "simulated_time_s": end} for words, end in (("a", 239.9), ("b", 240.0))])
    assert found.splitlines()[2:] == ["| a | 5,000 | 0.25 | 20 | 237 |", "| b | > 5,000 | < 0.25 | 20 | > 237 |"]


def test_joined_forecasts_are_equally_probable_and_keep_their_weights() -> None:
    two, three = {"a": np.arange(2.0), "b": np.zeros(2)}, {"a": np.arange(2.0, 5.0)}
    parts = [
        Forecast(Path(), True, [0, 1], np.array([0.25, 0.75]), two, [Path("x")] * 2),
        Forecast(Path(), True, [0, 1, 2], np.ones(3) / 3.0, three, [Path("y")] * 3),
    ]
    found = joined(Path(), parts)
    assert found.weights == pytest.approx([0.125, 0.375, 1 / 6, 1 / 6, 1 / 6])
    assert list(found.columns) == ["a"] and list(found.columns["a"]) == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert found.run_folders == [Path("x")] * 2 + [Path("y")] * 3 and found.members == [0, 1, 2, 3, 4]


def test_front_speed_is_that_over_a_span(monkeypatch: pytest.MonkeyPatch) -> None:
    class Halting:
        def __init__(self, _: Path) -> None:
            # 20 m/s, a step back, and rest at 900 m
            times = np.array([0.0, 10.0, 20.0, 30.0, 100.0])
            self.series = {"time_s": times, "front_position_m": np.array([0.0, 200.0, 400.0, 390.0, 900.0])}

    monkeypatch.setattr("reproduction.studies.joffre_judged.Run", Halting)
    assert front_speed(Path(), 100.0) == pytest.approx(20.0) and np.isnan(front_speed(Path(), 800.0))


def section(heading: str, data: bytes) -> str:
    part = figure_part(heading, data_address(data, "image/png"), "A caption.")
    return f"<h2>{heading}</h2>\n{part}\n"


def test_figures_are_found_by_the_beginning_of_their_heading() -> None:
    headings = {heading: f"{heading} L" for heading in SWEEP_FIGURES}
    page = "".join(section(words, words.encode()) for words in ("Sensitivity of peak speed", *headings.values()))
    for heading, words in headings.items():
        assert image_of(page, heading) == words.encode()
    page = "<h2>Probability maps</h2>\n<p>Not available: no member covers any cell.</p>" + section("Spread", b"other")
    with pytest.raises(StudyError, match="Probability maps"):
        image_of(page, "Probability maps")
