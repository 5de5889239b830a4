"""Two-page summary for non-experts, and the same results at the top of a report: ranges, settings, no paths."""

import html
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import Fails, MakeRun, history_columns, page_of, update_facts, write_history
from figure_parts import labels
from map_runs import THICKNESS, VOLUME

import thawslide
from thawslide import ReportError, Run
from thawslide.command_line import main
from thawslide.figures.area import whole_figure
from thawslide.figures.class_maps import arrival_classes, thickness_classes
from thawslide.figures.section_results import draw_section_arrival, section_extent
from thawslide.figures.site import make_site
from thawslide.main_numbers import main_numbers
from thawslide.messages import LANGUAGES, Messages
from thawslide.pages.client_text import arrival_rows, assumptions, limits, plain_numbers, scenario
from thawslide.pages.facts import settings_of
from thawslide.pages.ranges import ranges_of
from thawslide.pages.results import map_note
from thawslide.pages.summary import make_summary
from thawslide.text_files import read_table

SAY = Messages()


def test_scenario_states_rest_or_motion_and_maps_explain_their_outline(map_run: Path) -> None:
    assert "The mass is at rest from 8.5 s on." in scenario(Run(map_run), SAY)
    update_facts(map_run, at_rest=False, rest_since_s=None)
    assert "The mass was still moving at the end: the affected area can become larger." in scenario(Run(map_run), SAY)
    update_facts(map_run, warnings=["one", "two"])
    last = limits(Run(map_run), SAY, "warning_in_report")[-1]
    assert last == "The program reported 2 warnings on this run. See Diagnosis in the full report."
    assert "reported 2 warnings on this run. See Diagnosis below." in page_of(map_run)
    contour, site = make_site(Run(map_run)), make_site(Run(map_run))
    vars(site)["affected"] = [np.zeros((4, 2))]
    for say in map(Messages, LANGUAGES):
        assert say("edge_note") not in map_note(contour, say)
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
    assert (arrival.limits[0], arrival.limits[-1]) == (0.0, pytest.approx(9.8))
    assert len(arrival.words) == len(arrival.limits) - 1 <= 7
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
    assert text.count('src="') == text.count('src="data:image/png;base64,') == 2
    assert '<th scope="row">maximum speed</th><td>72 km/h</td>' in text and "This is one scenario." in text


def test_command_writes_the_summary(
    map_run: Path, capsys: pytest.CaptureFixture[str], tmp_path: Path, fails: Fails
) -> None:
    assert main([str(map_run), "--brief", "--output", str(tmp_path), "--dpi", "50"]) == 0
    out = capsys.readouterr().out
    assert f"summary: {tmp_path / 'summary.html'}" in out and f"summary: {tmp_path / 'summary.pdf'}" in out
    assert not (map_run / "summary.html").exists()
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
    expected = {"travel_distance_m": "160 m", "peak_speed_m_s": "54 km/h", "peak_thickness_m": "4 m"}
    assert expected.items() <= found.items()
    with pytest.raises(ReportError, match="no snapshots"):
        make_summary(Run(make_run(name="empty", snapshots=0)), tmp_path)


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
    package = Path(thawslide.__file__).parent
    rows = read_table(package / "messages.csv", ("key", *LANGUAGES)).rows
    code = "".join(path.read_text() for path in package.rglob("*.py")).replace("'", '"')
    for _, row in rows:
        values = {tuple(sorted(re.findall(r"{(\w+)}", row[language]))) for language in LANGUAGES}
        assert len(values) == 1 and all(row[language].strip() for language in LANGUAGES), row["key"]
        # Keys are literals, or are composed: limit_NAME, assume_KEY, QUANTITY_means.
        words = re.sub(r"^(limit|assume)_|_(means|plain)$", "", row["key"])
        assert f'"{row["key"]}"' in code or f'"{words}"' in code, f"{row['key']} is not used"


def stated(page: str) -> dict[str, float]:
    """Return the five numbers of the results by name, in m, m2, m3, m/s and s."""
    found = re.findall(r'<dt>(.*?)</dt><dd><span class="value">([\d.,]+) (.*?)</span>', page)
    scale = {"m³": 1.0, "million m³": 1e6, "m": 1.0, "m²": 1.0, "km²": 1e6, "km/h": 1 / 3.6, "s": 1.0}
    return {name: float(value.replace(",", "")) * scale[unit] for name, value, unit in found}


def test_results_equal_run_json_the_maps_the_diagnosis_and_the_history(map_run: Path, make_run: MakeRun) -> None:
    page = page_of(map_run)
    found = stated(page)
    names = ["released volume", "travel distance", "affected area", "maximum thickness", "maximum speed"]
    assert [found.pop(name) for name in names] == pytest.approx([VOLUME, 280.0, 16800.0, THICKNESS, 20.0], rel=5e-3)
    assert found == {}
    assert "It falls 112 m over this distance." in page
    of_table = {row.key: row.number for row in main_numbers(Run(map_run))}
    for each in plain_numbers(Run(map_run), SAY):
        assert each.key in of_table, each
    found = stated(page_of(make_run()))
    assert list(found) == ["released volume", "travel distance", "maximum thickness", "maximum speed", "duration"]
    # The mean velocity is below 1 % of its maximum from 9.7 s on.
    assert list(found.values()) == pytest.approx([800.0, 160.0, 4.0, 15.0, 9.7], rel=5e-3)


def test_alerts_name_incomplete_runs_and_open_balances(make_run: MakeRun) -> None:
    folder = make_run()
    assert "The simulation is incomplete" not in page_of(folder)
    update_facts(folder, status="failed", message="particle 7 left the domain")
    residual = {"mechanical_residual_J": np.linspace(0.0, 2e11, 101)}  # of 1e13 J
    write_history(folder / "history.csv", history_columns(101, 2) | residual)
    page = page_of(folder)
    before = page[: page.index('<details id="numbers"')]
    assert '<p class="note">The simulation is incomplete. All results are those up to 10 s.</p>' in before
    assert '<p class="note">A balance of mass or energy does not close.' in before
    assert "particle 7" not in before and "particle 7" in page


def test_member_of_an_ensemble_has_ranges(map_run: Path, tmp_path: Path) -> None:
    assert ranges_of(Run(map_run)) is None
    (tmp_path / "members").mkdir()
    (tmp_path / "sweep.json").write_text('{"members": 21}')
    distances = 200.0 + 10.0 * np.arange(21)  # m: 200, 210, ... 400
    table = {"member": range(21), "status": "done", "travel_distance_m": distances, "error": ""}
    pd.DataFrame(table).to_parquet(tmp_path / "members.parquet")
    run = Run(map_run.rename(tmp_path / "members" / "000008"))
    distance = plain_numbers(run, SAY, ranges_of(run))[1]
    # The smallest member that 5 % do not exceed is the second of 21, and that of 95 % the twentieth.
    assert (distance.key, distance.spread) == ("travel_distance_m", "210 m to 390 m")
    page = page_of(run.folder)
    assert '<span class="range">(210 m to 390 m)</span>' in page
    assert "Ranges: 5 to 95 % of 21 simulations with different parameters." in page


def test_finest_run_of_a_pair_has_its_error_as_a_range(map_run: Path, tmp_path: Path) -> None:
    (tmp_path / "slide-pair").mkdir()
    run = Run(map_run.rename(tmp_path / "slide-pair" / "h"))
    results = {"travel_distance_m": {"value": 280.0, "error": 15.0}, "deposit_area_m2": {"value": 1.0, "error": None}}
    (run.folder.parent / "pair.json").write_text(json.dumps({"results": results}))
    numbers = plain_numbers(run, SAY, ranges_of(run))
    assert {each.key: each.spread for each in numbers if each.spread} == {"travel_distance_m": "265 m to 295 m"}
    (run.folder.parent / "pair.json").write_text('{"results": 5}')
    assert ranges_of(run) is None


def test_assumptions_are_those_of_the_case(make_run: MakeRun) -> None:
    folder = make_run()
    with (folder / "case.toml").open("a") as file:
        file.write(
            '\n[basal]\nfriction = "lubricated"\nfriction_angle = 21.5\n[substrate.old_ice]\nx_min = 3.0\n'
            '[bed]\nlaw = "friction"\n[body.a]\ntemperature = -5.0\n[body.b]\ntemperature = -5\nporosity = 0.3\n'
        )
    found = assumptions(Run(folder), SAY)
    assert found[:4] == [
        "Friction angle below the mass: 21.5°.", "Different friction on parts of the terrain: old ice.",
        "Frictional heat melts ice, and the water reduces friction.", "Temperature of the mass at the start: −5 °C.",
    ]  # fmt: skip
    assert found[4] == "The mass entrains material from the ground."  # porosity differs between the bodies


@pytest.mark.parametrize("name", ["basal", "bed", "body", "mechanisms", "substrate"])
def test_value_in_place_of_a_table_is_an_error(make_run: MakeRun, name: str) -> None:
    folder = make_run()
    text = (folder / "case.toml").read_text()
    (folder / "case.toml").write_text(f"{name} = 5\n{text}")
    with pytest.raises(ReportError, match=f"case.toml: {name}: not a table"):
        page_of(folder)


def test_settings_are_the_keys_that_the_case_gives(make_run: MakeRun) -> None:
    folder = make_run()
    (folder / "case.toml").write_text(
        '[case]\ntitle = "x"\ngravity = 9.81  # m/s2, not given\n[terrain]\nfile = "/srv/me/dem # 1.tif"\n'
        "[body.slide]\ntemperature = -5.0  # C\ntaper = 0.0  # not given\n"
    )
    rows = re.findall(r'<th scope="row">(.*?)</th><td>(.*?)</td><td>(.*?)</td>', settings_of(Run(folder)))
    assert rows == [
        ("case.title", "&quot;x&quot;", ""), ("terrain.file", "&quot;dem # 1.tif&quot;", ""),
        ("body.slide.temperature", "-5.0", "°C"),
    ]  # fmt: skip


def test_page_has_no_absolute_path_and_no_dump_of_run_json(make_run: MakeRun) -> None:
    folder = make_run(snapshots=0)
    inputs = [{"path": "/srv/me/secret/case.toml", "sha256": "ab" * 32, "bytes": 12}]
    update_facts(
        folder, command="/opt/bin/thawslide run /srv/me/secret", host="laptop", inputs=inputs,
        warnings=["/srv/me/secret/dem.tif: has no unit"], parts=[{"host": "laptop", "warnings": ["/srv/me/x/y"]}],
    )  # fmt: skip
    page = page_of(folder.resolve())
    for text in ("/srv/me", "/opt/bin", str(folder.parent), "laptop", "removed particles"):
        assert text not in page, text
    assert "dem.tif: has no unit" in page and '<th scope="row">case.toml</th>' in page


def test_section_shows_start_end_and_maximum_in_the_language(make_run: MakeRun) -> None:
    run = Run(make_run())
    figure = section_extent(run, Messages("de"), 5.0, 4.0)
    words = {text.get_text() for axes in figure.axes if (box := axes.get_legend()) for text in box.get_texts()}
    assert {"am Anfang", "bei 10 s", "Maximum aller Zeiten"} <= words
    assert {"Mächtigkeit (m)", "Distanz (m)"} <= labels(figure)
    start, end = figure.axes[1].lines
    for line, left in ((start, 20.0), (end, 140.0)):  # 20 m long, 4 m thick
        x, thickness = line.get_data()
        known = np.isfinite(thickness)
        assert x[known].min() == pytest.approx(left, abs=11.0) and np.nanmax(thickness) == pytest.approx(4.0)
    area = whole_figure(5.0, 3.0)
    draw_section_arrival(area, run, SAY)
    x, time = area.figure.axes[0].lines[0].get_data()
    assert np.interp(100.0, x, time) == pytest.approx(5.0)  # front at 40 m + 12 m/s
