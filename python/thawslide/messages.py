"""Texts of results and summary in the languages of one table, messages.csv, and quantities in these languages."""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

from thawslide.number_text import area_text, number_text, quantity_text, volume_text
from thawslide.text_files import read_table

LANGUAGES = ("en", "de", "fr")
_MILLION = "million m³"  # as `volume_text` writes it
# Marks of thousands and decimals; the narrow no-break space keeps a number on one line.
_MARKS = {
    "en": str.maketrans({}),
    "de": str.maketrans({",": ".", ".": ","}),
    "fr": str.maketrans({",": "\N{NARROW NO-BREAK SPACE}", ".": ","}),
}
_KMH = 3.6
_MINUTE = 60.0


@cache
def _table() -> dict[str, dict[str, str]]:
    path = Path(str(resources.files("thawslide").joinpath("messages.csv")))
    return {row["key"]: row for _, row in read_table(path, ("key", *LANGUAGES)).rows}


class Messages:
    """Texts by key, and quantities, in one language."""

    def __init__(self, language: str = LANGUAGES[0]) -> None:
        """`language`: one of LANGUAGES."""
        self.language = language

    def __call__(self, key: str, **values: object) -> str:
        """Return a text with values in place of the names in its braces."""
        return _table()[key][self.language].format(**values)

    def localized(self, text: str) -> str:
        """Return a number or quantity in English form with the marks of the language."""
        number, _, unit = text.partition(" ")
        unit = self("million") if unit == _MILLION else unit
        return f"{number.translate(_MARKS[self.language])} {unit}".rstrip()

    def number(self, value: float) -> str:
        """Return a number."""
        return self.localized(number_text(value))

    def quantity(self, value: float, unit: str) -> str:
        """Return a number with its unit."""
        return self.localized(quantity_text(value, unit))

    def volume(self, value: float) -> str:
        """Return a volume [m3]."""
        return self.localized(volume_text(value))

    def area(self, value: float) -> str:
        """Return an area [m2]."""
        return self.localized(area_text(value))

    def speed(self, value: float) -> str:
        """Return a speed [m/s] in km/h."""
        return self.quantity(_KMH * value, "km/h")

    def time(self, value: float) -> str:
        """Return a time [s], from one minute up also in minutes."""
        if value < _MINUTE:
            return self.quantity(value, "s")
        return self("minutes", seconds=self.number(value), minutes=self.localized(number_text(value / _MINUTE, 2)))
