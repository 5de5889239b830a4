"""Laboratory experiments: lines from particles, and values of figures."""

from pathlib import Path

import numpy as np
import pytest

from reproduction.studies import laboratory, laboratory_page
from reproduction.study import Place


def test_windows_contain_the_whole_volume_and_are_half_as_wide_at_the_wall() -> None:
    rng = np.random.default_rng(3)
    x, volume = rng.uniform(0.1, 2.0, 200), rng.uniform(0.0, 1.0, 200)
    window = 0.125
    at = np.arange(0.5 * window, 3.0, window)
    found = laboratory.thickness(x, volume, at, window, 0.07)
    assert float(found.sum() * window) == pytest.approx(float(volume.sum()), rel=1e-12)
    assert np.all(found[at > 2.2] == 0.0)
    x, volume = np.arange(0.005, 1.0, 0.01), np.full(100, 0.01 * 3.0)
    assert laboratory.thickness(x, volume, np.array([0.0, 0.5]), 0.2, 0.01) == pytest.approx([3.0, 3.0])


@pytest.mark.parametrize("slope", [-0.5, 0.0, 0.25])
def test_failure_line_of_a_linear_field_is_exact(slope: float) -> None:
    # Displacement 0.1 (y - line(x)) above the line and below it (negative, which is not moved), in rows 1 mm apart.
    spacing = 0.001
    grid = (np.arange(100) + 0.5) * spacing
    x, y = (each.ravel() for each in np.meshgrid(grid, grid))
    line = 0.05 + slope * (x - 0.05)
    places = np.array([0.03, 0.05, 0.06])
    found = laboratory.failure_line(np.column_stack((x, y)), 0.1 * (y - line), places, 0.001, spacing)
    assert found == pytest.approx(0.05 + slope * (places - 0.05) + 0.01, abs=1e-4)


def test_failure_line_of_material_at_rest_is_its_top_and_measured_lines_are_complete() -> None:
    start = np.array([[0.05, 0.01], [0.05, 0.03], [0.05, 0.05]])
    assert laboratory.failure_line(start, np.zeros(3), np.array([0.05]), 0.001, 0.02) == [laboratory.BAR_HEIGHT]
    for name, count, place, x, height in (
        ("surface", 23, -1, 0.442348498, 0.001519511), ("failure", 9, 0, 0.021159264, 0.098901077),
    ):  # fmt: skip
        found = laboratory.read_points(laboratory.MEASURED / f"{name}.csv")
        assert (len(found[0]), found[0][place], found[1][place]) == (count, x, height)


def test_runs_have_unique_names_and_keys() -> None:
    jobs = laboratory.jobs(Place(Path("program"), Path("runs"), Path("pages")))
    assert len({job.key for job in jobs}) == len(jobs) > 60
    for job in jobs:
        keys = [change.split("=")[0] for change in job.sets]
        assert len(set(keys)) == len(keys)


def bars(cell: float, offset: float) -> laboratory.Bars:
    """Return bars whose lines lie above the measured ones by an offset [m]."""
    surface = laboratory.read_points(laboratory.MEASURED / "surface.csv")
    failure = laboratory.read_points(laboratory.MEASURED / "failure.csv")
    lifted = failure[1] + offset
    return laboratory.Bars(
        cell, surface[1] + offset, (surface[0], surface[1] + offset), lifted,
        (failure[0], lifted), 0.442 + offset, 0.02,
    )  # fmt: skip


def test_figure_of_bars_has_runs_and_measurements() -> None:
    found = {
        (transfer, cell): bars(cell, 1e-4 * cell + (0.001 if transfer == "apic" else 0.0))
        for transfer in laboratory.TRANSFERS
        for cell in laboratory.BAR_CELLS
    }
    for panel, transfer in zip(laboratory_page.bar_figure(found).axes, laboratory.TRANSFERS, strict=True):
        lines = {str(line.get_label()): line for line in panel.lines}
        for cell in laboratory.BAR_CELLS[1:]:
            of_cell = found[transfer, cell]
            for words, profile in ("surface", of_cell.profile), ("failure line", of_cell.failure_profile):
                np.testing.assert_array_equal(lines[f"{words}, cells of {cell:g} mm"].get_data(), profile)
        for words, name in ("surface", "surface"), ("failure line", "failure"):
            measured = laboratory.read_points(laboratory.MEASURED / f"{name}.csv")
            line = lines[f"{words}, measured (MaterialPointSolver.jl; Bui et al. 2008)"]
            np.testing.assert_array_equal(line.get_data(), measured)


def test_table_of_bars_has_offsets() -> None:
    found = {("flip", 10.0): bars(10.0, 0.002), ("flip", 5.0): bars(5.0, -0.003)}
    rows = [line.split(" | ") for line in laboratory_page.bar_table(found).splitlines()]
    assert (rows[2][1:], rows[3][1:]) == (["2.0", "3.0 |"], ["+2.0", "-3.0 |"])
    assert (rows[4][1:], rows[5][1:]) == (["+2", "-3 |"], ["", "5.0 |"])
