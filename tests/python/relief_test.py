"""Hillshade compared with Horn's formula, and round numbers of contour lines and scale bars."""

import numpy as np
import pytest

from thawslide.relief import contour_levels, hillshade, round_number, slopes


def plane(slope_x: float, slope_y: float) -> np.ndarray:
    x, y = np.meshgrid(10.0 * np.arange(7), 5.0 * np.arange(6))
    return slope_x * x + slope_y * y


@pytest.mark.parametrize("slope_x", [-1.0, 0.0, 0.3])
@pytest.mark.parametrize("slope_y", [-0.5, 0.0, 2.0])
@pytest.mark.parametrize("exaggeration", [1.0, 3.0])
def test_brightness_of_a_plane_is_the_cosine_to_the_light(slope_x: float, slope_y: float, exaggeration: float) -> None:
    normal = np.array([-exaggeration * slope_x, -exaggeration * slope_y, 1.0])
    light = np.array([-0.5, 0.5, np.sqrt(0.5)])  # from the north-west, 45 degrees high
    wanted = max(0.0, float(normal @ light) / float(np.linalg.norm(normal)))
    np.testing.assert_allclose(hillshade(plane(slope_x, slope_y), 10.0, 5.0, exaggeration), wanted, atol=1e-12)


def test_brightness_depends_on_aspect_light_and_data() -> None:
    assert hillshade(np.zeros((4, 4)), 1.0, 1.0) == pytest.approx(np.sin(np.pi / 4))
    towards = plane(np.sqrt(0.5), -np.sqrt(0.5))  # falls to the north-west by 45 degrees
    assert hillshade(towards, 10.0, 5.0) == pytest.approx(1.0)
    assert hillshade(-2.0 * towards, 10.0, 5.0) == pytest.approx(0.0)
    assert hillshade(plane(-1.0, 0.0), 10.0, 5.0, azimuth=90.0, altitude=45.0) == pytest.approx(1.0)
    heights = plane(0.1, 0.2)
    heights[3, 3] = np.nan
    shade = hillshade(heights, 10.0, 5.0)
    assert np.isnan(shade[2:5, 2:5]).sum() >= 8 and np.isfinite(shade[:2]).all()


def test_slopes_have_weights_one_two_one_and_two_rows() -> None:
    heights = np.zeros((3, 3))
    heights[0, 2], heights[1, 2], heights[2, 2] = 8.0, 80.0, 800.0
    slope_x, slope_y = slopes(heights, 2.0, 4.0)
    assert slope_x[1, 1] == pytest.approx((8.0 + 2 * 80.0 + 800.0) / 16.0)
    assert slope_y[1, 1] == pytest.approx((800.0 - 8.0) / 32.0)
    with pytest.raises(ValueError, match=r"at least 2 x 2 heights \(found \(1, 5\)\)"):
        slopes(np.zeros((1, 5)), 1.0, 1.0)


@pytest.mark.parametrize(
    ("value", "found"), [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (49.0, 20.0), (730.0, 500.0), (0.07, 0.05)]
)
def test_round_number_is_not_above_the_value(value: float, found: float) -> None:
    assert round_number(value) == pytest.approx(found)


@pytest.mark.parametrize("span", [0.7, 3.0, 95.0, 1234.0, 3999.0])
@pytest.mark.parametrize("most", [5, 16, 24])
def test_contour_levels_are_few_round_and_inside(span: float, most: int) -> None:
    levels = contour_levels(np.array([[812.3, 812.3 + span, np.nan]]), most)
    assert 1 <= len(levels) <= most
    assert levels[0] >= 812.3 and levels[-1] <= 812.3 + span
    if len(levels) > 1:
        step = levels[1] - levels[0]
        assert round_number(step * (1 + 1e-9)) == pytest.approx(step)
        assert len(levels) > most / 6


def test_level_terrain_has_no_contour_lines_and_zero_no_round_number() -> None:
    assert not contour_levels(np.full((3, 3), 7.0), 10).size
    assert not contour_levels(np.full((3, 3), np.nan), 10).size
    with pytest.raises(ValueError, match="expected a positive number, found 0"):
        round_number(0.0)
