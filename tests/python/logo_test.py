"""Author, scenario and logo of [report] at the top of the report and the summary."""

import base64
import re
from io import BytesIO
from pathlib import Path

import pytest
from conftest import MakeRun, page_of
from PIL import Image

from thawslide import Run
from thawslide.errors import ReportError
from thawslide.pages.logo import logo_of
from thawslide.pages.summary import make_summary

COLOUR = (200, 30, 60)


def with_report(folder: Path, keys: str) -> Path:
    """Add keys to [report] of a run's case file."""
    case = folder / "case.toml"
    text = case.read_text()
    case.write_text(
        text.replace("[report]\n", f"[report]\n{keys}\n") if "[report]" in text else f"{text}\n[report]\n{keys}\n"
    )
    return folder


def write_logo(path: Path, size: tuple[int, int] = (1800, 300)) -> None:
    path.parent.mkdir(exist_ok=True)
    Image.new("RGB", size, COLOUR).save(path)


def images_of(page: str) -> list[Image.Image]:
    """Return the logos of a page."""
    found = re.findall(r'<img class="logo" src="data:image/png;base64,([^"]+)"', page)
    return [Image.open(BytesIO(base64.b64decode(data))) for data in found]


def test_the_report_begins_with_logo_author_and_scenario(make_run: MakeRun) -> None:
    keys = 'author = "Office of <b>hazards"\nscenario = "A serac falls."\nlogo = "inputs/logo.png"'
    folder = with_report(make_run(), keys)
    write_logo(folder / "inputs" / "logo.png")
    page = page_of(folder)
    (logo,) = images_of(page)
    assert logo.size == (900, 150) and logo.convert("RGB").getpixel((5, 5)) == COLOUR
    assert "Office of &lt;b&gt;hazards, computed on" in page and "<p>A serac falls. " in page
    assert page.index('class="logo"') < page.index("<h1>")


def test_the_summary_has_the_logo_on_its_first_page(make_run: MakeRun) -> None:
    folder = make_run()
    without, _ = make_summary(Run(folder))
    assert images_of(without.read_text()) == []
    with_report(folder, 'author = "An office"\nlogo = "inputs/logo.jpg"')
    write_logo(folder / "inputs" / "logo.jpg", (300, 300))
    page, document = make_summary(Run(folder))
    assert len(images_of(page.read_text())) == 1 and "An office, " in page.read_text()
    assert document.stat().st_size > 0


@pytest.mark.parametrize("content", [b"", b"\x89PNG\r\n\x1a\n", b"<svg/>", b"GIF89a"])
def test_a_damaged_logo_is_named(make_run: MakeRun, content: bytes) -> None:
    folder = with_report(make_run(), 'logo = "inputs/logo.png"')
    (folder / "inputs").mkdir(exist_ok=True)
    (folder / "inputs" / "logo.png").write_bytes(content)
    with pytest.raises(ReportError, match=r"logo\.png: not a PNG or JPEG image .*Correct report\.logo"):
        logo_of(Run(folder))


def test_a_logo_of_many_pixels_is_refused(make_run: MakeRun) -> None:
    folder = with_report(make_run(), 'logo = "inputs/logo.png"')
    write_logo(folder / "inputs" / "logo.png", (6000, 5000))
    with pytest.raises(ReportError, match="Use a smaller image"):
        logo_of(Run(folder))
