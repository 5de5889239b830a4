"""Reports of run folders as kills, full disks and damage leave them: what is whole is drawn, the rest is named."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, history_columns, write_history
from map_figure_parts import drawn

from thawslide import Run
from thawslide.command_line import main
from thawslide.figures import FIGURES
from thawslide.report import make_report
from thawslide.whole_file import written_whole


def report(folder: Path, capsys: pytest.CaptureFixture[str], *only: str) -> tuple[int, str, str]:
    """Return exit code, what standard error says, and the page; all figures that suit the run, or those named."""
    code = main([str(folder), "--dpi", "50", *(["--only", ",".join(only)] if only else [])])
    page = folder / "report.html"
    return code, capsys.readouterr().err, page.read_text(encoding="utf-8") if page.is_file() else ""


def test_history_cut_in_the_middle_of_a_row(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    text = (folder / "history.csv").read_text()
    (folder / "history.csv").write_text(text[: len(text) // 2])
    code, told, page = report(folder, capsys, "motion")
    assert code == 0
    for words in (told, page):
        assert "history.csv: the last row was cut off and is left out" in words


def test_history_without_its_first_row(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    text = (folder / "history.csv").read_text()
    (folder / "history.csv").write_text(text[: text.index("\n") + 1])
    code, told, page = report(folder, capsys)
    assert (code, page) == (2, "")
    assert "history.csv: no rows after the header; the run has not written its first row" in told


def test_a_row_damaged_in_the_middle_is_named(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    lines = (folder / "history.csv").read_text().splitlines(keepends=True)
    lines[40] = lines[40][:30] + "\n"
    (folder / "history.csv").write_text("".join(lines))
    code, told, _ = report(folder, capsys)
    assert code == 2
    assert "history.csv:41: " in told
    assert "the row is damaged. `thawslide resume` writes what follows a checkpoint again" in told


def test_a_missing_and_a_damaged_snapshot(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "snapshots" / "000003.vtkhdf").unlink()
    (folder / "snapshots" / "000005.vtkhdf").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    code, told, page = report(folder, capsys, "velocity")
    assert code == 0
    for words in (told, page):
        assert "000003.vtkhdf: not there; the figures have the others" in words
        assert "000005.vtkhdf: cannot be read as HDF5" in words
    assert Run(folder, leave_out_damaged=True).times.tolist() == [0.0, 1.0, 2.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0]


def test_a_snapshot_with_a_damaged_field_costs_its_figures_only(
    make_run: MakeRun, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = make_run()
    with h5py.File(folder / "snapshots" / "000004.vtkhdf", "a") as file:
        del file["VTKHDF/PointData/velocity"]
        file["VTKHDF/PointData/velocity"] = np.ones(3)
    code, told, page = report(folder, capsys)
    assert code == 2
    assert "error: velocity is left out: " in told
    assert "000004.vtkhdf: 'VTKHDF/PointData/velocity' has the shape (3,); it is damaged" in told
    assert "Could not be drawn: velocity. Why stands under Left out." in page
    assert (folder / "figures" / "motion.png").is_file()


def test_no_run_json(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "run.json").unlink()
    code, _, page = report(folder, capsys, "motion")
    assert code == 0
    assert "There is no run.json, so whether this run came to its end is not known." in page


@pytest.mark.parametrize("text", ['{"status": "running", "simu', "[]", "", "\0" * 50])
def test_run_json_cut_off(make_run: MakeRun, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "run.json").write_text(text)
    code, told, page = report(folder, capsys)
    assert (code, page) == (2, "")
    assert "run.json" in told


def test_a_killed_run_says_how_to_go_on(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "run.json").write_text(json.dumps({"status": "running", "simulated_time_s": 0.0}))
    code, _, page = report(folder, capsys, "motion")
    assert code == 0
    assert "This run stopped without a word" in page
    assert f"`thawslide resume {folder}` goes on" in page


@pytest.mark.parametrize("damaged", ["max_thickness.tif", "terrain.tif", "results.gpkg"])
def test_damaged_maps_cost_their_figures_only(map_run: Path, damaged: str, capsys: pytest.CaptureFixture[str]) -> None:
    whole = (map_run / "maps" / damaged).read_bytes()
    (map_run / "maps" / damaged).write_bytes(whole[: len(whole) // 2])
    code, told, page = report(map_run, capsys)
    assert code == 2
    assert f"{damaged}: cannot be read as a Geo" in told
    assert "Could not be drawn: " in page
    assert (map_run / "figures" / "motion.png").is_file()


def test_numbers_of_an_explosion_are_drawn_or_left_out(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    for name, values in columns.items():
        if name not in ("time_s", "step"):
            values[5:] = [1e30, 1e200, -1e308, np.inf, -np.inf, np.nan]
    write_history(folder / "history.csv", columns)
    with warnings.catch_warnings(record=True) as noise:
        warnings.simplefilter("always")
        code, told, page = report(folder, capsys)
    assert [str(each.message) for each in noise if issubclass(each.category, RuntimeWarning)] == []
    assert code == 2
    assert "error: band is left out: " in told
    assert "Could not be drawn: band. Why stands under Left out." in page
    assert (folder / "figures" / "motion.png").is_file()


@pytest.mark.filterwarnings("ignore:Glyph")  # the font has no Chinese
def test_dollar_signs_and_odd_letters_are_text(make_run: MakeRun) -> None:
    """A pair of dollar signs would begin a formula, and a formula with a mistake could not be drawn."""
    folder = make_run()
    title = r"$\frac{ 5 $ & <b> 氷 \u0007 x"
    case = (folder / "case.toml").read_text().replace('"Block on a slope & <more>"', json.dumps(title))
    (folder / "case.toml").write_text(case)
    (folder / "inputs" / "targets.csv").write_text(
        'quantity,time_s,value,unit,source\nmean_velocity,4,9,m/s,"$\\nothing$, $5 and $6"\n'
    )
    figure = FIGURES["motion"].draw(Run(folder))
    figure.savefig(folder / "drawn.png", dpi=50)
    (speed, _), said = figure.axes, figure.get_suptitle()
    assert said == f"{title}: motion of the slide"
    assert r"reported: $\nothing$, $5 and $6" in [text.get_text() for text in speed.get_legend().get_texts()]
    assert len(make_report(Run(folder), dpi=50).figures) == 8


def test_a_title_is_no_part_of_the_page(make_run: MakeRun) -> None:
    folder = make_run()
    case = (folder / "case.toml").read_text().replace("Block on a slope & <more>", "BODY of TITLE")
    (folder / "case.toml").write_text(case)
    page = make_report(Run(folder), names=["motion"], dpi=50).page.read_text(encoding="utf-8")
    assert "<title>BODY of TITLE</title>" in page
    assert page.count("<h1>") == 1


def test_what_cannot_be_written_leaves_the_earlier_file_whole(make_run: MakeRun) -> None:
    folder = make_run()
    report = make_report(Run(folder), names=["motion"], dpi=50)
    before = {path: path.read_bytes() for path in (report.page, report.figures["motion"])}
    for path in before:
        with pytest.raises(OSError, match="full"), written_whole(path) as beside:
            beside.write_bytes(b"the first half")
            raise OSError("full")
        assert path.read_bytes() == before[path]
        assert not list(path.parent.glob(".*part*"))


def test_ticks_of_powers_stay_formulas(map_run: Path, make_run: MakeRun) -> None:
    figure = FIGURES["energy"].draw(Run(make_run()))
    figure.draw_without_rendering()
    powers = [
        text for axes in figure.axes if axes.get_yscale() == "log" for text in axes.get_yticklabels() if text.get_text()
    ]
    assert powers
    assert all(text.get_parse_math() for text in powers)
    assert drawn("extent_maps", map_run) is not None
