"""Reports of damaged run folders: intact data are plotted, damage is named."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, history_columns, write_history
from map_figure_parts import plotted

from thawslide import Run
from thawslide.atomic_file import atomic_file
from thawslide.command_line import main
from thawslide.figures import FIGURES
from thawslide.report_page import make_report


def report(folder: Path, capsys: pytest.CaptureFixture[str], *only: str) -> tuple[int, str, str]:
    """Return exit code, standard error and page, for all figures that suit the run or those named."""
    code = main([str(folder), "--dpi", "50", *(["--only", ",".join(only)] if only else [])])
    page = folder / "report.html"
    return code, capsys.readouterr().err, page.read_text(encoding="utf-8") if page.is_file() else ""


def test_incomplete_last_row_is_a_warning(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    text = (folder / "history.csv").read_text()
    (folder / "history.csv").write_text(text[: len(text) // 2])
    code, errors, page = report(folder, capsys, "motion")
    assert code == 0
    for words in (errors, page):
        assert "history.csv: the last row is incomplete and is ignored" in words


def test_history_without_rows_is_an_error(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    text = (folder / "history.csv").read_text()
    (folder / "history.csv").write_text(text[: text.index("\n") + 1])
    code, errors, page = report(folder, capsys)
    assert (code, page) == (2, "")
    assert "history.csv: no rows after the header. Wait for the first row of the run." in errors


def test_damaged_row_is_an_error_with_its_line(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    lines = (folder / "history.csv").read_text().splitlines(keepends=True)
    lines[40] = lines[40][:30] + "\n"
    (folder / "history.csv").write_text("".join(lines))
    code, errors, _ = report(folder, capsys)
    assert code == 2
    assert "history.csv:41: " in errors
    assert "Repeat the rows after the last checkpoint with `thawslide resume`." in errors


def test_missing_and_damaged_snapshots_are_warnings(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "snapshots" / "000003.vtkhdf").unlink()
    (folder / "snapshots" / "000005.vtkhdf").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    code, errors, page = report(folder, capsys, "velocity")
    assert code == 0
    for words in (errors, page):
        assert "000003.vtkhdf: missing. The figures use the other snapshots." in words
        assert "000005.vtkhdf: cannot be read as HDF5" in words
    assert Run(folder, skip_damaged=True).times.tolist() == [0.0, 1.0, 2.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0]


def test_damaged_field_affects_only_its_figures(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    with h5py.File(folder / "snapshots" / "000004.vtkhdf", "a") as file:
        del file["VTKHDF/PointData/velocity"]
        file["VTKHDF/PointData/velocity"] = np.ones(3)
    code, errors, page = report(folder, capsys)
    assert code == 2
    assert "error: velocity: not plotted: " in errors
    assert "000004.vtkhdf: damaged (found the shape (3,) of 'VTKHDF/PointData/velocity')" in errors
    assert "Not plotted: velocity, interactive view. Section &#x27;Missing figures&#x27; has the reasons." in page
    assert (folder / "figures" / "motion.png").is_file()


def test_missing_run_json_is_a_note(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "run.json").unlink()
    code, _, page = report(folder, capsys, "motion")
    assert code == 0
    assert "There is no run.json: it is unknown whether this run is complete." in page


@pytest.mark.parametrize("text", ['{"status": "running", "simu', "[]", "", "\0" * 50])
def test_incomplete_run_json_is_an_error(make_run: MakeRun, text: str, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "run.json").write_text(text)
    code, errors, page = report(folder, capsys)
    assert (code, page) == (2, "")
    assert "run.json" in errors


def test_page_of_a_killed_run_has_the_command_to_resume(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    (folder / "run.json").write_text(json.dumps({"status": "running", "simulated_time_s": 0.0}))
    code, _, page = report(folder, capsys, "motion")
    assert code == 0
    assert "This run terminated unexpectedly" in page
    assert f"To continue from its last checkpoint: `thawslide resume {folder}`." in page


@pytest.mark.parametrize("damaged", ["max_thickness.tif", "terrain.tif", "results.gpkg"])
def test_damaged_maps_affect_only_their_figures(
    map_run: Path, damaged: str, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = (map_run / "maps" / damaged).read_bytes()
    (map_run / "maps" / damaged).write_bytes(whole[: len(whole) // 2])
    code, errors, page = report(map_run, capsys)
    assert code == 2
    assert f"{damaged}: cannot be read as a Geo" in errors
    assert "Not plotted: " in page
    assert (map_run / "figures" / "motion.png").is_file()


def test_overflow_affects_only_its_figures(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder = make_run()
    columns = history_columns(11, 2)
    for name, values in columns.items():
        if name not in ("time_s", "step"):
            values[5:] = [1e30, 1e200, -1e308, np.inf, -np.inf, np.nan]
    write_history(folder / "history.csv", columns)
    with warnings.catch_warnings(record=True) as noise:
        warnings.simplefilter("always")
        code, errors, page = report(folder, capsys)
    assert [str(each.message) for each in noise if issubclass(each.category, RuntimeWarning)] == []
    assert code == 2
    assert "error: band: not plotted: " in errors
    assert "Not plotted: band. Section &#x27;Missing figures&#x27; has the reasons." in page
    assert (folder / "figures" / "motion.png").is_file()


@pytest.mark.filterwarnings("ignore:Glyph")  # the font has no Chinese
def test_special_characters_are_text(make_run: MakeRun) -> None:
    """A pair of dollar signs would be a formula, and an invalid formula is an error."""
    folder = make_run()
    title = r"$\frac{ 5 $ & <b> 氷 \u0007 x"
    case = (folder / "case.toml").read_text().replace('"Block on a slope & <more>"', json.dumps(title))
    (folder / "case.toml").write_text(case)
    (folder / "inputs" / "targets.csv").write_text(
        'quantity,time_s,value,unit,source\nmean_velocity,4,9,m/s,"$\\nothing$, $5 and $6"\n'
    )
    figure = FIGURES["motion"].plot(Run(folder))
    figure.savefig(folder / "motion.png", dpi=50)
    (speed, _), heading = figure.axes, figure.get_suptitle()
    assert heading == f"{title}: motion"
    assert r"reported: $\nothing$, $5 and $6" in [text.get_text() for text in speed.get_legend().get_texts()]
    assert len(make_report(Run(folder), dpi=50).figures) == 8


def test_title_is_not_a_template(make_run: MakeRun) -> None:
    folder = make_run()
    case = (folder / "case.toml").read_text().replace("Block on a slope & <more>", "BODY of TITLE")
    (folder / "case.toml").write_text(case)
    page = make_report(Run(folder), names=["motion"], dpi=50).page.read_text(encoding="utf-8")
    assert "<title>BODY of TITLE</title>" in page
    assert page.count("<h1>") == 1


def test_failed_write_keeps_the_previous_file(make_run: MakeRun) -> None:
    folder = make_run()
    report = make_report(Run(folder), names=["motion"], dpi=50)
    before = {path: path.read_bytes() for path in (report.page, report.figures["motion"])}
    for path in before:
        with pytest.raises(OSError, match="full"), atomic_file(path) as temporary:
            temporary.write_bytes(b"the first half")
            raise OSError("full")
        assert path.read_bytes() == before[path]
        assert not list(path.parent.glob(".*part*"))


def test_ticks_of_powers_are_formulas(map_run: Path, make_run: MakeRun) -> None:
    figure = FIGURES["energy"].plot(Run(make_run()))
    figure.draw_without_rendering()
    powers = [
        text for axes in figure.axes if axes.get_yscale() == "log" for text in axes.get_yticklabels() if text.get_text()
    ]
    assert powers
    assert all(text.get_parse_math() for text in powers)
    assert plotted("extent_maps", map_run) is not None
