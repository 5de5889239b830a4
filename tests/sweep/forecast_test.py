"""`thawslide forecast` on a small slope: prior check, weights in all results, continuation, and errors."""

import json
import subprocess
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT, Capture, read, write
from slope_case import write_slope_case

import thawslide
from thawslide.case import Case
from thawslide.errors import ReportError
from thawslide.forecasts.command import main
from thawslide.program import find_program
from thawslide.scores.command import main as score
from thawslide.scores.ensemble import crps
from thawslide.sweeps.api import validated
from thawslide.sweeps.design_file import read_sweep_file
from thawslide.sweeps.folder import SweepFolder
from thawslide.sweeps.outcome import write_outcome

CELL, COLUMNS, ROWS, NORTH = 40.0, 120, 12, 6_500_480.0
CASE = """case = { dimension = 3 }
mechanics = { transfer = "apic" }
time = { end = 90.0, stepping = "adaptive", output_interval = 90.0, history_interval = 2.0 }
grid = { cell = 40.0, min = [400040.0, 6500040.0, -80.0], max = [404760.0, 6500440.0, 1120.0], leaving = "remove" }
terrain = { type = "dem", file = "dem.tif" }
basal = { friction = "constant", friction_angle = 20.0 }
heat = { enabled = false }
pressure = { enabled = false }
maps = { cell = 40.0 }
material.rock = { law = "mohr_coulomb", youngs_modulus = 1.0e7, poisson_ratio = 0.2, friction_angle = 35.0, \
cohesion = 1.0e3, gaps_close_first = true }
[body.slide]
material = "rock"
shape = "release"
thickness = { raster = "thickness.tif" }
"""
SWEEP = """[sweep]
cases = ["case.toml"]
sample = "lhs:12"
seed = 1
[sweep.range]
"basal.friction_angle" = [8.0, 26.0]
"""


@pytest.fixture
def slope(tmp_path: Path, with_program: None) -> Path:
    """Return the folder of a 3D case: 1.1 million m3 on a slope of 30 degrees above level ground."""
    folder = tmp_path / "slope"
    x = (np.arange(COLUMNS) + 0.5) * CELL
    heights = np.tile(np.maximum(1100.0 - 0.58 * x, 100.0 - 0.02 * x), (ROWS, 1))
    write(folder / "dem.tif", heights, 400_000.0, NORTH, CELL)
    thickness = np.zeros((ROWS, COLUMNS))
    thickness[4:8, 9:15] = 28.0
    write(folder / "thickness.tif", thickness, 400_000.0, NORTH, CELL)
    (folder / "case.toml").write_text(CASE)
    (folder / "sweep.toml").write_text(SWEEP)
    return folder


def test_a_forecast_is_weighted_throughout_and_continues(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    output = tmp_path / "forecast"
    command = [str(slope), "--prior", "events", "--output", str(output), "--workers", "1"]
    assert main(command) == 0
    printed = capfd.readouterr()
    assert "release of 1.08 million m³" in printed.out
    assert "published events of 0.4 to 2.5 times the volume" in printed.out
    assert "12 members done, 0 failed" in printed.err
    table = pd.read_parquet(output / "members.parquet")
    weights = table["weight"].to_numpy()
    stored = json.loads((output / "prior" / "prior.json").read_text())
    assert weights == pytest.approx([stored["weights"][str(number)] for number in range(12)])
    assert weights.sum() == pytest.approx(1.0) and weights.max() > 1.5 / 12
    blocks = pd.read_parquet(output / "prior" / "members.parquet")
    assert list(blocks["basal.friction_angle"]) == list(table["basal.friction_angle"]) and "weight" not in blocks
    folders = [SweepFolder(output).run_folder(number) for number in range(12)]
    arrival = np.array([read(folder / "maps" / "arrival_time.tif") for folder in folders])
    expected = np.tensordot(weights, np.isfinite(arrival), 1)
    assert read(output / "probability" / "reached.tif") == pytest.approx(expected)
    assert np.abs(expected - np.isfinite(arrival).mean(axis=0)).max() > 0.05
    page = (output / "sweep.html").read_text()
    assert "<h2>Prior check</h2>" in page and "All results are weighted" in page and "Not available" not in page
    summary = (output / "summary.html").read_text()
    assert "1.08 million m³ of rock and ice are released" in summary
    assert "Of 12 simulations with different parameters, this is number" in summary
    assert "Summary of a forecast of 12 simulations" in summary and "This is one scenario" not in summary
    assert summary.count('src="data:image/png') == 3 and "Fraction of the simulations that reach each place." in summary
    assert (output / "summary.pdf").is_file()

    observed = tmp_path / "observed.toml"
    observed.write_text('[travel_distance]\nvalue = 2.0\nunit = "km"\n')
    assert score([str(output), "--observed", str(observed)]) == 0
    first = json.loads((output / "score.json").read_text())["rows"][0]["members_crps"]

    SweepFolder(output).record_file(3).unlink()
    assert main([*command[:1], *command[3:]]) == 0
    second = pd.read_parquet(output / "members.parquet")
    assert list(second["starts"]) == [1] * 12 and "weight" not in second
    assert second["travel_distance_m"].equals(table["travel_distance_m"])
    assert read(output / "probability" / "reached.tif") == pytest.approx(np.isfinite(arrival).mean(axis=0))
    after = json.loads((output / "score.json").read_text())["rows"][0]["members_crps"]
    assert after == pytest.approx(crps(table["travel_distance_m"].to_numpy(), np.ones(12), 2000.0) / 1e3) != first


def error(capfd: Capture, *words: object) -> str:
    capfd.readouterr()
    assert main([str(word) for word in words]) == 2
    return capfd.readouterr().err.splitlines()[-1]


def test_errors_state_the_reason_and_the_remedy(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    file, output = slope / "sweep.toml", ("--output", tmp_path / "forecast")
    for text, words in (
        (SWEEP.replace("lhs:12", "lhs:6"), "too few members with H/L of a rigid block (found 6 of 6; needed 10)"),
        (SWEEP.replace("[8.0, 26.0]", "[95.0, 99.0]"), "basal.friction_angle: no value of the distribution is allowed"),
        (SWEEP.replace('["case.toml"]', '["case.toml", "b.toml"]'), "sweep.cases: several cases (found 2; allowed 1)"),
        ("[other]\n", "no table [sweep]. Add it, with cases and at least one varied key."),
        ("[sweep\n", "not valid TOML"),
    ):
        file.write_text(text)
        assert words in error(capfd, slope, *output, "--workers", 1)
        assert not (tmp_path / "forecast" / "sweep.json").exists()
    file.write_text(SWEEP.replace("lhs:12", "morris:8"))
    assert "--prior events: not for the sample morris. Use lhs or sobol" in error(capfd, slope, "--prior", "events")
    file.write_text(SWEEP)
    found = error(capfd, slope, "--event", "Pink Mountian")
    assert "--event: no published event" in found and "did you mean pink mountain?" in found
    file.write_text(SWEEP.replace("seed = 1", "seed = 1\nblock = true"))
    assert "sweep.block: a forecast needs runs" in error(capfd, slope, *output)
    file.unlink()
    words = "sweep.toml: no such file. Write it: its table [sweep] lists the case and the varied keys"
    assert words in error(capfd, slope, *output)
    for kind, words in (
        ("rock and ice", '"rock and ice": fewer than 5 published events of a similar volume; allowed: rock'),
        ("snow", '"snow"; allowed: rock'),
    ):
        with pytest.raises(SystemExit):
            main([str(slope), "--kind", kind])
        assert f"argument --kind: {words}" in capfd.readouterr().err


def test_blocks_that_cannot_be_computed_are_reported(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    (slope / "case.toml").write_text(CASE.replace("thickness.tif", "empty.tif"))
    write(slope / "empty.tif", np.zeros((ROWS, COLUMNS)), 400_000.0, NORTH, CELL)
    found = error(capfd, slope, "--output", tmp_path / "forecast")
    assert "empty.tif: the thickness is not above 0 at any point: there is no release." in found
    thickness = np.zeros((ROWS, COLUMNS))
    thickness[4:8, 20:24] = 28.0
    write(slope / "other.tif", thickness, 400_000.0, NORTH, CELL)
    second = '[body.other]\nmaterial = "rock"\nshape = "release"\nthickness = { raster = "other.tif" }\n'
    (slope / "case.toml").write_text(CASE + second)
    found = error(capfd, slope, "--output", tmp_path / "other", "--workers", 1)
    assert "no rigid block of the 12 members can be computed (first error:" in found and "or use --prior none." in found


def test_folders_of_others_are_left_alone(slope: Path, tmp_path: Path, capfd: Capture) -> None:
    for kept in (tmp_path / "work" / "prior" / "notes.txt", tmp_path / "other" / "notes.txt"):
        kept.parent.mkdir(parents=True)
        kept.write_text("mine")
        output = tmp_path / kept.relative_to(tmp_path).parts[0]
        for prior in ("sweep", "none"):
            found = error(capfd, slope, "--output", output, "--prior", prior)
            assert "not empty, and not of a forecast. Specify another --output." in found
        assert kept.read_text() == "mine"


def test_members_without_weight_alone_give_no_results(slope: Path, tmp_path: Path) -> None:
    members = pd.DataFrame({"member": [0, 1], "status": ["done", "done"], "weight": [0.0, 0.0]})
    design = read_sweep_file(slope / "sweep.toml").design
    with pytest.raises(ReportError, match="no member with a weight is done"):
        write_outcome(SweepFolder(tmp_path), design, members, [], None, "maps", print)


def test_members_of_fine_cases_have_their_ground(tmp_path: Path, with_program: None) -> None:
    folder, x = tmp_path / "slide", np.arange(400) * 10.0
    write(tmp_path / "dem.tif", np.tile(3000.0 - 0.6 * x, (300, 1)), 400_000.0, NORTH, 10.0)
    thickness = np.zeros((300, 400))
    thickness[140:160, 100:130] = 40.0
    write(tmp_path / "thickness.tif", thickness, 400_000.0, NORTH, 10.0)
    inputs = tmp_path / "dem.tif", tmp_path / "thickness.tif"
    thawslide.new_case(*inputs, folder, reach_angle=26.0, resolution="fine", on_message=print)
    cells = tomllib.loads((folder / "sweep.toml").read_text())["sweep"]["set"]
    assert cells["grid.cell"] > Case(folder)["grid.cell"]
    sets = [word for key, value in cells.items() for word in ("--set", f"{key}={value}")]
    done = subprocess.run([str(find_program()), "check", str(folder), *sets], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_a_design_of_a_2d_case_is_for_sweep(tmp_path: Path, capfd: Capture) -> None:
    file = write_slope_case(tmp_path / "slope", end=0.5, cell=10.0).with_name("sweep.toml")
    file.write_text(SWEEP)
    assert f"not a 3D case. For other cases, use: thawslide sweep {file}" in error(capfd, file.parent)


@pytest.mark.parametrize("resolution", ["quick", "standard"])
def test_new_writes_a_design_whose_members_are_valid(tmp_path: Path, with_program: None, resolution: str) -> None:
    valley, folder = ROOT / "cases" / "valley3d", tmp_path / "slide"
    printed: list[str] = []
    inputs = valley / "valley.tif", valley / "release.geojson"
    thawslide.new_case(*inputs, folder, resolution=resolution, on_message=printed.append)
    assert any(line.endswith(f" forecast {folder}") for line in printed)
    design = read_sweep_file(folder / "sweep.toml").design
    cases = validated(design.members())
    assert len(cases) == design.size == 32 and {case["grid.cell"] for case in cases} == {40.0}
    angles, bands = ([case[key] for case in cases] for key in ("basal.friction_angle", "band.thickness"))
    assert 20.0 <= min(angles) < 21.0 and 34.0 < max(angles) <= 35.0
    assert 0.1 <= min(bands) < 0.2 and 0.9 < max(bands) <= 1.0
