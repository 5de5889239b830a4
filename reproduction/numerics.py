"""Influence of the cell, the time step, the stiffness and the viscosity on the Lamplugh case with band columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reproduction.members import QUANTITIES, Observed
from reproduction.study import Job

THICKNESSES = (0.21, 0.30, 0.40)  # m, of the band at the start
CELLS = (20.0, 10.0, 5.0)  # m, the coarsest first
CELL = 10.0  # m, of the case
STEP_PER_CELL = 1e-3  # s/m, as in the case
VISCOSITY_PER_CELL = 2.5e-4  # s/m, as in the case: one viscosity number on every cell
VISCOSITY = "material.rock_ice.viscosity_time"
DOMAIN = (-200.0, 14000.0, 200.0, 2400.0)  # m, x and y
QUANTITY_NAMES = ("displacement", "runout", "peak")


def on_cells(cell: float) -> tuple[str, ...]:
    """Return the changes of the case to another cell: step and viscosity are in proportion to it."""
    changes = (f"grid.cell={cell:g}", f"time.step={STEP_PER_CELL * cell:g}")
    return changes if cell == CELL else (*changes, f"{VISCOSITY}={VISCOSITY_PER_CELL * cell:g}")


def cell_key(thickness: float, cell: float) -> str:
    """Return the folder of a run of the table of cells."""
    return f"e-{thickness:g}-cell-{cell:g}"


def cell_rows() -> list[Job]:
    """Return the runs of the table of cells: each thickness of the band on each cell."""
    return [
        Job(
            cell_key(thickness, cell),
            f"e {thickness:g} m, cells of {cell:g} m",
            (f"band.thickness={thickness:g}", *on_cells(cell)),
        )
        for cell in reversed(CELLS)  # the long runs first
        for thickness in THICKNESSES
    ]


def _shifted(fraction: float, cell: float = CELL) -> tuple[str, ...]:
    """Return the changes that shift the grid by a fraction of a cell, down and to the left."""
    by = fraction * cell
    left, right, low, high = (edge - by for edge in DOMAIN)
    return (f"grid.min=[{left:g},{low:g}]", f"grid.max=[{right:g},{high:g}]")


def numerics_rows() -> list[Job]:
    """Return the runs that differ from the case in one numerical parameter."""
    modulus = "material.rock_ice.youngs_modulus"
    slip = "material.rock_ice.softening_slip"
    return [
        Job("half-step", "half the time step", ("time.step=0.005",)),
        Job("half-modulus", "half of Young's modulus", (f"{modulus}=2.5e8",)),
        Job("twice-modulus", "twice Young's modulus (shorter step)", (f"{modulus}=1e9", "time.step=0.007")),
        # The viscous stress is viscosity_time times the shear modulus: these keep it.
        Job("soft", "half of Young's modulus, the same viscosity", (f"{modulus}=2.5e8", f"{VISCOSITY}=0.005")),
        Job("softest", "a quarter of Young's modulus, the same viscosity", (f"{modulus}=1.25e8", f"{VISCOSITY}=0.01")),
        Job(
            "stiff",
            "twice Young's modulus, the same viscosity (shorter step)",
            (f"{modulus}=1e9", f"{VISCOSITY}=0.00125", "time.step=0.007"),
        ),
        Job("half-viscosity", "half the viscosity", (f"{VISCOSITY}=0.00125",)),
        Job("twice-viscosity", "twice the viscosity (shorter step)", (f"{VISCOSITY}=0.005", "time.step=0.008")),
        Job("half-slip", "half the slip over which the body softens", (f"{slip}=0.435",)),
        Job("twice-slip", "twice that slip", (f"{slip}=1.74",)),
        Job(
            "fine-same-viscosity",
            "cells of 5 m, the same viscosity (shorter step)",
            ("grid.cell=5", "time.step=0.003"),
        ),
        Job("quarter-shift", "the grid shifted by a quarter of a cell", _shifted(0.25)),
        Job("half-shift", "the grid shifted by half a cell", _shifted(0.5)),
        Job("twice-column-step", "twice the time step of the columns", ("band.column_step=0.1",)),
    ]


def cells_table(found: Mapping[str, Observed]) -> str:
    """Return the table of cells: displacement, runout, peak, and the difference of the finer two, by thickness."""
    lines = ["| e [m] | quantity | " + " | ".join(f"{cell:g} m" for cell in CELLS) + " | finer two differ by |"]
    lines.append("|---" * (len(CELLS) + 3) + "|")
    quantities = {each.name: each for each in QUANTITIES}
    for thickness in THICKNESSES:
        growth = " | ".join(f"{found[cell_key(thickness, cell)].dilation:.1f}" for cell in CELLS)
        for name in QUANTITY_NAMES:
            quantity = quantities[name]
            values = [getattr(found[cell_key(thickness, cell)], name) for cell in CELLS]
            difference = abs(values[-1] - values[-2]) / values[-2]
            text = f"{100.0 * difference:.1f} %" if np.isfinite(difference) else "none"
            head = f"{quantity.head} [{quantity.unit}]"
            numbers = " | ".join(quantity.text(value) for value in values)
            lines.append(f"| {thickness:g} | {head} | {numbers} | {text} |")
        lines.append(f"| {thickness:g} | growth of the volume [%] | {growth.replace('nan', 'none')} | |")
    return "\n".join(lines)


def numerics_table(rows: Sequence[Job], base: Observed, found: Mapping[str, Observed]) -> str:
    """Return one line per run: displacement, runout and peak, and their differences from the case."""
    quantities = [each for each in QUANTITIES if each.name in QUANTITY_NAMES]
    lines = ["| run | " + " | ".join(f"{each.head} [{each.unit}]" for each in quantities) + " | set |"]
    lines.append("|---" * (len(quantities) + 2) + "|")
    for row in rows:
        each = found[row.key]
        if each.failure and np.isnan(each.peak):
            lines.append(f"| {row.words} | {each.failure} |{' |' * (len(quantities) - 1)} |")
            continue
        cells = []
        for quantity in quantities:
            value, of_case = getattr(each, quantity.name), getattr(base, quantity.name)
            change = 100.0 * (value / of_case - 1.0) if of_case else float("nan")
            cells.append(f"{quantity.text(value)} ({change:+.1f} %)".replace("-", "−"))
        lines.append(f"| {row.words} | {' | '.join(cells)} | {' '.join(f'`{setting}`' for setting in row.sets)} |")
    return "\n".join(lines)
