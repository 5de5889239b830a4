"""Point masses on a profile: closed forms on a plane and at a bend, and chains."""

import numpy as np
import pytest

from reproduction.point_masses import GRAVITY, Friction, move, smooth_profile

X = np.arange(0.0, 4000.0, 10.0)
PLANE = smooth_profile(X, 2000.0 - 0.5 * X)
ANGLE = np.arctan(0.5)


def friction(*coefficients: float) -> Friction:
    """Return one coefficient for each sample, everywhere."""
    values = np.array(coefficients)[:, None]
    return Friction(values, values, np.full_like(values, 50.0), values, 1e9)


def test_a_point_on_a_plane_has_the_closed_form() -> None:
    found = move(PLANE, np.array([500.0]), np.zeros((2, 1)), friction(0.1, 0.3), 10.0, 0.01, chained=False)
    for sample, coefficient in enumerate((0.1, 0.3)):
        down = GRAVITY * (np.sin(ANGLE) - coefficient * np.cos(ANGLE))
        inner = slice(5, -5)
        assert found.up[sample, inner] == pytest.approx(down * np.sin(ANGLE), rel=1e-3)
        assert found.along[sample, inner] == pytest.approx(-down * np.cos(ANGLE), rel=1e-3)


def test_a_point_that_friction_holds_does_not_move() -> None:
    found = move(PLANE, np.array([500.0]), np.zeros((1, 1)), friction(0.6), 2.0, 0.01, chained=False)
    assert np.all(found.up == 0.0) and np.all(found.along == 0.0)


def test_momentum_is_the_integral_of_the_force_past_a_bend() -> None:
    bent = smooth_profile(X, np.where(X < 1000.0, 1500.0 - 0.5 * X, 1000.0))
    found = move(bent, np.array([700.0]), np.zeros((1, 1)), friction(0.0), 20.0, 0.005, chained=False)
    speed = -np.cumsum(found.along[0]) * 0.005
    drop = np.interp(700.0, bent.x, bent.z) - bent.z[-1]
    assert speed[-10] == pytest.approx(np.sqrt(2.0 * GRAVITY * drop), rel=5e-3)
    assert np.sum(found.up[0]) * 0.005 == pytest.approx(0.0, abs=0.2)


@pytest.mark.parametrize("chained", [False, True])
def test_a_part_that_is_held_leaves_later(chained: bool) -> None:
    starts = np.array([[0.0, 0.0, 3.0, 3.0]])
    found = move(PLANE, np.array([600.0, 580.0, 560.0, 540.0]), starts, friction(0.2), 6.0, 0.01, chained)
    before, after = found.up[0, 200], found.up[0, 500]
    assert after == pytest.approx(2.0 * before, rel=1e-2)


def test_a_chain_has_one_acceleration() -> None:
    bent = smooth_profile(X, np.where(X < 1000.0, 1500.0 - 0.5 * X, 1000.0))
    places = np.array([1100.0, 700.0])  # on the flat, and on the slope
    found = move(bent, places, np.zeros((1, 2)), friction(0.0), 2.0, 0.01, chained=True)
    common = 0.5 * GRAVITY * np.sin(ANGLE)
    inner = slice(5, -5)
    assert found.along[0, inner] == pytest.approx(-0.5 * common * (1.0 + np.cos(ANGLE)), rel=1e-3)
    assert found.up[0, inner] == pytest.approx(0.5 * common * np.sin(ANGLE), rel=1e-3)
