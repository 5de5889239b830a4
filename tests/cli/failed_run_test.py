"""Early ends of a run, with position, time, cause and last state: failures, guards, rest, unphysical temperatures."""

import re
import signal
from collections.abc import Callable
from pathlib import Path

import conftest
import h5py
import pytest
from conftest import FALL, LAMPLUGH, Interrupted, Program, Ran, edit, history, run_facts, sets, snapshot_files

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
    start = r"error: the run failed at t = \S+ s \(step \d+\): energy grew by \S+ J per m of width without a physical"
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


def test_columns_that_boil_dry_are_reported_once(warnings_of_run: RunWarnings) -> None:
    (note,) = warnings_of_run(*FAST)
    found = re.match(r"warning: at [\d.]+ s (\d+ columns|a column) .*boiled dry, and the hottest is at (\d+) C", note)
    assert found, note
    assert 100 < int(found[2]) < 5000
    assert "no longer limits temperature and friction" in note


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (sets(heat__steam="false"), "Nothing boils, as heat.steam is false"),
        (sets(band__model="scaled", band__thickness=0.01), "Nothing in the model boils"),
    ],
)
def test_without_steam_nothing_boils(warnings_of_run: RunWarnings, words: list[str], text: str) -> None:
    (note,) = warnings_of_run(*FAST, *words)
    assert f"the base passes 100 C. {text}: temperatures above 100 C are not physical" in note


def test_a_cold_base_has_no_warning(warnings_of_run: RunWarnings) -> None:
    assert warnings_of_run(*sets(basal__friction_angle=10, band__thickness=0.1)) == []


# A block of 48 particles that slides to a stop within about 1.2 s.
SLIDES = sets(time__end=5, body__block__velocity="[2,0]", material__rock__viscosity_time=0.0005)
SOFT = sets(material__rock_ice__youngs_modulus=0.5, time__step=0.01)
RESTS = [*SLIDES, *sets(time__stop_at_rest=0.1, time__rest_time=0.4)]


def test_a_run_ends_at_rest_and_continues_if_changed(ran: Ran, thawslide: Program, small_case: Path, run: Path) -> None:
    printed = thawslide.ok("run", small_case, "--output", run, *RESTS)
    facts = run_facts(run)
    reported = re.fullmatch(
        r"the slide is at rest: since t = (\S+) s no more than 0\.5 % of its mass has moved faster than 0\.1 m/s "
        r"\(time\.stop_at_rest\)",
        facts["message"],
    )
    assert reported, facts["message"]
    assert printed.endswith(facts["message"] + "\n")
    assert facts["status"] == "done"
    end = facts["simulated_time_s"]
    assert end == pytest.approx(float(reported[1]) + 0.4, abs=0.0101) and 1.0 < end < 2.0
    # All outputs have that time; until then the run equals the one without the key.
    columns = history(run)
    assert columns["time_s"][-1] == end
    complete = ran(*SLIDES, *sets(time__end=end), name="complete")
    conftest.assert_identical(run, complete)
    before, ended = conftest.content_of(run), f"{run} has reached its end at {end:g} s: {facts['message']}"
    assert thawslide.ok("resume", run) == f"{ended}; nothing to do\n"
    assert thawslide.ok("resume", run, "--end", 6) == (
        f"{run} has come to rest at {end:g} s; nothing to do. To continue it, add --set time.stop_at_rest=0\n"
    )
    assert conftest.content_of(run) == before
    thawslide.ok("resume", run, *sets(time__rest_time=0.6))
    longer = run_facts(run)
    assert longer["simulated_time_s"] == pytest.approx(end + 0.2, abs=0.02)
    assert longer["message"].startswith("the slide is at rest")
    thawslide.ok("resume", run, *sets(time__rest_time=0.4, basal__friction_angle=5))
    again = run_facts(run)
    assert again["simulated_time_s"] == pytest.approx(longer["simulated_time_s"] + 0.4, abs=0.03)
    assert again["parts"][-1]["changes"] == ["time.rest_time=0.4", "basal.friction_angle=5"]
    thawslide.ok("resume", run, "--end", again["simulated_time_s"] + 0.5, "--set", "time.stop_at_rest=0")
    assert run_facts(run)["simulated_time_s"] == pytest.approx(again["simulated_time_s"] + 0.5)
    assert run_facts(run)["message"] == ""
    text = (run / "case.toml").read_text()
    assert "stop_at_rest = 0.0 " in text and "rest_time = 0.4 " in text


def test_a_run_at_rest_without_its_last_checkpoint_ends_at_the_same_rest(ran: Ran, thawslide: Program) -> None:
    run = ran(*RESTS, *sets(checkpoint__interval=0.3, time__history_interval=0.1, time__output_interval=1))
    rows = (run / "history.csv").read_bytes()
    (run / "checkpoint.bin").unlink()
    thawslide.ok("resume", run, "--end", 5.5)
    assert (run / "history.csv").read_bytes() == rows


def test_an_instability_does_not_advise_a_wider_domain(thawslide: Program, small_case: Path, run: Path) -> None:
    """With contact one cell too early, the ground rebounds the falling block with more energy than it had."""
    fall = sets(time__end=2, body__block__min="[10,3]", body__block__max="[14,6]", basal__distance_check="false")
    message = thawslide.error("run", small_case, "--output", run, *fall, *sets(guards__energy_growth=0.001), code=3)
    assert "J per m of width without a physical cause" in message
    assert "Set it to true" in message and "widen" not in message
    facts = run_facts(run)
    assert facts["status"] == "failed" and message == f"error: {facts['message']}\n"
    assert len(list((run / "snapshots").iterdir())) > 1


def test_removed_particles_are_counted(thawslide: Program, run: Path) -> None:
    words = sets(time__end=20, guards__volume='"remove"', guards__removed_mass=0.05)
    outcome = thawslide("run", LAMPLUGH, "--output", run, *SOFT, *words)
    assert outcome.returncode == 3
    reported = re.search(r"\[guards\] has removed (\d+) particles: 0 not finite, ", outcome.stderr)
    assert reported, outcome.stderr
    assert re.search(
        r"warning: at t = \S+ s guards have removed \d+ particles?: 0 not finite, \d+ by their volume; history\.csv "
        r"has their mass, run\.json their number\n",
        outcome.stdout,
    )
    removed = f"{reported[1]} particles: 0 not finite, {reported[1]} by their volume"
    assert f"guards have removed {removed}\n" in outcome.stdout
    facts, columns = run_facts(run), history(run)
    assert facts["removed_particles"] == {"left": 0, "not_finite": 0, "volume": int(reported[1])}
    assert 0.0 < columns["removed_mass_kg"][-1] == pytest.approx(columns["left_mass_kg"][-1], rel=1e-12)


def test_resume_keeps_removed_particles(ran: Ran, thawslide: Program, interrupted: Interrupted, run: Path) -> None:
    guards = {"guards__volume": '"remove"', "guards__removed_mass": 1, "guards__smallest_volume": 0.5}
    words = [*SOFT, *sets(time__end=4.5, time__output_interval=0.7, **guards)]
    complete = ran(*words, case=LAMPLUGH, name="complete")
    assert interrupted(LAMPLUGH, run, words, signal.SIGTERM, 60) == 4
    thawslide.ok("resume", run)
    conftest.assert_identical(run, complete)
    removed = run_facts(complete)["removed_particles"]
    assert run_facts(run)["removed_particles"] == removed and removed["volume"] > 0
    assert (run / "checkpoint.bin").read_bytes() == (complete / "checkpoint.bin").read_bytes()


def test_slow_energy_growth_is_reported_once(ran: Ran, thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    slow = sets(time__end=30, time__history_interval=1, time__output_interval=10, guards__energy_growth=0.02)
    undamped = sets(material__rock__viscosity_number=0)
    slow += sets(body__block__max="[15.0,5.0]")
    outcome = thawslide("run", small_case, "--output", tmp_path / "run", *slow, *undamped)
    assert outcome.returncode == 0, outcome.stderr
    message = outcome.stdout + outcome.stderr
    assert message.count("gradually and without a physical cause") == 1
    assert "viscosity_number" in message
    slow += sets(material__rock__viscosity_time=0.002)
    damped = thawslide("run", small_case, "--output", tmp_path / "damped", *slow)
    assert damped.returncode == 0
    assert "without a physical cause" not in damped.stdout + damped.stderr
