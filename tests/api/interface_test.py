"""Maps, front, key numbers and nodes of a simulation; cases from dictionaries; loggers; texts of errors."""

import math
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, VALLEY, silent

import thawslide
from thawslide import Case, Logger, ReportError, Run, Simulation, UserError
from thawslide.errors import with_parameters
from thawslide.scarps.surfaces import Plane


def test_nodes_have_the_mass_and_momentum_of_the_particles(simulation: Simulation) -> None:
    assert len(simulation.nodes.mass) == 0
    simulation.step(50)
    mass, velocity = simulation.field("mass"), simulation.field("velocity")
    simulation.step()
    nodes = simulation.nodes
    assert nodes.mass.sum() == pytest.approx(mass.sum(), rel=1e-12)
    momentum = (nodes.mass[:, None] * nodes.velocity).sum(axis=0)
    np.testing.assert_allclose(momentum, (mass[:, None] * velocity).sum(axis=0), rtol=1e-10)
    cell = float(simulation.case["grid.cell"])
    particles = simulation.field("position")
    assert np.all(nodes.position.min(axis=0) > particles.min(axis=0) - 3.0 * cell)
    assert np.all(nodes.position.max(axis=0) < particles.max(axis=0) + 3.0 * cell)
    simulation.step(5)
    simulation.restore(simulation.checkpoint())
    assert len(simulation.nodes.mass) == 0
    simulation.step()
    assert simulation.nodes.mass.sum() == pytest.approx(simulation.field("mass").sum(), rel=1e-12)
    without_mechanics = Simulation(ROOT / "cases" / "freezing-bar" / "m025.toml", threads=1, on_message=silent)
    without_mechanics.step(3)
    assert len(without_mechanics.nodes.mass) == 0


def test_a_device_is_the_cpu_a_gpu_or_automatic(slope: Path, tmp_path: Path) -> None:
    for work in (
        lambda: Simulation(slope, threads=1, device="tpu", on_message=silent),
        lambda: thawslide.run(slope, tmp_path / "run", device="tpu", progress=False),
    ):
        with pytest.raises(UserError, match="device is 'tpu'; allowed: cpu, gpu, auto"):
            work()
    assert not (tmp_path / "run").exists()
    try:
        Simulation(slope, threads=1, device="gpu", on_message=silent)
    except UserError as error:  # without a GPU
        assert str(error).startswith("device gpu: ") and str(error).endswith("Run the case on the CPU: device cpu")
        assert "./run setup" not in str(error)
    simulation = Simulation(slope, threads=1, device="auto", on_message=silent)
    simulation.step()
    assert simulation.nodes.mass.sum() == pytest.approx(simulation.field("mass").sum(), rel=1e-12)


def test_positions_are_in_the_coordinates_of_the_case(simulation: Simulation, run: Run) -> None:
    points = run.snapshot(0, fields=["id"])
    order = np.argsort(points["id"]), np.argsort(simulation.field("id"))
    np.testing.assert_array_equal(simulation.field("position")[order[1]], points.points[order[0], :2])
    raw = simulation.blocks("position").reshape(-1, 2)[: simulation.particle_count]
    np.testing.assert_array_equal(raw + simulation.origin, simulation.field("position"))


def test_state_of_a_2d_simulation(simulation: Simulation) -> None:
    simulation.run(until=0.5)
    last = simulation.history.iloc[-1]
    assert simulation.row["time_s"] == simulation.time == last["time_s"]
    assert simulation.front == last["front_position_m"]
    assert dict(simulation.maps) == {} and simulation.key_numbers["dilation_fraction"] < 0.01
    with pytest.raises(KeyError, match="only 3D cases have maps"):
        simulation.maps["max_thickness"]
    assert simulation.fields["temperature"].unit == "degC"


def test_maps_and_key_numbers_are_those_of_the_run(tmp_path: Path) -> None:
    case = Case(VALLEY, {"time.end": 0.4, "grid.cell": 40.0})
    run: Run = thawslide.run(case, tmp_path / "run", threads=1, progress=False)
    simulation = Simulation(case, threads=1, on_message=silent)
    simulation.run()
    for name, live in simulation.maps.items():
        written = run.maps[name]
        assert live.grid.box == pytest.approx(written.grid.box) and live.unit == written.unit, name
        assert repr(live).startswith(f"Map({live.description!r}, {live.grid.rows} x {live.grid.columns} cells, "), name
        assert len(repr(live)) < 200, name
        np.testing.assert_allclose(live.values, written.values, rtol=1e-6, err_msg=name)
    assert run.maps["max_basal_temperature"].unit == simulation.maps["max_basal_temperature"].unit == "degC"
    assert run.maps.about("max_basal_temperature")[1] == "degC"
    numbers = simulation.key_numbers
    assert numbers["affected_area_m2"] == run.facts["affected_area_m2"] > 0.0
    assert all(numbers[name] == run.facts[name] for name in numbers if run.facts.get(name) is not None)


def test_a_dictionary_is_a_case(slope: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tables = tomllib.loads(slope.read_text())
    monkeypatch.chdir(slope.parent)
    case = Case.from_dict(tables)
    assert tomllib.loads(case.to_toml())["body"] == tomllib.loads(Case(slope).to_toml())["body"]
    assert case["grid.cell"] == Case(slope)["grid.cell"]
    with pytest.raises(UserError, match=r"^grid\.cell=-1\.0: grid\.cell is -1"):
        Case.from_dict(tables | {"grid": tables["grid"] | {"cell": -1.0}})
    assert case.name == "case"
    with pytest.raises(TypeError, match="grid is 5, and not a table"):
        Case.from_dict(tables | {"grid": 5})  # type: ignore[dict-item]
    with pytest.raises(TypeError, match="a case has no value of type object"):
        Case.from_dict({"grid": {"cell": object()}})


def test_messages_name_keys_and_parameters_in_place_of_options(
    slope: Path, tmp_path: Path, simulation: Simulation, run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    dem, release = VALLEY / "valley.tif", VALLEY / "release.geojson"
    plane = Plane(x=402000.0, y=6502900.0, dip=25.0, direction=110.0)
    wrong: dict[str, Callable[[], object]] = {
        r"^band\.thickness=-1\.0: band\.thickness is -1": lambda: Case(slope, {"band.thickness": -1.0}),
        r"^time\.step=10\.0: time\.step is 10 s": lambda: simulation.change({"time.step": 10.0}),
        r"^time\.step=10\.0: ": lambda: thawslide.resume(run.folder, {"time.end": 2.0, "time.step": 10.0}),
        r"^grid\.cel=3: key 'grid\.cel' is not known": lambda: thawslide.resume(run.folder, {"grid.cel": 3}),
        r"Specify another output, or replace that run with overwrite=True": lambda: thawslide.run(slope, run.folder),
        r"^only: no figure 'xx'": lambda: thawslide.report(run, only="xx"),
        r"^brief=True: allowed with one RUN only": lambda: thawslide.report(run, run, brief=True),
        r"^cell.* -1(?!.*help)": lambda: thawslide.new_case(dem, release, tmp_path / "new", cell=-1),
        r"^volume: ": lambda: thawslide.scarp(dem, plane, volume=-1.0),
        r"^keep: invalid": lambda: thawslide.sweep(slope, vary={"grid.cell": [5.0]}, keep="few"),
    }
    for message, work in wrong.items():
        with pytest.raises((UserError, ReportError), match=message) as raised:
            work()
        assert "--" not in str(raised.value)
    lines: list[str] = []
    case = Case(slope, {"basal.friction_angle": 1.0})
    Simulation(case, threads=1, on_message=lines.append)
    assert any(line.startswith("warning: basal.friction_angle=1.0: ") for line in lines), lines
    thawslide.run(case, slope.parent / "run", threads=1, progress=False)
    assert "warning: basal.friction_angle=1.0: " in capsys.readouterr().err


def test_options_in_commands_remain() -> None:
    lines = {
        "To continue, add --set time.stop_at_rest=0 or --end T.": "To continue, add time.stop_at_rest=0 or time.end=T.",
        "stopped: thawslide resume runs/a --end 3": "stopped: thawslide resume runs/a --end 3",
        "runs/a--b: --reach-angle is 0": "runs/a--b: reach_angle is 0",
        "--device gpu: to build: ./run --setup --gpu. Use --device cpu": (
            "device gpu: to build: ./run --setup --gpu. Use device cpu"
        ),
    }
    assert with_parameters("\n".join(lines)) == "\n".join(lines.values())


def test_a_logger_records_quantities_at_intervals(simulation: Simulation) -> None:
    logger = Logger(front_m=lambda simulation: simulation.front, particles=lambda simulation: simulation.particle_count)
    simulation.run(until=0.5, callback=logger, every=0.1)
    table = logger.table
    assert list(table.columns) == ["time_s", "step", "front_m", "particles"]
    np.testing.assert_allclose(table["time_s"], 0.1 * np.arange(1, 6), atol=1e-9)
    assert table["front_m"].is_monotonic_increasing and (table["particles"] == simulation.particle_count).all()
    with pytest.raises(ValueError, match="the logger itself records time_s"):
        Logger(time_s=lambda simulation: 0.0)
    assert repr(logger) == "Logger(front_m, particles: 5 rows)"
    assert Logger(front_m=lambda simulation: math.nan).table.empty


def test_callbacks_need_an_interval_and_are_called_once_per_step_at_most(simulation: Simulation) -> None:
    for interval in ({"every": 0.1}, {"every_steps": 2}):
        with pytest.raises(UserError, match=r"`every` and `every_steps` need a callback"):
            simulation.run(until=0.2, **interval)  # type: ignore[arg-type]
    assert simulation.time == 0.0
    times: list[float] = []
    simulation.run(until=0.025, callback=lambda now: times.append(now.time), every=0.002)
    np.testing.assert_allclose(times, 0.005 * np.arange(1, 6))
