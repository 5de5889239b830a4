"""Secs. 4.1 and 4.2 by stages: body, equilibrium, before and after 75 s."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reproduction.block import at
from reproduction.mixture import TABLE_1, HeatTable, power_saturation
from thawslide.run_folder import Numbers, Run, Snapshot

START, PEAK, END = 40.0, 75.0, 200.0  # s: the stages of the text
JUMPED = 76.0  # s: the first whole second with the band of 0.5 m
GRAVITY, SLOPE, FRICTION_ANGLE = 9.81, np.radians(48.0), np.radians(40.0)
SOURCE_THICKNESS = 50.0  # m: the average of the source in the text
HOTTEST = 1.0e4  # C: upper end of the table of heat content


def heating(run: Run, start: float, end: float) -> float:
    """Return the mean power of friction heat [GW] between two times [s]; nan if the run is shorter."""
    return (at(run, "friction_heat_J", end) - at(run, "friction_heat_J", start)) / (end - start) / 1e9


def basal_resistance(run: Run, start: float = 35.0, end: float = 40.0) -> float:
    """Return the mean basal resistance [GN] between two times [s]: friction work over the mean displacement."""
    work = at(run, "friction_work_J", end) - at(run, "friction_work_J", start)
    distance = at(run, "mean_displacement_m", end) - at(run, "mean_displacement_m", start)
    return work / distance / 1e9 if distance > 0.0 else float("nan")


def balance_cohesion(thickness: float) -> float:
    """Return the cohesion [MPa] for equilibrium of a frozen slab [m] on 48 degrees, with friction of 40 degrees.

    rho g H (sin - tan(phi) cos) + tan(phi) rho_I g H, with P_I = rho_I g H of the thickness along the normal.
    """
    weight, coefficient = TABLE_1.density() * GRAVITY * thickness, np.tan(FRICTION_ANGLE)
    ice = TABLE_1.ice_density * GRAVITY * thickness
    return float(weight * np.sin(SLOPE) - coefficient * (weight * np.cos(SLOPE) - ice)) / 1e6


def balance(block: Mapping[str, Numbers], cohesion: float) -> dict[str, float]:
    """Return the equilibrium of the rigid block at t = 0, from its history with a cohesion [Pa]."""
    driving = float(block["driving_traction_Pa"][0])
    frictional = float(block["sliding_strength_Pa"][0]) - cohesion
    return {
        "lamplugh_balance": (driving - frictional) / 1e6,
        "lamplugh_driving": driving / 1e3,
        "lamplugh_frictional": frictional / 1e3,
        "lamplugh_short": 100.0 * (1.0 - (frictional + 5.61e5) / driving),
        "lamplugh_balance_50m": balance_cohesion(SOURCE_THICKNESS),
    }


def in_band(shot: Snapshot) -> Numbers:
    """Return 1 for the particles of the band, 0 for others."""
    return np.asarray(shot["in_band"], dtype=np.float64)


def solid_fraction(run: Run, time: float) -> float:
    """Return n_e (Eq. 2, weight of ice 1/3) of the band at a time [s], mass-weighted mean; nan after the end."""
    if time > run.times[-1] + 1e-9:
        return float("nan")
    shot = run.snapshot(time=time)
    porosity, saturation = (np.asarray(shot[name], dtype=np.float64) for name in ("porosity", "liquid_saturation"))
    weight = in_band(shot) * np.asarray(shot["mass"])
    solid = 1.0 - porosity + porosity * (1.0 - saturation) / 3.0
    return float(np.sum(weight * solid) / np.sum(weight)) if weight.any() else float("nan")


def diffusion(run: Run) -> dict[str, float]:
    """Return the friction heat [TJ] from 76 s to the end, and the gain of particles outside the band at 76 s.

    Heat contents are those of the volumes at t = 0 over xi of the wide band, as in the simulator.
    """
    heat: dict[str, float] = dict.fromkeys(("generated", "given_off", "given_off_percent"), float("nan"))
    if run.times[-1] > JUMPED:
        first, last = run.snapshot(time=JUMPED), run.snapshot(-1)
        volume = np.asarray(run.snapshot(0)["volume"], dtype=np.float64) * run.width
        scale = float(run.section("grid")["cell"]) / float(run.section("band")["thickness"]["value"][-1])
        content = HeatTable(TABLE_1, power_saturation, -50.0, True, HOTTEST).content
        before, after = (content(np.asarray(shot["temperature"], dtype=np.float64)) for shot in (first, last))
        heat["given_off"] = float(np.sum((1.0 - in_band(first)) * volume * (after - before))) / scale / 1e12
        made = at(run, "friction_heat_J", float(run.times[-1])) - at(run, "friction_heat_J", JUMPED)
        heat["generated"] = made / 1e12
        heat["given_off_percent"] = 100.0 * heat["given_off"] / heat["generated"]
    melted = np.ones(1)
    diffusivity = float(TABLE_1.conductivity(melted)[0] / TABLE_1.capacity(melted)[0])
    heat["diffusion_length"] = float(np.sqrt(diffusivity * (END - PEAK)))
    heat["diffusion_days"] = 0.5**2 / diffusivity / 86400.0
    return {f"lamplugh_{name}": value for name, value in heat.items()}


def _body(run: Run) -> dict[str, float]:
    """Return volume [million m3], mean thickness [m], height [m] and length [m] of the body at the start."""
    shot = run.snapshot(0)
    section = float(np.sum(shot["volume"]))
    low, high = float(shot.points[:, 0].min()), float(shot.points[:, 0].max())
    assert run.terrain is not None
    x, z = run.terrain
    along = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x), np.diff(z)))))
    history = run.series
    return {
        "lamplugh_volume": section * run.width / 1e6,
        "lamplugh_thickness": section / float(np.interp(high, x, along) - np.interp(low, x, along)),
        "lamplugh_top": float(shot.points[:, 1].max()),
        "lamplugh_length_m": float(history["runout_m"][0]),
        "lamplugh_front_travel_km": float(history["front_position_m"][-1] - history["front_position_m"][0]) / 1e3,
    }


def _energy(run: Run) -> dict[str, float]:
    """Return the conversion of potential to kinetic energy [%], between 40 and 75 s and to the peak."""
    history = run.series
    kinetic = [at(run, "kinetic_J", time) / 1e12 for time in (START, PEAK)]
    fall = (at(run, "potential_J", START) - at(run, "potential_J", PEAK)) / 1e12
    peak = int(np.argmax(history["kinetic_J"]))
    whole = max(float(history["potential_J"][0] - history["potential_J"][peak]), 1e-300)
    return {
        "lamplugh_kinetic_40s": kinetic[0],
        "lamplugh_kinetic_75s": kinetic[1],
        "lamplugh_fall_40_75": fall,
        "lamplugh_converted": 100.0 * (kinetic[1] - kinetic[0]) / fall,
        "lamplugh_converted_peak": 100.0 * float(history["kinetic_J"][peak]) / whole,
    }


def measures(runs: dict[str, Run]) -> dict[str, float]:
    """Return speeds and heating of the stages."""
    run, dry = runs["lamplugh"], runs["lamplugh-no-pressurization"]
    saturations = [float(run.series["band_saturation"][0])]
    saturations += [at(run, "band_saturation", time) for time in (START, PEAK)]
    ice = 1.0 - saturations[0]
    found = {
        "lamplugh_speed_75s": at(run, "mean_velocity_m_s", PEAK),
        "lamplugh_speed_end": at(run, "mean_velocity_m_s", END),
        "lamplugh_heating_before": heating(run, START, PEAK),
        "lamplugh_heating_after": heating(run, PEAK, END),
        "lamplugh_friction_100s": at(run, "band_friction_coefficient", 100.0),
        "lamplugh_basal_resistance": basal_resistance(run),
        "lamplugh_dry_basal_resistance": basal_resistance(dry),
        "lamplugh_dry_runout_km": float(dry.series["runout_m"][-1]) / 1e3,
        "lamplugh_melted_before": 100.0 * (saturations[1] - saturations[0]) / ice,
        "lamplugh_melted_between": 100.0 * (saturations[2] - saturations[1]) / ice,
        "lamplugh_solid_start": solid_fraction(run, 0.0),
    }
    start = float(run.series["band_temperature_C"][0])
    for time in (START, PEAK):
        found[f"lamplugh_rise_{time:.0f}s"] = at(run, "band_temperature_C", time) - start
    for time in (START, PEAK, 100.0):
        found[f"lamplugh_solid_{time:.0f}s"] = solid_fraction(run, time)
    return found | _body(run) | _energy(run) | diffusion(run)
