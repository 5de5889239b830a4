"""Weights of the prior check: on five slopes, weighted rigid blocks have the H/L distribution of published events."""

from pathlib import Path

import numpy as np
import pytest

import thawslide
from thawslide import Case
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.forecasts.output import prior_lines
from thawslide.forecasts.prior import LEFT, check_prior
from thawslide.forecasts.weights import cumulative, member_weights
from thawslide.scores.baseline import similar_events
from thawslide.scores.ensemble import quantiles
from thawslide.scores.forecast import MOVES, Forecast
from thawslide.sweeps.numbers import numbers_of_block
from thawslide.sweeps.sensitivity import effective_number

VOLUME = 2.5e6  # m3
CASE = """case = { dimension = 2 }
time = { end = 250.0, stepping = "adaptive", output_interval = 250.0, history_interval = 1.0 }
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


def blocks_on(slope: str, folder: Path, tangents: Numbers, end: float = 9000.0) -> tuple[Numbers, Numbers]:
    """Return H/L of a block of 60 m for each tangent of the friction angle, and whether it leaves at the end [m]."""
    points = np.array([*SLOPES[slope][:-1], (end, SLOPES[slope][-1][1])], dtype=float)
    x = np.unique([*points[:, 0], 60.0, 70.0, 110.0, 120.0])
    ground = np.interp(x, *points.T)
    surface = ground + np.interp(x, [60.0, 70.0, 110.0, 120.0], [0.0, 12.0, 12.0, 0.0], left=0.0, right=0.0)
    rows = np.column_stack((x, ground, surface))
    np.savetxt(
        folder / "profile.csv", rows, "%.9g", ",", comments="",
        header="distance_m,terrain_elevation_m,surface_elevation_m",
    )  # fmt: skip
    (folder / "case.toml").write_text(CASE.replace("9000.0", f"{end}"))
    found = []
    for angle in np.degrees(np.arctan(tangents)):
        table = thawslide.block(Case(folder, {"basal.friction_angle": float(angle)}))
        numbers = numbers_of_block({name: table[name].to_numpy() for name in table}, [], 250.0)
        found.append((numbers["h_over_l"], numbers[LEFT]))
        assert np.isfinite(numbers[LEFT]) or abs(table["velocity_m_s"].iloc[-1]) < 0.1
    ratios, left = np.array(found).T
    return ratios, np.isfinite(left)


@pytest.mark.parametrize("slope", SLOPES)
def test_weighted_blocks_have_the_distribution_of_the_events(slope: str, tmp_path: Path) -> None:
    tangents = np.tan(np.radians(np.linspace(8.0, 26.0, 37)))
    ratios, has_left = blocks_on(slope, tmp_path, tangents)
    assert not has_left.any()
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
    at = np.array([0.1, 0.2, 0.3, 0.35, 0.4, 0.5])
    assert cumulative(events, at) == pytest.approx([0.0, 0.125, 0.5, 0.6875, 0.875, 1.0])
    members = np.array([0.1, 0.25, 0.25, 0.35, 0.45, 0.19, 0.22, 0.31])
    weights = member_weights(members, events)
    assert weights[1] == weights[2]
    for bound in (0.145, 0.205, 0.235, 0.28, 0.33, 0.4):
        assert weights[members < bound].sum() == pytest.approx(cumulative(events, np.array(bound)))


@pytest.mark.parametrize(
    ("low", "high", "advice"), [(0.3, 0.6, "Lower the friction"), (0.1, 0.3, "Raise friction or band thickness"),
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


def weights_by_iteration(members: Numbers, is_limit: Numbers, events: Numbers) -> Numbers:
    """Return weights with the self-consistent estimate of censored data (Turnbull, 1976), found by iteration."""
    values = np.unique(members[~is_limit])
    lowest = members[is_limit & (members <= values[0])]
    atoms = np.append(-np.inf, values) if lowest.size else values
    allowed = np.where(is_limit[:, None], atoms < members[:, None], atoms == members[:, None])
    before = np.full(len(atoms), 1.0 / len(atoms))
    for _ in range(5000):
        expected = allowed * before
        before = (expected / expected.sum(axis=1, keepdims=True)).mean(axis=0)
    bounds = [lowest.max()] if lowest.size else []
    bounds += list(0.5 * (values[1:] + values[:-1]))
    target = np.diff(cumulative(events, np.array(bounds)), prepend=0.0, append=1.0)
    expected = allowed * before
    return np.asarray(expected / expected.sum(axis=1, keepdims=True) @ (target / before) / len(members))


@pytest.mark.parametrize("seed", range(5))
def test_limits_have_the_weights_of_an_independent_estimate(seed: int) -> None:
    random = np.random.default_rng(seed)
    events, truth = random.uniform(0.2, 0.5, 20), random.uniform(0.15, 0.6, 40)
    is_limit = random.random(40) < 0.1 * (seed + 2)
    members = np.where(is_limit, truth + random.uniform(0.0, 0.2, 40), truth)
    members[-3:] = members[-3]  # two limits and a known result, or several, of the same value
    weights = member_weights(members, events, is_limit)
    assert weights == pytest.approx(weights_by_iteration(members, is_limit, events), abs=1e-9)
    assert weights.sum() == pytest.approx(1.0) and weights.min() >= 0.0
    # A larger limit says less: the member keeps more of the weight of larger results.
    assert np.unique(weights[is_limit]).size > 1


def test_blocks_that_leave_a_short_dem_share_the_weight_of_lower_events(tmp_path: Path) -> None:
    tangents = np.tan(np.radians(np.linspace(8.0, 26.0, 37)))
    events = np.array([event.ratio for event in similar_events(VOLUME, "")])
    complete, _ = blocks_on("concave", tmp_path, tangents)
    ratios, is_limit = blocks_on("concave", tmp_path, tangents, end=4500.0)
    assert 10 < is_limit.sum() < 27
    assert ratios[~is_limit] == pytest.approx(complete[~is_limit])
    assert (ratios[is_limit] >= complete[is_limit]).all()
    weights, expected = member_weights(ratios, events, is_limit), member_weights(complete, events)
    # Larger H/L have the weights of a long DEM. The bin of the first of them borders on blocks that have left.
    stops = np.flatnonzero(ratios > ratios[is_limit].max())[1:]
    assert stops.size > 8 and weights[stops] == pytest.approx(expected[stops])
    # All others have the same weight together, and those that leave without an order share it.
    rest = np.setdiff1d(np.arange(len(ratios)), stops)
    assert weights[rest].sum() == pytest.approx(expected[rest].sum())
    assert np.ptp(weights[is_limit]) < 0.2 * weights[is_limit].mean()


def test_blocks_that_leave_are_limits_and_those_at_rest_have_no_weight() -> None:
    blocks = forecast(list(np.linspace(0.25, 0.6, 40)), moving=15)
    blocks.columns[LEFT] = np.where(np.arange(40) < 12, 50.0, np.nan)
    prior = check_prior(blocks, VOLUME, "", True)
    assert prior.weights is not None and prior.is_limit.sum() == 15
    share = round(100.0 * prior.weights[:15].sum())
    assert prior.notes[-1] == (
        "12 of 40 blocks leave the DEM or reach the end of their path, 3 still move at time.end. Their H/L is an upper "
        f"limit, at most {prior.ratios[14]:.2f}; they have {share} % of the weight, that of events of lower H/L"
    )
    lines = prior_lines(prior.as_table())
    assert "≤ 0.26" in lines[2] and lines[2].split()[-1] == "0.58" and "≤" not in lines[4]
    assert check_prior(blocks, VOLUME, "", False).notes[-1].endswith("Their H/L is an upper limit, at most 0.38")
    blocks = forecast(list(np.linspace(0.1, 0.6, 40)))
    blocks.columns["displacement_m"][::4] = 0.0
    prior = check_prior(blocks, VOLUME, "", True)
    assert prior.members == [number for number in range(40) if number % 4] and prior.weights is not None
    assert prior.weights.sum() == pytest.approx(1.0)
    assert "10 of 40 blocks do not leave: they have no weight" in prior.notes[-1]


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
    words = r"found H/L at most 0\.17 of rigid blocks; 0 % of the events below, 100 % above"
    with pytest.raises(ReportError, match=words):
        check_prior(forecast([0.17] * 40, moving=40), VOLUME, "", True)
    all_leave = check_prior(forecast([0.6] * 40, moving=40), VOLUME, "", True)
    assert all_leave.weights == pytest.approx(1.0 / 40) and "they have 100 % of the weight" in all_leave.notes[-1]
    assert "no comparison" in check_prior(forecast(ratios), 1e3, "", False).notes[-1]
    assert "Pink Mountain" in check_prior(forecast(ratios), VOLUME, "", False).events
    assert "Pink Mountain" not in check_prior(forecast(ratios), VOLUME, "", False, "Pink Mountain").events
    prior = check_prior(forecast([*ratios, np.nan]), VOLUME, "rock", True)
    assert prior.members == list(range(40)) and prior.weights is not None
    assert [row[1] for row in prior.rows()][::2] == [40, len(similar_events(VOLUME, "rock"))]
    assert prior.rows()[1][3] == pytest.approx(prior.rows()[2][3], abs=0.02)
