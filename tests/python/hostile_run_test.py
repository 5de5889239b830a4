"""Reports of damaged run folders: intact data are plotted, damage is named."""

import json
import warnings
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, edit, history_columns, page_of, write_facts, write_history
from map_runs import plotted

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


def history(change: Callable[[str], str]) -> Callable[[Path], None]:
    return lambda folder: write(folder / "history.csv", change((folder / "history.csv").read_text()))


def write(path: Path, text: str) -> None:
    path.write_text(text)


def damage_row(text: str) -> str:
    lines = text.splitlines(keepends=True)
    lines[40] = lines[40][:30] + "\n"
    return "".join(lines)


def damage_snapshots(folder: Path) -> None:
    (folder / "snapshots" / "000003.vtkhdf").unlink()
    (folder / "snapshots" / "000005.vtkhdf").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))


# Damage, exit code, words of standard error, words of the page; without words of the page, there is none.
DAMAGE = {
    "incomplete last row": (
        history(lambda text: text[: len(text) // 2]), 0,
        ["warning: ", "history.csv: the last row is incomplete and is ignored"],
        ["history.csv: the last row is incomplete and is ignored"],
    ),
    "history without rows": (
        history(lambda text: text[: text.index("\n") + 1]), 2,
        ["history.csv: no rows after the header. Wait for the first row of the run."], [],
    ),
    "damaged row": (
        history(damage_row), 2,
        ["history.csv:41: ", "Repeat the rows after the last checkpoint with `thawslide resume`."], [],
    ),
    "missing and damaged snapshots": (
        damage_snapshots, 0, words := [
            "000003.vtkhdf: missing. The figures use the other snapshots.", "000005.vtkhdf: cannot be read as HDF5",
        ], words,
    ),
    "no run.json": (
        lambda folder: (folder / "run.json").unlink(), 0, [],
        ["There is no run.json: it is unknown whether this run is complete."],
    ),
    "killed run": (
        lambda folder: write_facts(folder, status="running", simulated_time_s=0.0), 0, [],
        ["This run terminated unexpectedly", "To continue from its last checkpoint: `thawslide resume FOLDER`."],
    ),
} | {
    f"run.json with {text[:9]!r}": (lambda folder, text=text: write(folder / "run.json", text), 2, ["run.json"], [])
    for text in ('{"status": "running", "simu', "[]", "", "\0" * 50)
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(make_run: MakeRun, capsys: pytest.CaptureFixture[str], name: str) -> None:
    damage, expected, errors_expected, page_expected = DAMAGE[name]
    folder = make_run()
    damage(folder)
    code, errors, page = report(folder, capsys, *(["velocity"] if "snapshots" in name else ["motion"]))
    assert code == expected
    assert all(words in errors for words in errors_expected)
    assert all(words.replace("FOLDER", folder.name) in page for words in page_expected)
    assert bool(page) == bool(page_expected)


def test_damaged_snapshots_have_no_times(make_run: MakeRun) -> None:
    folder = make_run()
    damage_snapshots(folder)
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


@pytest.mark.parametrize("damaged", ["max_thickness.tif", "terrain.tif", "results.gpkg"])
def test_damaged_maps_affect_their_figures(map_run: Path, damaged: str, capsys: pytest.CaptureFixture[str]) -> None:
    whole = (map_run / "maps" / damaged).read_bytes()
    (map_run / "maps" / damaged).write_bytes(whole[: len(whole) // 2])
    code, errors, page = report(map_run, capsys)
    assert code == 2
    assert f"{damaged}: cannot be read as a Geo" in errors
    assert "Not plotted: " in page
    assert (map_run / "figures" / "motion.png").is_file()


def test_overflow_affects_only_its_figures(make_run: MakeRun, capsys: pytest.CaptureFixture[str]) -> None:
    folder, columns = make_run(), history_columns(11, 2)
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
    folder = make_run(targets='quantity,time_s,value,unit,source\nmean_velocity,4,9,m/s,"$\\nothing$, $5 and $6"\n')
    title = r"$\frac{ 5 $ & <b> 氷 \u0007 x"
    edit(folder / "case.toml", '"Block on a slope & <more>"', json.dumps(title))
    figure = FIGURES["motion"].plot(Run(folder))
    figure.savefig(folder / "motion.png", dpi=50)
    (speed, _), heading = figure.axes, figure.get_suptitle()
    assert heading == f"{title}: motion"
    assert r"reported: $\nothing$, $5 and $6" in [text.get_text() for text in speed.get_legend().get_texts()]
    assert len(make_report(Run(folder), dpi=50).figures) == 8


def test_title_is_no_template_and_a_failed_write_keeps_the_file(make_run: MakeRun) -> None:
    folder = make_run()
    edit(folder / "case.toml", "Block on a slope & <more>", "BODY of TITLE")
    page = page_of(folder)
    assert "<title>BODY of TITLE</title>" in page and page.count("<h1>") == 1
    report = make_report(Run(folder), names=["motion"], dpi=50)
    before = {path: path.read_bytes() for path in (report.page, report.figures["motion"])}
    for path in before:
        with pytest.raises(OSError, match="full"), atomic_file(path) as temporary:
            temporary.write_bytes(b"the first half")
            raise OSError("full")
        assert path.read_bytes() == before[path] and not list(path.parent.glob(".*part*"))


def test_ticks_of_powers_are_formulas(map_run: Path, make_run: MakeRun) -> None:
    figure = FIGURES["energy"].plot(Run(make_run()))
    figure.draw_without_rendering()
    logarithmic = [axes for axes in figure.axes if axes.get_yscale() == "log"]
    powers = [text for axes in logarithmic for text in axes.get_yticklabels() if text.get_text()]
    assert powers
    assert all(text.get_parse_math() for text in powers)
    assert plotted("extent_maps", map_run) is not None
