"""Files of any content: a value, or an error that names the file, within a limit of processor time."""

import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fuzz" / "python"))

from readers import CORPUS, READERS, SEED, Folder, Reader

from thawslide import Run
from thawslide.key_numbers import key_numbers
from thawslide.pages.facts import facts_of

SEEDS = sorted(CORPUS.glob(f"*/*{SEED}"))
TIME_LIMIT = 10.0  # s, of processor time
# Inputs with errors, and words of the messages.
ERRORS = {
    "force_record/long": "band-pass 0.5 to 4 s over 1e+12 s: too many samples (found 8e+13; allowed 20,000,000)",
    "targets/utf16": "targets.csv: encoded as UTF-16; save it as UTF-8",
}


def test_every_reader_has_a_corpus() -> None:
    assert {path.parent.name for path in SEEDS} == set(READERS)
    assert set(ERRORS) <= {f"{path.parent.name}/{path.stem}" for path in SEEDS}


@pytest.mark.parametrize("seed", SEEDS, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_inputs_of_the_corpus_give_a_value_or_an_error(seed: Path) -> None:
    start = time.process_time()
    errors = Folder(READERS[seed.parent.name]).check(seed.read_bytes())
    assert time.process_time() - start < TIME_LIMIT
    expected = ERRORS.get(f"{seed.parent.name}/{seed.stem}")
    assert (expected in errors) if expected is not None else (errors == "" or seed.stem not in ("valid", "windows"))


OF_CASE = ("title", "dimension", "per_metre", "report_times", "end_note")
OF_RUN = {
    "case": Reader("case.toml", lambda folder: [getattr(Run(folder), each) for each in OF_CASE]),
    "facts": Reader("run.json", lambda folder: (facts_of(Run(folder).facts), Run(folder).last_state)),
    "history": Reader("history.csv", lambda folder: key_numbers(Run(folder))),
    "terrain": Reader("terrain.csv", lambda folder: Run(folder).terrain),
    "targets": Reader("inputs/targets.csv", lambda folder: Run(folder).targets),
}


@pytest.mark.parametrize(
    ("reader", "text", "message"),
    [
        ("facts", "{", "run.json: not valid JSON ("),
        ("facts", "[]", "run.json: not a JSON object."),
        ("facts", '{"status": "done", "at_rest": "no"}', "at_rest: invalid value (found no; allowed true, false, "),
        ("facts", '{"status": "done", "warnings": "none"}', "warnings: not a list of texts (found none)"),
        ("facts", '{"status": "done", "covered_area_m2": "wide"}', "covered_area_m2: not a number (found wide)"),
        ("facts", '{"a":' * 5000 + "1" + "}" * 5000, "run.json: "),
        ("facts", '{"status": "done", "a": ' + "[" * 40 + "]" * 40 + "}", "run.json: too deeply nested (allowed 32"),
        ("facts", '{"status": "done", "steps": ' + "9" * 5000 + "}", "run.json: not valid JSON (Exceeds the limit"),
        ("facts", '{"status": "sleeping"}', "run.json: status: invalid value (found sleeping; allowed running, "),
        ("facts", "{}", "run.json: status: invalid value (found None; allowed running, done, "),
        ("facts", '{"status": "done", "simulated_time_s": "2"}', "run.json: simulated_time_s: not a number (found 2)"),
        ("facts", '{"status": "done", "drop_height_m": NaN}', "run.json: drop_height_m: not a number (found nan)"),
        ("case", "[case\n", "case.toml: not valid TOML ("),
        ("case", "a = " + "[" * 5000, "case.toml: not valid TOML"),
        ("case", "[case]\ndimension = 4\n", "case.toml: case.dimension: invalid value (found 4; allowed 2 or 3)"),
        ("case", '[case]\nwidth = "wide"\n', "width: invalid value (found wide; allowed a finite number, or as many"),
        ("case", "[case]\nwidth = { x = [0, 1], value = [1] }\n", "case.width: invalid value (found {"),
        ("case", "[case]\nwidth = { x = [1, 0], value = [1, 2] }\n", "case.width: invalid value (found {"),
        ("case", "[case]\nwidth = { x = [0, 1], value = [1, 0] }\n", "case.width: invalid value (found {"),
        ("case", "case = 1\n", "case.toml: case: not a table. Repeat the run."),
        ("case", "[report]\ntimes = [1, nan]\n", "report.times: invalid value (found [1, nan]; allowed a list"),
        ("case", "[probe.a]\npoint = [1]\n", "probe.a.point: invalid value (found [1]; allowed a list"),
        ("case", "[grid]\ncell = 1e-9\nmin = [0, 0]\nmax = [9, 9]\n", "grid: invalid domain (found 0 to 9 with cells"),
        ("history", "", "history.csv: empty. Wait for the first row of the run."),
        ("history", "time_s,st", "history.csv: empty. Wait for the first row of the run."),
        ("history", "time_s,step\n", "history.csv: no rows after the header. Wait for the first row of the run."),
        ("history", "a,b\n1,2\n", "history.csv:1: no column time_s. Select the folder of a run."),
        ("history", "time_s,step\n0,0\n1\n", "history.csv:3: damaged row (found 1 values for 2 columns)."),
        ("history", "time_s,step\n0,none\n", "history.csv:2: expected a number, found 'none'"),
        ("history", "time_s,time_s\n0,0\n", "history.csv:1: duplicate column 'time_s'"),
        ("history", "time_s,a\n0,1_0\n", "history.csv:2: expected a number, found '1_0'"),
        ("history", "time_s,a\nnan,1\n", "history.csv:2: time_s does not increase (found nan after -inf)"),
        ("terrain", "", "terrain.csv: empty; expected the columns distance_m, terrain_elevation_m"),
        ("terrain", "distance_m,height\n0,1\n", "terrain.csv:1: no column terrain_elevation_m; found "),
        ("targets", "# x\nquantity,time_s\na,b\n", "targets.csv:2: no column value; found"),
        ("terrain", "distance_m,terrain_elevation_m\n0,1\n0,2\n", "terrain.csv:3: distance_m does not increase"),
        ("terrain", "distance_m,terrain_elevation_m\n", "terrain.csv: no rows after the header"),
        ("terrain", "distance_m,terrain_elevation_m\n0,inf\n", "terrain.csv:2: expected a finite number, found 'inf'"),
    ],
)  # fmt: skip
def test_messages_name_the_error(reader: str, text: str, message: str) -> None:
    assert message in Folder(OF_RUN[reader]).check(text.encode())


def test_zero_bytes_end_the_history() -> None:
    folder = Folder(OF_RUN["history"])
    assert folder.check((folder.path / "history.csv").read_bytes() + bytes(4096)) == ""
