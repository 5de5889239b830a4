"""Report page, key numbers, and the command with its exit codes."""

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import Fails, MakeRun, history_columns, numbers, page_of, write_facts, write_history

from thawslide import Run
from thawslide.balance import balances
from thawslide.command_line import main
from thawslide.figures import FIGURES
from thawslide.key_numbers import found_for, quantity_text, stop_time
from thawslide.number_text import unit_text
from thawslide.pages.markup import file_data
from thawslide.report_page import make_report
from thawslide.time_reference import time_note

IN_SECTION = ["motion", "velocity", "plastic_strain", "temperature", "pore_pressure", "force", "band", "energy"]
OF_DIAGNOSIS = ["temperature", "pore_pressure", "band", "energy"]


def test_key_numbers_are_those_of_the_history(make_run: MakeRun) -> None:
    found = numbers(Run(make_run()))
    assert (found["Peak mean velocity"], found["Runout distance L"][0]) == (("12 m/s", "at 5 s"), "160 m")
    assert "initial length 40 m" in found["Runout distance L"][1]
    assert (found["Front travel distance"][0], found["Mean displacement"][0]) == ("120 m", "80 m")
    assert found["Maximum mean band temperature"] == ("110 °C", "at 10 s")
    assert found["Maximum mean band pore pressure"] == ("1.5 MPa", "at 5 s")
    # sin(pi t / 10)^2 < 0.01 from t = 9.68 s on; rows are 0.1 s apart.
    assert found["Stop time"][0] == "9.7 s"


def test_numbers_of_an_unknown_front_a_moving_mass_and_a_mass_at_rest(make_run: MakeRun) -> None:
    unknown = np.full(11, np.nan)
    reason = "no flow path: maps.path is not specified, and the mass has barely moved"
    found = numbers(Run(make_run(rows=11, history={"front_position_m": unknown, "runout_m": unknown})))
    assert found["Runout distance L"] == found["Front travel distance"] == ("not available", reason)
    run = Run(make_run(name="moving", rows=11, history={"mean_velocity_m_s": np.arange(11.0)}))
    assert stop_time(run) is None
    assert numbers(run)["Stop time"] == ("not reached", "mean velocity at 10 s: 10 m/s")
    still = {name: np.zeros(11) for name in history_columns(11, 2) if name != "time_s"}
    run = Run(make_run(name="still", rows=11, history=still))
    assert numbers(run)["Peak mean velocity"][0] == "0 m/s"
    assert [balance.percentage for balance in balances(run)] == ["0 % of the maximum change of any term"] * 2


def test_dilation_and_removed_mass_are_rows(make_run: MakeRun) -> None:
    folder, columns = make_run(), history_columns(11, 2)
    assert "Volume change by dilation" not in numbers(Run(folder)), "history of an earlier version"
    columns["dilation_fraction"] = np.linspace(0.0, 0.0625, 11)
    columns["dilation_volume_m3"] = np.linspace(0.0, 250.0, 11)
    columns["mass_kg"], columns["left_mass_kg"] = np.linspace(1e6, 0.75e6, 11), np.linspace(0.0, 0.25e6, 11)
    write_history(folder / "history.csv", columns)
    found = numbers(Run(folder))
    assert found["Volume change by dilation"] == ("+6.2 %", "250 m³; without entrained bed material")
    assert found["Mass removed"] == ("250 t", "25 % of the mass: left the domain or the DEM, or removed by guards")
    columns["left_mass_kg"][:] = 0.0
    write_history(folder / "history.csv", columns)
    assert "Mass removed" not in numbers(Run(folder))


def test_quantities_have_prefixes_and_three_digits() -> None:
    values = [(2.8e11, "N"), (np.nan, "Pa"), (2848.0, "m"), (12345.0, "m"), (5.2e7, "m3"), (-10.0, "C"), (-10.0, "°C")]
    texts = ["280 GN", "none", "2,850 m", "12,300 m", "52 million m³", "−10 °C", "−10 °C"]
    assert [quantity_text(value, unit) for value, unit in values] == texts
    assert quantity_text(5612.5, "m", 6) == "5,612.5 m"
    assert [unit_text(unit) for unit in ("m3/s2", "degC", "kg/m3", "1/Pa", "")] == ["m³/s²", "°C", "kg/m³", "1/Pa", ""]


def test_report_has_all_figures_and_the_page(make_run: MakeRun) -> None:
    folder = make_run()
    lines: list[str] = []
    report = make_report(Run(folder), dpi=50, progress=lines.append)
    assert list(report.figures) == IN_SECTION
    for name, path in report.figures.items():
        assert path == folder / "figures" / f"{name}.png" and path.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    assert (len(lines), lines[0]) == (len(IN_SECTION), f"[1/8] motion: {folder / 'figures' / 'motion.png'}")
    page = report.page.read_text(encoding="utf-8")
    assert "<h1>Block on a slope &amp; &lt;more&gt;</h1>" in page
    extent, *shown = re.findall(r'src="([^"]+)"', page)
    assert extent.startswith("data:image/png;base64,")
    in_order = sorted(IN_SECTION, key=lambda name: name in OF_DIAGNOSIS)
    assert shown == [file_data(report.figures[name]) for name in in_order]
    places = [page.index(f'<details id="{name}" class="part">') for name in ("numbers", "diagnosis")]
    assert places == sorted(places)
    assert [name for name in IN_SECTION if page.index(f'<h2 id="figure-{name}">') > places[1]] == OF_DIAGNOSIS
    assert '<th scope="row">Peak mean velocity</th><td>12 m/s</td><td>at 5 s</td>' in page
    assert '<th scope="row">particle steps per second</th><td>3,100,000</td>' in page
    assert '<th scope="row">momentum to grid</th><td>1.25</td>' in page
    assert "exceeds 100 °C from 9.3 s on and attains 110 °C. Water does not boil because the model has no" in page
    assert "This run is incomplete" not in page


def test_page_has_the_message_of_the_end_and_no_note_below_boiling(make_run: MakeRun) -> None:
    folder = make_run(rows=11, history={"band_temperature_C": np.full(11, 99.0)})
    assert "Water does not boil" not in page_of(folder)
    folder = make_run(name="failed", facts={"status": "failed", "message": "particle 7 left the domain"})
    assert "This run is incomplete (failed): particle 7 left the domain." in page_of(folder)
    write_facts(folder, message="the whole slide has left.")
    page = page_of(folder)
    assert "The whole slide has left." in page and "incomplete" not in page


def test_command_lists_missing_figures(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run(snapshots=0)
    assert main([str(folder), "--dpi", "50"]) == 0
    out = capsys.readouterr().out
    assert "Block on a slope & <more>: 101 rows of history, 0 snapshots" in out
    assert f"[2/8] velocity: not available: {folder}: no snapshots" in out
    assert out.rstrip().endswith(f"report: {folder / 'report.html'}")
    assert not (folder / "figures" / "velocity.png").exists()
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "<h2>Missing figures</h2>" in page and "velocity.png" not in page


def test_command_errors_state_problem_and_remedy(make_run: MakeRun, tmp_path: Path, fails: Fails) -> None:
    folder = make_run(snapshots=0)
    fails([], "error: RUN: not specified. Specify a run folder, e.g. thawslide-report runs/lamplugh.")
    fails([str(tmp_path / "no")], "no such folder")
    known = f"Allowed: {', '.join(FIGURES)}"
    fails([str(folder), "--only", "bnd"], f"--only: no figure 'bnd'; did you mean band? {known}")
    fails([str(folder), "--only", "qqq"], f"--only: no figure 'qqq'. {known}")
    fails([str(folder), "--only", ","], f"--only: no figure name. {known}")
    fails([str(folder), "--only", "temperature"], "no snapshots. Set time.output_interval and repeat the run.")
    fails(["--setup", "a.json"], "--setup: requires --picture, and no RUN.")
    (tmp_path / "file").write_text("")
    fails([str(folder), "--output", str(tmp_path / "file")], "cannot be written (")


@pytest.mark.parametrize("dpi", ["0", "many", "5000"])
def test_invalid_resolutions_are_errors(make_run: MakeRun, dpi: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main([str(make_run()), "--dpi", dpi])
    assert stop.value.code == 2
    assert f"not a valid resolution (found '{dpi}'; allowed whole numbers from 30 to 1200)" in capsys.readouterr().err


def test_reported_values_are_compared_at_times_of_the_run(make_run: MakeRun) -> None:
    folder = make_run()
    page = page_of(folder)
    assert page.index("Times are measured from the start of the run.") > page.index("Reported values</summary>")
    targets = next(folder.glob("**/*targets*.csv"))
    # 12 sin2(pi t/10) m/s is 6 m/s at 2.5 s of the run.
    targets.write_text("quantity,time_s,value,unit,source\nstart_velocity,4,6,m/s,x\nmean_displacement,7,50,m,x\n")
    run = Run(folder)
    start, displacement = run.targets
    assert (start.time, displacement.time) == pytest.approx((2.5, 5.5), abs=1e-3)
    assert found_for(run, displacement) == "44 m"  # 8 m/s for 5.5 s
    assert found_for(run, start) == "2.5 s after the start"
    page = page_of(folder)
    note = "Those of reported values are shifted: the mean velocity first attains 6 m/s at 2.5 s."
    assert page.count(note) == 1 and page.index("Reported values</summary>") < page.index(note)
    for words in ("mean velocity that sets the times", "mean displacement"):
        assert f'<th scope="row">{words}</th>' in page
    targets.write_text("quantity,time_s,value,unit,source\nstart_velocity,4,60,m/s,x\nmean_displacement,7,50,m,x\n")
    run = Run(folder)
    never = ["never", "not compared: the run never attains start_velocity"]
    assert [found_for(run, target) for target in run.targets] == never
    assert "It never attains 60 m/s." in time_note(run)
    labels = [str(found.get_label()).replace("\n", " ") for found in FIGURES["motion"].plot(run).axes[1].lines]
    assert "1 reported value of mean displacement not shown: the run never attains start_velocity" in labels
