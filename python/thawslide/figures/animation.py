"""A film of the slide over its terrain, from every snapshot: speed, the ground it has passed, and a clock."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, cast

import imageio_ffmpeg
import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from numpy.typing import NDArray

from thawslide.errors import NotInRunError, ReportError
from thawslide.figures.colours import colour_range
from thawslide.figures.map_panel import MapPage, colour_map, paint, quiet_corner, scale_bar
from thawslide.figures.site import Site, make_site
from thawslide.figures.slide_on_map import SPEED, columns_on, where_thick
from thawslide.figures.style import BLUE, RED, STYLE, time_axis, time_line
from thawslide.run import Run

MOST_FRAMES = 240
_SECONDS = 12.0  # that a film lasts, where its frames are neither too slow nor too fast
_TELL_EVERY = 3.0  # s
_LARGEST_DPI = 128  # 1280 pixels wide
_ASPECTS = (1.4, 2.4)  # of the map: films are wider than high
_FOOT = 1.62  # inches below the map, for colourbar, course of the speed and notes

Pixels = NDArray[np.uint8]


class Film:
    """A film still to be written: one frame for each snapshot, or for evenly chosen ones where there are many."""

    def __init__(self, run: Run) -> None:
        """Choose the frames; NotInRunError for a run without maps or without snapshots to move between."""
        self.site: Site = make_site(run, _ASPECTS)
        if len(run.times) < 2:
            raise NotInRunError(f"{run.folder}: an animation needs two snapshots; set [time] output_interval")
        count = min(len(run.times), MOST_FRAMES)
        self.indices = [int(index) for index in np.round(np.linspace(0, len(run.times) - 1, count))]
        self.frames_per_second = int(np.clip(round(count / _SECONDS), 2, 25))

    def frames(self, dpi: int) -> Iterator[Pixels]:
        """Yield the frames in order, each of shape (height, width, 3), both even as films need it."""
        with mpl.rc_context(cast(Any, STYLE)):
            picture = _Picture(self.site, min(dpi, _LARGEST_DPI))
            for index in self.indices:
                pixels = picture.show(index)
                yield np.ascontiguousarray(pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2])

    def write(self, path: Path, dpi: int, progress: Callable[[str], None] = lambda line: None) -> None:
        """Write an mp4 file (H.264, which browsers and slides play); progress tells every few seconds how far it is."""
        beside = path.with_name(f"{path.stem}.part{path.suffix}")
        writer = None
        told = time.monotonic()
        try:
            for number, frame in enumerate(self.frames(dpi), 1):
                if writer is None:
                    size = (frame.shape[1], frame.shape[0])
                    writer = imageio_ffmpeg.write_frames(
                        beside, size, fps=self.frames_per_second, quality=8, macro_block_size=2, codec="libx264"
                    )
                    writer.send(None)
                writer.send(frame)
                if time.monotonic() - told > _TELL_EVERY:
                    told = time.monotonic()
                    progress(f"      {path.name}: frame {number} of {len(self.indices)}")
            if writer is not None:
                writer.close()
                writer = None
            beside.replace(path)
        except (OSError, RuntimeError) as error:
            raise ReportError(f"{path}: the film cannot be written: {error}") from error
        finally:
            if writer is not None:
                writer.close()
            beside.unlink(missing_ok=True)


class _Picture:
    """The map of a film, of which only the slide, the clock and what it has passed change from frame to frame."""

    def __init__(self, site: Site, dpi: int) -> None:
        run = site.run
        self.site = site
        _, high, extend = colour_range(_positive(site.part("max_speed").values), from_zero=True)
        painter = ScalarMappable(Normalize(0.0, high), colour_map(SPEED.colours))
        self.page = page = MapPage(f"{run.title}: {SPEED.words}", site.scene, 1, _FOOT)
        self.axes = page.panel(0, labels=True)
        self.passed = np.zeros((site.grid.rows, site.grid.columns), dtype=bool)
        veil = ScalarMappable(Normalize(0.0, 1.0), ListedColormap(["#00000000", "#8A4B2A66"]))
        empty = np.full(self.passed.shape, np.nan)
        field = site.reached
        self.trace = paint(self.axes, type(field)(site.grid, empty), veil)
        self.slide = paint(self.axes, type(field)(site.grid, empty), painter)
        site.draw_release(self.axes)
        site.draw_probes(self.axes)
        scale_bar(self.axes, quiet_corner(site.reached, site.scene.box))
        bar_axes = page.place(page.LEFT, page.height - 1.1, 3.6, 0.14)
        bar = page.figure.colorbar(painter, cax=bar_axes, orientation="horizontal", extend=extend)
        bar.set_label(f"speed ({SPEED.unit})", labelpad=1)
        drawn = [artist for artist in self.axes.get_children() if artist.get_zorder() > self.slide.get_zorder()]
        self.above = sorted(
            (artist for artist in drawn if artist.get_visible()), key=lambda artist: artist.get_zorder()
        )
        self.clock = self.axes.set_title("", loc="left", size=12)
        course = page.place(page.LEFT + 4.6, page.height - 1.48, page.WIDTH - page.LEFT - 4.6 - page.RIGHT, 0.72)
        time_line(course, run.history["time_s"], run.history["mean_velocity_m_s"], color=BLUE)
        time_axis(course, run.history["time_s"])
        course.set_ylim(bottom=0.0)
        course.set_ylabel("mean speed\n(m/s)")
        self.hand = course.axvline(0.0, color=RED, linewidth=1.2)
        page.note(f"Dashed: release. Brown: passed by the slide. {site.scene.note()}")
        page.figure.set_dpi(dpi)
        self.canvas = cast(Any, FigureCanvasAgg(page.figure))  # its methods are untyped
        # Drawing all anew would take most of the time of a film: what does not change is drawn once.
        self.changing = [self.trace, self.slide, *self.above, self.clock, self.hand]
        for artist in self.changing:
            artist.set_animated(True)
        self.canvas.draw()
        self.still = self.canvas.copy_from_bbox(page.figure.bbox)

    def show(self, index: int) -> Pixels:
        """Return the picture of a snapshot, shape (height, width, 3)."""
        columns = columns_on(self.site, index)
        self.passed |= columns.thickness.values > self.site.threshold
        self.trace.set_data(np.where(self.passed, 1.0, np.nan))
        field = where_thick(columns.speed, columns, self.site.threshold)
        self.slide.set_data(np.ma.masked_invalid(field.values))
        self.clock.set_text(f"t = {columns.time:.1f} s")
        self.hand.set_xdata([columns.time, columns.time])
        self.canvas.restore_region(self.still)
        for artist in self.changing:
            self.page.figure.draw_artist(artist)
        return np.asarray(self.canvas.buffer_rgba())[:, :, :3]


def _positive(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return values[np.nan_to_num(values) > 0.0]


def animation(run: Run) -> Film:
    """Return the film of a run."""
    return Film(run)
