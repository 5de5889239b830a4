"""Reading a run folder: values and names of the files, variable widths, and messages of errors."""

import os
import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import ROOT, MakeRun, edit, ground, history_columns, snapshot_file

from reproduction.lamplugh import deposit
from thawslide import NotInRunError, ReportError, Run, Snapshot
from thawslide.atomic_file import atomic_file
from thawslide.figures import FIGURES
from thawslide.figures.snapshots import particle_size
from thawslide.key_numbers import found_for
from thawslide.maps import read_map
from thawslide.report_page import make_report
from thawslide.targets import Target


def test_history_terrain_case_and_targets_are_read(make_run: MakeRun) -> None:
    run, written = Run(make_run()), history_columns(101, 2)
    assert (list(run.series), run.series.rows) == (list(written), 101)
    for name, values in written.items():
        np.testing.assert_array_equal(run.series[name], values)
    assert np.isnan(run.series["band_temperature_C"][0])
    assert (run.title, run.report_times, run.per_metre) == ("Block on a slope & <more>", [0.0, 4.0, 7.4], False)
    assert run.vertical == 1 and Run(make_run(name="space", dimension=3)).vertical == 2
    np.testing.assert_allclose(run.terrain[1], ground(run.terrain[0]))
    velocities = [("mean_velocity", 4.0, 9.0), ("mean_velocity", 6.0, 11.0)]
    assert [(t.quantity, t.time, t.value) for t in run.targets[:2]] == velocities
    assert run.targets[-1].value == 1.1e11


def test_optional_files_can_be_missing(make_run: MakeRun) -> None:
    folder = make_run(terrain=False, targets=False, width=0.0, times="[]")
    (folder / "run.json").unlink()
    run = Run(folder)
    assert run.terrain is None and run.per_metre
    assert (run.targets, run.facts, run.report_times) == ([], {}, [])


def test_snapshots_are_read_by_index_and_by_nearest_time_and_missing_names_are_errors(make_run: MakeRun) -> None:
    run = Run(make_run())
    np.testing.assert_array_equal(run.times, np.arange(11.0))
    assert (run.snapshot(3).time, run.snapshot(-1).time) == (3.0, 10.0) and run.snapshot(time=7.4).time == 7.0
    snapshot = run.snapshot(time=1e9)
    assert (snapshot.time, snapshot.step) == (10.0, 1000)
    assert (snapshot.points.shape, snapshot["stress"].shape) == ((80, 3), (80, 6))
    assert snapshot.unit("temperature") == "degC"
    np.testing.assert_allclose(np.linalg.norm(snapshot["velocity"], axis=1), 50.0)
    with pytest.raises(NotInRunError, match=r"no column runout \(nearest: runout_m\)"):
        run.series["runout"]
    with pytest.raises(NotInRunError, match=r"no field speed \(found: body, displacement, "):
        run.snapshot(0)["speed"]


def expect(folder: Path, text: str, kind: type[ReportError] = ReportError) -> None:
    with pytest.raises(kind, match=re.escape(text)):
        run = Run(folder)
        _ = run.case, run.series, run.terrain, run.targets, run.facts, run.times, run.snapshot(0)


def test_other_folders_and_missing_targets_are_errors(make_run: MakeRun, tmp_path: Path) -> None:
    expect(tmp_path / "nowhere", "no such folder. Select the folder of a run, e.g. runs/lamplugh.")
    expect(tmp_path, "not a run folder (found no case.toml and no history.csv). Select the folder of a run.")
    folder = make_run()
    (folder / "history.csv").unlink()
    expect(folder, "not a run folder (found no history.csv).")
    folder = make_run(name="targets")
    (folder / "inputs" / "targets.csv").unlink()
    expect(folder, "targets.csv: no such file. Correct report.targets in ")


@pytest.mark.parametrize("name", ["x" * 300, "zero\\u0000byte", "loop"])
def test_invalid_name_of_targets_is_an_error(make_run: MakeRun, name: str) -> None:
    folder = make_run()
    (folder / "loop").symlink_to("loop")
    edit(folder / "case.toml", "inputs/targets.csv", name)
    expect(folder, "case.toml: report.targets: cannot be read (found '" + name[:4])


def test_missing_and_incomplete_snapshots_are_errors(make_run: MakeRun) -> None:
    folder = make_run(snapshots=3)
    with h5py.File(snapshot_file(folder, 0), "a") as file:
        del file["VTKHDF"].attrs["time"]
    with h5py.File(snapshot_file(folder, 1), "a") as file:
        del file["VTKHDF/Points"]
    with h5py.File(snapshot_file(folder, 2), "a") as file:
        del file["VTKHDF/PointData/mass"]
        file["VTKHDF/PointData/mass"] = np.ones(3)
    snapshot_file(folder, 3).write_text("cut")
    of_mass, cut = "found 3 rows of 'mass' for 80 particles", "000003.vtkhdf: cannot be read as HDF5"
    for number, text in enumerate(("no group VTKHDF with", "found no Points", of_mass, cut)):
        with pytest.raises(ReportError, match=text):
            Run(folder).snapshot(number)
    none = make_run(name="none", snapshots=0)
    expect(none, "no snapshots. Set time.output_interval and repeat the run.", NotInRunError)
    with pytest.raises(ReportError, match=r"no snapshot 11 \(found 11 snapshots\)"):
        Run(make_run(name="some")).snapshot(11)


WIDENING = "{ x = [20.0, 40.0], value = [10.0, 40.0] }"


def test_volume_size_and_thickness_include_the_relative_width(make_run: MakeRun) -> None:
    run, one = Run(make_run(width=WIDENING)), Run(make_run(name="one", width=10.0))
    assert run.relative_width(np.array([0.0, 20.0, 30.0, 40.0, 900.0])).tolist() == [1.0, 1.0, 2.5, 4.0, 4.0]
    assert one.relative_width(np.array([0.0, 900.0])).tolist() == [1.0, 1.0]
    assert (run.width, run.per_metre, one.width) == (10.0, False, 10.0)
    volume, shot = Target("source_volume", 0.0, 1.0, "m3", "survey"), run.snapshot(0)
    assert found_for(run, volume) == "800 m³", "80 particles of 1 m3 per metre of 10 m"
    expected = particle_size(one, one.snapshot(0)) / np.sqrt(run.relative_width(shot.points[:, 0]))
    assert particle_size(run, shot) == pytest.approx(expected, rel=1e-15)
    assert expected.min() < 0.6 * expected.max(), "the body is across the widening"
    run = Run(make_run(name="deposit", width=WIDENING, snapshots=1))  # a block 4 m high and 20 m long at its start
    x, thickness = deposit(run)
    assert x[0] == 50.0
    shot = run.snapshot(0)
    areas = run.section_areas(shot)
    assert areas == pytest.approx(np.asarray(shot["volume"]) / run.relative_width(shot.points[:, 0]))
    assert thickness[0] == pytest.approx(areas.sum() / 100.0)


def names_in(list_name: str) -> set[str]:
    text = (ROOT / "src" / "io" / "run_folder.cpp").read_text()
    found = re.search(rf"\b{list_name} =(.*?);", text, re.DOTALL)
    assert found
    return set("".join(re.findall(r'"([^"]*)"', found[1])).split())


def test_simulator_has_all_names_of_figures_and_maps() -> None:
    assert names_in("figures_of_a_run") == set(FIGURES)
    source = (ROOT / "src" / "sim" / "maps" / "map_kinds.cpp").read_text()
    kinds = set(re.findall(r'^ +{"(\w+)", "', source, re.MULTILINE))
    assert len(kinds) >= 10 and names_in("maps_of_a_run") == kinds | {"terrain", "release", "ground"}


def test_temporary_files_of_two_reports_do_not_collide(tmp_path: Path) -> None:
    """Their names have the number of the process; a link in place of such a file is not followed."""
    path, victim = tmp_path / "motion.png", tmp_path / "victim"
    victim.write_text("mine")
    (tmp_path / f".motion.{os.getpid()}.thawslide-part.png").symlink_to(victim)
    with atomic_file(path) as temporary:
        assert temporary.name == f".motion.{os.getpid()}.thawslide-part.png"
        temporary.write_text("new")
    assert path.read_text() == "new" and not path.is_symlink() and victim.read_text() == "mine"


@pytest.mark.parametrize("what", ["pipe", "/dev/zero"])
def test_pipes_and_devices_do_not_block_readers(make_run: MakeRun, tmp_path: Path, what: str) -> None:
    folder = make_run()
    os.mkfifo(tmp_path / "pipe")
    file = snapshot_file(folder, 3)
    file.unlink()
    file.symlink_to(tmp_path / what)
    for read, remedy in (Snapshot, "Remove it"), (read_map, "Repeat the run"):
        with pytest.raises(ReportError, match=rf"000003\.vtkhdf: not a file\. {remedy}"):
            read(file)
    assert 3.0 not in Run(folder, skip_damaged=True).times
    page = make_report(Run(folder, skip_damaged=True), names=["velocity"], dpi=50).page
    assert "000003.vtkhdf: not a file" in page.read_text(encoding="utf-8")
