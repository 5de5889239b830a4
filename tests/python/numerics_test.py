"""Influence of numerical parameters on the Lamplugh case with band columns: its runs and tables."""

import dataclasses
import tomllib
from pathlib import Path

from reproduction import numerics
from reproduction.members import Observed


def test_rows_scale_step_and_viscosity_and_shift_the_domain() -> None:
    rows = {row.key: row.sets for row in numerics.cell_rows()}
    assert len(rows) == 9
    assert rows["e-0.21-cell-5"] == (
        "band.thickness=0.21", "grid.cell=5", "time.step=0.005", "material.rock_ice.viscosity_time=0.00125",
    )  # fmt: skip
    assert next(iter(rows)).endswith("cell-5"), "the long runs first"
    shifted = {row.key: row.sets for row in numerics.numerics_rows()}
    assert shifted["quarter-shift"] == ("grid.min=[-202.5,197.5]", "grid.max=[13997.5,2397.5]")


def test_table_of_cells_has_the_difference_of_the_finer_two() -> None:
    found = {
        row.key: Observed(peak=80.0, displacement=5.0 if row.key.endswith("-5") else 4.0, runout=9.0, dilation=15.0)
        for row in numerics.cell_rows()
    }
    found[numerics.cell_key(0.4, numerics.CELLS[-1])] = Observed(failure="not run")
    lines = numerics.cells_table(found).splitlines()
    assert lines[0] == "| e [m] | quantity | 20 m | 10 m | 5 m | finer two differ by |"
    assert lines[2] == "| 0.21 | mean displacement [km] | 4.00 | 4.00 | 5.00 | 25.0 % |"
    assert lines[5] == "| 0.21 | growth of the volume [%] | 15.0 | 15.0 | 15.0 | |"
    assert lines[10] == "| 0.4 | mean displacement [km] | 4.00 | 4.00 | none | none |"


def test_table_of_numerics_has_differences_from_the_case() -> None:
    base = Observed(peak=80.0, displacement=5.0, runout=9.0)
    rows = numerics.numerics_rows()[:2]
    found = {
        rows[0].key: dataclasses.replace(base, displacement=4.9, runout=9.27),
        rows[1].key: Observed(failure="broke off at 3 s"),
    }
    lines = numerics.numerics_table(rows, base, found).splitlines()
    assert lines[0] == "| run | runout [km] | peak [m/s] | mean displacement [km] | set |"
    assert lines[2] == "| half the time step | 9.3 (+3.0 %) | 80.0 (+0.0 %) | 4.90 (−2.0 %) | `time.step=0.005` |"
    assert lines[3] == "| half of Young's modulus | broke off at 3 s | | | |"


def test_rows_have_the_multiples_in_their_names() -> None:
    path = Path(__file__).resolve().parents[2] / "cases" / "lamplugh-columns" / "case.toml"
    case = tomllib.loads(path.read_text(encoding="utf-8"))
    rock = case["material"]["rock_ice"]
    assert (case["grid"]["cell"], case["time"]["step"]) == (numerics.CELL, numerics.STEP_PER_CELL * numerics.CELL)
    assert rock["viscosity_time"] == numerics.VISCOSITY_PER_CELL * numerics.CELL
    assert (*case["grid"]["min"], *case["grid"]["max"]) == tuple(numerics.DOMAIN[k] for k in (0, 2, 1, 3))
    rows = {row.key: dict(each.split("=") for each in row.sets) for row in numerics.numerics_rows()}
    factors = {
        "half-modulus": (0.5, 1.0, 1.0), "twice-modulus": (2.0, 1.0, 1.0), "soft": (0.5, 2.0, 1.0),
        "softest": (0.25, 4.0, 1.0), "stiff": (2.0, 0.5, 1.0), "half-viscosity": (1.0, 0.5, 1.0),
        "twice-viscosity": (1.0, 2.0, 1.0), "half-slip": (1.0, 1.0, 0.5), "twice-slip": (1.0, 1.0, 2.0),
        "fine-same-viscosity": (1.0, 1.0, 1.0),
    }  # fmt: skip
    for key, of_row in factors.items():
        for name, factor in zip(("youngs_modulus", "viscosity_time", "softening_slip"), of_row, strict=True):
            value = float(rows[key].get(f"material.rock_ice.{name}", rock[name]))
            assert abs(value / rock[name] - factor) < 1e-9, (key, name)
