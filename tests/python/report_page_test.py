"""Self-contained page of a run: balances, inputs, kept figures, interactive view, published events, author and logo."""

import base64
import json
import os
import re
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import MakeRun, edit, history_columns, page_of, update_facts, write_history
from map_runs import centres, write_map
from PIL import Image

from thawslide import ReportError, Run
from thawslide.balance import balance_note, balances
from thawslide.figures.moments import shown_snapshot
from thawslide.main_numbers import main_numbers
from thawslide.mobility import mobility_of
from thawslide.pages.events import events_part, published_events
from thawslide.pages.logo import logo_of
from thawslide.pages.packing import Packing, unpacked
from thawslide.pages.section_view import MOST_PARTICLES, chosen_particles, section_view
from thawslide.pages.summary import make_summary
from thawslide.pages.view import MOST_SNAPSHOTS
from thawslide.report_page import make_report
from thawslide.section_thickness import particle_thickness, spaced


def element(page: str, name: str) -> str:
    found = re.search(rf'<script type="[^"]+" id="{name}">(.*?)</script>', page, re.DOTALL)
    assert found, name
    return found[1]


def view_of(folder: Path) -> tuple[dict[str, Any], str]:
    page = page_of(folder)
    return json.loads(element(page, "view-parts")), element(page, "view-data")


def field_of(parts: dict[str, Any], words: str) -> dict[str, Any]:
    (found,) = [field for field in parts["fields"] if field["words"] == words]
    return found


@pytest.fixture(params=["2D", "3D"])
def any_run(request: pytest.FixtureRequest, make_run: MakeRun) -> Path:
    if request.param == "2D":
        return make_run()
    folder: Path = request.getfixturevalue("map_run")
    return folder


def test_page_loads_nothing(any_run: Path) -> None:
    page = page_of(any_run)
    visible = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)  # their addresses are not loaded
    assert not re.search(r'https?://|<link|href="//', visible)
    sources = re.findall(r'\b(?:src|srcset|data|poster)="([^"]*)"', visible)
    assert sources and all(source.startswith("data:") for source in sources)
    assert "Content-Security-Policy\" content=\"default-src 'none';" in page and page.count('id="plotly"') == 1
    assert not re.search(r"<script[^>]*\bsrc=", page) and len(page) < 15_000_000


def test_page_with_selected_figures_keeps_the_others(make_run: MakeRun) -> None:
    folder = make_run()
    make_report(Run(folder), names=["motion", "band"], dpi=50)
    report = make_report(Run(folder), names=["force"], dpi=50)
    assert (list(report.figures), list(report.kept)) == (["force"], ["motion", "band"])
    page = report.page.read_text(encoding="utf-8")
    assert re.findall(r'<h2 id="figure-(\w+)">', page) == ["motion", "force", "band"], "order of the page"
    assert "Plotted before the last change of history.csv." not in page
    earlier = (folder / "history.csv").stat().st_mtime - 10.0
    for name in ("force", "band"):
        os.utime(folder / "figures" / f"{name}.png", (earlier, earlier))
    page = page_of(folder, "motion")
    assert page.count("Plotted before the last change of history.csv.") == 2


def test_linked_figures_are_not_kept_and_inputs_have_hashes(make_run: MakeRun, tmp_path: Path) -> None:
    folder = make_run()
    make_report(Run(folder), names=["motion"], dpi=50)
    (tmp_path / "secret.png").write_bytes(b"private")
    (folder / "figures" / "band.png").symlink_to(tmp_path / "secret.png")
    assert not make_report(Run(folder), names=["motion"], dpi=50).kept
    file = {"path": "/cases/x/slope.csv", "sha256": "ab12" * 16, "bytes": 1234}
    update_facts(folder, inputs=[file, {"path": 5}, "text"])
    page = page_of(folder)
    assert f'<th scope="row">slope.csv</th><td>1,234 bytes</td><td>{"ab12" * 16}</td>' in page
    assert '<th scope="row">5</th><td>not known</td><td>not known</td>' in page


def test_balances_have_a_verdict_and_published_events_are_plausible(make_run: MakeRun) -> None:
    folder = make_run(rows=11, history={"mass_residual_kg": np.linspace(0.0, 50.0, 11)})  # of 1e6 kg
    found = balances(Run(folder))
    assert [each.words for each in found] == ["Mass", "Mechanical energy", "Thermal energy"]
    assert all(each.closes for each in found) and balance_note(Run(folder)) == ""
    assert found[0].percentage == "0.005 % of the initial and entrained mass"
    assert found[1].percentage == "below 0.0001 % of the maximum change of any term"
    residual = {"mechanical_residual_J": np.linspace(0.0, 2e11, 11)}  # of 1e13 J
    write_history(folder / "history.csv", history_columns(11, 2) | residual)
    page = page_of(folder)
    row = "<td>does not close (limit 1 %)</td><td>maximum residual 2 % of the maximum change of any term</td>"
    assert f'<th scope="row">Mechanical energy</th>{row}' in page
    assert "The balance of mechanical energy does not close." in page
    events = published_events()
    assert len({event.name for event in events}) == len(events) > 30
    for event in events:
        assert 0.05 < event.ratio < 0.7 and 1e4 < event.volume < 1e9, event
        assert re.search(r"\(\d{4}\)$", event.source), event


@pytest.mark.parametrize("tilt", [40.0, -20.0])
def test_mobility_with_tilted_gravity_is_that_of_the_rotated_slope(make_run: MakeRun, tilt: float) -> None:
    folder = make_run(case_keys=f"gravity_tilt = {tilt}\n")
    found = mobility_of(Run(folder))
    # Independently: turn rear (0, 100), front (160, 20) and the particles until gravity points down.
    turn = np.exp(-1j * np.radians(tilt))
    rear, front = turn * (0 + 100j), turn * (160 + 20j)
    along, above = np.meshgrid(np.arange(0.5, 20.0), np.arange(0.5, 4.0))
    particles = turn * (20.0 + along + 1j * (90.0 - 0.5 * along + above))
    assert found.length == pytest.approx(abs((front - rear).real))
    assert found.height == pytest.approx(particles.imag.max() - front.imag)
    rows = {row.words: row for row in main_numbers(Run(folder))}
    assert rows["Travel distance L"].number == pytest.approx(found.length)
    assert rows["Runout distance"].number == pytest.approx(160.0)
    assert "drop height over travel distance" in rows["H/L"].remark


def test_view_shows_the_terrain_near_the_slide_with_axes_of_the_frame(make_run: MakeRun) -> None:
    folder = make_run(snapshots=3)  # from x = 20.5 m to 63.5 m
    view = section_view(Run(folder)).parts
    assert view["axes"] == ["distance", "elevation"]
    assert view["terrain"][0][2:] == pytest.approx([20.5 - 0.15 * 43.0, 63.5 + 0.15 * 43.0])
    assert view["terrain"][1][2:] == pytest.approx([100.0 - 0.5 * 69.95, 100.0 - 0.5 * 14.05])
    edit(folder / "case.toml", "[case]\n", "[case]\ngravity_tilt = 30.0\n")
    assert section_view(Run(folder)).parts["axes"] == ["distance along x", "height normal to x"]


def test_mobility_with_tilted_gravity_of_a_run_towards_minus_x(make_run: MakeRun) -> None:
    time = np.linspace(0.0, 10.0, 11)
    front = {"front_position_m": 20.0 - time, "runout_m": 20.0 + time}
    folder = make_run(rows=11, history=front, case_keys="gravity_tilt = -40.0\n")
    (folder / "terrain.csv").write_text("distance_m,terrain_elevation_m\n-200,0\n200,0\n")
    angle = np.radians(40.0)
    assert mobility_of(Run(folder)).length == pytest.approx(30.0 * np.cos(angle))  # from x = 40 m to 10 m


def test_main_numbers_of_a_map_run_are_those_of_its_maps_and_an_event(map_run: Path) -> None:
    rows = {row.words: row.value for row in main_numbers(Run(map_run))}
    assert rows.items() >= {
        "Release volume": "28,800 m³", "Peak speed": "20 m/s", "Peak flow thickness": "6 m", "H/L": "0.4",
        "Latest arrival time": "9.8 s", "Arrival time at probe gate": "5 s",
    }.items()  # fmt: skip
    parts = json.loads(element(page_of(map_run), "events-parts"))
    *published, run = parts["traces"]
    assert sum(len(trace["x"]) for trace in published) == len(published_events())
    assert run["name"] == "this run"
    assert (run["x"], run["y"]) == ([pytest.approx(0.0288)], [pytest.approx(112.0 / 280.0)])
    assert parts["layout"]["xaxis"]["type"] == "log"
    for travelled in (None, 0.0, -5.0):
        update_facts(map_run, travel_distance_m=travelled)
        assert events_part({"x": mobility_of(Run(map_run))}) == ""


def test_mobility_and_thickness_of_a_section_are_those_of_profile_and_history(make_run: MakeRun) -> None:
    run = Run(make_run())
    shot = run.snapshot(0)
    thickness = particle_thickness(run, shot)
    inner = (shot.points[:, 0] > 23.0) & (shot.points[:, 0] < 37.0)
    np.testing.assert_allclose(thickness[inner], 4.0)
    found = mobility_of(run)
    # 80 particles of 1 m3 per metre of width, 10 m wide; the highest is 3.5 m above the slope 1/2 at x = 20.5 m.
    assert (found.volume, found.length) == (pytest.approx(800.0), pytest.approx(160.0))
    assert found.height == pytest.approx(0.5 * (160.0 - 20.5) + 3.5)
    # Arrival at 40 + 12 t >= 0.99 * 160.
    expected = {"Release volume": "800 m³", "H/L": "0.46", "Peak flow thickness": "4 m", "Arrival time": "9.9 s"}
    assert expected.items() <= {row.words: row.value for row in main_numbers(run)}.items()


def test_packed_arrays_return_with_16_bits_in_a_limited_amount() -> None:
    packing, values = Packing(), np.array([[1.5, np.nan], [-3.0, 1e4]])
    constant = np.full(3, 7.25)
    places = [packing.add(values), packing.add(constant), packing.add(np.full(2, np.nan)), packing.add(np.zeros(0))]
    text = packing.text()
    assert unpacked(text, places[0]) == pytest.approx(values.ravel(), abs=10_003.0 / 131_068, nan_ok=True)
    assert unpacked(text, places[1]).tolist() == [7.25] * 3 and np.isnan(unpacked(text, places[2])).all()
    assert unpacked(text, places[3]).size == 0
    assert len(spaced(1000, MOST_SNAPSHOTS)) == MOST_SNAPSHOTS and spaced(1000, MOST_SNAPSHOTS)[-1] == 999
    assert spaced(3, MOST_SNAPSHOTS) == [0, 1, 2] and spaced(0, MOST_SNAPSHOTS) == []
    ids = np.arange(1_000_000)
    rows = chosen_particles(ids, len(ids))
    assert len(rows) == pytest.approx(MOST_PARTICLES, rel=0.05)
    counts, _ = np.histogram(rows, bins=10, range=(0, len(ids)))
    assert counts.min() > 0.8 * MOST_PARTICLES / 10, "distributed over the body"
    later = chosen_particles(ids[500_000:], len(ids))
    assert np.array_equal(ids[500_000:][later], rows[rows >= 500_000]), "the same particles"


def test_section_view_has_the_particles_of_each_snapshot(make_run: MakeRun) -> None:
    folder = make_run()
    parts, data = view_of(folder)
    run = Run(folder)
    assert (parts["kind"], len(parts["times"])) == ("section", 11)
    assert {field["words"] for field in parts["fields"]} == {
        "speed", "flow thickness", "equivalent plastic strain", "temperature", "pore pressure", "liquid saturation",
    }  # fmt: skip
    speed, pressure = field_of(parts, "speed"), field_of(parts, "pore pressure")
    assert (speed["unit"], pressure["unit"]) == ("m/s", "MPa")
    places = parts["points"]["particles"]
    for index in range(11):
        shot = shown_snapshot(run, index)
        for packed, values in (
            (places["x"], shot.points[:, 0]), (places["y"], shot.points[:, 1]),
            (speed["values"], np.linalg.norm(shot["velocity"], axis=1)),
            (pressure["values"], shot["pore_pressure"] / 1e6),
        ):  # fmt: skip
            assert unpacked(data, packed[index]) == pytest.approx(values, abs=1e-3)


def test_map_view_has_the_volume_of_the_mass_or_is_missing(map_run: Path) -> None:
    parts, data = view_of(map_run)
    thickness, speed = field_of(parts, "flow thickness"), field_of(parts, "depth-averaged speed")
    area = parts["grid"]["dx"] * parts["grid"]["dy"]
    for index in range(6):
        values = unpacked(data, thickness["values"][index])
        assert np.nansum(values) * area == pytest.approx(28_800.0, rel=2e-3), "without cells below 0.1 m"
        expected = 20.0 if index == 0 else 20.0 * np.sqrt(1.16)  # from the file, and from displacement on the slope
        assert np.nanmax(unpacked(data, speed["values"][index])) == pytest.approx(expected, rel=1e-3)
    reached = unpacked(data, field_of(parts, "maximum flow thickness")["values"][0])
    assert np.count_nonzero(reached > 0.1) * area == pytest.approx(16_800.0)
    assert len(unpacked(data, parts["elevation"])) == len(reached)
    assert {line["words"] for line in parts["lines"]} == {"release", "affected area", "flow path"}
    assert list(parts["probes"]) == ["gate"]
    (map_run / "maps" / "terrain.tif").write_bytes(b"II*\0 damaged")
    page = page_of(map_run)
    assert 'id="view-parts"' not in page and '<th scope="row">Interactive view</th>' in page


def test_units_of_maps_and_settings_are_written_as_in_figures(map_run: Path) -> None:
    x, _ = centres()
    write_map(map_run / "maps" / "max_basal_temperature.tif", np.zeros(x.shape), "C", "maximum temperature")
    with (map_run / "case.toml").open("a") as file:
        file.write("\n[body.slab]\ntemperature = -10.0  # C\ndensity = 900.0  # kg/m3\n")
    page = page_of(map_run)
    for name, value, unit in (
        ("max_basal_temperature.tif", "maximum temperature", "°C"), ("body.slab.temperature", "-10.0", "°C"),
        ("max_momentum_flux.tif", "max momentum flux", "m³/s²"), ("body.slab.density", "900.0", "kg/m³"),
    ):  # fmt: skip
        assert f'<th scope="row">{name}</th><td>{value}</td><td>{unit}</td>' in page


COLOUR = (200, 30, 60)


def with_report(folder: Path, keys: str) -> Path:
    """Add keys to [report] of a run's case file."""
    edit(folder / "case.toml", "[report]\n", f"[report]\n{keys}\n")
    return folder


def write_logo(path: Path, size: tuple[int, int] = (1800, 300)) -> None:
    Image.new("RGB", size, COLOUR).save(path)


def test_the_report_begins_with_logo_author_and_scenario(make_run: MakeRun) -> None:
    keys = 'author = "Office of <b>hazards"\nscenario = "A serac falls."\nlogo = "inputs/logo.png"'
    folder = with_report(make_run(), keys)
    write_logo(folder / "inputs" / "logo.png")
    page = page_of(folder)
    (data,) = re.findall(r'<img class="logo" src="data:image/png;base64,([^"]+)"', page)
    logo = Image.open(BytesIO(base64.b64decode(data)))
    assert logo.size == (900, 150) and logo.convert("RGB").getpixel((5, 5)) == COLOUR
    assert "Office of &lt;b&gt;hazards, computed on" in page and "<p>A serac falls. " in page
    assert page.index('class="logo"') < page.index("<h1>")


def test_the_summary_has_the_logo_on_its_first_page(make_run: MakeRun) -> None:
    folder = make_run()
    assert 'class="logo"' not in make_summary(Run(folder))[0].read_text()
    with_report(folder, 'author = "An office"\nlogo = "inputs/logo.jpg"')
    write_logo(folder / "inputs" / "logo.jpg", (300, 300))
    page, document = make_summary(Run(folder))
    assert page.read_text().count('<img class="logo"') == 1 and "An office, " in page.read_text()
    assert document.stat().st_size > 0


@pytest.mark.parametrize("content", [b"", b"\x89PNG\r\n\x1a\n", b"<svg/>", b"GIF89a"])
def test_damaged_and_too_large_logos_are_named(make_run: MakeRun, content: bytes) -> None:
    folder = with_report(make_run(), 'logo = "inputs/logo.png"')
    (folder / "inputs" / "logo.png").write_bytes(content)
    with pytest.raises(ReportError, match=r"logo\.png: not a PNG or JPEG image .*Correct report\.logo"):
        logo_of(Run(folder))
    write_logo(folder / "inputs" / "logo.png", (6000, 5000))
    with pytest.raises(ReportError, match="Use a smaller image"):
        logo_of(Run(folder))
