"""Sec. 3.3: the block on an incline of 40 degrees, four combinations of mechanisms (Figs. 9, 10 and 11)."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from reproduction.block import at, first_time, mark
from reproduction.mixture import TABLE_1
from reproduction.runs import INCLINES
from thawslide.figures.style import (
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    NOTE,
    ORANGE,
    RED,
    TIME_LABEL,
    styled,
    time_line,
    title_panels,
)
from thawslide.run_folder import Numbers, Run

GRAVITY, SLOPE, HEIGHT = 9.81, np.radians(40.0), 50.0
NAMES = {"D": "D", "DL": "D-L", "DLP": "D-L-P", "PL": "P-L"}
COLOURS = {"D": BLUE, "DL": GREEN, "DLP": RED, "PL": ORANGE}
TIMES = (2.5, 5.0, 10.0, 15.0, 25.0)  # s
LATE = 15.0  # s: "later" in the paper
_QUANTITIES = {
    "velocity": ("mean_velocity_m_s", 1.0),
    "displacement": ("mean_displacement_m", 1.0),
    "temperature": ("band_temperature_C", 1.0),
    "saturation": ("band_saturation", 1.0),
    "pressure": ("band_pore_pressure_Pa", 1e3),
    "friction": ("band_friction_coefficient", 1.0),
    "strain": ("mean_plastic_strain", 1.0),
}


def smooth(run: Run, column: str, span: float = 0.5) -> Numbers:
    """Return the running mean of a column over `span` seconds, because elastic waves modulate contact quantities."""
    values, time = run.series[column], run.series["time_s"]
    rows = max(1, round(span / (time[1] - time[0]))) if len(time) > 1 else 1
    rows = min(rows, len(time))
    filled = np.where(np.isfinite(values), values, 0.0)
    weight = np.isfinite(values).astype(float)
    window = np.ones(rows)
    count = np.convolve(weight, window, mode="same")
    return np.where(count > 0, np.convolve(filled, window, mode="same") / np.maximum(count, 1e-300), np.nan)


def flow_height(run: Run, time: float) -> float:
    """Return the mean height [m] of the sliding mass: volume over length."""
    if time > run.times[-1] + 1e-9:
        return float("nan")
    shot = run.snapshot(time=time)
    x = shot.points[:, 0]
    low, high = np.quantile(x, [0.005, 0.995])
    return float(np.sum(shot["volume"]) / (high - low))


def drag(run: Run) -> float:
    """Return the mean basal force from 15 to 25 s over the slope-normal weight; nan in a shorter run."""
    history = run.series
    late = history["time_s"] >= LATE
    weight = float(history["mass_kg"][0]) * GRAVITY * float(np.cos(SLOPE))
    return float(np.mean(np.abs(history["basal_force_x_N"][late]))) / weight if late.any() else float("nan")


def friction_coefficient(porosity: float, saturation: float) -> float:
    """Return mu_e of Eq. 25 with the limits 0.05 and 0.85, omega 2, phi_f 40 degrees and an ice weight of 1/3."""
    solid = 1.0 - porosity + porosity * (1.0 - saturation) / 3.0
    return float((1.0 - (1.0 - (solid - 0.05) / 0.8) ** 2) * np.tan(np.radians(40.0)))


def friction_decrease(run: Run) -> dict[str, float]:
    """Return the decrease of the coefficient of P-L to 25 s, the porosity of the band, and the decrease by porosity."""
    friction = run.series["band_friction_coefficient"]
    band = run.snapshot(time=25.0)
    inside = np.asarray(band["in_band"]) > 0
    porosity = float(np.mean(np.asarray(band["porosity"], dtype=np.float64)[inside])) if inside.any() else float("nan")
    start = friction[np.isfinite(friction)]
    return {
        "incline_PL_friction_fall": (float(start[0]) if start.size else np.nan)
        - at(run, "band_friction_coefficient", 25.0),
        "incline_PL_porosity": porosity,
        "incline_PL_fall_by_porosity": friction_coefficient(TABLE_1.porosity, 0.0)
        - friction_coefficient(porosity, 0.0),
    }


def falls_below(run: Run, other: Run, column: str, after: float) -> float:
    """Return the first time [s] after a given one at which a column is below that of another run; nan for never."""
    time = run.series["time_s"]
    below = (run.series[column] < np.interp(time, other.series["time_s"], other.series[column])) & (time > after)
    return float(time[np.argmax(below)]) if below.any() else float("nan")


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return the numbers of Sec. 3.3, by case, quantity and time."""
    free = float(GRAVITY * np.sin(SLOPE))
    found = {
        "incline_free_acceleration": free,
        "incline_free_velocity": 25.0 * free,
        "incline_normal_pressure": TABLE_1.density() * GRAVITY * HEIGHT * float(np.cos(SLOPE)) / 1e3,
        "incline_DLP_start_pressure": float(runs["incline-DLP"].series["band_pore_pressure_Pa"][0]) / 1e3,
    }
    for name in INCLINES:
        run, key = runs[f"incline-{name}"], f"incline_{name}"
        for quantity, (column, scale) in _QUANTITIES.items():
            for time in TIMES:
                found[f"{key}_{quantity}_{time:g}s".replace(".", "_")] = at(run, column, time) / scale
        found[f"{key}_melted"] = first_time(run, "band_saturation", 0.99)
        found[f"{key}_half_melted"] = first_time(run, "band_saturation", 0.495)
        history = run.series
        work = np.abs(history["potential_J"] - history["potential_J"][0]) + np.abs(history["friction_work_J"])
        residual = np.abs(history["mechanical_residual_J"][-1]) / max(work[-1], 1e-300)
        found[f"{key}_residual"] = 100.0 * float(residual)
        found[f"{key}_height"] = flow_height(run, 25.0)
        found[f"{key}_drag"] = drag(run)
        found[f"{key}_friction_work"] = float(history["friction_work_J"][-1]) / 1e9
        velocity, times = history["mean_velocity_m_s"], history["time_s"]
        late = times > 10.0
        found[f"{key}_late_acceleration"] = (
            float(np.polyfit(times[late], velocity[late], 1)[0]) if late.sum() > 2 else float("nan")
        )
        found[f"{key}_warming"] = found[f"{key}_temperature_25s"] - found[f"{key}_temperature_15s"]
    found["incline_melting_crossing"] = falls_below(runs["incline-DLP"], runs["incline-DL"], "band_saturation", 2.0)
    ice = runs["incline-DLP-ice"]
    found["incline_ice_velocity"] = at(ice, "mean_velocity_m_s", 25.0)
    found["incline_ice_drag"] = drag(ice)
    found["incline_gain_heat"] = found["incline_DLP_velocity_25s"] - found["incline_ice_velocity"]
    found["incline_gain_all"] = found["incline_DLP_velocity_25s"] - found["incline_D_velocity_25s"]
    found["incline_gain_L"] = found["incline_DL_velocity_25s"] - found["incline_D_velocity_25s"]
    found["incline_gain_P"] = found["incline_DLP_velocity_25s"] - found["incline_DL_velocity_25s"]
    found |= friction_decrease(runs["incline-PL"])
    for name in ("D", "PL"):
        run, key = runs[f"incline-{name}-no-viscosity"], f"incline_{name}_undamped"
        found[f"{key}_displacement"] = at(run, "mean_displacement_m", min(20.0, run.series["time_s"][-1]))
        found[f"{key}_end"] = float(run.series["time_s"][-1])
        found[f"{key}_displacement_end"] = float(run.series["mean_displacement_m"][-1])
    found["incline_D_displacement_20s"] = at(runs["incline-D"], "mean_displacement_m", 20.0)
    return found


@styled
def _plot(runs: dict[str, Run], panels: tuple[tuple[str, str, float, float], ...], titles: tuple[str, ...]) -> Figure:
    """Plot columns over time: (column, label, divisor, running mean [s])."""
    figure = Figure(figsize=(COLUMN_WIDTH, 3.2), layout="constrained")
    axes = list(figure.subplots(1, len(panels)))
    for panel, (column, words, divisor, span) in zip(axes, panels, strict=True):
        for name in INCLINES:
            run = runs[f"incline-{name}"]
            values = (smooth(run, column, span) if span else run.series[column]) / divisor
            dashes = "--" if name == "PL" else "-"  # it often coincides with D-L-P
            time_line(panel, run.series["time_s"], values, color=COLOURS[name], linestyle=dashes, label=NAMES[name])
        panel.set_ylabel(words)
        panel.set_xlabel(TIME_LABEL)
        panel.set_xlim(0.0, runs["incline-DLP"].series["time_s"][-1])
        panel.grid(True)
    axes[0].legend(loc="best")
    title_panels(axes, titles)
    return figure


def figure_9(runs: dict[str, Run]) -> Figure:
    """Plot temperature and saturation of the band."""
    panels = (("band_temperature_C", "temperature (°C)", 1.0, 0.0), ("band_saturation", "liquid saturation", 1.0, 0.0))
    figure = _plot(runs, panels, ("band temperature", "band saturation"))
    figure.axes[1].set_ylim(-0.02, 1.02)
    mark(figure.axes[1], 10.0, 1.0, "Lei et al.: P-L has melted", COLOURS["PL"])
    return figure


def figure_10(runs: dict[str, Run]) -> Figure:
    """Plot friction coefficient and pore pressure along the base."""
    panels = (
        ("band_friction_coefficient", "friction coefficient", 1.0, 0.5),
        ("band_pore_pressure_Pa", "pore pressure (MPa)", 1e6, 0.0),
    )
    figure = _plot(runs, panels, ("friction coefficient, mean over 0.5 s", "band pore pressure"))
    pressure = figure.axes[1]
    # If it does not act on the base (D, D-L) it increases without bound: such curves are thin and leave the panel.
    for name, line in zip(INCLINES, list(pressure.lines), strict=True):
        if name in ("D", "DL"):
            line.set(linestyle=":", linewidth=1.1)
    normal = TABLE_1.density() * GRAVITY * HEIGHT * float(np.cos(SLOPE)) / 1e6
    pressure.set_ylim(0.0, 1.45 * normal)
    pressure.axhline(normal, color=NOTE, linewidth=0.9, linestyle=(0, (5, 3)))
    pressure.annotate("normal pressure", (0.99, normal), xycoords=("axes fraction", "data"), xytext=(0, 3), size=8,
                      ha="right", textcoords="offset points", color=NOTE)  # fmt: skip
    highest = {name: float(np.nanmax(runs[f"incline-{name}"].series["band_pore_pressure_Pa"])) / 1e6
               for name in ("D", "DL")}  # fmt: skip
    words = f"dotted: no effect on the base; maximum {highest['D']:.0f} MPa (D), {highest['DL']:.0f} MPa (D-L)"
    pressure.annotate(words, (0.015, 0.03), xycoords="axes fraction", size=8, color=NOTE)
    return figure


def figure_11(runs: dict[str, Run]) -> Figure:
    """Plot plastic strain, velocity and displacement of the mixture."""
    panels = (
        ("mean_plastic_strain", "equivalent plastic strain", 1.0, 0.0),
        ("mean_velocity_m_s", "mean velocity (m/s)", 1.0, 0.0),
        ("mean_displacement_m", "mean displacement (m)", 1.0, 0.0),
    )
    figure = _plot(runs, panels, ("plastic strain, mass-weighted mean", "velocity", "displacement"))
    return figure
