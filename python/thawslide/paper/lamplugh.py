"""Sec. 4: the Lamplugh avalanche. Figs. 14 to 20 are those of any report; the deposit is drawn here."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from thawslide.figures.force import seismic_force
from thawslide.figures.style import BLUE, GREEN, NOTE, RED, letters, styled
from thawslide.key_numbers import stop_time
from thawslide.paper.block import at
from thawslide.run import Numbers, Run

# Gradients the text gives for the way down: source slope, ramp, valley floor.
SLOPE, RAMP = 48.0, 8.0
BIN = 100.0  # m
PHASE = 75.0  # s: the time of the peak in the paper


def deposit(run: Run) -> tuple[Numbers, Numbers]:
    """Return (x [m], thickness [m]) at the end of the run: volume over 100 m of distance."""
    shot = run.snapshot(-1)
    x = shot.points[:, 0]
    edges = np.arange(np.floor(x.min() / BIN) * BIN, x.max() + BIN, BIN)
    volume, _ = np.histogram(x, edges, weights=np.asarray(shot["volume"], dtype=np.float64))
    return 0.5 * (edges[1:] + edges[:-1]), volume / BIN


def breaks(run: Run) -> tuple[float, float]:
    """Return x [m] of the foot of the slope and of the ramp: where the ground's slope falls under 28 and 4 degrees."""
    assert run.terrain is not None
    x, z = run.terrain
    slope = np.degrees(np.arctan(-np.gradient(z, x)))
    steep = x[slope > 0.5 * (SLOPE + RAMP)]
    ramp = x[slope > 0.5 * RAMP]
    return float(steep.max()), float(ramp.max())


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return the numbers of Sec. 4."""
    run, other = runs["lamplugh"], runs["lamplugh-no-pressurization"]
    history, time = run.history, run.history["time_s"]
    speed = history["mean_velocity_m_s"]
    peak = int(np.argmax(speed))
    _, force = seismic_force(run)
    loudest = int(np.nanargmax(force))
    stopped, other_stopped = stop_time(run), stop_time(other)
    start = np.flatnonzero(speed >= 8.0)
    x, thickness = deposit(run)
    foot, valley = breaks(run)
    whole = max(float(thickness.sum()), 1e-300)
    found = {
        "lamplugh_peak": float(speed[peak]),
        "lamplugh_peak_time": float(time[peak]),
        "lamplugh_8_time": float(time[start[0]]) if start.size else float("nan"),
        "lamplugh_speed_40s": at(run, "mean_velocity_m_s", 40.0),
        "lamplugh_speed_200s": at(run, "mean_velocity_m_s", 200.0),
        "lamplugh_displacement": float(history["mean_displacement_m"][-1]),
        "lamplugh_displacement_40s": at(run, "mean_displacement_m", 40.0),
        "lamplugh_runout_km": float(history["runout_m"][-1]) / 1e3,
        "lamplugh_front_km": float(history["front_position_m"][-1]) / 1e3,
        "lamplugh_stop": stopped if stopped is not None else float("nan"),
        "lamplugh_saturation_40s": at(run, "band_saturation", 40.0),
        "lamplugh_saturation_75s": at(run, "band_saturation", PHASE),
        "lamplugh_friction_start": float(
            history["band_friction_coefficient"][np.isfinite(history["band_friction_coefficient"])][0]
        ),
        "lamplugh_pressure_start": float(history["band_pore_pressure_Pa"][0]) / 1e6,
        "lamplugh_friction_40s": at(run, "band_friction_coefficient", 40.0),
        "lamplugh_friction_75s": at(run, "band_friction_coefficient", PHASE),
        "lamplugh_force_TN": float(force[loudest]) / 1e12,
        "lamplugh_force_time": float(time[loudest]),
        "lamplugh_temperature_40s": at(run, "band_temperature_C", 40.0),
        "lamplugh_temperature_75s": at(run, "band_temperature_C", PHASE),
        "lamplugh_temperature_80s": at(run, "band_temperature_C", 80.0),
        "lamplugh_temperature_200s": at(run, "band_temperature_C", 200.0),
        "lamplugh_temperature_peak": float(np.nanmax(history["band_temperature_C"])),
        "lamplugh_temperature_at_peak": float(history["band_temperature_C"][peak]),
        "lamplugh_pressure_40s": at(run, "band_pore_pressure_Pa", 40.0) / 1e6,
        "lamplugh_pressure_75s": at(run, "band_pore_pressure_Pa", PHASE) / 1e6,
        "lamplugh_pressure_200s": at(run, "band_pore_pressure_Pa", 200.0) / 1e6,
        "lamplugh_strain_40s": at(run, "mean_plastic_strain", 40.0),
        "lamplugh_strain_75s": at(run, "mean_plastic_strain", PHASE),
        "lamplugh_strain_end": float(history["mean_plastic_strain"][-1]),
        "lamplugh_rescale_PJ": float(history["band_rescale_J"][-1]) / 1e15,
        "lamplugh_friction_PJ": float(history["friction_heat_J"][-1]) / 1e15,
        "lamplugh_deposit_slope": 100.0 * float(thickness[x < foot].sum()) / whole,
        "lamplugh_deposit_ramp": 100.0 * float(thickness[(x >= foot) & (x < valley)].sum()) / whole,
        "lamplugh_deposit_valley": 100.0 * float(thickness[x >= valley].sum()) / whole,
        "lamplugh_deposit_thickest": float(thickness.max()),
        "lamplugh_deposit_thickest_km": float(x[int(np.argmax(thickness))]) / 1e3,
        "lamplugh_deposit_length_km": float(np.ptp(x[thickness > 1.0])) / 1e3,
        "lamplugh_dry_peak": float(other.history["mean_velocity_m_s"].max()),
        "lamplugh_dry_displacement": float(other.history["mean_displacement_m"][-1]),
        "lamplugh_dry_stop": other_stopped if other_stopped is not None else float("nan"),
        "lamplugh_particles": float(len(run.snapshot(0).points)),
    }
    found["lamplugh_rise_time"] = found["lamplugh_peak_time"] - found["lamplugh_8_time"]
    return found


@styled
def figure_deposit(runs: dict[str, Run]) -> Figure:
    """Draw ground, start and deposit along the profile, and the deposit's thickness."""
    run = runs["lamplugh"]
    figure = Figure(figsize=(10.0, 5.0), layout="constrained")
    section, thick = figure.subplots(2, 1, sharex=True, height_ratios=(1.0, 1.0))
    assert run.terrain is not None
    ground_x, ground_z = run.terrain
    section.fill_between(ground_x / 1e3, ground_z, ground_z.min() - 50.0, color="#E4E0DA")
    for index, colour, words in ((0, NOTE, "start"), (-1, RED, f"t = {run.times[-1]:g} s")):
        points = run.snapshot(index).points
        section.plot(points[:, 0] / 1e3, points[:, 1], ".", color=colour, markersize=1.5, label=words)
    section.set_ylabel("elevation (m)")
    section.legend(loc="upper right", markerscale=6)
    x, thickness = deposit(run)
    thick.bar(x / 1e3, thickness, width=BIN / 1e3, color=BLUE, edgecolor="white", linewidth=0.3)
    thick.set_ylabel("thickness (m)")
    thick.set_xlabel("distance (km)")
    for height, place, words in zip((0.97, 0.87), breaks(run), ("foot of the slope", "foot of the ramp"), strict=True):
        thick.axvline(place / 1e3, color=GREEN, linewidth=1.0, linestyle="--")
        thick.annotate(words, (place / 1e3, height), xycoords=("data", "axes fraction"), xytext=(4, 0),
                       textcoords="offset points", va="top", size=8, color=GREEN)  # fmt: skip
    for axes in (section, thick):
        axes.grid(True)
        axes.set_xlim(ground_x[0] / 1e3, ground_x[-1] / 1e3)
    letters([section, thick], ("profile", "thickness of the deposit, means over 100 m"))
    return figure
