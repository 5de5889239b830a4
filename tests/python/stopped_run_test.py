"""Figures of a run that did not come to its end say so, and when that was."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from map_figure_parts import drawn, maps_of, notes

from thawslide import Run


def test_figures_of_a_stopped_run_say_when_it_stopped(map_run: Path) -> None:
    """With the state the run was left in, where the case asks for earlier times only."""
    facts = json.loads((map_run / "run.json").read_text()) | {"status": "stopped", "simulated_time_s": 9.51}
    (map_run / "run.json").write_text(json.dumps(facts))
    with (map_run / "case.toml").open("a") as case:
        case.write("[time]\nend = 60.0\n[report]\ntimes = [0.0, 2.0]\n")
    said = "The run was stopped at 9.51 s of 60 s. "
    extent = drawn("extent_maps", map_run)
    assert maps_of(extent)[-1].get_title(loc="left") == "(d) thickness at 9.51 s (stopped)"
    assert maps_of(drawn("impact_maps", map_run))[-1].get_title(loc="left")[4:] == (
        "change of elevation at 9.51 s (stopped)"
    )
    speeds, sections = drawn("slide_speed", map_run), drawn("cross_sections", map_run)
    assert [axes.get_title(loc="left") for axes in maps_of(speeds)] == ["(a) t = 0 s", "(b) t = 2 s", "(c) t = 10 s"]
    assert "at 9.51 s (stopped)" in [text.get_text() for text in sections.legends[0].get_texts()]
    for figure in (extent, speeds, sections):
        assert said in notes(figure).replace("\n", " ") + " "


@pytest.mark.parametrize(
    ("facts", "note", "state"),
    [
        ({"status": "done", "simulated_time_s": 10.0}, "", "10 s"),
        ({"status": "failed", "simulated_time_s": 10.4087}, "The run went bad at 10.41 s. ", "10.41 s (failed)"),
        ({"status": "running", "simulated_time_s": 0.0}, "The run was still running at 10 s. ", "10 s (still running)"),
    ],
)
def test_how_a_run_ended(map_run: Path, facts: dict[str, object], note: str, state: str) -> None:
    (map_run / "run.json").write_text(json.dumps(facts))
    run = Run(map_run)
    assert (run.end_note, run.last_state) == (note, state)
