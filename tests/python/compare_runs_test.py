"""Page that compares runs, and its command."""

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import Fails, MakeRun, edit, update_facts
from figure_parts import titled
from map_runs import write_map_run

from thawslide import ReportError, Run
from thawslide.command_line import main
from thawslide.figures.run_histories import run_histories
from thawslide.figures.run_maps import run_maps
from thawslide.pages.comparison import case_rows, make_comparison, names_of, number_rows


@pytest.fixture
def two_runs(make_run: MakeRun) -> list[Run]:
    second = make_run(name="second", history={"mean_displacement_m": 16.0 * np.linspace(0.0, 10.0, 101)})
    edit(second / "case.toml", "cell = 2.0", "cell = 4.0")
    return [Run(make_run(name="first")), Run(second)]


def test_histories_key_numbers_and_differences_are_compared(two_runs: list[Run]) -> None:
    figure = run_histories(names_of(two_runs))
    assert [len(axes.lines) for axes in figure.axes] == [2] * 6
    assert [float(np.asarray(line.get_ydata())[-1]) for line in figure.axes[1].lines] == [80.0, 160.0]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["first", "second"]
    rows = {words: values for words, *values in number_rows(names_of(two_runs))}
    assert rows["Mean displacement"] == ["80 m", "160 m"]
    assert rows["Peak mean velocity"] == ["12 m/s (at 5 s)"] * 2
    assert rows["Thermal energy balance"] == ["closes (limit 1 %): below 0.0001 %"] * 2
    assert case_rows(names_of(two_runs)) == [["grid.cell", "2.0", "4.0"]]
    for run, digit in zip(two_runs, "ab", strict=True):
        inputs = [{"path": f"x/{name}", "sha256": digit * 64} for name in ("dem.tif", "case.toml")]
        update_facts(run.folder, inputs=inputs)
    rows = case_rows(names_of([Run(run.folder) for run in two_runs]))
    assert rows[-1] == ["SHA-256 of dem.tif", f"{'a' * 16}...", f"{'b' * 16}..."]


def test_maps_have_one_scale(map_run: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    write_map_run(other, 2)
    figure = run_maps({"one": Run(map_run), "two": Run(other)})
    one, two = titled(figure, "(a) one"), titled(figure, "(b) two")
    norms = [axes.images[-1].norm for axes in (one, two)]
    assert (norms[0].vmin, norms[0].vmax) == (norms[1].vmin, norms[1].vmax) and one.get_xlim() == two.get_xlim()


def test_command_writes_to_first_run(two_runs: list[Run], capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    folders = [str(run.folder) for run in two_runs]
    assert main([*folders, "--dpi", "50"]) == 0
    path = two_runs[0].folder / "comparison.html"
    assert capsys.readouterr().out.rstrip().endswith(f"comparison: {path}")
    assert main([*folders, "--dpi", "50", "--output", str(tmp_path / "elsewhere")]) == 0
    page = (tmp_path / "elsewhere" / "comparison.html").read_text(encoding="utf-8")
    assert page == path.read_text(encoding="utf-8")
    visible = re.sub(r"<script.*?</script>", "", page, flags=re.DOTALL)
    assert not re.search(r"https?://", visible)
    assert all(source.startswith("data:") for source in re.findall(r'src="([^"]*)"', visible))
    assert re.search(r'<tr><th scope="row">grid.cell</th><td data-column="[^"]+">2.0</td><td [^>]*>4.0</td></tr>', page)


def test_runs_of_the_same_name_have_their_paths(make_run: MakeRun) -> None:
    runs = [Run(make_run(name="a/run")), Run(make_run(name="b/run"))]
    assert list(names_of(runs)) == [str(run.folder.resolve()) for run in runs]
    with pytest.raises(ReportError, match="RUN: the same run twice"):
        names_of([runs[0], runs[0]])


def test_2d_and_3d_runs_are_compared(make_run: MakeRun, map_run: Path, tmp_path: Path) -> None:
    page = make_comparison([Run(make_run()), Run(map_run)], tmp_path, 50).read_text(encoding="utf-8")
    assert "2D and 3D runs: areas and volumes are comparable only if the 2D case has a width." in page
    assert "The runs have different time references." not in page


@pytest.mark.parametrize(("option", "name"), [(["--only", "motion"], "--only"), (["--brief"], "--brief")])
def test_options_of_one_run_are_errors_for_two(two_runs: list[Run], option: list[str], name: str, fails: Fails) -> None:
    words = f"{name}: allowed with one RUN only (found 2). Remove the option."
    fails([*(str(run.folder) for run in two_runs), *option], words)
