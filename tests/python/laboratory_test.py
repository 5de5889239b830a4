"""Laboratory experiments: lines from particles, and values of figures."""

import numpy as np
import pytest

from reproduction.studies import laboratory


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
