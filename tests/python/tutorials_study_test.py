"""Figures of the tutorials, taken from the page of a sweep."""

import pytest

from reproduction.studies.tutorials import SWEEP_FIGURES, image_of
from reproduction.study import StudyError
from thawslide.pages.markup import data_address, figure_part


def section(heading: str, data: bytes) -> str:
    part = figure_part(heading, data_address(data, "image/png"), "A caption.")
    return f"<h2>{heading}</h2>\n{part}\n"


def test_figures_are_found_by_the_beginning_of_their_heading() -> None:
    headings = {heading: f"{heading} L" for heading in SWEEP_FIGURES}
    page = "".join(section(words, words.encode()) for words in ("Sensitivity of peak speed", *headings.values()))
    for heading, words in headings.items():
        assert image_of(page, heading) == words.encode()


def test_a_missing_figure_is_an_error() -> None:
    page = "<h2>Probability maps</h2>\n<p>Not available: no member covers any cell.</p>" + section("Spread", b"other")
    with pytest.raises(StudyError, match="Probability maps"):
        image_of(page, "Probability maps")
