"""Numbers in another unit: `check` notes or refuses what a user would enter, for every key of the reference."""

from pathlib import Path
from typing import Any

import pytest
from conftest import Program
from terrain_files import toml

CASE = toml("""
[case] gravity_tilt = 30.0
[time] end = 2.0 | step = 0.001 | output_interval = 1.0 | history_interval = 0.5 | stop_at_rest = 0.05
[grid] cell = 5.0 | min = [-20.0, -10.0] | max = [300.0, 60.0]
[terrain] type = "flat"
[material.rock] law = "mohr_coulomb" | youngs_modulus = 5.0e8 | poisson_ratio = 0.2 | friction_angle = 35.0
  cohesion = 1.0e6 | viscosity_time = 0.02 | hydraulic_conductivity = 1.0e-7
[body.block] material = "rock" | min = [0.0, 0.0] | max = [100.0, 30.0] | temperature = -10.0 | porosity = 0.375
[substrate.ice] x_min = 50.0 | friction_angle = 20.0
[basal] friction_angle = 25.0 | cohesion = 1.9e5 | slip_distance = 20.0
[band] model = "columns" | thickness = 0.2
""")
# Units in which users give numbers, by that of the key: the number of one key unit in the other unit.
OTHERS = {
    "Pa": {"MPa": 1e-6, "GPa": 1e-9}, "1/Pa": {"1/MPa": 1e6, "1/GPa": 1e9}, "degrees": {"radians": 0.0174533},
    "J/kg/K": {"kJ/kg/K": 1e-3, "kcal/kg/K": 2.388e-4}, "W/m/K": {"mW/m/K": 1e3, "W/cm/K": 0.01},
    "1/K": {"1e-6/K": 1e6}, "J/kg": {"kJ/kg": 1e-3, "kcal/kg": 2.388e-4, "J/m3": 917.0}, "N/m3": {"kN/m3": 1e-3},
    "kg/m3": {"g/cm3": 1e-3},
}  # fmt: skip
LENGTHS, TIMES, SPEEDS, KELVIN = {"mm": 1e3}, {"ms": 1e3}, {"mm/s": 1e3}, {"K": lambda value: value + 273.15}
PLANE = "terrain.type=plane band.model=scaled case.gravity_tilt=0"
# Keys with their usual values, the other keys that they need, and further units.
VALUES: dict[str, tuple[float, str, dict[str, object]]] = {
    "case.gravity": (9.81, "", {"ft/s2": 3.2808, "cm/s2": 100.0}), "case.gravity_tilt": (30.0, "", {}),
    "terrain.slope": (30.0, f"{PLANE} body.block.min=[0,10] body.block.max=[50,40]", {}),
    "grid.steepest": (65.0, f"time.stepping=adaptive {PLANE}", {}),
    "time.step": (0.001, "", TIMES), "time.stop_at_rest": (0.05, "", SPEEDS),
    "checkpoint.wall_interval": (600.0, "", TIMES),
    "phases.rock_density": (2750.0, "", {}), "phases.ice_density": (917.0, "", {}),
    "phases.water_density": (1000.0, "", {}), "phases.rock_heat_capacity": (858.0, "", {}),
    "phases.ice_heat_capacity": (2040.0, "", {}), "phases.water_heat_capacity": (4180.0, "", {}),
    "phases.rock_conductivity": (3.0, "", {}), "phases.ice_conductivity": (2.22, "", {}),
    "phases.water_conductivity": (0.58, "", {}), "phases.rock_expansion": (3e-5, "", {}),
    "phases.ice_expansion": (5.1e-5, "", {}), "phases.water_expansion": (2.75e-4, "", {}),
    "phases.water_bulk_modulus": (1e9, "", {}), "phases.latent_heat": (333500.0, "", {}),
    "phases.water_unit_weight": (9810.0, "", {}), "freezing.reference_temperature": (0.0, "", KELVIN),
    "material.rock.youngs_modulus": (5e8, "", {}), "material.rock.friction_angle": (35.0, "", {}),
    "material.rock.dilation_angle": (10.0, "", {}), "material.rock.cohesion": (1e6, "", {"kPa": 1e-3}),
    "material.rock.residual_cohesion": (4e4, "material.rock.softening_slip=0.5", {"kPa": 1e-3}),
    "material.rock.residual_friction_angle": (30.0, "material.rock.softening_slip=0.5", {}),
    "material.rock.softening_slip": (0.5, "material.rock.residual_cohesion=1e5", LENGTHS),
    "material.rock.tension_cutoff": (1e5, "", {"kPa": 1e-3}), "material.rock.viscosity_time": (0.02, "", TIMES),
    "material.rock.hydraulic_conductivity": (1e-7, "", {"m/h": 3600.0, "m/day": 86400.0, "m/a": 3.156e7}),
    "body.block.temperature": (-10.0, "", KELVIN), "body.block.porosity": (0.375, "", {"percent": 100.0}),
    "body.block.velocity": ([50.0, 0.0], "", {"km/h": 3.6, **SPEEDS}),
    "mechanics.settle_time": (5.0, "mechanics.initial_stress=settle mechanics.settle_damping=2", TIMES),
    "mechanics.mass_damping": (0.05, "", {"1/h": 3600.0}), "basal.friction_angle": (25.0, "", {}),
    "basal.turbulent_friction": (1000.0, "basal.friction=voellmy basal.friction_coefficient=0.2", {"km/s2": 1e-3}),
    "basal.cohesion": (1.9e5, "", {"kPa": 1e-3}), "basal.residual_cohesion": (1e5, "", {"kPa": 1e-3}),
    "basal.slip_distance": (20.0, "", {"cm": 100.0, **LENGTHS}),
    "substrate.ice.cohesion": (1e5, "substrate.ice.slip_distance=20", {"kPa": 1e-3}),
    "substrate.ice.slip_distance": (20.0, "", {"cm": 100.0, **LENGTHS}), "substrate.ice.friction_angle": (20.0, "", {}),
    "band.thickness": (0.2, "", LENGTHS), "band.grain_size": (0.05, "band.growth=inertial",
    LENGTHS), "band.mixing_slip": (50.0, "", LENGTHS),
    "band.load_time": (1.0, "", TIMES), "band.column_step": (0.1, "", TIMES),
    "band.ground_temperature": (-5.0, "", KELVIN), "pressure.skeleton_compressibility": (2e-9, "", {"1/kPa": 1e3}),
}  # fmt: skip
# Not tested: lengths and coordinates, because a flume and a mountain have any; times of output, any; those that need a
# DEM, a bed, bodies in contact or a section of some width, and have ranges of the same form.
NOT_TESTED = {
    "case.width", "time.end", "time.output_interval", "time.history_interval", "time.rest_time", "time.moved_distance",
    "grid.cell", "grid.min", "grid.max", "terrain.elevation", "terrain.resample", "terrain.smooth",
    "checkpoint.interval", "maps.cell", "maps.arrival_thickness", "maps.area_thickness", "probe.NAME.point",
    "report.times", "report.force_periods", "freezing.slope", "body.NAME.min", "body.NAME.release_time",
    "body.NAME.max", "body.NAME.vertices", "body.NAME.thickness", "body.NAME.taper", "body.NAME.surface_tolerance",
    "body.NAME.largest_volume", "frame.NAME.min", "frame.NAME.max", "frame.NAME.velocity", "mechanics.fmpm_interval",
    "mechanics.settle_damping", "basal.cohesion_loss_time", "substrate.NAME.x_min", "substrate.NAME.x_max",
    "substrate.NAME.turbulent_friction", "substrate.NAME.residual_cohesion", "substrate.NAME.cohesion_loss_time",
    "bed.depth", "bed.strength", "bed.friction_angle", "bed.temperature", "contact.friction_angle",
    "contact_pair.NAME.friction_angle", "pressure.residual_stress",
}  # fmt: skip


@pytest.fixture
def case(tmp_path: Path) -> Path:
    (tmp_path / "case.toml").write_text(CASE)
    return tmp_path / "case.toml"


@pytest.fixture(scope="module")
def units(thawslide: Program) -> dict[str, str]:
    """Return the units of all keys of the reference."""
    tables: Any = thawslide.json("describe")
    return {f"{table['table'].strip('[]')}.{key['key']}": key["unit"] for table in tables for key in table["keys"]}


def declared(key: str) -> str:
    """Return the name of a key in the reference."""
    parts = key.split(".")
    return key if len(parts) == 2 else f"{parts[0]}.NAME.{parts[2]}"


def test_every_key_with_a_unit_is_listed(units: dict[str, str]) -> None:
    assert {key for key, unit in units.items() if unit} <= {*map(declared, VALUES), *NOT_TESTED}


def text_about(thawslide: Program, case: Path, key: str, value: object, needed: str) -> str:
    """Return the warnings about a key, or the error."""
    words = [word for setting in (*needed.split(), f"{key}={value}") for word in ("--set", setting)]
    outcome = thawslide("check", case, *words)
    if outcome.returncode:
        assert outcome.returncode == 2 and f"{key} is " in outcome.stderr, outcome.stderr
        return outcome.stderr
    lines = outcome.stdout.splitlines()
    return "\n".join(line for line in lines if line.startswith("warning:") and f" {key} is" in line)


@pytest.mark.parametrize("key", VALUES)
def test_a_number_in_another_unit_is_noted_and_the_usual_one_is_not(
    thawslide: Program, case: Path, units: dict[str, str], key: str
) -> None:
    value, needed, more = VALUES[key]
    assert text_about(thawslide, case, key, value, needed) == ""
    for other, factor in {**OTHERS.get(units[declared(key)], {}), **more}.items():
        convert = factor if callable(factor) else lambda number, by=factor: number * by
        converted = [convert(each) for each in value] if isinstance(value, list) else convert(value)
        assert text_about(thawslide, case, key, converted, needed), f"{key} in {other}: {converted} is not noted"


@pytest.mark.parametrize(
    ("setting", "text"),
    [
        ("basal.cohesion=190", "If it is in kPa, it is 1.9e+05 Pa."),
        ("phases.latent_heat=333.5", "If it is in kJ/kg, it is 3.335e+05 J/kg."),
        ("body.block.velocity=[180,0]", "in km/h, it is 50 m/s"),
        ("case.gravity_tilt=0.5236", "If it is in radians, it is 30 degrees."),
        ("phases.rock_density=2.75", "If it is in g/cm3, it is 2750 kg/m3."),
        ("material.rock.viscosity_time=20", "If it is in ms, it is 0.02 s."),  # its step is an error
    ],
)
def test_the_probable_unit_is_named(thawslide: Program, case: Path, setting: str, text: str) -> None:
    outcome = thawslide("check", case, "--set", setting)
    assert text in outcome.stdout + outcome.stderr
