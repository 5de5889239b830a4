"""Arguments and designs of a sweep: values, addresses, truncated distributions, tied keys and correlated keys."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from conftest import Capture
from scipy.stats import spearmanr

import thawslide
from thawslide.arrays import Numbers
from thawslide.errors import ReportError
from thawslide.sweeps.command import main
from thawslide.sweeps.declared import limits_of_key
from thawslide.sweeps.design import Design, parse_correlation
from thawslide.sweeps.expressions import Expression
from thawslide.sweeps.variables import Levels, Normal, Uniform, Variable, levels, parse_levels, toml_value, truncated

ANGLE, COHESION = "basal.friction_angle", "basal.cohesion"
INSIDE = (-np.inf, np.inf)


@pytest.mark.parametrize(
    ("key", "low", "high"),
    [
        (ANGLE, 0.0, 90.0), ("body.slide.porosity", 0.0, 0.95), ("band.thickness", 0.0, np.inf),
        ("material.rock.poisson_ratio", -1.0, 0.5), ("grid.boundary.x_min", *INSIDE), ("no.such.key", *INSIDE),
    ],
)  # fmt: skip
def test_limits_are_those_of_the_reference(key: str, low: float, high: float) -> None:
    assert limits_of_key(key) == pytest.approx((low, high))


@pytest.mark.parametrize(
    ("variable", "low", "high"),
    [
        (Uniform("a", -10.0, 20.0), 0.0, 20.0), (Uniform("a", 80.0, 100.0), 80.0, 90.0),
        (Normal("a", 5.0, 4.0), 0.0, 17.0),
        (Normal("a", 80.0, 5.0), 65.0, 90.0), (Normal("a", 60.0, 0.5, True), 60.0 * np.exp(-1.5), 90.0),
    ],
)  # fmt: skip
def test_a_distribution_is_truncated_at_the_limits(variable: Variable, low: float, high: float) -> None:
    cut = truncated(variable, 0.0, 90.0)
    ends = (cut.at(0.0), cut.at(1.0))
    assert ends == pytest.approx((low, high), abs=1e-3) and ends[0] > 0.0 and ends[1] < 90.0
    values = [variable.at(u) for u in np.linspace(0.0, 1.0, 20001)]
    inside = [value for value in values if low <= value <= high]
    for u in (0.1, 0.5, 0.9):  # the distribution of the values that are left does not change
        assert cut.at(u) == pytest.approx(np.quantile(inside, u), rel=2e-3)


def test_a_distribution_inside_its_limits_does_not_change() -> None:
    for variable in (Uniform("a", 1.0, 2.0), Normal("a", 40.0, 2.0), Levels("a", (-5.0, 100.0))):
        assert truncated(variable, 0.0, 90.0) is variable
    with pytest.raises(ReportError, match=r"no value of the distribution is allowed \(found 95 to 99"):
        truncated(Uniform("a", 95.0, 99.0), 0.0, 90.0)


@pytest.mark.parametrize("sample", ["lhs:20", "sobol:16", "saltelli:4", "morris:4"])
def test_a_sweep_beyond_the_limits_of_keys_has_a_note(slope: Path, tmp_path: Path, capfd: Capture, sample: str) -> None:
    command = [str(slope), "--block", "--set", "time.end=0.02", "--sample", sample, "--output", str(tmp_path / "sweep")]
    command += ["--normal", f"{ANGLE}=5:4", "--range", "band.thickness=0:1"]
    assert main(command) == 0
    errors = capfd.readouterr().err
    assert f"note: {ANGLE}: the distribution is truncated to 2.4e-05 to 17, the allowed values" in errors
    assert "note: band.thickness: the distribution is truncated to 1e-06 to 1, the allowed values" in errors
    table = pd.read_parquet(tmp_path / "sweep" / "members.parquet")
    assert (table[ANGLE] > 0.0).all() and (table["band.thickness"] > 0.0).all()


def tie(key: str, text: str) -> Expression:
    return Expression(key, text, "--tie")


def test_tied_keys_follow_the_others_in_order() -> None:
    ties = (tie("b.c", "0.5 * a.x + two"), tie("d", "min(b.c, 1) + max(a.x, 3)"), tie("whole", "a.x * 2"))
    design = Design(("case",), (Levels("a.x", (1, 4)), Levels("two", (2,))), ties=ties)
    assert [member.changes for member in design.members()] == [
        {"two": 2, "a.x": 1, "b.c": 2.5, "d": 4, "whole": 2},
        {"two": 2, "a.x": 4, "b.c": 4, "d": 5, "whole": 8},
    ]


@pytest.mark.parametrize(
    ("ties", "words"),
    [
        (["a=2"], "varied twice"), (["b=a+"], "--tie b: not an expression"),
        (["b=c"], "--tie b: no varied or set key 'c'"),
        (["b=__import__('os')"], "not allowed|no function"), (["b=a.x.y"], "no varied or set key 'a.x.y'"),
        (["b=title"], "no varied or set key 'title'"),
    ],
)  # fmt: skip
def test_invalid_ties_are_refused(ties: list[str], words: str) -> None:
    with pytest.raises(ReportError, match=words):
        Design(
            ("case",), (Levels("a", (1.0, 2.0)), Levels("title", ("x",))),
            ties=tuple(Expression.parse(text, "--tie") for text in ties),
        ).members()  # fmt: skip


def test_a_tie_makes_a_design_possible(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    residual = "material.rock.residual_cohesion"
    command = [str(slope), "--block", "--sample", "lhs:8", "--range", "material.rock.cohesion=1e4:2e5"]
    command += ["--set", "material.rock.softening_slip=0.5"]
    assert main([*command, "--range", f"{residual}=1e4:2e5", "--output", str(tmp_path / "a")]) == 2
    assert "Give a residual at most the cohesion" in capfd.readouterr().err
    assert main([*command, "--tie", f"{residual}=0.5*material.rock.cohesion", "--output", str(tmp_path / "b")]) == 0
    table = pd.read_parquet(tmp_path / "b" / "members.parquet")
    assert np.allclose(table[residual], 0.5 * table["material.rock.cohesion"])
    page = (tmp_path / "b" / "sweep.html").read_text()
    assert "0.5*material.rock.cohesion" in page


def ranks_of(design: Design) -> Numbers:
    return np.asarray(spearmanr(design.probabilities()).statistic)


@pytest.mark.parametrize(("method", "count"), [("lhs", 400), ("sobol", 512)])
@pytest.mark.parametrize("value", [-0.9, 0.3, 0.8])
def test_correlated_keys_have_the_rank_correlation_and_distributions(method: str, count: int, value: float) -> None:
    variables = (Uniform("a", 0.0, 1.0), Normal("b", 5.0, 1.0), Normal("c", 1.0, 0.5, True))
    free = Design(("case",), variables, method, count, 3)
    design = Design(("case",), variables, method, count, 3, correlations=(("c", "a", value),))
    found = ranks_of(design)
    assert found[0, 2] == pytest.approx(value, abs=0.03)
    assert found[0, 1] == pytest.approx(0.0, abs=0.05) and found[1, 2] == pytest.approx(0.0, abs=0.05)
    np.testing.assert_array_equal(np.sort(design.probabilities(), axis=0), np.sort(free.probabilities(), axis=0))
    assert design.members() == design.members()


@pytest.mark.parametrize(
    ("method", "count", "correlations", "words"),
    [
        ("lhs", 9, [("a", "x", 0.5)], "x does not vary"), ("lhs", 9, [("a", "b", 1.0)], "between -1"),
        ("lhs", 9, [("a", "a", 0.5)], "two keys"), ("morris", 9, [("a", "b", 0.5)], "allowed lhs, sobol"),
        ("lhs", 3, [("a", "b", 0.5)], "more than 3 members"),
        ("lhs", 9, [("a", "b", 0.9), ("b", "c", 0.9), ("a", "c", -0.9)], "contradict each other"),
    ],
)  # fmt: skip
def test_invalid_correlations_are_refused(method: str, count: int, correlations: list[Any], words: str) -> None:
    variables = tuple(Uniform(key, 0.0, 1.0) for key in "abc")
    with pytest.raises(ReportError, match=words):
        Design(("case",), variables, method, count, correlations=tuple(correlations))


def test_forms_of_a_correlation() -> None:
    assert parse_correlation("a.b, c=-0.5") == ("a.b", "c", -0.5)
    for text in ("a,b", "a,b=x", "=", ""):
        with pytest.raises(ReportError, match="Specify KEY,KEY=NUMBER"):
            parse_correlation(text)


def test_correlated_and_tied_keys_in_a_file_and_from_python(slope: Path, tmp_path: Path) -> None:
    file = tmp_path / "sweep.toml"
    file.write_text(
        f'[sweep]\nblock = true\ncases = ["slope"]\nsample = "lhs:30"\n[sweep.range]\n"{ANGLE}" = [10, 20]\n'
        f'"{COHESION}" = [1e3, 2e3]\n[sweep.set]\n"basal.slip_distance" = 20.0\n[sweep.correlate]\n'
        f'"{ANGLE},{COHESION}" = -0.7\n'
        f'[sweep.tie]\n"{COHESION.replace("cohesion", "residual_cohesion")}" = "{COHESION} / 2"\n'
    )
    assert main([str(file), "--output", str(tmp_path / "a")]) == 0
    table = pd.read_parquet(tmp_path / "a" / "members.parquet")
    assert spearmanr(table[ANGLE], table[COHESION]).statistic == pytest.approx(-0.7, abs=0.1)
    other = thawslide.sweep(
        slope, tmp_path / "b", ranges={ANGLE: (10, 20), COHESION: (1e3, 2e3)}, sample="lhs:30", block=True,
        vary={"basal.slip_distance": [20.0]},
        correlate={(ANGLE, COHESION): -0.7}, tie={"basal.residual_cohesion": f"{COHESION} / 2"}, progress=False,
    )  # fmt: skip
    keys = [ANGLE, COHESION, "basal.residual_cohesion"]
    pd.testing.assert_frame_equal(table[keys], other[keys])


@pytest.mark.parametrize(
    "address", ["tcp://127.0.0.1:9", "127.0.0.1:9", "nonsense://node:1", "tcp://127.0.0.1:x", "tls://127.0.0.1:9"]
)
def test_a_scheduler_without_an_answer_is_an_error(
    slope: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: Capture, address: str
) -> None:
    monkeypatch.setattr("thawslide.sweeps.engine._CONNECT_TIMEOUT", 0.5)
    command = [str(slope), "--block", "--vary", "basal.friction_angle=10,12", "--output", str(tmp_path / "sweep")]
    assert main([*command, "--scheduler", address]) == 2
    errors = capfd.readouterr().err
    assert f"error: --scheduler {address}: no connection (" in errors and "correct the address" in errors
    if address == "tcp://127.0.0.1:9":
        assert main(command) == 0  # the sweep continues without it


@pytest.mark.parametrize("text", ["2025-05-28", "2025-05-28T10:00:00Z", "2025-05-28 10:00:00.5", "12:30:00"])
def test_dates_and_times_are_texts(text: str) -> None:
    assert toml_value(text) == text
    assert parse_levels(f"case.title={text},a").values == (text, "a")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('[sweep.vary]\n"case.title" = [2025-05-28]', "case.title: a case has no value of type date"),
        ('[sweep.vary]\n"time.end" = 5', "sweep.vary.'time.end': not a list (found '5')"),
        ("[sweep.vary.time]\nend = [1, 2]", "sweep.vary.'time': not a list"),
        ('seed = -1\n[sweep.range]\n"basal.friction_angle" = [1, 2]', "--seed: negative (found -1)"),
        ('[sweep.set]\n"case.title" = 2025-05-28', "case.title: a case has no value of type date"),
    ],
)
def test_values_in_a_file_are_checked(slope: Path, tmp_path: Path, capfd: Capture, content: str, message: str) -> None:
    file = tmp_path / "sweep.toml"
    sample = 'sample = "lhs:4"\n' if "range" in content else ""
    file.write_text(f'[sweep]\nblock = true\ncases = ["slope"]\n{sample}{content}\n')
    assert main([str(file), "--output", str(tmp_path / "sweep")]) == 2
    assert message in capfd.readouterr().err


def test_numbers_of_numpy_and_paths_are_values(slope: Path, tmp_path: Path) -> None:
    profiles = [slope.parent / "profile.csv"]
    vary: dict[str, Any] = {"basal.friction_angle": np.array([10.0, 12.0]), "terrain.file": profiles}
    table = thawslide.sweep(slope, tmp_path / "sweep", vary=vary, block=True, progress=False)
    assert list(table["basal.friction_angle"]) == [10.0, 12.0]


def test_values_of_other_types_are_refused() -> None:
    for value in (object(), {1, 2}, 1j, None):
        with pytest.raises(ReportError, match=r"a: a case has no value of type"):
            levels("a", [value])
