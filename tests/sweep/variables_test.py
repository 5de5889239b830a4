"""Varied keys: their forms on the command line, and distributions."""

from __future__ import annotations

import pytest

from thawslide.errors import ReportError
from thawslide.sweeps.variables import Levels, Normal, Uniform, parse_distribution, parse_levels


def test_lists_have_values_of_toml_or_text() -> None:
    assert parse_levels("band.thickness=0.05,0.1,0.2") == Levels("band.thickness", (0.05, 0.1, 0.2))
    assert parse_levels("basal.friction=coulomb,lubricated").values == ("coulomb", "lubricated")
    assert parse_levels("heat.steam=true,false").values == (True, False)
    assert parse_levels("body.block.velocity=[0.0, 1.0],[0.0, 2.0]").values == ([0.0, 1.0], [0.0, 2.0])


def test_steps_include_both_ends() -> None:
    assert parse_levels("basal.friction_angle=20:30:5").values == (20, 25, 30)
    assert parse_levels("band.thickness=0.1:0.3:0.1").values == (0.1, 0.2, 0.3)
    assert parse_levels("band.thickness=0.1:0.35:0.1").values == (0.1, 0.2, 0.3)


@pytest.mark.parametrize("text", ["band.thickness", "=1", "k=", "k=1,1", "k=3:1:1", "k=1:2:0", "k=0:1:1e-9"])
def test_invalid_lists_are_refused(text: str) -> None:
    with pytest.raises(ReportError, match="--vary"):
        parse_levels(text)


def test_distributions_have_their_quantiles() -> None:
    uniform = parse_distribution("range", "k=2:4")
    assert uniform == Uniform("k", 2.0, 4.0) and uniform.at(0.25) == 2.5
    normal = parse_distribution("normal", "k=10:2")
    assert isinstance(normal, Normal) and normal.at(0.5) == pytest.approx(10.0)
    assert normal.at(0.0) == pytest.approx(4.0) and normal.at(1.0) == pytest.approx(16.0)
    lognormal = parse_distribution("lognormal", "k=10:0.5")
    assert lognormal.at(0.5) == pytest.approx(10.0)
    assert lognormal.at(1.0) == pytest.approx(10.0 * 2.718281828**1.5, rel=1e-6)


@pytest.mark.parametrize(
    ("kind", "text"),
    [("range", "k=2:2"), ("range", "k=2"), ("normal", "k=1:0"), ("lognormal", "k=-1:1"), ("range", "k=nan:1")],
)
def test_invalid_distributions_are_refused(kind: str, text: str) -> None:
    with pytest.raises(ReportError, match=f"--{kind}"):
        parse_distribution(kind, text)
