"""Quantities for reproduction/page_numbers.toml, from a run, a rigid-block run and a generated page."""

from __future__ import annotations

import re
from functools import cached_property
from pathlib import Path

import numpy as np

from reproduction import freezing
from reproduction.lamplugh import deposit, read_block
from reproduction.members import Observed, observed
from thawslide.arrays import Numbers
from thawslide.figures.force import force_in_band, seismic_force
from thawslide.figures.force_record import Comparison, compared, filtered
from thawslide.force_record import PARTS
from thawslide.history import History
from thawslide.key_numbers import stop_time
from thawslide.run_folder import Run
from thawslide.targets import Band
from thawslide.time_reference import time_of_speed


class Curve:
    """Values of the columns of a history: at the end, extremes, and at a time [s]."""

    def __init__(self, history: History) -> None:
        self.series = history

    def end(self, column: str) -> float:
        """Return the last value."""
        return float(self.series[column][-1])

    def maximum(self, column: str) -> float:
        """Return the maximum."""
        return float(np.nanmax(self.series[column]))

    def minimum(self, column: str) -> float:
        """Return the minimum."""
        return float(np.nanmin(self.series[column]))

    def time_of_maximum(self, column: str) -> float:
        """Return the time [s] of the maximum."""
        return float(self.series["time_s"][int(np.nanargmax(self.series[column]))])

    def first_time(self, column: str, value: float) -> float:
        """Return the time [s] at which a column first attains a value, nan if it never does."""
        reached = np.flatnonzero(self.series[column] >= value)
        return float(self.series["time_s"][reached[0]]) if reached.size else float("nan")

    def at(self, time: float, column: str) -> float:
        """Return the value at a time [s]."""
        return float(np.interp(time, self.series["time_s"], self.series[column]))


class Measured(Curve):
    """A run folder."""

    def __init__(self, folder: Path) -> None:
        self.run = Run(folder)
        super().__init__(self.run.series)

    @cached_property
    def observed(self) -> Observed:
        """The results of the case with band columns."""
        return observed(self.run.folder)

    @cached_property
    def peak(self) -> float:
        """The peak of the mean velocity [m/s]."""
        return self.maximum("mean_velocity_m_s")

    @cached_property
    def peak_time(self) -> float:
        """The time [s] of that peak."""
        return self.time_of_maximum("mean_velocity_m_s")

    @cached_property
    def front(self) -> float:
        """The front travel distance [m]."""
        known = self.series["runout_m"][np.isfinite(self.series["runout_m"])]
        return float(known[-1] - known[0])

    def fact(self, name: str) -> float:
        """Return an entry of run.json."""
        return float(self.run.facts[name])

    def speed_reached(self, speed: float) -> float:
        """Return the time [s] at which the mean velocity first attains a value [m/s]."""
        return time_of_speed(self.run, speed)

    def stop(self, below: float) -> float:
        """Return the time [s] from which on the mean velocity is below a value [m/s], inf if there is none."""
        time = stop_time(self.run, below)
        return float("inf") if time is None else time

    def force(self, shortest: float = 0.0, longest: float = 0.0) -> float:
        """Return the maximum seismic force [N] in a band of periods [s], or unfiltered.

        The unfiltered maximum excludes the first second, in which the initial stress adjusts.
        """
        if longest:
            return float(np.nanmax(force_in_band(self.run, Band(shortest, longest))))
        return float(np.nanmax(self._whole_force()))

    @property
    def force_time(self) -> float:
        """The time [s] of the maximum unfiltered force."""
        return float(self.series["time_s"][int(np.nanargmax(self._whole_force()))])

    @property
    def first_force(self) -> tuple[float, float]:
        """Time [s] and value [N] of the maximum force in the first second."""
        first = self.series["time_s"] <= 1.0
        force = np.nan_to_num(seismic_force(self.run)[1][first])
        return float(self.series["time_s"][first][int(np.argmax(force))]), float(force.max())

    def _whole_force(self) -> Numbers:
        return np.asarray(np.where(self.series["time_s"] > 1.0, seismic_force(self.run)[1], np.nan))

    @cached_property
    def comparison(self) -> Comparison:
        """The run and the force record in the record's band."""
        return compared(self.run)

    @property
    def reversal(self) -> float:
        """The time [s] from the maximum upward to the maximum downward value of the vertical force."""
        found = self.comparison.run.reversal
        return found.duration if found else float("nan")

    @property
    def record_reversal(self) -> float:
        """The same time for the force record."""
        found = self.comparison.record.reversal
        return found.duration if found else float("nan")

    def record_force(self, shortest: float, longest: float) -> float:
        """Return the maximum force [N] of the record in a band of periods [s]."""
        record = self.run.force_record
        assert record is not None
        parts = [filtered(record.time, record.best[part], record.time, Band(shortest, longest)) for part in PARTS]
        return float(np.max(np.sqrt(sum(part * part for part in parts))))

    @cached_property
    def freezing_errors(self) -> tuple[float, float]:
        """The maximum and the root mean square error [K] of the freezing bar."""
        return freezing.errors(self.run)

    def depth_of(self, temperature: float) -> float:
        """Return the distance [m] from the cold end of the freezing bar at which it has a temperature [C] at last."""
        x, found = freezing.profile(self.run)
        return float(np.interp(temperature, found, x))

    @property
    def entrained_fraction(self) -> float:
        """The ratio of entrained to initial mass."""
        return self.end("entrained_mass_kg") / float(self.series["mass_kg"][0])

    @property
    def columns_over_slide(self) -> float:
        """The maximum ratio of ice and water in band columns to those in the sliding mass."""
        body = self.series["ice_kg"] + self.series["water_kg"]
        return float(np.max(self.series["column_water_kg"] / body))

    @property
    def volume(self) -> float:
        """The initial volume [m3] of a 3D run."""
        return float(np.sum(self.run.snapshot(0, fields=["volume"])["volume"]))

    @property
    def band_fraction(self) -> float:
        """The fraction of the mass in the scaled band at the start."""
        shot = self.run.snapshot(0, fields=["mass", "in_band"])
        return float(np.sum(shot["mass"] * shot["in_band"]) / np.sum(shot["mass"]))

    @property
    def velocity_noise(self) -> float:
        """The root mean square velocity [m/s] of particles at the end of a 2D run, relative to the mean of their cell.

        Each cell reduces the number of degrees of freedom by one.
        """
        shot = self.run.snapshot(-1)
        cells = np.floor(shot.points[:, :2] / float(self.run.section("grid")["cell"])).astype(np.int64)
        _, cell = np.unique(cells, axis=0, return_inverse=True)
        velocity = np.asarray(shot["velocity"], dtype=np.float64)[:, :2]
        means = [np.bincount(cell, part) / np.bincount(cell) for part in velocity.T]
        apart = velocity - np.stack([mean[cell] for mean in means], axis=1)
        return float(np.sqrt(np.sum(apart**2) / (len(apart) - len(means[0]))))

    def length(self, place: int) -> float:
        """Return the length [m] of the sliding mass in a snapshot, from the last particle to the first."""
        return float(np.ptp(self.run.snapshot(place, fields=["volume"]).points[:, 0]))

    @property
    def hottest_particle(self) -> float:
        """The maximum temperature [C] of a particle in any snapshot."""
        return max(
            float(np.max(self.run.snapshot(place, fields=["temperature"])["temperature"]))
            for place in range(self.run.times.size)
        )

    def deposit_thickness(self, start: float, end: float) -> Numbers:
        """Return the thickness [m] of the deposit from x to x [m], in means over 100 m."""
        x, thickness = deposit(self.run)
        return np.asarray(thickness[(x >= start) & (x <= end)])


class Block(Curve):
    """Table of `thawslide block`."""

    def __init__(self, table: Path) -> None:
        super().__init__(read_block(table))

    @property
    def safety(self) -> float:
        """The safety factor at the start."""
        return float(self.series["sliding_strength_Pa"][0] / self.series["driving_traction_Pa"][0])


def cells_of(line: str) -> list[str]:
    """Return the cells of a row of a table, without bold."""
    return [cell.strip().strip("*") for cell in line.strip().strip("|").split("|")]


def from_table(source: str, column: str, *keys: str) -> float:
    """Return a number of a table in a page, in the row that begins with these cells; the last one of a range.

    KeyError if no table has this column and this row.
    """
    header: list[str] = []
    previous = ""
    for line in source.splitlines():
        if re.fullmatch(r"\|[-| :]+\|", line.strip()):
            header = cells_of(previous)
        elif column in header and (cells := cells_of(line))[: len(keys)] == list(keys):
            value = cells[header.index(column)].partition(" (")[0]
            return float(re.findall(r"[-−]?[\d,]+(?:\.\d+)?", value)[-1].replace(",", "").replace("−", "-"))
        elif not line.startswith("|"):
            header = []
        previous = line
    raise KeyError(f"no table has the column '{column}' and a row that begins with {keys}")
