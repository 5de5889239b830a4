"""Runs that fail or reach unphysical temperatures: exit codes, messages with position, time and cause, last state."""

import re
from collections.abc import Callable
from pathlib import Path

import h5py
import pytest
from conftest import FALL, LAMPLUGH, Program, edit, history, run_facts, sets, snapshot_files

PATTERN = (
    r"error: the run failed at t = (\S+) s \(step (\d+)\): particle (\d+) of body '(\w+)' at \((\S+), (\S+)\) m: "
    r"(.*?)\. (?:It moves at \S+ m/s, the slide at \S+ m/s on average\. )?Likely cause: (.*)\n"
)


def expect_failure(thawslide: Program, case: Path, run: Path, **keys: object) -> re.Match[str]:
    """Run a case that must fail, check its files, and return the match of the message."""
    words = sets(**keys)
    message = thawslide.error("run", case, "--output", run, *words, code=3)
    reported = re.fullmatch(PATTERN, message)
    assert reported, message
    time, step, particle = float(reported[1]), int(reported[2]), int(reported[3])
    facts = run_facts(run)
    assert facts["status"] == "failed"
    assert f"error: {facts['message']}\n" == message
    assert facts["simulated_time_s"] == pytest.approx(time, rel=1e-5) and facts["steps"] == step
    columns = history(run)
    assert columns["step"][-1] == step and columns["time_s"][-1] == pytest.approx(time, rel=1e-5)
    with h5py.File(snapshot_files(run)[-1]) as last:
        assert last["VTKHDF"].attrs["step"] == step
        place = last["VTKHDF/Points"][particle]
        assert last["VTKHDF/PointData/id"][particle] == particle
    assert place[:2] == pytest.approx([float(reported[5]), float(reported[6])], rel=1e-4)
    with h5py.File(run / "particles.vtkhdf") as index:
        assert index["VTKHDF/Steps"].attrs["NSteps"] == len(snapshot_files(run))
    assert not (run / "checkpoint.previous.bin").exists(), "only the one before the first step"
    return reported


def test_a_body_that_leaves_the_domain_upward_fails_the_run(thawslide: Program, tmp_path: Path) -> None:
    reported = expect_failure(thawslide, LAMPLUGH, tmp_path / "run", time__end=20, body__slide__velocity="[0,300]")
    # The highest surface, 2146 m, rises 254 m at 300 m/s less gravity: about 0.87 s to the top of the domain at 2400 m.
    assert 0.8 < float(reported[1]) < 0.95
    assert reported[4] == "slide" and 2390.0 < float(reported[6]) < 2400.0
    assert reported[7] == "it left the domain"
    assert reported[8] == "the slide ran further than [grid] min and max allow; widen them in its direction."


def test_a_step_too_long_for_the_load_is_named_as_cause(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    # A fall at 1e5 m/s2 is too fast for a step of 4 ms; this is not visible at the start.
    message = thawslide.error("run", small_case, "--output", tmp_path / "guarded", *sets(**FALL), code=3)
    start = (
        r"error: the run failed at t = \S+ s \(step \d+\): energy grew by \S+ J per m of width without a physical cause"
    )
    assert re.match(start, message) and "of body 'block' at (" in message, message
    reported = expect_failure(thawslide, small_case, tmp_path / "run", **FALL, guards__energy_growth="inf")
    assert reported[7] == "its volume ratio is not positive"
    assert reported[8].startswith("the step is too long for the material")


@pytest.mark.parametrize(
    ("more", "advice"),
    [
        ({"mechanics__transfer": "blend", "mechanics__pic_fraction": 0.001}, "or a larger mechanics.pic_fraction."),
        ({"material__rock__viscosity_time": 1e-5}, "viscosity_number or viscosity_time of the material, or mechanics."),
        ({"time__stepping": "adaptive", "time__safety": 0.9}, "Try half of time.safety, "),
    ],
)
def test_advice_names_no_value_that_is_set(
    thawslide: Program, small_case: Path, tmp_path: Path, more: dict[str, object], advice: str
) -> None:
    words = ["--output", tmp_path / "run", *sets(**{**FALL, **more})]
    assert advice in thawslide.error("run", small_case, *words, code=3).partition("Likely cause")[2]


# A block at 100 m/s whose friction pore pressure does not reduce: a band of 1 mm boils dry within half a second.
FAST = sets(
    grid__max="[220.0, 10.0]", body__block__velocity="[100.0, 0.0]", basal__friction="coefficient",
    basal__friction_coefficient=0.8, band__thickness=0.001, time__end=0.5,
)  # fmt: skip

RunWarnings = Callable[..., list[str]]


@pytest.fixture
def warnings_of_run(thawslide: Program, small_case: Path, tmp_path: Path) -> RunWarnings:
    def run(*more: str) -> list[str]:
        edit(small_case / "case.toml", "friction_angle = 10.0\n", "")
        printed = thawslide.ok("run", small_case, "--output", tmp_path / "run", *more)
        return re.findall(r"^warning: at .*$", printed, flags=re.MULTILINE)

    return run


def limits(notes: list[str]) -> list[int]:
    """Return the temperature limits in warnings, which must increase."""
    found = [int(re.search(r"passes ([\d,]+) C", note)[1].replace(",", "")) for note in notes]  # type: ignore[index]
    assert found == sorted(set(found))
    return found


def test_columns_that_boil_dry_are_reported_once(warnings_of_run: RunWarnings) -> None:
    note, *later = warnings_of_run(*FAST)
    found = re.match(r"warning: at [\d.]+ s (\d+ columns|a column) .*boiled dry, and the hottest is at (\d+) C", note)
    assert found, note
    assert 100 < int(found[2]) < 5000
    assert set(limits(later)) <= {500, 1000, 2000}
    assert "no longer limits temperature and friction" in note


@pytest.mark.parametrize(
    ("words", "highest", "text"),
    [
        (sets(heat__steam="false"), 1000, "Nothing boils, as heat.steam is false"),
        (sets(band__model="scaled", band__thickness=0.01), 500, "Nothing in the model boils"),
    ],
)
def test_without_steam_nothing_boils(warnings_of_run: RunWarnings, words: list[str], highest: int, text: str) -> None:
    notes = warnings_of_run(*FAST, *words)
    assert limits(notes)[-1] >= highest
    assert all(f"{text}: temperatures above 100 C are not physical" in note for note in notes)


def test_a_cold_base_has_no_warning(warnings_of_run: RunWarnings) -> None:
    assert warnings_of_run(*sets(basal__friction_angle=10, band__thickness=0.1)) == []
