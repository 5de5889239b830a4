"""Reported values: conversion of units, and messages of errors with lines."""

import re
from pathlib import Path

import pytest
from conftest import ROOT, MakeRun, edit, page_of, update_facts
from figure_parts import line
from wrong_tables import HEADER, WRONG_TARGETS

from thawslide import ReportError, Run
from thawslide.figures import FIGURES
from thawslide.key_numbers import found_for
from thawslide.report_page import make_report
from thawslide.targets import QUANTITIES, Target, read_targets


def read(tmp_path: Path, text: str | bytes) -> list[Target]:
    path = tmp_path / "targets.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_targets(path)


def test_units_are_converted_and_back(tmp_path: Path) -> None:
    rows = {
        "mean_displacement,5,0.6,km,x": 600.0, "front_distance,5,80,cm,x": 0.8, "mean_velocity,5,36,km/h,x": 10.0,
        "band_temperature,5,0,K,x": -273.15, "band_temperature,6,-1,degC,x": -1.0, "band_saturation,5,30,%,x": 0.3,
        "band_pore_pressure,5,1.5,MPa,x": 1.5e6, "max_seismic_force,5,0.28,TN,x": 2.8e11,
        "max_seismic_force_35_150_s,5,280,GN,x": 2.8e11, "source_volume,0,52,million m3,x": 52e6,
        "deposit_volume,0,0.052,km³,x": 52e6, "deposit_area,0,12,ha,x": 12e4,
        "angle_of_reach,0,0.25,rad,x": 14.323944878270581,
    }  # fmt: skip
    targets = read(tmp_path, HEADER + "\n".join(rows) + "\n")
    for (row, value), target in zip(rows.items(), targets, strict=True):
        assert target.value == pytest.approx(value, rel=1e-14, abs=1e-14), row
        assert target.in_its_unit(target.value) == pytest.approx(float(row.split(",")[2]), rel=1e-12, abs=1e-12), row
    for name, quantity in QUANTITIES.items():
        assert next(iter(quantity.units.values())) == (1.0, 0.0), name
        for unit, (factor, offset) in quantity.units.items():
            target = Target(name, 0.0, 7.0, unit, "")
            assert factor * target.in_its_unit(7.0) + offset == pytest.approx(7.0, rel=1e-12), unit


def test_times_can_be_in_minutes_and_line_ends_marks_and_spaces_are_ignored(tmp_path: Path) -> None:
    for column, seconds in ("time_s", 1.5), ("time_min", 90.0), ("time_h", 5400.0):
        (target,) = read(tmp_path, f"quantity,{column},value,unit\nmean_velocity,1.5,1,m/s\n")
        assert (target.time, target.source) == (seconds, "")
    text = HEADER + "mean_displacement,5,0.6,km,Müller\n"
    spaces = f'# one\n\n{HEADER}\n"mean_displacement",5, 0.6 ,km,"Müller"\n\n'
    for each in text, "\ufeff" + text, text.replace("\n", "\r\n"), text.rstrip().replace("\n", "\r"), spaces:
        assert read(tmp_path, each) == [Target("mean_displacement", 5.0, 600.0, "km", "Müller")], each


@pytest.mark.parametrize(("text", "message"), WRONG_TARGETS)
def test_invalid_files_are_errors_with_their_line(tmp_path: Path, text: str | bytes, message: str) -> None:
    words = message if message.startswith("found") else f"targets.csv{message}"
    with pytest.raises(ReportError, match=re.escape(words)):
        read(tmp_path, text)


def test_report_compares_in_the_unit_of_the_file(make_run: MakeRun) -> None:
    rows = "mean_displacement,5,0.06,km,model\nmean_velocity,5,36,km/h,seismic\nsource_mean_thickness,0,4,m,x\n"
    folder = make_run(targets=HEADER + rows)
    run = Run(folder)
    assert [found_for(run, target) for target in run.targets] == ["0.04 km", "43.2 km/h", "not compared"]
    page = re.sub(r'<td data-column="[^"]*">', "<td>", page_of(folder))
    assert '<th scope="row">mean displacement</th><td>5 s</td><td>0.06 km</td><td>0.04 km</td><td>model</td>' in page
    speed, distance = FIGURES["motion"].plot(run).axes
    assert line(speed, "reported: seismic")[1] == [10.0]
    assert line(distance, "reported mean displacement: model")[1] == [60.0]


def test_observations_and_results_of_other_models_are_separate(make_run: MakeRun) -> None:
    rows = (
        "mean_velocity,4,9,m/s,radar,observation\nmean_velocity,6,11,m/s,blocks,model\n"
        "mean_displacement,5,60,m,blocks,model\nmean_displacement,6,70,m,survey,observation\n"
        "front_distance,10,150,m,guess,assumption\n"
    )
    folder = make_run(targets=HEADER.rstrip() + ",kind\n" + rows)
    run = Run(folder)
    assert [target.kind for target in run.targets] == ["observation", "model", "model", "observation", "assumption"]
    kinds = re.findall(r"<h3>(.*?)</h3>\n(.*?)</table>", page_of(folder), re.DOTALL)
    assert [kind for kind, _ in kinds] == ["Observations", "Results of other models", "Assumptions"]
    sources = [re.findall(r"<td[^>]*>(radar|survey|blocks|guess)</td>", table) for _, table in kinds]
    assert sources == [["radar", "survey"], ["blocks", "blocks"], ["guess"]]
    marks = {str(each.get_label()): each for axes in FIGURES["motion"].plot(run).axes for each in axes.lines}
    expected = {
        "observed: radar": 9.0, "modelled: blocks": 11.0, "observed mean displacement: survey": 70.0,
        "assumed runout distance: guess": 150.0,
    }  # fmt: skip
    for label, value in expected.items():
        assert list(marks[label].get_ydata()) == [value]
    filled = [label for label, each in marks.items() if ": " in label and each.get_markerfacecolor() != "white"]
    assert filled == ["observed: radar", "observed mean displacement: survey"]


def test_results_of_the_end_are_compared(make_run: MakeRun) -> None:
    rows = "deposit_volume,0,52,million m3,x\nangle_of_reach,0,14,degrees,x\ndrop_height,0,1,km,x\n"
    folder = make_run(targets=HEADER + rows, facts={"covered_volume_m3": 5e7, "reach_angle_degrees": 14.5})
    for when in ("", " at 9 s (not at rest)"):
        run = Run(folder)
        expected = [f"50 million m³{when}", f"14.5 degrees{when}", "not available in 2D"]
        assert [found_for(run, target) for target in run.targets] == expected
        update_facts(folder, at_rest=False, simulated_time_s=9.0)


def test_errors_precede_the_figures(make_run: MakeRun) -> None:
    folder = make_run(targets=HEADER + "mean_displacement,5,0.6,miles,x\n")
    with pytest.raises(ReportError, match="the unit 'miles' for mean_displacement"):
        make_report(Run(folder), dpi=50)
    assert not (folder / "figures").exists()


@pytest.mark.parametrize("name", ["../outside.csv", "/etc/hostname", "inputs/link.csv"])
def test_file_outside_the_run_folder_is_an_error(make_run: MakeRun, name: str) -> None:
    folder = make_run()
    (folder.parent / "outside.csv").write_text(HEADER)
    (folder / "inputs" / "link.csv").symlink_to(folder.parent / "outside.csv")
    edit(folder / "case.toml", 'targets = "inputs/targets.csv"', f'targets = "{name}"')
    with pytest.raises(ReportError, match="outside the run folder"):
        _ = Run(folder).targets


def test_reference_has_all_quantities_with_units() -> None:
    text = (ROOT / "docs" / "reference" / "reported-values.md").read_text(encoding="utf-8")
    table = text[text.index("| quantity | unit |") :].split("\n\n")[0]
    stated: dict[str, set[str]] = {}
    for row in table.splitlines()[2:]:
        names, units, _ = row.strip("|").split("|")
        for name in re.findall(r"`(\w+)`", names):
            stated[name] = {unit.strip() for unit in units.split(",")}
    assert set(stated) == {*QUANTITIES, "max_seismic_force_35_150_s"}
    for name, quantity in QUANTITIES.items():
        # Other spellings of the same, as m² and deg, are not listed.
        assert stated[name] <= set(quantity.units)
        assert {quantity.units[unit] for unit in stated[name]} == set(quantity.units.values()), name
