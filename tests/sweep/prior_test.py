"""Weights of the prior check: on five slopes, weighted rigid blocks have the H/L distribution of published events."""

from pathlib import Path

import numpy as np
import pytest

import thawslide
from thawslide import Case
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.forecasts.prior import check_prior
from thawslide.forecasts.weights import cumulative, member_weights
from thawslide.scores.baseline import similar_events
from thawslide.scores.ensemble import quantiles
from thawslide.scores.forecast import MOVES, Forecast
from thawslide.sweeps.numbers import numbers_of_block
from thawslide.sweeps.sensitivity import effective_number

VOLUME = 2.5e6  # m3
CASE = """case = { dimension = 2 }
time = { end = 250.0, stepping = "adaptive", output_interval = 250.0, history_interval = 5.0 }
grid = { cell = 10.0, min = [0.0, -50.0], max = [9000.0, 1300.0] }
terrain = { type = "profile", file = "profile.csv" }
basal = { friction = "constant", friction_angle = 20.0 }
block = { bends = false }
heat = { enabled = false }
pressure = { enabled = false }
material.rock = { law = "elastic", youngs_modulus = 5.0e6, poisson_ratio = 0.2 }

[body.block]
material = "rock"
shape = "surface"
"""
# Distance and elevation of the terrain [m]: a plane, a kinked slope, steps, a concave slope, and a slope that rises.
FALL = np.linspace(0.0, 2600.0, 53)
SLOPES = {
    "plane": [(0, 1200), (1600, 0), (9000, 0)],
    "kinked": [(0, 1250), (1000, 250), (4000, 0), (9000, 0)],
    "steps": [(0, 1150), (500, 750), (700, 720), (1700, 100), (3000, 30), (9000, 0)],
    "concave": [*zip(FALL, 1200.0 * (1.0 - FALL / 2600.0) ** 2, strict=True), (9000, 0)],
    "rising": [(0, 1200), (1500, 0), (3000, 0), (9000, 400)],
}


def blocks_on(slope: str, folder: Path, tangents: Numbers) -> Numbers:
    """Return H/L of a block of 60 m for each tangent of the friction angle."""
    points = np.array(SLOPES[slope], dtype=float)
    x = np.unique([*points[:, 0], 60.0, 70.0, 110.0, 120.0])
    ground = np.interp(x, *points.T)
    surface = ground + np.interp(x, [60.0, 70.0, 110.0, 120.0], [0.0, 12.0, 12.0, 0.0], left=0.0, right=0.0)
    rows = np.column_stack((x, ground, surface))
    np.savetxt(
        folder / "profile.csv", rows, "%.9g", ",", comments="",
        header="distance_m,terrain_elevation_m,surface_elevation_m",
    )  # fmt: skip
    (folder / "case.toml").write_text(CASE)
    found = []
    for angle in np.degrees(np.arctan(tangents)):
        table = thawslide.block(Case(folder, {"basal.friction_angle": float(angle)}))
        assert abs(table["velocity_m_s"].iloc[-1]) < 0.1
        found.append(numbers_of_block({name: table[name].to_numpy() for name in table}, [])["h_over_l"])
    return np.array(found)


@pytest.mark.parametrize("slope", SLOPES)
def test_weighted_blocks_have_the_distribution_of_the_events(slope: str, tmp_path: Path) -> None:
    tangents = np.tan(np.radians(np.linspace(8.0, 26.0, 37)))
    ratios = blocks_on(slope, tmp_path, tangents)
    # A point mass with Coulomb friction has H/L = tan(phi) on every profile; the block is 60 m long.
    assert ratios == pytest.approx(tangents, rel=0.1)
    events = np.array([event.ratio for event in similar_events(VOLUME, "")])
    weights = member_weights(ratios, events)
    assert weights.sum() == pytest.approx(1.0) and weights.min() >= 0.0

    at = np.linspace(0.1, 0.6, 501)
    target = cumulative(events, at)

    def distance(mass: Numbers) -> float:
        return float(np.max(np.abs(mass @ (ratios[:, None] <= at) - target)))

    # Kolmogorov's distance that 5 % of the samples of the effective number exceed.
    sampling_error = 1.36 / np.sqrt(effective_number(weights))
    assert distance(weights) < min(0.1, sampling_error)
    assert distance(np.full(len(ratios), 1.0 / len(ratios))) > 0.2
    for found, expected in zip(quantiles(ratios, weights), np.quantile(events, (0.05, 0.5, 0.95)), strict=True):
        assert found == pytest.approx(expected, abs=np.std(events) / np.sqrt(len(events)))
    assert weights @ tangents == pytest.approx(events.mean(), abs=np.std(events) / np.sqrt(len(events)))


def test_weights_are_exact_between_members_and_shared_by_equal_ones() -> None:
    events = np.array([0.2, 0.3, 0.3, 0.4])
    assert cumulative(events, np.array([0.1, 0.2, 0.3, 0.35, 0.4, 0.5])) == pytest.approx(
        [0.0, 0.125, 0.5, 0.6875, 0.875, 1.0]
    )
    members = np.array([0.1, 0.25, 0.25, 0.35, 0.45, 0.19, 0.22, 0.31])
    weights = member_weights(members, events)
    assert weights[1] == weights[2]
    for bound in (0.145, 0.205, 0.235, 0.28, 0.33, 0.4):
        assert weights[members < bound].sum() == pytest.approx(cumulative(events, np.array(bound)))


@pytest.mark.parametrize(
    ("low", "high", "advice"), [(0.3, 0.6, "Lower the friction"), (0.1, 0.3, "Raise the friction"),
                                (0.25, 0.3, "Widen the ranges")],
)  # fmt: skip
def test_members_that_do_not_cover_the_events_are_refused(low: float, high: float, advice: str) -> None:
    with pytest.raises(ReportError, match=r"\d+ % of the events below, \d+ % above; allowed: 10 %") as error:
        member_weights(np.linspace(low, high, 30), np.linspace(0.2, 0.4, 21))
    assert f"found H/L {low:.2f} to {high:.2f} of rigid blocks" in str(error.value)
    assert f"{advice} in sweep.toml" in str(error.value)


def test_few_effective_members_are_refused() -> None:
    members = np.array([0.01, *np.full(4, 0.3), *np.linspace(0.8, 0.9, 30)])
    with pytest.raises(ReportError, match=r"found 4\.\d effective members; needed 5"):
        member_weights(members, np.linspace(0.2, 0.4, 21))


def forecast(ratios: list[float], displacement: float = 100.0, moving: int = 0) -> Forecast:
    count = len(ratios)
    columns = {"h_over_l": np.array(ratios), "displacement_m": np.full(count, displacement)}
    columns[MOVES] = (np.arange(count) < moving).astype(float)
    return Forecast(Path("prior"), True, list(range(count)), np.full(count, 1.0 / count), columns, [])


def test_a_prior_check_needs_members_that_leave_and_events() -> None:
    with pytest.raises(ReportError, match=r"too few members with H/L of a rigid block \(found 9 of 10; needed 10\)"):
        check_prior(forecast([*np.linspace(0.1, 0.6, 9), np.nan]), VOLUME, "", False)
    ratios = list(np.linspace(0.1, 0.6, 40))
    with pytest.raises(ReportError, match=r"no member leaves \(found 40 rigid blocks at rest\)"):
        check_prior(forecast(ratios, 0.5), VOLUME, "", False)
    with pytest.raises(ReportError, match="fewer than 5 published events with a volume similar to 1,000 m"):
        check_prior(forecast(ratios), 1e3, "", True)
    with pytest.raises(ReportError, match=r"most rigid blocks still move .* \(found 21 of 40; allowed: at most half\)"):
        check_prior(forecast(ratios, moving=21), VOLUME, "", True)
    assert "no comparison" in check_prior(forecast(ratios), 1e3, "", False).notes[-1]
    assert "Pink Mountain" in check_prior(forecast(ratios), VOLUME, "", False).events
    assert "Pink Mountain" not in check_prior(forecast(ratios), VOLUME, "", False, "Pink Mountain").events
    prior = check_prior(forecast([*ratios, np.nan]), VOLUME, "rock", True)
    assert prior.members == list(range(40)) and prior.weights is not None
    assert [row[1] for row in prior.rows()][::2] == [40, len(similar_events(VOLUME, "rock"))]
    assert prior.rows()[1][3] == pytest.approx(prior.rows()[2][3], abs=0.02)


def test_members_that_do_not_leave_have_no_weight() -> None:
    blocks = forecast(list(np.linspace(0.1, 0.6, 40)))
    blocks.columns["displacement_m"][::4] = 0.0
    prior = check_prior(blocks, VOLUME, "", True)
    assert prior.members == [number for number in range(40) if number % 4] and prior.weights is not None
    assert prior.weights.sum() == pytest.approx(1.0)
    assert "10 of 40 blocks do not leave: they have no weight" in prior.notes[-1]
