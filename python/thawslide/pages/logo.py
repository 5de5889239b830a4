"""Logo at the top of a report and a summary, from the image that a case names in [report]."""

from __future__ import annotations

import base64
from io import BytesIO

from PIL import Image, UnidentifiedImageError

from thawslide.errors import ReportError
from thawslide.run_folder import Run

_SIZE = (900, 300)  # largest, in pixels
_MOST_PIXELS = 25_000_000


def logo_of(run: Run) -> Image.Image | None:
    """Return the image, not larger than a report shows; None if the case names none, ReportError if it is damaged."""
    path = run.logo
    if path is None:
        return None
    try:
        with Image.open(path, formats=("PNG", "JPEG")) as image:
            if image.width * image.height > _MOST_PIXELS:
                raise ReportError(
                    f"{path}: too large (found {image.width} x {image.height} pixels; allowed {_MOST_PIXELS:,} in "
                    "all). Use a smaller image as report.logo."
                )
            logo = image.convert("RGBA")
    except (UnidentifiedImageError, OSError, ValueError, SyntaxError) as error:
        raise ReportError(f"{path}: not a PNG or JPEG image ({error}). Correct report.logo.") from error
    logo.thumbnail(_SIZE)
    return logo


def logo_html(run: Run) -> list[str]:
    """Return the image as part of a page: one element, or none."""
    logo = logo_of(run)
    if logo is None:
        return []
    buffer = BytesIO()
    logo.save(buffer, format="PNG")
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    return [f'<img class="logo" src="data:image/png;base64,{data}" alt="">']
