"""The force on the ground against one that was inverted from seismic waves, both within its band, on one clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from thawslide.arrays import Numbers
from thawslide.band_pass import SAMPLES, band_passed, even_times
from thawslide.errors import NotInRunError
from thawslide.figures.force import force_in_band, reported_forces, seismic_force
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, NOTE, give_title, letters, prefixed, styled, time_axis
from thawslide.force_record import (
    PARTS,
    ForceRecord,
    Reversal,
    projected,
    projected_ends,
    reversal,
    travel_azimuth,
)
from thawslide.run import Run
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
    """A run and a record within the record's band, both on the clock of the run."""

    run: Curves
    record: Curves
    ends: dict[str, tuple[Numbers, Numbers]]  # of the record's range, by component; empty where it gives none
    azimuth: float  # degrees, clockwise from north
    shift: float  # s, added to the record's times
    aligned: bool


def filtered(time: Numbers, values: Numbers, at: Numbers, band: Band) -> Numbers:
    """Return a history within a band at other times [s], which may begin before it or end after it."""
    return band_passed(time, values, band.shortest, band.longest, at)


def _times(start: float, end: float, band: Band) -> Numbers:
    return even_times(start, end, band.shortest / SAMPLES, band.shortest, band.longest)


def compared(run: Run) -> Comparison:
    """Return what the figure draws; NotInRunError where there is nothing to compare."""
    record = run.force_record
    if record is None:
        raise NotInRunError("the case names no report.force_record")
    if run.per_metre:
        raise NotInRunError("the force record is not drawn: the case states no width (case.width)")
    azimuth = travel_azimuth(record)
    of_record = _times(float(record.time[0]), float(record.time[-1]), record.band)
    up, north, east = (filtered(record.time, record.best[part], of_record, record.band) for part in PARTS)
    theirs = Curves(of_record, up, projected(north, east, azimuth), reversal(of_record, up))

    # A first filter from the start to the end of the run, to find the clock; then over the record's time.
    start = float(run.shown_time[0])
    clock = _curves(run, record, azimuth, start)
    aligned = clock.reversal is not None and theirs.reversal is not None
    shift = clock.reversal.zero - theirs.reversal.zero if clock.reversal and theirs.reversal else 0.0
    ours = _curves(run, record, azimuth, min(start, float(of_record[0]) + shift))
    moved = theirs.reversal.moved(shift) if theirs.reversal else None
    return Comparison(
        run=ours,
        record=Curves(of_record + shift, theirs.up, theirs.along, moved),
        ends=_ends(record, theirs, azimuth),
        azimuth=azimuth,
        shift=shift,
        aligned=aligned,
    )


def _curves(run: Run, record: ForceRecord, azimuth: float, start: float) -> Curves:
    """Return the run's force within the band from a time [s], before its own start too, to the end of the run."""
    axes = "xyz"[: run.dimension]
    needed = [f"seismic_force_{axis}_N" for axis in axes] + (["front_position_m"] if run.dimension == 2 else [])
    absent = [name for name in needed if name not in run.history]
    if absent:
        raise NotInRunError(f"history.csv has no column {absent[0]}")
    parts, _ = seismic_force(run)
    time = run.shown_time
    at = _times(start, float(time[-1]), record.band)
    passed = {axis: filtered(time, values, at, record.band) for axis, values in parts.items()}
    up = passed["xyz"[run.vertical]]
    along = projected(passed["y"], passed["x"], azimuth) if run.dimension == 3 else _towards(run) * passed["x"]
    return Curves(at, up, along, reversal(at, up))


def _towards(run: Run) -> float:
    """Return 1 for a slide that leaves towards +x in a section, -1 for one that leaves towards -x."""
    front = run.history["front_position_m"]
    return -1.0 if front[-1] < front[0] else 1.0


def _ends(record: ForceRecord, best: Curves, azimuth: float) -> dict[str, tuple[Numbers, Numbers]]:
    """Return the ends of the record's range about its curves; the distances from the best solution are not filtered."""
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


def clock_words(found: Comparison) -> str:
    """Return a sentence on how the two clocks were brought together."""
    if not found.aligned:
        return "The clocks are not aligned, as one of the vertical forces does not reverse: t = 0 of both is the same."
    return (
        f"The record's clock is moved by {_signed(found.shift)} s, so that both vertical forces pass 0 between their "
        "largest upward and downward values at the same time."
    )


def inversion_words(run: Run) -> list[str]:
    """Return a sentence for each reported largest force: what the record and the run have in the same band."""
    record = run.force_record
    if record is None or run.per_metre:
        return []
    sentences = []
    for target in reported_forces(run):
        stated, band = band_of(target), band_of(target) or record.band
        values = {"as reported": target.value}
        if record.band.shortest <= band.shortest and band.longest <= record.band.longest:
            parts = [filtered(record.time, record.best[part], record.time, band) for part in PARTS]
            values["in the record"] = float(np.max(np.sqrt(sum(part * part for part in parts))))
        values["in the run"] = float(np.max(force_in_band(run, band)))
        divisor, unit = prefixed(list(values.values()), "N")
        numbers = ", ".join(f"{value / divisor:.3g} {unit} {words}" for words, value in values.items())
        periods = f"in {band.words}" if stated else f"without a stated band, compared in {band.words}"
        ratio = target.value / values["in the record"] if values.get("in the record") else 0.0
        differ = f"; the two inversions differ by a factor of {max(ratio, 1.0 / ratio):.2g}" if ratio else ""
        sentences.append(f"Largest force {periods} ({target.source or 'no source given'}): {numbers}{differ}.")
    return sentences


def caption(run: Run) -> str:
    """Return the figure's caption: filter, clock, direction, and how published inversions agree with one another."""
    record = run.force_record
    assert record is not None
    fixed = (
        f"Force on the ground less the static weight: run, and inversion of seismic waves ({record.source}). Both are "
        f"filtered to periods of {record.band.words} by the same filter. Since timing is compared, the filter has "
        "no phase shift. It therefore spreads by up to half a period before an onset: the curve before the start of "
        "the run is only this effect. The run is assumed to be at rest before its start and to keep its last force "
        "after its end."
    )
    if run.per_metre:
        return fixed
    found = compared(run)
    of_run = "its section" if run.dimension == 2 else "the same, with x as east and y as north"
    way = (
        f"Direction of travel: for the record, the azimuth of {found.azimuth:.0f} degrees, that of the slide's largest "
        f"horizontal momentum, which is minus the time integral of the force; for the run, {of_run}."
    )
    return " ".join([fixed, clock_words(found), way, *inversion_words(run)])


@styled
def force_record(run: Run) -> Figure:
    """Draw the force (a) upwards and (b) along the direction of travel, of the run and of the record."""
    found = compared(run)
    record = run.force_record
    assert record is not None
    start = float(run.shown_time[0])
    both = [found.run.up, found.run.along, found.record.up, found.record.along]
    divisor, unit = prefixed(np.concatenate(both), "N")
    clock = f"clock moved by {_signed(found.shift)} s" if found.aligned else "clocks not aligned"
    figure = Figure(figsize=(COLUMN_WIDTH, 5.1), layout="constrained")
    give_title(figure, run.titled("force and its seismic inversion"))
    panels = list(figure.subplots(2, 1, sharex=True))
    for axes, name in zip(panels, ("up", "along"), strict=True):
        axes.axhline(0.0, color=NOTE, linewidth=0.6)
        for end in [found.ends[name]] if found.ends else []:
            axes.fill_between(found.record.time, end[0] / divisor, end[1] / divisor, color=BLACK, alpha=0.18,
                              linewidth=0, label="range of the inversion")  # fmt: skip
        axes.plot(found.record.time, getattr(found.record, name) / divisor, color=BLACK,
                  label=f"{record.source or 'inversion'}, {clock}")  # fmt: skip
        ours, moves = getattr(found.run, name) / divisor, found.run.time >= start
        axes.plot(found.run.time[moves], ours[moves], color=BLUE, label="run")
        axes.plot(found.run.time[~moves], ours[~moves], color=BLUE, alpha=0.35, label="filter before the run")
        axes.axvline(start, color=BLUE, linewidth=0.8, linestyle=":")
        time_axis(axes, found.record.time)
        axes.set_ylabel(f"force ({unit})")
    panels[-1].set_xlabel(run.clock.label)
    _mark_reversals(panels[0], found, divisor)
    panels[0].legend(loc="upper right")
    letters(
        panels,
        (
            f"vertical, positive upwards, periods of {record.band.words}",
            f"horizontal, positive in the direction of travel (record: azimuth {found.azimuth:.0f}°)",
        ),
    )
    return figure


def _mark_reversals(axes: Axes, found: Comparison, divisor: float) -> None:
    """Mark the largest upward and downward force of both, and write the time between them."""
    for number, (name, curves, colour) in enumerate((("inversion", found.record, BLACK), ("run", found.run, BLUE))):
        if curves.reversal is None:
            continue
        when = np.array([curves.reversal.upward, curves.reversal.downward])
        axes.plot(when, np.interp(when, curves.time, curves.up) / divisor, "o", color=colour, markersize=5,
                  markerfacecolor="white", label="_marks")  # fmt: skip
        words = f"{name}: {curves.reversal.duration:.1f} s from largest upward to largest downward force"
        axes.text(0.99, 0.12 - 0.09 * number, words, transform=axes.transAxes, ha="right", size=8, color=colour)
