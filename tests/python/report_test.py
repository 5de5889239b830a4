"""The page, the key numbers and the command with its exit codes."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import MakeRun, history_columns, write_history

from thawslide import ReportError, Run
from thawslide.clock import clock_note
from thawslide.command_line import main
from thawslide.figures import FIGURES
from thawslide.key_numbers import found_for, key_numbers, shown, stop_time
from thawslide.report import make_report

IN_SECTION = ["motion", "velocity", "plastic_strain", "temperature", "pore_pressure", "force", "band", "energy"]
PNG = b"\x89PNG\r\n\x1a\n"


def numbers(run: Run) -> dict[str, tuple[str, str]]:
    return {row.words: (row.value, row.remark) for row in key_numbers(run)}


def test_key_numbers(make_run: MakeRun) -> None:
    found = numbers(Run(make_run()))
    assert found["Peak mean velocity"] == ("12 m/s", "at 5 s")
    assert found["Runout"][0] == "160 m"
    assert "40 m of it before anything moves" in found["Runout"][1]
    assert found["Way of the front"][0] == "120 m"
    assert found["Mean displacement"][0] == "80 m"
    assert found["Highest mean band temperature"] == ("110 °C", "at 10 s")
    assert found["Highest mean band pore pressure"] == ("1.5 MPa", "at 5 s")
    assert found["Mechanical energy residual"][0] == "1e−09"
    assert found["Thermal energy residual"][0] == "1e−09"
    # sin(pi t / 10)^2 < 0.01 from t = 9.68 s on; rows are 0.1 s apart.
    assert found["Stop time"][0] == "9.7 s"


def test_a_front_that_is_not_known_at_first(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    columns["front_position_m"][:2] = columns["runout_m"][:2] = np.nan
    write_history(folder / "history.csv", columns)
    found = numbers(Run(folder))
    assert found["Runout"] == ("160 m", "front at 10 s less rear at the start")
    assert found["Way of the front"] == ("96 m", "front at 10 s less front at 2 s, the first known")


def test_a_front_that_is_never_known(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    columns["front_position_m"][:] = columns["runout_m"][:] = np.nan
    write_history(folder / "history.csv", columns)
    why = "maps.path is not given, and the slide has hardly moved: no path to measure along"
    found = numbers(Run(folder))
    assert found["Runout"] == found["Way of the front"] == ("not known", why)


def test_a_run_that_has_not_stopped_says_how_fast_it_still_is(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    columns["mean_velocity_m_s"] = np.arange(11.0)
    write_history(folder / "history.csv", columns)
    run = Run(folder)
    assert stop_time(run) is None
    assert numbers(run)["Stop time"] == ("not reached", "mean velocity at 10 s: 10 m/s")


def test_dilation_and_removed_mass_are_rows(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    assert "Volume change by dilation" not in numbers(Run(folder)), "of an older run"
    columns["dilation_share"] = np.linspace(0.0, 0.0625, 11)
    columns["dilation_volume_m3"] = np.linspace(0.0, 250.0, 11)
    columns["mass_kg"], columns["left_mass_kg"] = np.linspace(1e6, 0.75e6, 11), np.linspace(0.0, 0.25e6, 11)
    write_history(folder / "history.csv", columns)
    found = numbers(Run(folder))
    assert found["Volume change by dilation"] == ("+6.2 %", "250 m³; without the bed taken up")
    assert found["Mass removed"] == (
        "250 t",
        "25 % of the mass: left the domain or the terrain model, or removed by guards",
    )
    columns["left_mass_kg"][:] = 0.0
    write_history(folder / "history.csv", columns)
    assert "Mass removed" not in numbers(Run(folder))


@pytest.mark.parametrize(
    ("facts", "message"),
    [
        ('{"status": "done", "at_rest": "no"}', "at_rest must be true, false or null, found no"),
        ('{"status": "done", "warnings": "none"}', "warnings must be a list of texts, found none"),
        ('{"status": "done", "covered_area_m2": "wide"}', "covered_area_m2 must be a number, found wide"),
    ],
)
def test_facts_of_the_end_are_what_they_should_be(make_run: MakeRun, facts: str, message: str) -> None:
    folder = make_run()
    (folder / "run.json").write_text(facts)
    with pytest.raises(ReportError, match=message):
        _ = Run(folder).facts


def test_a_run_that_never_moved(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    for name in columns:
        columns[name] = np.zeros(11) if name != "time_s" else columns[name]
    write_history(folder / "history.csv", columns)
    found = numbers(Run(folder))
    assert found["Peak mean velocity"][0] == "0 m/s"
    assert found["Mechanical energy residual"][0] == "nothing changed"


def test_numbers_are_written_short() -> None:
    assert shown(2.8e11, "N") == "280 GN"
    assert shown(-10.0, "°C") == "−10 °C"
    assert shown(float("nan"), "Pa") == "none"


def test_report_writes_every_figure_and_the_page(make_run: MakeRun) -> None:
    folder = make_run()
    lines: list[str] = []
    report = make_report(Run(folder), dpi=50, progress=lines.append)
    assert list(report.figures) == IN_SECTION
    for name, path in report.figures.items():
        assert path == folder / "figures" / f"{name}.png"
        assert path.read_bytes().startswith(PNG)
    assert len(lines) == len(IN_SECTION)
    assert lines[0] == f"[1/8] motion: {folder / 'figures' / 'motion.png'}"

    page = report.page.read_text(encoding="utf-8")
    assert "<h1>Block on a slope &amp; &lt;more&gt;</h1>" in page
    links = re.findall(r'src="([^"]+)"', page)
    assert links == [f"figures/{name}.png" for name in IN_SECTION]
    assert all((folder / link).is_file() for link in links)
    assert "http" not in page
    assert '<th scope="row">Peak mean velocity</th><td>12 m/s</td><td>at 5 s</td>' in page
    assert '<th scope="row">particle steps per second</th><td>3.1e6</td>' in page
    assert '<th scope="row">momentum to grid</th><td>1.25</td>' in page
    assert "passes 100 °C at 9.3 s and reaches 110 °C. Nothing in the model boils" in page
    assert "This run did not come to its end" not in page


def test_no_note_on_boiling_below_100_degrees(make_run: MakeRun) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    columns["band_temperature_C"] = np.full(11, 99.0)
    write_history(folder / "history.csv", columns)
    report = make_report(Run(folder), names=["motion"], dpi=50)
    assert "Nothing in the model boils" not in report.page.read_text(encoding="utf-8")


def test_a_failed_run_is_called_so(make_run: MakeRun) -> None:
    folder = make_run()
    (folder / "run.json").write_text(json.dumps({"status": "failed", "message": "particle 7 left the domain"}))
    report = make_report(Run(folder), names=["motion"], dpi=50)
    note = "This run did not come to its end (failed): particle 7 left the domain."
    assert note in report.page.read_text(encoding="utf-8")


def test_a_run_that_was_done_before_its_time_says_why(make_run: MakeRun) -> None:
    folder = make_run()
    (folder / "run.json").write_text(json.dumps({"status": "done", "message": "the whole slide has left."}))
    page = make_report(Run(folder), names=["motion"], dpi=50).page.read_text(encoding="utf-8")
    assert "The whole slide has left." in page
    assert "did not come to its end" not in page


def test_command_leaves_out_what_the_run_lacks(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run(snapshots=0)
    assert main([str(folder), "--dpi", "50"]) == 0
    out = capsys.readouterr().out
    assert "Block on a slope & <more>: 101 rows of history, 0 snapshots" in out
    assert f"[2/8] velocity: left out, {folder}: no snapshots" in out
    assert out.rstrip().endswith(f"report: {folder / 'report.html'}")
    assert not (folder / "figures" / "velocity.png").exists()
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "<h2>Left out</h2>" in page
    assert "velocity.png" not in page


def test_command_draws_only_what_is_asked_for_where_it_is_asked(make_run: MakeRun, tmp_path: Path) -> None:
    folder = make_run()
    output = tmp_path / "elsewhere"
    assert main([str(folder), "--output", str(output), "--only", "band,motion", "--dpi", "50"]) == 0
    assert sorted(path.name for path in (output / "figures").iterdir()) == ["band.png", "motion.png"]
    assert (output / "report.html").is_file()
    assert not (folder / "figures").exists()


def test_command_tells_of_a_row_cut_off(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "history.csv").write_text((folder / "history.csv").read_text()[:-5])
    assert main([str(folder), "--only", "motion", "--dpi", "50"]) == 0
    assert "note: " in (message := capsys.readouterr().err)
    assert "the last row was cut off and is left out" in message


def fails(arguments: list[str], text: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(arguments) == 2
    assert text in capsys.readouterr().err


def test_command_errors(make_run: MakeRun, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run(snapshots=0)
    fails([], "error: give a run folder, e.g. thawslide-report runs/lamplugh", capsys)
    fails([str(tmp_path / "no")], "no such folder", capsys)
    known = f"There are: {', '.join(FIGURES)}"
    fails([str(folder), "--only", "bnd"], f"--only: no figure 'bnd'; did you mean band? {known}", capsys)
    fails([str(folder), "--only", "qqq"], f"--only: no figure 'qqq'. {known}", capsys)
    fails([str(folder), "--only", ","], f"--only: names no figure. {known}", capsys)
    fails([str(folder), "--only", "temperature"], "no snapshots; set [time] output_interval", capsys)
    fails(["--setup", "a.json"], "--setup SETUP.json and --picture OUT.png belong together", capsys)
    (tmp_path / "file").write_text("")
    fails([str(folder), "--output", str(tmp_path / "file")], "cannot be written: ", capsys)


@pytest.mark.parametrize("dpi", ["0", "many", "5000"])
def test_command_refuses_odd_resolutions(make_run: MakeRun, dpi: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        main([str(make_run()), "--dpi", dpi])
    assert stop.value.code == 2
    assert f"expected a whole number from 30 to 1200, found '{dpi}'" in capsys.readouterr().err


def test_reported_values_are_compared_on_the_clock_they_name(make_run: MakeRun) -> None:
    folder = make_run()
    run = Run(folder)
    assert "Times count from the start of the run." in make_report(run, names=["motion"], dpi=50).page.read_text()
    targets = next(folder.glob("**/*targets*.csv"))
    # 12 sin2(pi t/10) m/s comes to 6 m/s at 2.5 s of its own.
    targets.write_text("quantity,time_s,value,unit,source\nstart_velocity,4,6,m/s,x\nmean_displacement,7,50,m,x\n")
    run = Run(folder)
    start, displacement = run.targets
    assert run.clock.shift == pytest.approx(1.5, abs=1e-3)
    assert found_for(run, displacement) == "44 m"  # 8 m/s for 5.5 s
    assert found_for(run, start) == "2.5 s after its start"
    page = make_report(run, names=["motion"], dpi=50).page.read_text(encoding="utf-8")
    assert "the mean velocity first reaches 6 m/s at 4 s. The run starts at 1.5 s on it." in page
    panel = FIGURES["motion"].draw(run).axes[1]
    marks = next(drawn for drawn in panel.lines if str(drawn.get_label()).startswith("reported mean"))
    assert marks.get_xdata()[0] == 7.0
    targets.write_text("quantity,time_s,value,unit,source\nstart_velocity,4,60,m/s,x\nmean_displacement,7,50,m,x\n")
    run = Run(folder)
    assert [found_for(run, target) for target in run.targets] == [
        "never",
        "not compared: the run never reaches the speed that sets the clock",
    ]
    assert "It never reaches 60 m/s at 4 s" in clock_note(run)
    (note,) = FIGURES["motion"].draw(run).axes[1].texts
    assert note.get_text() == "1 reported mean not drawn: the run never reaches the speed that sets the clock"
