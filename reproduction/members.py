"""Numbers of the Lamplugh case on band columns, over members of initial noise and one at a time."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from reproduction.engine import failure
from reproduction.lamplugh import INVERSION
from reproduction.one_at_a_time import incompleteness
from reproduction.study import Job
from thawslide.errors import ReportError
from thawslide.figures.force import force_in_band
from thawslide.figures.force_record import compared
from thawslide.key_numbers import stop_time
from thawslide.run_folder import Run
from thawslide.time_reference import time_of_speed

NOISE = 0.1  # of the distance of particles
MEMBERS = 20
SET_SPEED, SET_TIME = 8.0, 40.0  # m/s, s: times are aligned by the mean velocity at this time
REST = 0.1  # m/s
MODEL = "Lei et al., MPM"  # source of the rows of the kind "model"
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Observed:
    """Results of a run; nan if not attained, inf for a stop that is not attained."""

    failure: str = ""
    start: float = float("nan")  # s, time of the run: first at SET_SPEED
    end: float = float("nan")  # s, aligned: end of the run
    peak: float = float("nan")  # m/s
    rise: float = float("nan")  # s, from SET_SPEED to the peak
    displacement: float = float("nan")  # km
    runout: float = float("nan")  # km
    stop: float = float("nan")  # s, aligned
    force: float = float("nan")  # TN
    reversal: float = float("nan")  # s, from the maximum upward to the maximum downward force
    dilation: float = float("nan")  # %, growth of the volume
    hottest: float = float("nan")  # C
    ratio: float = float("nan")  # P over averaged N


@dataclass(frozen=True)
class Quantity:
    """A row of the table: its name in Observed, kind, words, unit, reported value, and accepted interval."""

    name: str
    kind: str  # of KINDS
    words: str
    head: str  # of a column
    unit: str
    reported: str
    wanted: str
    least: float
    most: float
    form: str
    is_strict: bool = False  # every member must be inside, not only the median

    @property
    def name_in_text(self) -> str:
        """The words without their explanation."""
        return self.words.partition(":")[0]

    def accepts(self, value: float) -> bool:
        """Return whether a value lies in the interval."""
        return self.least <= value <= self.most + ROUND_OFF

    def text(self, value: float, end: float = float("nan")) -> str:
        """Return a value as text, or that it is not attained by the `end`."""
        if np.isposinf(value):
            return f"not by {end:.0f}" if np.isfinite(end) else "not reached"
        return f"{value:{self.form}}".replace("-", "−") if np.isfinite(value) else "none"


NONE = float("-inf")
# Kinds of rows, with their plural: a bound is a physical limit without observation.
KINDS = {"observation": "observations", "model": "results of other models", "bound": "physical bounds"}
QUANTITIES = (
    Quantity("runout", "observation", "runout: front at the end minus initial rear", "runout", "km", "10.5",
             "9 to 11.5", 9.0, 11.5, ".1f"),
    Quantity("force", "observation", f"force, band-passed {INVERSION.words} (the band is assumed)",
             f"force {INVERSION.words}", "TN", "0.28", "0.22 to 0.34", 0.22, 0.34, ".2f"),
    Quantity("reversal", "observation", "vertical force, 10 to 200 s: from its maximum upward to its maximum "
             "downward value", "force reverses in", "s", "10.6", "8 to 13", 8.0, 13.0, ".1f"),
    Quantity("peak", "model", "peak of the mean velocity", "peak", "m/s", "80", "72 to 88", 72.0, 88.0, ".1f"),
    Quantity("rise", "model", "from 8 m/s to the peak", "to the peak", "s", "35", "28 to 42", 28.0, 42.0, ".1f"),
    Quantity("displacement", "model", "mean displacement", "mean displacement", "km", "5.6 to 5.9", "5.3 to 6.2", 5.3,
             6.2, ".2f"),
    Quantity("stop", "model", "stop: mean velocity below 0.1 m/s", "stop", "s", "before 200", "before 200", NONE, 200.0,
             ".0f"),
    Quantity("hottest", "bound", "hottest of any column", "hottest column", "°C", "", "below 210", NONE, 210.0, ".0f"),
    Quantity("ratio", "bound", "maximum P over averaged N", "P over N", "", "", "at most 1", NONE, 1.0, ".3f", True),
)  # fmt: skip


def observed(folder: Path) -> Observed:
    """Return the results of a run folder, with the reason if it is missing or incomplete."""
    if not (folder / "history.csv").is_file():
        return Observed(failure=failure(folder))
    run = Run(folder)
    history, time = run.series, run.series["time_s"]
    speed = history["mean_velocity_m_s"]
    start, stop = time_of_speed(run, SET_SPEED), stop_time(run, REST)
    shift = SET_TIME - start
    return Observed(
        failure=incompleteness(folder),
        start=start,
        end=float(time[-1]) + shift,
        peak=float(np.nanmax(speed)),
        rise=float(time[int(np.nanargmax(speed))]) - start,
        displacement=float(history["mean_displacement_m"][-1]) / 1e3,
        runout=float(history["runout_m"][-1]) / 1e3,
        stop=float("inf") if stop is None else stop + shift,
        force=float(np.nanmax(force_in_band(run, INVERSION))) / 1e12,
        reversal=_reversal(run),
        dilation=100.0 * float(history["dilation_fraction"][-1]),
        hottest=float(np.nanmax(history["band_max_temperature_C"])),
        ratio=float(np.nanmax(history["band_max_pressure_ratio"])),
    )


def _reversal(run: Run) -> float:
    """Return the time [s] from the maximum upward to the maximum downward value of the vertical force."""
    try:
        found = compared(run).run.reversal
    except ReportError:
        return float("nan")
    return found.duration if found else float("nan")


def member_rows() -> list[Job]:
    """Return the members: the case with initial noise, each with a different seed."""
    return [
        Job(f"member-{seed:02d}", f"seed {seed}", (f"initial.noise={NOISE}", f"initial.seed={seed}"))
        for seed in range(1, MEMBERS + 1)
    ]


def _value_of(case: Mapping[str, Any], key: str) -> Any:
    """Return the value of a key with dots in a resolved case, None without it."""
    found: Any = case
    for part in key.split("."):
        found = found.get(part) if isinstance(found, Mapping) else None
    return found


def _is_set(case: Mapping[str, Any], setting: str) -> bool:
    key, _, text = setting.partition("=")
    value = _value_of(case, key)
    if isinstance(value, bool | str):
        return str(value).lower() == text.lower()
    return isinstance(value, int | float) and float(value) == float(text)


def variant_rows(case: Mapping[str, Any]) -> list[Job]:
    """Return variants that differ from a resolved case in one parameter each, without settings of the case."""
    conductivity = "material.rock_ice.hydraulic_conductivity"
    glacier = "substrate.glacier.friction_coefficient"
    other_boundary = "sealed" if _value_of(case, "pressure.frozen_rows") == "vented" else "vented"
    load_time = 2.0 * float(_value_of(case, "band.load_time"))
    grows = _value_of(case, "band.growth") == "slip"
    # A key of the case cannot be removed: negligible growth represents none.
    other_growth = (
        [
            Job("no-growth", "the band does not grow", ("band.growth_per_slip=1e-12",)),
            Job("e-0.55", "e 0.55 m, and it does not grow", ("band.growth_per_slip=1e-12", "band.thickness=0.55")),
        ]
        if grows
        else [Job("inertial", "the band grows by its inertial number", ("band.growth=inertial",))]
    )
    rows = [
        Job("e-0.15", "e 0.15 m at the start", ("band.thickness=0.15",)),
        Job("e-0.3", "e 0.3 m at the start", ("band.thickness=0.3",)),
        *other_growth,
        Job("no-mixing", "no mixing of the band", ("band.mixing_slip=inf",)),
        Job("mixing-100", "mixing over 100 m of slip", ("band.mixing_slip=100",)),
        Job("heat-0.9", "fraction of work that heats 0.9", ("basal.heat_fraction=0.9",)),
        Job("k-5e-8", "k 5e-8 m/s", (f"{conductivity}=5e-8",)),
        Job("k-2e-7", "k 2e-7 m/s", (f"{conductivity}=2e-7",)),
        Job("glacier-0.10", "friction on the glacier 0.10", (f"{glacier}=0.10",)),
        Job("glacier-0.13", "friction on the glacier 0.13", (f"{glacier}=0.13",)),
        Job("bonds-100", "bonds lost over 100 m", ("basal.slip_distance=100",)),
        Job("skeleton-1e-8", "m_v 1e-8 1/Pa", ("pressure.skeleton_compressibility=1e-8",)),
        Job(f"frozen-{other_boundary}", f"frozen rows {other_boundary}", (f"pressure.frozen_rows={other_boundary}",)),
        Job("no-steam", "no steam: water stays liquid", ("heat.steam=false",)),
        Job(
            "viscosity-0.005",
            "viscosity of the body 0.005 s (shorter step)",
            ("material.rock_ice.viscosity_time=0.005", "time.step=0.007"),
        ),
        Job("broken-20", "broken body of 20 degrees", ("material.rock_ice.residual_friction_angle=20",)),
        Job("load-time", f"N averaged over {load_time:g} s", (f"band.load_time={load_time:g}",)),
    ]
    return [row for row in rows if not all(_is_set(case, setting) for setting in row.sets)]


def _values(found: Sequence[Observed], quantity: Quantity) -> np.ndarray:
    """Return the values of a quantity of the complete members."""
    values = np.array([getattr(each, quantity.name) for each in found if not each.failure], dtype=np.float64)
    return values[~np.isnan(values)]


def median(found: Sequence[Observed], quantity: Quantity) -> float:
    """Return the median over the complete members, nan without any."""
    values = _values(found, quantity)
    return float(np.median(values)) if values.size else float("nan")


def is_met(found: Sequence[Observed], quantity: Quantity) -> bool:
    """Return whether a row is met: by the median, or by every member if it is strict."""
    values = _values(found, quantity)
    if quantity.is_strict:
        return len(values) == len(found) > 0 and all(quantity.accepts(value) for value in values)
    return quantity.accepts(median(found, quantity))


def members_table(found: Sequence[Observed]) -> str:
    """Return the table of members, observations first: reported, accepted, median, range, and whether a row is met."""
    end = min((each.end for each in found if not each.failure), default=float("nan"))
    lines = [
        "| kind | quantity | reported | accepted | median | range | members inside | met |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for each in QUANTITIES:
        values = _values(found, each)
        if values.size:
            low, high = each.text(values.min(), end), each.text(values.max(), end)
            spread = low if low == high else f"{low} to {high}"
        else:
            spread = "none"
        inside = f"{sum(each.accepts(value) for value in values)} of {len(found)}"
        words = f"{each.words} [{each.unit}]" if each.unit else each.words
        cells = (each.kind, words, each.reported, each.wanted, each.text(median(found, each), end), spread, inside)
        lines.append(f"| {' | '.join(cells)} | {'yes' if is_met(found, each) else '**no**'} |")
    return "\n".join(lines)


def verdict(found: Sequence[Observed]) -> str:
    """Return which rows are met, which are not, and which members failed."""
    counts = []
    for kind, words in KINDS.items():
        rows = [each for each in QUANTITIES if each.kind == kind]
        met = [each.name_in_text for each in rows if is_met(found, each)]
        counts.append(f"- {words}: {len(met)} of {len(rows)} ({'; '.join(met) or 'none'})")
    parts = ["Met:\n\n" + "\n".join(counts)]
    missed = [f"- {_miss(found, each)}" for each in QUANTITIES if not is_met(found, each)]
    parts.append("Not met:\n\n" + "\n".join(missed) if missed else "Not met: none.")
    broken = [f"seed {seed} ({' '.join(each.failure.split())})" for seed, each in enumerate(found, 1) if each.failure]
    if broken:
        parts.append(f"Excluded from median and range, because they failed: {'; '.join(broken)}.")
    return "\n\n".join(parts)


def _miss(found: Sequence[Observed], quantity: Quantity) -> str:
    """Return the value of a row that is not met."""
    values = _values(found, quantity)
    if not values.size:
        return f"{quantity.name_in_text}: no member has it (accepted: {quantity.wanted})"
    if quantity.is_strict and all(quantity.accepts(value) for value in values):
        return f"{quantity.name_in_text}: not every member ended (accepted: {quantity.wanted} in each)"
    which, value = ("maximum", float(values.max())) if quantity.is_strict else ("median", median(found, quantity))
    if not np.isfinite(value):
        return f"{quantity.name_in_text}: at least half of the members have none (accepted: {quantity.wanted})"
    number = f"{quantity.text(value)} {quantity.unit}".strip()
    return f"{quantity.name_in_text}: the {which} is {number} (accepted: {quantity.wanted})"


def middle_member(found: Sequence[Observed]) -> int:
    """Return the index of the member nearest to the medians, relative to the intervals with two ends."""
    distances = np.full(len(found), np.inf)
    for place, each in enumerate(found):
        if not each.failure and np.isfinite(each.start):
            distances[place] = sum(
                abs(getattr(each, quantity.name) - median(found, quantity)) / (quantity.most - quantity.least)
                for quantity in QUANTITIES
                if np.isfinite(quantity.least)
            )
    return int(np.argmin(distances))


def variants_table(rows: Sequence[Job], found: Mapping[str, Observed]) -> str:
    """Return one line a run; values outside the accepted interval are bold."""
    heads = [f"{each.kind}: {each.head}" + (f" [{each.unit}]" if each.unit else "") for each in QUANTITIES]
    lines = [f"| run | {' | '.join(heads)} | 8 m/s at [s] | set |", "|---" * (len(heads) + 3) + "|"]
    broken = []
    for row in rows:
        each, sets = found[row.key], " ".join(f"`{setting}`" for setting in row.sets)
        if np.isnan(each.peak):
            lines.append(f"| {row.words} | {each.failure} |{' |' * len(heads)} {sets} |")
            continue
        cells = []
        for quantity in QUANTITIES:
            value = getattr(each, quantity.name)
            text = quantity.text(value, each.end)
            cells.append(text if quantity.accepts(value) else f"**{text}**")
        start = f"{each.start:.1f}" if np.isfinite(each.start) else "never"
        lines.append(f"| {row.words} | {' | '.join(cells)} | {start} | {sets} |")
        if each.failure:
            broken.append(f"- {row.words} failed: {' '.join(each.failure.split())}")
    return "\n".join(lines) + ("\n\n" + "\n".join(broken) if broken else "")


def numbers(members: Sequence[Observed], variants: Mapping[str, Observed]) -> dict[str, float]:
    """Return the numbers for texts of the page: median_peak, least_peak, most_peak, e_0_35_peak and so on."""
    named = {}
    for quantity in QUANTITIES:
        values = _values(members, quantity)
        named[f"median_{quantity.name}"] = median(members, quantity)
        named[f"least_{quantity.name}"] = float(values.min()) if values.size else float("nan")
        named[f"most_{quantity.name}"] = float(values.max()) if values.size else float("nan")
        for key, each in variants.items():
            named[f"{re.sub(r'[^a-z0-9]', '_', key)}_{quantity.name}"] = getattr(each, quantity.name)
    return named
