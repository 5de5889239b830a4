"""The runner of studies: reuse of runs, failures, selection, order, exit codes, skipped and frozen studies."""

import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from reproduction import __main__ as command
from reproduction import engine
from reproduction.studies import STUDIES
from reproduction.study import ROOT, Job, Place, Study, StudyError
from reproduction.tables import markdown, rewrapped, with_marks
from thawslide import ReportError

# Writes the files of a run that the engine reads; the settings bad, broken and slow change its end.
PROGRAM = """import hashlib, json, pathlib, sys, time
words = sys.argv[1:]
if words == ["version"]:
    print("thawslide 0.1.0 (commit COMMIT, g++ 12.2.0)")
    sys.exit()
if "bad=1" in words:
    sys.exit("error: no such key bad")
output, case = pathlib.Path(words[words.index("--output") + 1]), pathlib.Path(words[1])
if words[0] == "block":
    output.write_text("time_s,velocity_m_s\\n0,0\\n")
    sys.exit()
output.mkdir()
rest = "".join(f"{t},{5 if t < 20 else 0}\\n" for t in range(60))
(output / "history.csv").write_text("time_s,mean_velocity_m_s\\n" + rest)
inputs = [{"path": str(case), "sha256": hashlib.sha256(case.read_bytes()).hexdigest()}]
(output / "run.json").write_text(json.dumps({"status": "done", "inputs": inputs}))
time.sleep(600 if "slow=1" in words else 0)
if "broken=1" in words:
    print("error: the run failed at 3 s", file=sys.stderr)
    sys.exit(3)
"""


def write_program(path: Path, commit: str = "0123abcd") -> Path:
    path.write_text(f"#!{sys.executable}\n{PROGRAM.replace('COMMIT', commit)}")
    path.chmod(0o755)
    return path


@pytest.fixture
def lines() -> list[str]:
    return []


@pytest.fixture
def place(tmp_path: Path, lines: list[str]) -> Place:
    (tmp_path / "case.toml").write_text("# one")
    program = write_program(tmp_path / "program")
    return Place(program, tmp_path / "runs", tmp_path / "pages", cases=tmp_path, report=lines.append)


JOBS = (Job("a"), Job("b", sets=("x=1",)), Job("block", subcommand="block"))


def test_complete_runs_are_reused_and_recorded(place: Place, lines: list[str]) -> None:
    assert place.perform(JOBS) == []
    assert lines[0] == "3 runs, 0 of them complete" and lines[-1].startswith("3 of 3, about 0 min left: ")
    stamp = (place.runs / "a" / "run.json").stat().st_mtime_ns
    assert place.perform(JOBS) == []
    assert lines[4:] == ["3 runs, 3 of them complete"]
    assert (place.runs / "a" / "run.json").stat().st_mtime_ns == stamp
    words, case = engine.read_record(place.runs / "b").command, str(place.cases / "case.toml")  # type: ignore[union-attr]
    assert words[1:] == ["run", case, "--output", str(place.runs / "b"), "--threads", "1", "--set", "x=1"]
    assert engine.is_done(place.runs / "block.csv") and 0.0 < engine.processor_time(place.runs / "a") < 10.0
    facts = json.loads((place.runs / "a.record.json").read_text())
    assert (list(facts["inputs"]), facts["program"], facts["code"]) == ([case], "0123abcd", 0)


@pytest.mark.parametrize("change", ["case", "settings", "commit", "results", "record"])
def test_runs_are_repeated_after_a_change(place: Place, change: str) -> None:
    job = Job("a")
    place.perform([job])
    assert engine.is_current(place.task(job))
    if change == "case":
        (place.cases / "case.toml").write_text("# two")
    elif change == "settings":
        job = Job("a", sets=("x=1",))
    elif change == "commit":
        place = replace(place, program=write_program(place.program.with_name("newer"), "4567"))
    elif change == "results":
        (place.runs / "a").rename(place.runs / "moved")
    else:
        (place.runs / "a.record.json").write_text("{")
    assert not engine.is_current(place.task(job))


def test_runs_of_the_same_commit_by_a_program_elsewhere_are_repeated_only_if_its_tree_had_changes(place: Place) -> None:
    assert engine.commit_of(place.program) == place.version == "0123abcd"
    dirty = write_program(place.program, "0123abcd-dirty")
    changed = replace(place, program=dirty)
    assert len(changed.version) == 64
    changed.perform([Job("a")])
    assert engine.is_current(changed.task(Job("a")))
    dirty.write_text(dirty.read_text() + "# changed\n")
    assert not engine.is_current(replace(place, program=dirty).task(Job("a")))


def test_missing_program_or_version_has_its_remedy(place: Place, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ReportError, match=r"Build it with \./run --setup\."):
        engine.commit_of(Path("/bin/false"))
    assert command.main(["--program", str(place.cases / "none")]) == 2
    assert "Build it with ./run --setup." in capsys.readouterr().err


def test_failed_runs_are_kept_and_stated(place: Place, lines: list[str]) -> None:
    jobs = (Job("good"), Job("bad", sets=("bad=1",)), Job("broken", sets=("broken=1",)))
    with pytest.raises(StudyError, match=r"bad: error: no such key bad; broken: error: the run failed at 3 s\. The"):
        place.perform(jobs)
    assert any("min left: bad: error: no such key bad" in line for line in lines)
    assert engine.failure(place.runs / "good") == "" and engine.failure(place.runs / "none") == "not run"
    assert engine.log_file(place.runs / "broken").read_text() == "error: the run failed at 3 s\n"
    # A run that failed keeps its results and is not repeated; one without results is.
    assert engine.is_current(place.task(jobs[2])) and not engine.is_current(place.task(jobs[1]))
    tolerant = replace(place, tolerates_failures=True)
    assert [each.partition(":")[0] for each in tolerant.perform(jobs)] == ["bad", "broken"]


def test_run_without_results_is_not_complete(tmp_path: Path) -> None:
    task = engine.Task("a", (sys.executable, "-c", "print('moving')"), tmp_path / "a")
    assert engine.execute(task).message == "a was not written" and not engine.is_done(task.results)
    assert engine.log_file(task.results).read_text() == "moving\n"


def test_run_at_rest_is_stopped_and_complete(place: Place) -> None:
    place.perform([Job("a", sets=("slow=1",), until_rest=True)])
    record = engine.read_record(place.runs / "a")
    assert record is not None and record.is_done and record.code == -15
    assert engine.is_current(place.task(Job("a", sets=("slow=1",), until_rest=True)))


def test_expensive_runs_start_first_names_are_unique_and_parts_select_runs(place: Place, lines: list[str]) -> None:
    tasks = [place.task(Job(key, cost=cost)) for key, cost in (("a", 1.0), ("b", 3.0), ("c", 2.0))]
    engine.perform(tasks, 1, lines.append)
    assert [line.split(": ")[1].split()[0] for line in lines[1:]] == ["b", "c", "a"]
    with pytest.raises(ValueError, match=r"runs with the same name: \['a'\]"):
        engine.perform([tasks[0], tasks[0]], 1, lines.append)
    chosen = replace(place, runs=place.runs / "chosen", parts=("plane-*", "alr"))
    chosen.perform([Job("plane-20"), Job("plane-10"), Job("alr"), Job("alr-rough")])
    assert sorted(path.name for path in chosen.runs.iterdir() if path.is_dir()) == ["alr", "plane-10", "plane-20"]


def stage_of(place: Place) -> list[Job]:
    return [Job("second", sets=(f"n={len((place.runs / 'first' / 'history.csv').read_text())}",))]


@pytest.fixture
def studies(place: Place, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Replace the studies by small ones; return the names of those whose page is written."""
    done: list[str] = []

    def made(name: str, **more: object) -> Study:
        def write(place: Place) -> Sequence[str]:
            done.append(name)
            place.page(f"docs/{name}.md").write_text(name)
            return ["a number differs"] if name == "wrong" else []

        return Study(name, (f"docs/{name}.md",), 1.0, write, **more)  # type: ignore[arg-type]

    small = (
        made("staged", stages=(lambda place: [Job("first")], stage_of), cases=place.cases),
        made("refused", stages=(lambda place: [Job("x", sets=("bad=1",))],), cases=place.cases), made("wrong"),
        made("absent", needs=lambda place: [place.data / "none.tif"], remedy="Copy it."),
        made("frozen", is_frozen=True), made("last"),
    )  # fmt: skip
    monkeypatch.setattr(command, "STUDIES", {study.name: study for study in small})
    return done


def call(place: Place, *words: str) -> int:
    return command.main([*words, "--program", str(place.program), "--output", str(place.runs), "--quick"])


def test_studies_are_made_if_some_fail(place: Place, studies: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert call(place) == 1
    assert studies == ["staged", "wrong", "last"]
    output = capsys.readouterr().out
    assert "made: staged, last; skipped: absent; failed: refused, wrong\n" in output
    assert "absent: skipped: not found: " in output and "none.tif. Copy it." in output
    assert "refused: error: x: error: no such key bad" in output and "wrong: a number differs" in output
    written = place.runs / "quick" / "written" / "docs"
    assert sorted(path.name for path in written.iterdir()) == ["last.md", "staged.md", "wrong.md"]
    assert (place.runs / "quick" / "pages" / "staged" / "second" / "run.json").is_file()


@pytest.mark.parametrize(
    ("words", "expected", "code"),
    [
        (["--only", "last", "staged"], ["staged", "last"], 0),  # in the order of the studies
        (["--only", "frozen"], ["frozen"], 0), (["--only", "absent"], [], 0), (["--only", "wrong"], ["wrong"], 1),
        (["--only", "staged:first", "staged:second"], ["staged"], 0), (["--only", "none"], [], 2),
        (["--draw-only", "--only", "refused", "last"], ["refused", "last"], 0),
    ],
)  # fmt: skip
def test_studies_are_chosen(place: Place, studies: list[str], words: list[str], expected: list[str], code: int) -> None:
    assert call(place, *words) == code
    assert studies == expected


def test_list_states_times_and_absences(place: Place, studies: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert call(place, "--list") == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "staged           1 min  docs/staged.md"
    assert "none.tif" in lines[3] and "made only if it is named" in lines[4]
    assert studies == []


def test_every_page_of_results_names_the_command_that_makes_it() -> None:
    for study in STUDIES.values():
        for page in study.pages:
            if page.endswith(".md") and study.name != "numbers":
                text = (ROOT / page).read_text(encoding="utf-8")
                assert "scripts/pages --only" in text or page == "docs/verification.md", page


def test_pages_have_tables_marks_and_wrapped_paragraphs() -> None:
    assert markdown([["", "a"], ["b", "1"]]) == "|  | a |\n| --- | --- |\n| b | 1 |"
    assert with_marks("x\n\n@one@\n\n@two@\n\ny", {"one": "", "two": "2"}) == "x\n\n2\n\ny"
    text = rewrapped("# A\n\n" + "word " * 40 + "\n\n- item\n- " + "long " * 30 + "\n\n| a |\n| - |")
    assert max(map(len, text.splitlines())) <= 120 and "\n  long" in text and rewrapped(text) == text
