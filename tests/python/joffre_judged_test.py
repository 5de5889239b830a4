"""The page of the judged forecast has its committed numbers; joined forecasts are equally probable."""

import json
from pathlib import Path

import numpy as np
import pytest

from reproduction.studies.joffre_judged import front_speed, joined
from reproduction.studies.joffre_judged_page import FOLDER, PAGE, page_text, run_table
from reproduction.study import ROOT
from thawslide.scores.forecast import Forecast


def test_page_has_the_committed_numbers() -> None:
    found = json.loads((ROOT / FOLDER / "numbers.json").read_text(encoding="utf-8"))
    text = page_text(found)
    assert text == (ROOT / PAGE).read_text(encoding="utf-8")
    assert "@" not in text
    prose = [line for line in text.splitlines() if not line.startswith("|")]
    assert sum(len(line.split()) for line in prose) <= 700


def test_runs_that_do_not_come_to_rest_are_limits() -> None:
    row = {"travel_distance_m": 5e3, "h_over_l": 0.25, "mean_speed_m_s": 20.0, "duration_s": 237.0}
    found = run_table([{**row, "words": words, "simulated_time_s": end} for words, end in (("a", 239.9), ("b", 240.0))])
    assert found.splitlines()[2:] == ["| a | 5,000 | 0.25 | 20 | 237 |", "| b | > 5,000 | < 0.25 | 20 | > 237 |"]


def test_joined_forecasts_are_equally_probable_and_keep_their_weights() -> None:
    parts = [
        Forecast(
            Path(), True, [0, 1], np.array([0.25, 0.75]), {"a": np.arange(2.0), "b": np.zeros(2)}, [Path("x")] * 2
        ),
        Forecast(Path(), True, [0, 1, 2], np.ones(3) / 3.0, {"a": np.arange(2.0, 5.0)}, [Path("y")] * 3),
    ]
    found = joined(Path(), parts)
    assert found.weights == pytest.approx([0.125, 0.375, 1 / 6, 1 / 6, 1 / 6])
    assert list(found.columns) == ["a"] and list(found.columns["a"]) == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert found.run_folders == [Path("x")] * 2 + [Path("y")] * 3
    assert found.members == [0, 1, 2, 3, 4]


def test_front_speed_is_that_over_a_span(monkeypatch: pytest.MonkeyPatch) -> None:
    class Halting:
        def __init__(self, _: Path) -> None:
            # 20 m/s, a step back, and rest at 900 m
            times = np.array([0.0, 10.0, 20.0, 30.0, 100.0])
            self.series = {"time_s": times, "front_position_m": np.array([0.0, 200.0, 400.0, 390.0, 900.0])}

    monkeypatch.setattr("reproduction.studies.joffre_judged.Run", Halting)
    assert front_speed(Path(), 100.0) == pytest.approx(20.0)
    assert np.isnan(front_speed(Path(), 800.0))
