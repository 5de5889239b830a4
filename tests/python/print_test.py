"""Figures for journals: width of two columns, letters in order, readable type, 150 dots per inch."""

import re
import struct
from pathlib import Path

import numpy as np
import pytest
from band_columns_test import column_history
from conftest import MakeRun, write_history
from matplotlib.figure import Figure
from matplotlib.text import Text

from reproduction import lamplugh
from thawslide import Run
from thawslide.figures import FIGURES
from thawslide.figures.style import COLUMN_WIDTH, without_title
from thawslide.report_page import make_report

SMALLEST = 6.0  # points


def check(figure: Figure) -> None:
    assert 4.0 <= figure.get_size_inches()[0] <= COLUMN_WIDTH
    figure.draw_without_rendering()
    small = {
        text.get_text(): text.get_fontsize()
        for text in figure.findobj(Text)
        if text.get_text() and text.get_visible() and text.get_fontsize() < SMALLEST
    }
    assert not small
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    letters = [found[1] for title in titles if (found := re.match(r"\((.)\) ", title))]
    assert letters == list("abcdefghijklmnopqrstuvwxyz"[: len(letters)])


def test_figures_have_the_width_of_two_columns(make_run: MakeRun, map_run: Path) -> None:
    folder = make_run()
    names = [name for name, kind in FIGURES.items() if kind.suits(Run(folder))]
    assert len(names) > 5
    for name in names:
        check(FIGURES[name].plot(Run(folder)))
    write_history(folder / "history.csv", column_history())
    for name in ("band", "water"):
        check(FIGURES[name].plot(Run(folder)))
    for name in ("extent_maps", "slide_speed", "cross_sections", "impact_maps"):
        check(FIGURES[name].plot(Run(map_run)))


def test_figures_without_title_have_larger_panels(make_run: MakeRun) -> None:
    figure = FIGURES["band"].plot(Run(make_run()))
    assert figure.get_suptitle()
    figure.draw_without_rendering()
    high = figure.axes[0].get_position().y1
    assert without_title(figure).get_suptitle() == ""
    figure.draw_without_rendering()
    assert figure.axes[0].get_position().y1 > high, "the panels use the space of the title"


@pytest.mark.parametrize("name", ["motion", "velocity"])
def test_images_have_150_dots_per_inch(make_run: MakeRun, name: str) -> None:
    image = make_report(Run(make_run()), names=[name]).figures[name].read_bytes()
    width = struct.unpack(">I", image[16:20])[0]  # of a PNG's first block
    assert width == int(150 * COLUMN_WIDTH)


def test_profile_of_a_deposit_states_its_exaggeration(make_run: MakeRun, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lamplugh, "deposit", lambda run: (np.array([50.0, 150.0]), np.array([3.0, 4.0])))
    monkeypatch.setattr(lamplugh, "zones", lambda run: [])
    figure = lamplugh.figure_deposit({"lamplugh": Run(make_run())})
    section = figure.axes[0]
    width, height = figure.get_size_inches() * section.get_position().size
    (left, right), (low, top) = section.get_xlim(), section.get_ylim()
    times = 1e3 * (right - left) / width * height / (top - low)
    assert section.get_title(loc="left") == f"(a) profile, vertical exaggeration {times:.2g}×"
