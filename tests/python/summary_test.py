"""Two-page summary for non-experts."""

import re
from pathlib import Path

import pytest
from conftest import Fails, MakeRun, update_facts

from thawslide import Run
from thawslide.command_line import main
from thawslide.figures.class_maps import arrival_classes, thickness_classes
from thawslide.figures.site import make_site
from thawslide.pages.summary import make_summary
from thawslide.pages.summary_text import arrival_rows, limits, plain_numbers, scenario


def test_scenario_states_rest_or_motion_and_limits_the_warnings(map_run: Path) -> None:
    assert "The mass is at rest from 8.5 s on." in scenario(Run(map_run))
    update_facts(map_run, at_rest=False, rest_since_s=None)
    assert "The mass was still moving at the end: the affected area can become larger." in scenario(Run(map_run))
    update_facts(map_run, warnings=["one", "two"])
    assert limits(Run(map_run))[-1].startswith("The program reported 2 warnings on this run")


def test_many_probes_leave_space_for_the_map(map_run: Path) -> None:
    rows = [line.split(",") for line in (map_run / "probes.csv").read_text().splitlines()]
    place = rows[0].index("gate_thickness_m")
    for number in range(40):
        rows[0].append(f"place_{number}_thickness_m")
        for row in rows[1:]:
            row.append(row[place])
    (map_run / "probes.csv").write_text("".join(",".join(row) + "\n" for row in rows))
    page, document = make_summary(Run(map_run), dpi=30)
    assert page.read_text().count(">place ") == 40
    assert document.stat().st_size > 10_000


def test_classes_numbers_and_arrivals_are_those_of_the_run(map_run: Path) -> None:
    site = make_site(Run(map_run))
    thickness = thickness_classes(site)
    assert thickness.words == ["below 1 m", "1 to 5 m", "above 5 m"]
    assert thickness.limits == [0.1, 1.0, 5.0, 6.0]
    arrival = arrival_classes(site)
    assert arrival.limits[0] == 0.0
    assert len(arrival.words) == len(arrival.limits) - 1 <= 7
    assert arrival.limits[-1] == pytest.approx(9.8)
    assert [(each.name, each.value) for each in plain_numbers(Run(map_run))] == [
        ("released volume", "28,800 m³"), ("travel distance", "280 m"), ("affected area", "16,800 m²"),
        ("maximum thickness", "6 m"), ("maximum speed", "72 km/h"),
    ]  # fmt: skip
    assert plain_numbers(Run(map_run))[1].meaning == "It falls 112 m over this distance."
    assert arrival_rows(Run(map_run)) == [("gate", "5 s", "6 m")]


def test_summary_has_two_pages_loads_nothing_and_is_the_same_for_the_same_run(map_run: Path, tmp_path: Path) -> None:
    first, second = (make_summary(Run(map_run), tmp_path / name, dpi=50) for name in ("a", "b"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
    page, document = first
    text = page.read_text(encoding="utf-8")
    assert len(re.findall(rb"/Type /Page\b", document.read_bytes())) == 2
    assert not re.search(r"https?://|<script", text)
    sources = re.findall(r'src="([^"]*)"', text)
    assert len(sources) == 2
    assert all(source.startswith("data:image/png;base64,") for source in sources)
    assert '<th scope="row">maximum speed</th><td>72 km/h</td>' in text and "This is one scenario." in text


def test_command_writes_the_summary(map_run: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert main([str(map_run), "--brief", "--output", str(tmp_path), "--dpi", "50"]) == 0
    out = capsys.readouterr().out
    assert f"summary: {tmp_path / 'summary.html'}" in out and f"summary: {tmp_path / 'summary.pdf'}" in out
    assert not (map_run / "summary.html").exists()


def test_summary_excludes_sections_and_selected_figures(make_run: MakeRun, map_run: Path, fails: Fails) -> None:
    fails([str(make_run()), "--brief"], "--brief: only for 3D runs on a DEM, which have maps.")
    words = "--only: not allowed with --brief. Remove one of the options."
    fails([str(map_run), "--brief", "--only", "motion"], words)
