"""Sec. 3.1: freezing bar compared with an enthalpy finite-volume solution of the same equation (Fig. 4)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reproduction.mixture import FREEZING_BAR, HeatTable, Mixture, linear_saturation
from reproduction.runs import BARS, PRINTED
from thawslide.figures.style import BLACK, BLUE, COLUMN_WIDTH, GREEN, ORANGE, RED, styled, title_panels
from thawslide.run_folder import Numbers, Run

COLD_END = -3.0  # C
LENGTH = 2.0  # m
COMPARED = 0.95  # m: range of the errors
CELLS = 800


@lru_cache(maxsize=16)
def reference(
    slope: float, latent: bool, time: float, cells: int = CELLS, mixture: Mixture = FREEZING_BAR
) -> tuple[Numbers, Numbers]:
    """Return (x [m], T [C]) of the bar at a time [s]: explicit finite volumes for its heat, far end insulated."""
    saturation = linear_saturation(slope)
    table = HeatTable(mixture, saturation, COLD_END, latent)
    size = LENGTH / cells
    x: Numbers = np.asarray((np.arange(cells) + 0.5) * size, dtype=np.float64)
    ones = np.ones(1)
    largest_diffusivity = float(mixture.conductivity(0 * ones)[0] / mixture.capacity(0 * ones)[0])
    steps = int(np.ceil(time / (0.4 * size**2 / largest_diffusivity)))
    step = time / steps
    temperature: Numbers = np.zeros(cells)
    content = table.content(temperature)
    flow = np.zeros(cells + 1)
    cold = float(mixture.conductivity(saturation(COLD_END * ones))[0])
    for _ in range(steps):
        conductivity = mixture.conductivity(saturation(temperature))
        flow[1:-1] = -0.5 * (conductivity[1:] + conductivity[:-1]) * np.diff(temperature) / size
        flow[0] = -0.5 * (cold + conductivity[0]) * (temperature[0] - COLD_END) / (0.5 * size)
        content -= step / size * np.diff(flow)
        temperature = table.temperature(content)
    return x, temperature


def slope_and_latent(run: Run) -> tuple[float, bool]:
    """Return m [1/K] and whether latent heat is on, from the resolved case."""
    return float(run.section("freezing")["slope"]), bool(run.section("heat").get("latent", True))


def profile(run: Run, time: float | None = None) -> tuple[Numbers, Numbers]:
    """Return (x, T) of the particles at a time [s], or at the end of the run, in order of x."""
    shot = run.snapshot(-1) if time is None else run.snapshot(time=time)
    order = np.argsort(shot.points[:, 0], kind="stable")
    return shot.points[order, 0], np.asarray(shot["temperature"], dtype=np.float64)[order]


def temperature_errors(run: Run) -> tuple[Numbers, Numbers]:
    """Return (x [m], T minus that of the reference [K]) of the particles over 0 < x < 0.95 m."""
    x, temperature = profile(run)
    exact_x, exact = reference(*slope_and_latent(run), float(run.times[-1]))
    # The curve includes the wall: the first particles are between it and the first volume.
    difference = temperature - np.interp(x, np.concatenate(([0.0], exact_x)), np.concatenate(([COLD_END], exact)))
    return x[x < COMPARED], difference[x < COMPARED]


def errors(run: Run) -> tuple[float, float]:
    """Return the maximum and the root mean square error [K] over 0 < x < 0.95 m."""
    _, difference = temperature_errors(run)
    return float(np.max(np.abs(difference))), float(np.sqrt(np.mean(difference**2)))


def place_of_saturation(run: Run, saturation: float, time: float | None = None) -> float:
    """Return x [m] at which the saturation of particles attains a value, at the end or a time; nan if it does not."""
    x, temperature = profile(run, time)
    liquid = linear_saturation(slope_and_latent(run)[0])(temperature)
    if not liquid[0] < saturation <= liquid[-1]:
        return float("nan")
    return float(np.interp(saturation, liquid, x))


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return the numbers of Sec. 3.1, by the name of the run and of the quantity."""
    found, backward = {}, 0.0
    for name, run in ((f"freezing-bar-{base}", runs[f"freezing-bar-{base}"]) for base in BARS):
        key = "freezing_" + name.removeprefix("freezing-bar-").replace("-", "_")
        found[f"{key}_max_error"], found[f"{key}_rms_error"] = errors(run)
        found[f"{key}_half"] = place_of_saturation(run, 0.5)
        found[f"{key}_half_early"] = place_of_saturation(run, 0.5, 0.5 * float(run.times[-1]))
        liquid = linear_saturation(slope_and_latent(run)[0])(profile(run)[1])
        found[f"{key}_left"], found[f"{key}_right"] = float(liquid[0]), float(liquid[-1])
        backward = max(backward, float(np.max(np.maximum.accumulate(liquid) - liquid)))
        frozen, thawed = place_of_saturation(run, 0.05), place_of_saturation(run, 0.95)
        found[f"{key}_width"] = thawed - frozen
        slope, _ = slope_and_latent(run)
        found[f"{key}_gradient"] = 0.9 / slope / (thawed - frozen)
        printed = runs[name + PRINTED]
        created, removed = (abs(float(printed.series[c][-1])) for c in ("capacity_heat_J", "boundary_heat_J"))
        found[f"{key}_printed_error"] = errors(printed)[0]
        found[f"{key}_printed_heat"] = 100.0 * created / max(removed, 1e-300)
    found["freezing_backward"] = backward  # maximum decrease of saturation with distance from the cold end
    found["freezing_max_error"] = max(value for name, value in found.items() if name.endswith("_max_error"))
    found["freezing_rms_error"] = max(value for name, value in found.items() if name.endswith("_rms_error"))
    return found


_DRAWN = (
    ("freezing-bar-m025", "m = 0.25", BLUE),
    ("freezing-bar-m050", "m = 0.5", GREEN),
    ("freezing-bar-m100", "m = 1", ORANGE),
    ("freezing-bar-m050-no-latent", "m = 0.5, no latent heat", RED),
)


NEAR = 0.16  # m: range of the lower panels


def _draw_errors(axes: Axes, runs: dict[str, Run], ending: str) -> None:
    """Plot the errors of the particles near the cold end."""
    for name, _, colour in _DRAWN:
        x, difference = temperature_errors(runs[name + ending])
        axes.plot(x, 1e3 * difference, "o-", color=colour, markersize=3.0, linewidth=0.7)
    axes.set_ylabel("error (mK)")
    axes.set_ylim(-45.0, 45.0)


@styled
def figure_4(runs: dict[str, Run]) -> Figure:
    """Plot temperature and saturation along the bar and near its end: particles as points, the reference as lines.

    The lowest panels have the errors of Thawslide and of the published update.
    """
    figure = Figure(figsize=(COLUMN_WIDTH, 8.3), layout="constrained")
    panels = list(figure.subplots(3, 2).flat)
    for name, words, colour in _DRAWN:
        run = runs[name]
        slope, latent = slope_and_latent(run)
        liquid = linear_saturation(slope)
        x, temperature = profile(run)
        fine_x, fine = reference(slope, latent, float(run.times[-1]))
        for number, axes in enumerate(panels[:4]):
            points, line = (temperature, fine) if number % 2 == 0 else (liquid(temperature), liquid(fine))
            every = 6 if number < 2 else 1
            axes.plot(fine_x, line, color=BLACK, linewidth=0.9, zorder=3)
            axes.plot(x[::every], points[::every], "o", color=colour, markersize=3.4, label=words, zorder=2)
    panels[0].plot([], [], color=BLACK, linewidth=0.9, label="finite volumes, 2.5 mm")
    _draw_errors(panels[4], runs, "")
    _draw_errors(panels[5], runs, PRINTED)
    for number, axes in enumerate(panels):
        axes.set_xlim(0.0, 1.0 if number < 2 else NEAR)
        if number < 4:
            axes.set_ylabel("liquid saturation" if number % 2 else "temperature (°C)")
        axes.grid(True)
        if number in (1, 3):
            axes.set_ylim(-0.01, 1.02)
    for axes in panels[4:]:
        axes.set_xlabel("distance from the cold end (m)")
    panels[0].legend(loc="lower right")
    after = ("temperature after one day", "liquid saturation after one day")
    near = ("temperature near the cold end", "saturation near the cold end")
    title_panels(panels, (*after, *near, "error of temperature", "error with the published update (Eqs. 18, 19)"))
    return figure
