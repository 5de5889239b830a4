"""Results at the top of a report: numbers of the run's files, ranges of pairs and ensembles, settings, no paths."""

import csv
import json
import re
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
from conftest import MakeRun, history_columns, page_of, update_facts, write_history
from map_runs import THICKNESS
from matplotlib.figure import Figure

from thawslide import Run
from thawslide.errors import ReportError
from thawslide.figures.area import whole_figure
from thawslide.figures.section_results import draw_section_arrival, section_extent
from thawslide.main_numbers import main_numbers
from thawslide.messages import Messages
from thawslide.pages.client_text import assumptions, plain_numbers
from thawslide.pages.facts import settings_of
from thawslide.pages.ranges import ranges_of

SAY = Messages()


def columns(folder: Path) -> dict[str, np.ndarray]:
    """Return the columns of history.csv without the package."""
    rows = list(csv.DictReader((folder / "history.csv").read_text().splitlines()))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def stated(page: str) -> dict[str, float]:
    """Return the five numbers of the results by name, in m, m2, m3, m/s and s."""
    found = re.findall(r'<dt>(.*?)</dt><dd><span class="value">([\d.,]+) (.*?)</span>', page)
    scale = {"m³": 1.0, "million m³": 1e6, "m": 1.0, "m²": 1.0, "km²": 1e6, "km/h": 1 / 3.6, "s": 1.0}
    return {name: float(value.replace(",", "")) * scale[unit] for name, value, unit in found}


def test_results_of_a_map_run_equal_run_json_and_the_maps(map_run: Path) -> None:
    facts = json.loads((map_run / "run.json").read_text())
    with h5py.File(map_run / "snapshots" / "000000.vtkhdf") as file:
        volume = float(np.sum(file["VTKHDF/PointData/volume"]))
    page = page_of(map_run)
    assert stated(page) == pytest.approx(
        {
            "released volume": volume,
            "travel distance": facts["travel_distance_m"],
            "affected area": facts["affected_area_m2"],
            "maximum thickness": THICKNESS,
            "maximum speed": 20.0,
        },
        rel=5e-3,  # three digits
    )
    assert f"It falls {facts['drop_height_m']:g} m over this distance." in page


def test_results_of_a_section_equal_the_history(make_run: MakeRun) -> None:
    folder = make_run()
    history = columns(folder)
    found = stated(page_of(folder))
    assert found["travel distance"] == pytest.approx(history["runout_m"][-1], rel=5e-3)
    assert found["maximum speed"] == pytest.approx(history["max_velocity_m_s"].max(), rel=5e-3)
    assert list(found) == ["released volume", "travel distance", "maximum thickness", "maximum speed", "duration"]
    slow = history["mean_velocity_m_s"] >= 0.01 * history["mean_velocity_m_s"].max()
    assert found["duration"] == pytest.approx(history["time_s"][np.flatnonzero(slow)[-1] + 1], rel=5e-3)


def test_results_are_the_key_numbers_of_the_diagnosis(map_run: Path) -> None:
    of_table = {row.key: row.number for row in main_numbers(Run(map_run))}
    for each in plain_numbers(Run(map_run), SAY):
        assert each.key in of_table, each


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


def member_of(folder: Path, run: Path) -> Path:
    """Move a run into an ensemble of 21 members whose travel distances are 200, 210, ... 400 m."""
    (folder / "members").mkdir(parents=True)
    (folder / "sweep.json").write_text('{"members": 21}')
    distances = 200.0 + 10.0 * np.arange(21)
    table = {"member": range(21), "status": "done", "travel_distance_m": distances, "error": ""}
    pd.DataFrame(table).to_parquet(folder / "members.parquet")
    return run.rename(folder / "members" / "000008")


def test_member_of_an_ensemble_has_ranges(map_run: Path, tmp_path: Path) -> None:
    assert ranges_of(Run(map_run)) is None
    run = Run(member_of(tmp_path / "forecast", map_run))
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
    case = folder / "case.toml"
    with case.open("a") as file:
        file.write('\n[basal]\nfriction = "lubricated"\nfriction_angle = 21.5\n[substrate.old_ice]\nx_min = 3.0\n')
        file.write(
            '[bed]\nlaw = "friction"\n[body.a]\ntemperature = -5.0\n[body.b]\ntemperature = -5\nporosity = 0.3\n'
        )
    found = assumptions(Run(folder), SAY)
    assert found[:4] == [
        "Friction angle below the mass: 21.5°.",
        "Different friction on parts of the terrain: old ice.",
        "Frictional heat melts ice, and the water reduces friction.",
        "Temperature of the mass at the start: −5 °C.",
    ]
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
        ("case.title", "&quot;x&quot;", ""),
        ("terrain.file", "&quot;dem # 1.tif&quot;", ""),
        ("body.slide.temperature", "-5.0", "°C"),
    ]


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


def titles(figure: Figure) -> set[str]:
    """Return the labels of all axes and legends."""
    labels = {label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel())}
    return labels | {text.get_text() for axes in figure.axes if (box := axes.get_legend()) for text in box.get_texts()}


def test_section_shows_start_end_and_maximum_in_the_language(make_run: MakeRun) -> None:
    run = Run(make_run())
    figure = section_extent(run, Messages("de"), 5.0, 4.0)
    assert {"am Anfang", "bei 10 s", "Maximum aller Zeiten", "Mächtigkeit (m)", "Distanz (m)"} <= titles(figure)
    start, end = figure.axes[1].lines
    for line, left in ((start, 20.0), (end, 140.0)):  # 20 m long, 4 m thick
        x, thickness = line.get_data()
        known = np.isfinite(thickness)
        assert x[known].min() == pytest.approx(left, abs=11.0) and np.nanmax(thickness) == pytest.approx(4.0)
    area = whole_figure(5.0, 3.0)
    draw_section_arrival(area, run, SAY)
    x, time = area.figure.axes[0].lines[0].get_data()
    assert np.interp(100.0, x, time) == pytest.approx(5.0)  # front at 40 m + 12 m/s
