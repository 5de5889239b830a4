"""Animation of the sliding mass on a map, from every snapshot: speed, covered area and time."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, cast

import imageio_ffmpeg
import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.image import AxesImage
from numpy.typing import NDArray

from thawslide.atomic_file import atomic_file
from thawslide.errors import NotInRunError, ReportError
from thawslide.figures.colours import THICKNESS, Painting, colour_range, label_bar, thickness_norm, thickness_words
from thawslide.figures.map_page import WIDTH, MapPage
from thawslide.figures.map_panel import colour_map, paint, quiet_corner, scale_bar
from thawslide.figures.site import Site, make_site
from thawslide.figures.slide_on_map import DEPTH_AVERAGED_SPEED, columns_on, where_thick
from thawslide.figures.style import BLUE, RED, TIME_LABEL, common_style, disable_formulas, time_axis, time_line
from thawslide.maps import Map
from thawslide.run_folder import Run

MOST_FRAMES = 240
_SECONDS = 12.0  # duration, within the limits of the frame rate
_PROGRESS_EVERY = 3.0  # s
_LARGEST_DPI = 128  # 1280 pixels wide
_SLIM = 1.2  # width over height of a map, below which two are placed side by side
_FOOT = 1.3  # inches below the maps, for the mean velocity over time

_COVERED = "#8A4B2A66"

Pixels = NDArray[np.uint8]


class Animation:
    """Animation to be written: one frame for each snapshot, or for evenly spaced ones if there are many."""

    def __init__(self, run: Run) -> None:
        """Select the frames; NotInRunError for a run without maps or with fewer than two snapshots."""
        self.site: Site = make_site(run)
        if len(run.times) < 2:
            raise NotInRunError(
                f"{run.folder}: too few snapshots for an animation (found {len(run.times)}; allowed 2 or more). "
                "Set a shorter time.output_interval and repeat the run."
            )
        count = min(len(run.times), MOST_FRAMES)
        self.indices = [int(index) for index in np.round(np.linspace(0, len(run.times) - 1, count))]
        self.frames_per_second = int(np.clip(round(count / _SECONDS), 2, 25))

    def frames(self, dpi: int) -> Iterator[Pixels]:
        """Yield the frames in order, each of shape (height, width, 3), with even height and width for the codec."""
        with common_style():
            image = _Image(self.site, min(dpi, _LARGEST_DPI))
            disable_formulas(image.page.figure)
            for index in self.indices:
                pixels = image.show(index)
                yield np.ascontiguousarray(pixels[: pixels.shape[0] // 2 * 2, : pixels.shape[1] // 2 * 2])

    def write(self, path: Path, dpi: int, progress: Callable[[str], None] = lambda line: None) -> None:
        """Write an mp4 file (H.264); `progress` receives the number of frames every few seconds."""
        try:
            with atomic_file(path) as temporary:
                self._write_frames(temporary, dpi, lambda text: progress(f"      {path.name}: {text}"))
        except (OSError, RuntimeError) as error:
            raise ReportError(
                f"{path}: cannot be written ({error}). Free space on the disk, or select another --output."
            ) from error

    def _write_frames(self, path: Path, dpi: int, report: Callable[[str], None]) -> None:
        writer = None
        reported = time.monotonic()
        try:
            for number, frame in enumerate(self.frames(dpi), 1):
                if writer is None:
                    size = (frame.shape[1], frame.shape[0])
                    writer = imageio_ffmpeg.write_frames(
                        path,
                        size,
                        fps=self.frames_per_second,
                        quality=8,
                        macro_block_size=2,
                        codec="libx264",
                        ffmpeg_log_level="error",
                    )
                    writer.send(None)
                writer.send(frame)
                if time.monotonic() - reported > _PROGRESS_EVERY:
                    reported = time.monotonic()
                    report(f"frame {number} of {len(self.indices)}")
        finally:
            if writer is not None:
                writer.close()


class _Image:
    """Maps of an animation; only the sliding mass, the covered area and the time change from frame to frame."""

    def __init__(self, site: Site, dpi: int) -> None:
        run = site.run
        self.site = site
        # The thickness is shown as well if the map of speeds does not become smaller.
        self.paintings = (DEPTH_AVERAGED_SPEED, THICKNESS) if site.scene.aspect < _SLIM else (DEPTH_AVERAGED_SPEED,)
        legend = "Dashed: release. Brown: previously covered area."
        note = f"{run.end_note}{legend} {site.scene.note()}"
        title = f"{run.title}: {' and '.join(painting.words for painting in self.paintings)}"
        count = len(self.paintings)
        self.page = page = MapPage(title, site.scene, count, note=note, foot=_FOOT, bar=0.72, narrowest=WIDTH)
        self.covered = np.zeros((site.grid.rows, site.grid.columns), dtype=bool)
        panels = [self._panel(number, painting) for number, painting in enumerate(self.paintings)]
        self.slides = [slide for _, slide in panels]
        self.traces = [trace for trace, _ in panels]
        self.time_title = page.figure.axes[0].set_title("", loc="left", size=10)
        course = page.place(page.left, page.below + 0.1, page.width - page.left - 0.25, 0.68)
        time_line(course, run.series["time_s"], run.series["mean_velocity_m_s"], color=BLUE)
        time_axis(course, run.series["time_s"], TIME_LABEL)
        course.set_ylim(bottom=0.0)
        course.set_title("mean velocity (m/s)", loc="left", size=8, pad=3)
        self.marker = course.axvline(0.0, color=RED, linewidth=1.2)
        page.figure.set_dpi(dpi)
        self._draw_background()

    def _panel(self, number: int, painting: Painting) -> tuple[AxesImage, AxesImage]:
        """Draw a map; return the images of the covered area and of the sliding mass, both empty."""
        site, page = self.site, self.page
        maximum = site.part("max_speed").values if painting is DEPTH_AVERAGED_SPEED else site.reached.values
        values = maximum[np.nan_to_num(maximum) > 0.0]
        _, high, extend = colour_range(values, from_zero=True)
        norm: Normalize = Normalize(0.0, high)
        if painting is THICKNESS:
            norm, extend = thickness_norm(values)
        painter = ScalarMappable(norm, colour_map(painting.colours))
        axes = page.panel(number, labels=True)
        empty = Map(site.grid, np.full(self.covered.shape, np.nan))
        trace = paint(axes, empty, ScalarMappable(Normalize(0.0, 1.0), ListedColormap([_COVERED])))
        slide = paint(axes, empty, painter)
        site.draw_release(axes)
        site.draw_probes(axes)
        if number == 0:
            scale_bar(axes, quiet_corner(site.reached, site.scene.box))
        bar = page.figure.colorbar(painter, cax=page.panel_bar(axes), extend=extend)
        label_bar(bar, norm)
        words = f"{painting.words} ({painting.unit})"
        bar.set_label(thickness_words(norm).replace("; ", "\n") if painting is THICKNESS else words, labelpad=2)
        return trace, slide

    def _draw_background(self) -> None:
        """Draw the constant parts once: redrawing them would take most of the time."""
        self.canvas = cast(Any, FigureCanvasAgg(self.page.figure))  # its methods are untyped
        self.changing: list[Artist] = [self.time_title, self.marker]
        for trace, slide in zip(self.traces, self.slides, strict=True):
            axes = slide.axes
            above = [artist for artist in axes.get_children() if artist.get_zorder() > slide.get_zorder()]
            lines = sorted((artist for artist in above if artist.get_visible()), key=lambda artist: artist.get_zorder())
            self.changing += [trace, slide, *lines]
        for artist in self.changing:
            artist.set_animated(True)
        self.canvas.draw()
        self.background = self.canvas.copy_from_bbox(self.page.figure.bbox)

    def show(self, index: int) -> Pixels:
        """Return the frame of a snapshot, shape (height, width, 3)."""
        columns = columns_on(self.site, index)
        self.covered |= columns.thickness.values > self.site.threshold
        for trace, slide, painting in zip(self.traces, self.slides, self.paintings, strict=True):
            trace.set_data(np.ma.masked_invalid(np.where(self.covered, 1.0, np.nan)))
            field = columns.speed if painting is DEPTH_AVERAGED_SPEED else columns.thickness
            slide.set_data(np.ma.masked_invalid(where_thick(field, columns, self.site.threshold).values))
        time = columns.time
        self.time_title.set_text(f"t = {time:.1f} s")
        self.marker.set_xdata([time, time])
        self.canvas.restore_region(self.background)
        for artist in self.changing:
            self.page.figure.draw_artist(artist)
        return np.asarray(self.canvas.buffer_rgba())[:, :, :3]


def animation(run: Run) -> Animation:
    """Return the animation of a run."""
    return Animation(run)
