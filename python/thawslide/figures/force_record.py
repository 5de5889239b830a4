"""Force on the terrain compared with one inverted from seismic waves, both in the same band, at aligned times."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.arrays import Numbers
from thawslide.band_pass import SAMPLES, band_passed, even_times
from thawslide.errors import NotInRunError
from thawslide.figures.force import force_in_band, reported_forces, seismic_force
from thawslide.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    NOTE,
    TIME_LABEL,
    note_below,
    styled,
    time_axis,
    title_figure,
    title_panels,
)
from thawslide.force_record import (
    PARTS,
    ForceRecord,
    Reversal,
    projected,
    projected_ends,
    reversal,
    travel_azimuth,
)
from thawslide.number_text import number_text, prefixed
from thawslide.run_folder import Run
from thawslide.targets import Band, band_of


@dataclass(frozen=True)
class Curves:
    """A force within a band over time [s]: its components [N] upwards and along the direction of travel."""

    time: Numbers
    up: Numbers
    along: Numbers
    reversal: Reversal | None


@dataclass(frozen=True)
class Comparison:
    """Run and record in the band of the record, at times of the run."""

    run: Curves
    record: Curves
    ends: dict[str, tuple[Numbers, Numbers]]  # of the range of the record, by component; empty without a range
    azimuth: float  # degrees, clockwise from north
    shift: float  # s, added to the record's times
    is_aligned: bool


def filtered(time: Numbers, values: Numbers, at: Numbers, band: Band) -> Numbers:
    """Return a band-passed history at other times [s], which may begin before it or end after it."""
    return band_passed(time, values, band.shortest, band.longest, at)


def _times(start: float, end: float, band: Band) -> Numbers:
    return even_times(start, end, band.shortest / SAMPLES, band.shortest, band.longest)


def record_curves(record: ForceRecord) -> Curves:
    """Return the record within its band at its own times, even ones."""
    at = _times(float(record.time[0]), float(record.time[-1]), record.band)
    up, north, east = (filtered(record.time, record.best[part], at, record.band) for part in PARTS)
    return Curves(at, up, projected(north, east, travel_azimuth(record)), reversal(at, up))


def compared(run: Run, other: ForceRecord | None = None) -> Comparison:
    """Return the curves of the figure, of the record of the run or another; NotInRunError without record or width."""
    record = other or run.force_record
    if record is None:
        raise NotInRunError("case.toml: no force record. Specify report.force_record.")
    if run.per_metre:
        raise NotInRunError("case.toml: the force record cannot be compared without a width. Specify case.width.")
    azimuth = travel_azimuth(record)
    of_record = record_curves(record)

    # The first filter covers the run and gives the shift of times; the second covers the time of the record.
    start = float(run.series["time_s"][0])
    preliminary = _curves(run, record, azimuth, start)
    is_aligned = preliminary.reversal is not None and of_record.reversal is not None
    shift = preliminary.reversal.zero - of_record.reversal.zero if preliminary.reversal and of_record.reversal else 0.0
    run_curves = _curves(run, record, azimuth, min(start, float(of_record.time[0]) + shift))
    moved = of_record.reversal.moved(shift) if of_record.reversal else None
    return Comparison(
        run=run_curves,
        record=Curves(of_record.time + shift, of_record.up, of_record.along, moved),
        ends=_ends(record, of_record, azimuth),
        azimuth=azimuth,
        shift=shift,
        is_aligned=is_aligned,
    )


def _curves(run: Run, record: ForceRecord, azimuth: float, start: float) -> Curves:
    """Return the band-passed force of the run from a time [s], which may precede its start, to its end."""
    axes = "xyz"[: run.dimension]
    needed = [f"seismic_force_{axis}_N" for axis in axes] + (["front_position_m"] if run.dimension == 2 else [])
    absent = [name for name in needed if name not in run.series]
    if absent:
        raise NotInRunError(f"history.csv: no column {absent[0]}.")
    parts, _ = seismic_force(run)
    time = run.series["time_s"]
    at = _times(start, float(time[-1]), record.band)
    passed = {axis: filtered(time, values, at, record.band) for axis, values in parts.items()}
    up = passed["xyz"[run.vertical]]
    along = projected(passed["y"], passed["x"], azimuth) if run.dimension == 3 else _direction(run) * passed["x"]
    return Curves(at, up, along, reversal(at, up))


def _direction(run: Run) -> float:
    """Return the sign of the direction of motion along x in a section."""
    front = run.series["front_position_m"]
    return -1.0 if front[-1] < front[0] else 1.0


def _ends(record: ForceRecord, best: Curves, azimuth: float) -> dict[str, tuple[Numbers, Numbers]]:
    """Return the range of the record around its curves; the distances from the best solution are not filtered."""
    if not record.low:
        return {}
    along = projected(record.best["north"], record.best["east"], azimuth)
    ranges = {
        "up": (record.best["up"], record.low["up"], record.high["up"]),
        "along": (along, *projected_ends(record.low, record.high, azimuth)),
    }
    return {
        name: (
            getattr(best, name) + np.interp(best.time, record.time, low - middle),
            getattr(best, name) + np.interp(best.time, record.time, high - middle),
        )
        for name, (middle, low, high) in ranges.items()
    }


def _signed(value: float) -> str:
    return f"{value:+.1f}".replace("-", "−")


def alignment_words(found: Comparison) -> str:
    """Return a sentence on the alignment of times."""
    if not found.is_aligned:
        return "Times are not aligned, because one of the vertical forces does not reverse."
    return (
        f"Times of the record are shifted by {_signed(found.shift)} s to align the sign reversals of both vertical "
        "forces."
    )


def inversion_words(run: Run) -> list[str]:
    """Return a sentence for each reported maximum force: values of the record and the run in the same band."""
    record = run.force_record
    if record is None or run.per_metre:
        return []
    sentences = []
    for target in reported_forces(run):
        stated, band = band_of(target), band_of(target) or record.band
        values = {"reported": target.value}
        if record.band.shortest <= band.shortest and band.longest <= record.band.longest:
            parts = [filtered(record.time, record.best[part], record.time, band) for part in PARTS]
            values["record"] = float(np.max(np.sqrt(sum(part * part for part in parts))))
        values["run"] = float(np.max(force_in_band(run, band)))
        divisor, unit = prefixed(list(values.values()), "N")
        shown = {name: f"{number_text(value / divisor)} {unit}" for name, value in values.items()}
        of_run = (
            f"The record has {shown['record']}, the run {shown['run']}"
            if "record" in shown
            else f"The run has {shown['run']}"
        )
        periods = f"in {band.words}" if stated else f"without a specified band, compared in {band.words}"
        ratio = target.value / values["record"] if values.get("record") else 0.0
        differ = f" The two inversions differ by a factor of {max(ratio, 1.0 / ratio):.2g}." if ratio else ""
        sentences.append(
            f"Maximum force {periods} ({target.source or 'no source'}): {shown['reported']} reported. {of_run}.{differ}"
        )
    return sentences


def caption(run: Run) -> str:
    """Return the caption: filter, alignment, direction, and the agreement of published inversions."""
    record = run.force_record
    assert record is not None
    fixed = (
        f"Force on the terrain minus static weight: run, and inversion of seismic waves ({record.source}). Both are "
        f"filtered to periods of {record.band.words} by the same filter without phase shift. It spreads an onset by up "
        "to half a period; the curve before the start of the run is this effect. The run is assumed to be at rest "
        "before its start and to keep its last force after its end."
    )
    if run.per_metre:
        return fixed
    found = compared(run)
    of_run = "along its section" if run.dimension == 2 else "the same azimuth, with x as east and y as north"
    direction = (
        f"Direction of travel: for the record, the azimuth of the maximum horizontal momentum, {found.azimuth:.0f}°; "
        f"for the run, {of_run}. The momentum is minus the time integral of the force."
    )
    return " ".join([fixed, alignment_words(found), direction, *inversion_words(run)])


@styled
def force_record(run: Run) -> Figure:
    """Plot (a) the vertical force and (b) the force in the direction of travel, of the run and of the record."""
    found = compared(run)
    record = run.force_record
    assert record is not None
    start = float(run.series["time_s"][0])
    both = [found.run.up, found.run.along, found.record.up, found.record.along]
    divisor, unit = prefixed(np.concatenate(both), "N")
    alignment = f"time shifted by {_signed(found.shift)} s" if found.is_aligned else "times not aligned"
    figure = Figure(figsize=(COLUMN_WIDTH, 5.1), layout="constrained")
    title_figure(figure, run.titled("force compared with seismic inversion"))
    panels = list(figure.subplots(2, 1, sharex=True))
    for axes, name in zip(panels, ("up", "along"), strict=True):
        axes.axhline(0.0, color=NOTE, linewidth=0.6)
        for end in [found.ends[name]] if found.ends else []:
            axes.fill_between(found.record.time, end[0] / divisor, end[1] / divisor, color=BLACK, alpha=0.18,
                              linewidth=0, label="range of the inversion")  # fmt: skip
        axes.plot(found.record.time, getattr(found.record, name) / divisor, color=BLACK,
                  label=f"{record.source or 'inversion'}, {alignment}")  # fmt: skip
        values, after = getattr(found.run, name) / divisor, found.run.time >= start
        axes.plot(found.run.time[after], values[after], color=BLUE, label="run")
        axes.plot(
            found.run.time[~after], values[~after], color=BLUE, alpha=0.35, label="filter response before the run"
        )
        axes.axvline(start, color=BLUE, linewidth=0.8, linestyle=":")
        time_axis(axes, found.record.time)
        axes.set_ylabel(f"force ({unit})")
    panels[-1].set_xlabel(TIME_LABEL)
    note_below(figure, _mark_reversals(panels[0], found, divisor))
    panels[0].legend(loc="upper right")
    title_panels(
        panels,
        (
            f"vertical force, positive upwards, periods {record.band.words}",
            f"horizontal force in the direction of travel (record: azimuth {found.azimuth:.0f}°)",
        ),
    )
    return figure


def _mark_reversals(axes: Axes, found: Comparison, divisor: float) -> str:
    """Mark the maximum upward and downward force of both curves; return a sentence on the time between them."""
    durations = []
    for name, curves, colour in (("inversion", found.record, BLACK), ("run", found.run, BLUE)):
        if curves.reversal is None:
            continue
        when = np.array([curves.reversal.upward, curves.reversal.downward])
        axes.plot(when, np.interp(when, curves.time, curves.up) / divisor, "o", color=colour, markersize=5,
                  markerfacecolor="white", label="_marks")  # fmt: skip
        durations.append(f"{name} {curves.reversal.duration:.1f} s")
    return f"From maximum upward to maximum downward force: {', '.join(durations)}." if durations else ""
