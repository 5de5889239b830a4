"""Reading a run folder: values of the files, and messages of errors."""

import re
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import MakeRun, edit, ground, history_columns

from thawslide import NotInRunError, ReportError, Run


def test_history_has_all_columns_and_nan(make_run: MakeRun) -> None:
    history = Run(make_run()).series
    written = history_columns(101, 2)
    assert (list(history), history.rows) == (list(written), 101)
    for name, values in written.items():
        np.testing.assert_array_equal(history[name], values)
    assert np.isnan(history["band_temperature_C"][0])


def test_terrain_case_and_targets_are_read(make_run: MakeRun) -> None:
    run = Run(make_run())
    assert (run.title, run.report_times) == ("Block on a slope & <more>", [0.0, 4.0, 7.4])
    assert not run.per_metre and run.terrain is not None
    np.testing.assert_allclose(run.terrain[1], ground(run.terrain[0]))
    velocities = [("mean_velocity", 4.0, 9.0), ("mean_velocity", 6.0, 11.0)]
    assert [(t.quantity, t.time, t.value) for t in run.targets[:2]] == velocities
    assert run.targets[-1].value == 1.1e11


def test_optional_files_can_be_missing(make_run: MakeRun) -> None:
    folder = make_run(terrain=False, targets=False, width=0.0, times="[]")
    (folder / "run.json").unlink()
    run = Run(folder)
    assert run.terrain is None and run.targets == []
    assert (run.facts, run.report_times) == ({}, [])
    assert run.per_metre


def test_snapshots_are_read_by_index_and_by_nearest_time(make_run: MakeRun) -> None:
    run = Run(make_run())
    np.testing.assert_array_equal(run.times, np.arange(11.0))
    assert (run.snapshot(3).time, run.snapshot(-1).time) == (3.0, 10.0)
    assert run.snapshot(time=7.4).time == 7.0
    snapshot = run.snapshot(time=1e9)
    assert (snapshot.time, snapshot.step) == (10.0, 1000)
    assert (snapshot.points.shape, snapshot["stress"].shape) == ((80, 3), (80, 6))
    assert snapshot.unit("temperature") == "degC"
    np.testing.assert_allclose(np.linalg.norm(snapshot["velocity"], axis=1), 50.0)


def test_vertical_axis_depends_on_the_dimension(make_run: MakeRun) -> None:
    assert Run(make_run(name="flat")).vertical == 1
    assert Run(make_run(name="solid", dimension=3)).vertical == 2


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


def test_incomplete_last_row_is_ignored_with_a_warning(make_run: MakeRun) -> None:
    folder = make_run(rows=11)
    (folder / "history.csv").write_text((folder / "history.csv").read_text()[:-20])
    run = Run(folder)
    assert (run.series.rows, run.series["time_s"][-1]) == (10, 9.0)
    assert run.warnings == [f"{folder / 'history.csv'}: the last row is incomplete and is ignored"]


def test_messages_on_missing_names_have_the_nearest_one(make_run: MakeRun) -> None:
    run = Run(make_run())
    with pytest.raises(NotInRunError, match=r"no column runout \(nearest: runout_m\)"):
        run.series["runout"]
    with pytest.raises(NotInRunError, match=r"no field speed \(found: body, displacement, "):
        run.snapshot(0)["speed"]


def test_missing_snapshots_are_errors(make_run: MakeRun) -> None:
    none = make_run(name="none", snapshots=0)
    expect(none, "no snapshots. Set time.output_interval and repeat the run.", NotInRunError)
    with pytest.raises(ReportError, match=r"no snapshot 11 \(found 11 snapshots\)"):
        Run(make_run(name="some")).snapshot(11)


def test_incomplete_snapshots_are_errors(make_run: MakeRun) -> None:
    folder = make_run(snapshots=3)
    paths = [folder / "snapshots" / f"{number:06d}.vtkhdf" for number in range(3)]
    with h5py.File(paths[0], "a") as file:
        del file["VTKHDF"].attrs["time"]
    with h5py.File(paths[1], "a") as file:
        del file["VTKHDF/Points"]
    with h5py.File(paths[2], "a") as file:
        del file["VTKHDF/PointData/mass"]
        file["VTKHDF/PointData/mass"] = np.ones(3)
    paths[1].with_name("000003.vtkhdf").write_text("cut")
    of_mass, cut = "found 3 rows of 'mass' for 80 particles", "000003.vtkhdf: cannot be read as HDF5"
    for number, text in enumerate(("no group VTKHDF with", "found no Points", of_mass, cut)):
        with pytest.raises(ReportError, match=text):
            Run(folder).snapshot(number)
