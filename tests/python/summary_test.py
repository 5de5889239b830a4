"""Two-page summary for non-experts."""

import html
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import Fails, MakeRun, page_of, update_facts

import thawslide
from thawslide import Run
from thawslide.command_line import main
from thawslide.errors import ReportError
from thawslide.figures.class_maps import arrival_classes, thickness_classes
from thawslide.figures.site import make_site
from thawslide.messages import LANGUAGES, Messages
from thawslide.pages.client_text import arrival_rows, limits, plain_numbers, scenario
from thawslide.pages.results import map_note
from thawslide.pages.summary import make_summary
from thawslide.text_files import read_table

SAY = Messages()


def test_scenario_states_rest_or_motion_and_limits_the_warnings(map_run: Path) -> None:
    assert "The mass is at rest from 8.5 s on." in scenario(Run(map_run), SAY)
    update_facts(map_run, at_rest=False, rest_since_s=None)
    assert "The mass was still moving at the end: the affected area can become larger." in scenario(Run(map_run), SAY)
    update_facts(map_run, warnings=["one", "two"])
    last = limits(Run(map_run), SAY, "warning_in_report")[-1]
    assert last == "The program reported 2 warnings on this run. See Diagnosis in the full report."
    assert "reported 2 warnings on this run. See Diagnosis below." in page_of(map_run)


def test_maps_explain_coloured_cells_outside_the_outline(map_run: Path) -> None:
    site = make_site(Run(map_run))
    for language in LANGUAGES:
        say = Messages(language)
        assert say("edge_note") not in map_note(site, say)  # the outline is a contour
    vars(site)["affected"] = [np.zeros((4, 2))]
    for language in LANGUAGES:
        say = Messages(language)
        assert map_note(site, say).endswith(f" {say('edge_note')}")


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
    thickness = thickness_classes(site, SAY)
    assert thickness.words == ["below 1 m", "1 to 5 m", "above 5 m"]
    assert thickness.limits == [0.1, 1.0, 5.0, 6.0]
    arrival = arrival_classes(site, SAY)
    assert arrival.limits[0] == 0.0
    assert len(arrival.words) == len(arrival.limits) - 1 <= 7
    assert arrival.limits[-1] == pytest.approx(9.8)
    assert [(each.name, each.value) for each in plain_numbers(Run(map_run), SAY)] == [
        ("released volume", "28,800 m³"), ("travel distance", "280 m"), ("affected area", "16,800 m²"),
        ("maximum thickness", "6 m"), ("maximum speed", "72 km/h"),
    ]  # fmt: skip
    assert plain_numbers(Run(map_run), SAY)[1].meaning == "It falls 112 m over this distance."
    assert arrival_rows(Run(map_run), SAY) == [("gate", "5 s", "6 m")]


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


def test_summary_excludes_selected_figures_and_unknown_languages(
    map_run: Path, fails: Fails, capsys: pytest.CaptureFixture[str]
) -> None:
    words = "--only: not allowed with --brief. Remove one of the options."
    fails([str(map_run), "--brief", "--only", "motion"], words)
    with pytest.raises(SystemExit):
        main([str(map_run), "--brief", "--language", "it"])
    assert "choose from en, de, fr" in capsys.readouterr().err.replace("'", "")
    with pytest.raises(ReportError, match="language: unknown \\(found 'it'; allowed en, de, fr\\)"):
        thawslide.report(map_run, brief=True, language="it")


def test_summary_of_a_section_has_its_extent_and_the_arrival_of_the_front(make_run: MakeRun, tmp_path: Path) -> None:
    folder = make_run()
    page, document = make_summary(Run(folder), tmp_path, dpi=50)
    text = page.read_text(encoding="utf-8")
    assert len(re.findall(rb"/Type /Page\b", document.read_bytes())) == 2
    assert text.count('src="data:image/png') == 2
    assert "A section cannot spread sideways" in text and "outside the outline" not in text
    found = {each.key: each.value for each in plain_numbers(Run(folder), SAY)}
    # The front is 160 m from the initial rear at 10 s; the fastest particle has 15 m/s.
    assert (found["travel_distance_m"], found["peak_speed_m_s"], found["peak_thickness_m"]) == (
        "160 m",
        "54 km/h",
        "4 m",
    )
    make_run(name="empty", snapshots=0)
    with pytest.raises(ReportError, match="no snapshots"):
        make_summary(Run(folder.parent / "empty"), tmp_path)


@pytest.mark.parametrize("language", LANGUAGES)
def test_results_and_summary_are_in_one_language(map_run: Path, tmp_path: Path, language: str) -> None:
    say = Messages(language)
    main([str(map_run), "--brief", "--output", str(tmp_path), "--dpi", "50", "--language", language])
    main([str(map_run), "--only", "motion", "--output", str(tmp_path), "--dpi", "50", "--language", language])
    volume = {"en": "28,800 m³", "de": "28.800 m³", "fr": "28\u202f800 m³"}[language]
    for name in ("summary.html", "report.html"):
        page = (tmp_path / name).read_text(encoding="utf-8")
        assert f'<html lang="{language}">' in page
        for text in (volume, say("head_limits"), say("limit_hazards"), say("assume_no_bed"), say("affected_area_m2")):
            assert html.escape(text) in page, text
        for other in LANGUAGES:
            assert (html.escape(Messages(other)("limit_hazards")) in page) == (other == language)


def test_messages_have_all_languages_with_the_same_values() -> None:
    rows = read_table(Path(thawslide.__file__).parent / "messages.csv", ("key", *LANGUAGES)).rows
    code = "".join(path.read_text() for path in Path(thawslide.__file__).parent.glob("*/*.py"))
    code += (Path(thawslide.__file__).parent / "messages.py").read_text()
    for _, row in rows:
        values = {tuple(sorted(re.findall(r"{(\w+)}", row[language]))) for language in LANGUAGES}
        assert len(values) == 1 and all(row[language].strip() for language in LANGUAGES), row["key"]
        stem = re.sub(r"_(means|plain|angle|coefficient)$", "", row["key"]).split("_")[-1]
        assert stem in code, f"{row['key']} is not used"
