"""Files of a run, described on its pages, bitwise identical on any number of threads, and refused folders."""

import csv
import hashlib
import os
import re
import tomllib
from pathlib import Path
from typing import Any

import conftest
import h5py
import numpy as np
import pytest
from conftest import LAMPLUGH, ROOT, Program, Ran, Slope, columns_of, history, run_facts, sets, snapshot_files

END = 1.0  # s, of the Lamplugh runs
UNITS = {
    "1": "id body liquid_saturation porosity plastic_strain in_band", "kg": "mass", "m3": "volume", "m/s": "velocity",
    "m": "displacement", "Pa": "stress pore_pressure liquid_pressure", "C": "temperature",
}  # fmt: skip
FIELDS = {name: unit for unit, names in UNITS.items() for name in names.split()}
COMPONENTS = {"velocity": 3, "displacement": 3, "stress": 6}  # of other fields, one


@pytest.fixture(scope="module")
def lamplugh(thawslide: Program, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a second of Lamplugh on one thread, with a snapshot each 0.25 s."""
    run = tmp_path_factory.mktemp("runs") / "lamplugh"
    words = sets(time__end=END, time__output_interval=0.25)
    outcome = thawslide("run", LAMPLUGH, "--threads", 1, "--output", run, *words)
    assert outcome.returncode == 0, outcome.stderr
    assert outcome.stderr == ""
    assert f"results in {run}" in outcome.stdout
    return run


def test_the_folder_contains_the_files_of_a_run_and_no_others(lamplugh: Path) -> None:
    files = "case.toml checkpoint.bin checkpoint.previous.bin history.csv inputs particles.vtkhdf run.json snapshots "
    assert {path.name for path in lamplugh.iterdir()} == {*files.split(), "terrain.csv"}
    assert {file.name for file in (lamplugh / "snapshots").iterdir()} == {f"{k:06d}.vtkhdf" for k in range(5)}
    assert (lamplugh / "checkpoint.bin").stat().st_size > 0


def test_history_has_rows_of_numbers_in_their_shortest_exact_form_and_begins_with_the_weight(lamplugh: Path) -> None:
    columns = history(lamplugh)
    assert next(iter(columns)) == "time_s"
    np.testing.assert_allclose(columns["time_s"], np.arange(11) * 0.1, rtol=0, atol=1e-12)
    assert columns["step"].tolist() == list(range(0, 201, 20))
    assert (columns["mass_kg"] == columns["mass_kg"][0]).all() and columns["mass_kg"][0] > 0
    text = (lamplugh / "history.csv").read_text()
    assert text.endswith("\n") and "#" not in text
    for field in (field for row in text.splitlines()[1:] for field in row.split(",")):
        value = float(field)
        assert len(field) <= len(repr(value)) and (np.isnan(value) or float(repr(value)) == value)
    first = {name: values[0] for name, values in columns.items()}
    assert first["basal_force_y_N"] == pytest.approx(-9.81 * first["mass_kg"], rel=1e-12)
    assert first["basal_force_x_N"] == first["seismic_force_x_N"] == first["seismic_force_y_N"] == 0.0
    unknown = {name for name, value in first.items() if np.isnan(value)}
    assert unknown == {"band_friction_coefficient"}, "no node is in contact before the first step"


def test_snapshots_contain_the_fields_sorted_by_id(lamplugh: Path) -> None:
    particles = run_facts(lamplugh)["particles"]
    for number, file in enumerate(snapshot_files(lamplugh)):
        with h5py.File(file) as opened:
            root = opened["VTKHDF"]
            assert root.attrs["Type"] == b"PolyData"
            assert root.attrs["time"] == pytest.approx(0.25 * number, abs=1e-12)
            assert root["Points"].shape == (particles, 3) and root["Points"].dtype == np.float64
            assert (root["Points"][:, 2] == 0.0).all()
            for name, unit in FIELDS.items():
                field = root["PointData"][name]
                assert field.shape == (particles, *([COMPONENTS[name]] if name in COMPONENTS else [])), name
                assert field.attrs["unit"] == unit.encode(), name
            assert root["PointData/id"][:].tolist() == list(range(particles))


def test_the_particles_file_combines_all_snapshots(lamplugh: Path) -> None:
    particles = run_facts(lamplugh)["particles"]
    files = snapshot_files(lamplugh)
    with h5py.File(lamplugh / "particles.vtkhdf") as opened:
        root = opened["VTKHDF"]
        assert root["Steps"].attrs["NSteps"] == len(files)
        np.testing.assert_allclose(root["Steps/Values"], np.arange(len(files)) * 0.25, rtol=0, atol=1e-12)
        assert root["Steps/PointOffsets"][:].tolist() == [particles * number for number in range(len(files))]
        assert root["NumberOfPoints"][:].tolist() == [particles] * len(files)
        assert root["Points"].shape == (particles * len(files), 3)
        for number, file in enumerate(files):
            rows = slice(particles * number, particles * (number + 1))
            alone = conftest.datasets(file)
            assert root["Points"][rows].tobytes() == alone["VTKHDF/Points"].tobytes()
            for name in FIELDS:
                assert root["PointData"][name][rows].tobytes() == alone[f"VTKHDF/PointData/{name}"].tobytes(), name


def test_run_json_reports_inputs_with_their_hashes_and_speed(lamplugh: Path) -> None:
    facts = run_facts(lamplugh)
    assert facts["status"] == "done" and facts["message"] == ""
    assert facts["steps"] == 200 and facts["simulated_time_s"] == pytest.approx(END)
    assert facts["threads"] == 1 and facts["origin_m"] == [-200.0, 200.0]
    rate = facts["particles"] * facts["steps"] / facts["wall_s"]
    assert facts["particle_steps_per_second"] == pytest.approx(rate)
    assert 0.0 < sum(facts["seconds_per_stage"].values()) <= facts["wall_s"]
    copies = {Path(each["copy"]).name: each for each in facts["inputs"]}
    assert sorted(copies) == ["case.toml", "lamplugh_force.csv", "lamplugh_profile.csv", "lamplugh_targets.csv"]
    for name, each in copies.items():
        content = (lamplugh / each["copy"]).read_bytes()
        assert content == (LAMPLUGH / name).read_bytes()
        assert each["sha256"] == hashlib.sha256(content).hexdigest()
        assert each["bytes"] == len(content)


def test_terrain_is_the_ground_of_the_columns_inside_the_domain(lamplugh: Path) -> None:
    """Columns are at the points of the profile. At a column, uGIMP has the weights 1/16, 7/8 and 1/16."""
    terrain, profile = columns_of(lamplugh / "terrain.csv"), columns_of(LAMPLUGH / "lamplugh_profile.csv")
    assert list(terrain) == ["distance_m", "terrain_elevation_m"]
    points = list(zip(*terrain.values(), strict=True))
    assert points[0][0] == -200.0 and points[-1][0] == 12000.0
    given = dict(zip(profile["distance_m"], profile["terrain_elevation_m"], strict=True))
    column = {x: (given[x - 10.0] + 4.0 * z + given[x + 10.0]) / 6.0 for x, z in given.items() if -200.0 < x < 12000.0}
    for x, elevation in points[2:-2]:
        before, here, after = (column[round(x + step, 6)] for step in (-10.0, 0.0, 10.0))
        assert elevation == pytest.approx(before / 16.0 + 7.0 * here / 8.0 + after / 16.0, abs=1e-6)


def test_the_resolved_case_has_bitwise_identical_results(ran: Ran, lamplugh: Path, tmp_path: Path) -> None:
    resolved = tomllib.loads((lamplugh / "case.toml").read_text())
    assert resolved["time"]["end"] == END and resolved["basal"]["lubrication_exponent"] == 2.0
    assert resolved["terrain"]["file"] == "inputs/lamplugh_profile.csv"
    ran(case=lamplugh, name="again")
    conftest.assert_identical(lamplugh, tmp_path / "again")


@pytest.mark.parametrize("threads", [2, 3])
def test_results_are_bitwise_identical_for_any_number_of_threads(ran: Ran, lamplugh: Path, threads: int) -> None:
    words = sets(time__end=END, time__output_interval=0.25)
    run = ran("--threads", threads, *words, case=LAMPLUGH)
    assert run_facts(run)["threads"] == threads
    conftest.assert_identical(lamplugh, run)


def test_folder_is_named_after_the_case(thawslide: Program, small_case: Path) -> None:
    (small_case / "steep.toml").write_text((small_case / "case.toml").read_text())
    thawslide.ok("run", small_case, folder=small_case.parent)
    thawslide.ok("run", small_case / "steep.toml", folder=small_case.parent)
    assert sorted(path.name for path in (small_case.parent / "runs").iterdir()) == ["small", "small-steep"]


def test_a_run_is_replaced_only_on_request_in_a_possible_folder(
    ran: Ran, thawslide: Program, small_case: Path, tmp_path: Path
) -> None:
    run = ran()
    before = (run / "history.csv").read_bytes()
    message = thawslide.error("run", small_case, "--output", run, *sets(time__end=0.1))
    assert (
        f"the output folder {run} contains another run. Specify another --output, or replace that run with --overwrite"
        in message
    )
    assert (run / "history.csv").read_bytes() == before
    (run / "notes.txt").write_text("mine")
    thawslide.ok("run", small_case, "--output", run, "--overwrite", *sets(time__end=0.1))
    assert history(run)["time_s"][-1] == pytest.approx(0.1)
    assert len(snapshot_files(run)) == 3
    assert (run / "notes.txt").read_text() == "mine"
    (tmp_path / "file").write_text("")
    for folder, words in (
        (tmp_path / "file" / "run", f"cannot be made: {tmp_path / 'file'} is a file. Give another --output."),
        (tmp_path / ("a" * 260), "File name too long"),
        ("", "--output: name a folder"),
    ):
        assert words in thawslide.error("run", small_case, "--output", folder)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission_is_refused(thawslide: Program, small_case: Path, tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o555)
    assert f"no permission for {closed}" in thawslide.error("run", small_case, "--output", closed / "run")


REFERENCE = ROOT / "docs" / "reference"
NAME = re.compile(r"`([^`\n]+)`")


def names_in(text: str) -> set[str]:
    """Return the names in the first column of the tables of a text."""
    return {name for row in re.findall(r"^\|([^|]*)\|", text, re.MULTILINE) for name in NAME.findall(row)}


def section(title: str) -> str:
    """Return a section of the page on output files."""
    text = (REFERENCE / "outputs.md").read_text()
    level = re.search(rf"^(#+) {re.escape(title)}$", text, re.MULTILINE)
    assert level
    return re.split(rf"^#{{1,{len(level[1])}}} ", text[level.end() :], maxsplit=1, flags=re.MULTILINE)[0]


def keys_in(value: Any) -> set[str]:
    """Return all keys of a JSON value and of the values in it."""
    if isinstance(value, list):
        return set().union(*map(keys_in, value))
    return set(value).union(*map(keys_in, value.values())) if isinstance(value, dict) else set()


@pytest.fixture
def case_on_dem(slope: Slope) -> Path:
    slope.ok("--cell", 10, thickness=20)
    return slope.case


def test_columns_fields_and_maps_are_listed(ran: Ran, thawslide: Program, small_case: Path, case_on_dem: Path) -> None:
    described = names_in(thawslide.ok("describe", "--outputs"))
    for case in (small_case, case_on_dem):
        run = ran(*sets(time__end=0.02), case=case, name=f"run-{case.name}")
        with (run / "history.csv").open(newline="") as file:
            columns = next(csv.reader(file))
        names = [
            Path(name).name for name in conftest.datasets(snapshot_files(run)[-1]) if re.search("PointData|^base", name)
        ]
        maps = [path.stem for path in run.glob("maps/*.tif")]
        assert len(columns) > 60 and len(names) >= 18 and bool(maps) == (case is case_on_dem)
        assert {*columns, *names, *maps} - described == set()


def test_keys_of_run_json_are_described(ran: Ran, case_on_dem: Path) -> None:
    run = ran(*sets(time__end=0.01), case=case_on_dem)
    facts = run_facts(run)
    main, parts, roughness = re.split(r"^Keys of `\w+`:$", section("run.json"), flags=re.MULTILINE)
    assert names_in(main) == set(facts)
    assert names_in(parts) == set(facts["parts"][0])
    assert names_in(roughness) == set(facts["roughness"])
    assert set(facts["inputs"][0]) | set(facts["removed_particles"]) <= set(NAME.findall(main))


def test_keys_of_json_of_commands_are_described(thawslide: Program, case_on_dem: Path, done: Path) -> None:
    checked = thawslide.json("check", case_on_dem)
    text = section("check --json")
    assert names_in(text) == set(checked)
    roughness = set(checked.pop("roughness"))
    assert keys_in(checked) <= set(NAME.findall(text)) | roughness
    assert names_in(section("status --json")) == set(thawslide.json("status", done))
