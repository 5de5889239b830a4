"""`thawslide score` on small sweeps and runs: numbers, maps, weights, files, the page, and errors."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import scoringrules
from conftest import CELL, Capture, write, write_box

from thawslide.figures.force_record import Comparison, Curves
from thawslide.force_record import extreme_times
from thawslide.number_text import area_text, number_text
from thawslide.pages.events import KINDS, published_events
from thawslide.report_page import make_report
from thawslide.scores.baseline import VOLUME_FACTOR, baseline_values, comparable_kinds, similar_events
from thawslide.scores.command import main
from thawslide.scores.ensemble import percentile
from thawslide.scores.force import best_alignment, correlation
from thawslide.scores.output import BEGIN, END, stored_section
from thawslide.scores.quantities import TABLES
from thawslide.scores.renewal import renew_score
from thawslide.sweeps.command import main as sweep

# Two numbers of the rock avalanche at Joffre Peak, 2019 (Friele et al.); the sweep is synthetic.
JOFFRE = """[event]
name = "Joffre Peak"
source = "Friele et al."
kind = "rock"
[travel_distance]
value = 4.0
unit = "km"
uncertainty = 0.4
[h_over_l]
value = 0.28
unit = "-"
[duration]
value = 2
unit = "min"
"""


def synthetic_sweep(folder: Path, weights: list[float] | None = None) -> pd.DataFrame:
    """Write a sweep of 24 members, of which the last has failed, without run folders."""
    random = np.random.default_rng(5)
    (folder / "members").mkdir(parents=True)
    (folder / "sweep.json").write_text(json.dumps({"members": 24}))
    length, ratio = random.gamma(25.0, 112.0, 24), random.uniform(0.3, 0.6, 24)
    table = pd.DataFrame({"member": range(24), "status": ["done"] * 23 + ["failed"], "basal.law": "voellmy"})
    table["release_volume_m3"] = 2.5e6
    table = table.assign(travel_distance_m=length, h_over_l=ratio, drop_height_m=length * ratio)
    if weights:
        table["weight"] = weights
    table.sample(frac=1.0, random_state=1).to_parquet(folder / "members.parquet", index=False)
    for number, distance in enumerate(length):
        time = np.linspace(0.0, 200.0, 401).astype(np.float32)
        front, speed = np.minimum(40.0 * time, distance), np.where(time < (300.0 if number < 2 else 90.0), 40.0, 0.3)
        np.savez(folder / "members" / f"{number:06d}.npz", time_s=time, runout_m=front, speed_m_s=speed)
    return table[:23]


def scored(forecast: Path, text: str, *words: str) -> pd.DataFrame:
    file = forecast.parent / "observed.toml"
    file.write_text(text)
    assert main([str(forecast), "--observed", str(file), *words]) == 0
    return pd.read_csv(forecast / "score.csv").set_index("quantity")


def failure(forecast: Path, text: str, capfd: Capture) -> str:
    file = forecast.parent / "observed.toml"
    file.write_text(text)
    capfd.readouterr()
    assert main([str(forecast), "--observed", str(file)]) == 2
    return capfd.readouterr().err.strip()


def test_scores_are_those_of_the_members_and_of_similar_events(tmp_path: Path, capfd: Capture) -> None:
    done = synthetic_sweep(tmp_path / "sweep")
    found = scored(tmp_path / "sweep", JOFFRE)
    events = [each for each in published_events() if 1e6 <= each.volume <= 6.25e6 and each.kind == "rock"]
    assert len(events) >= 5
    row = found.loc["travel_distance"]
    length = done["travel_distance_m"].to_numpy() / 1e3
    assert row["members_crps"] == pytest.approx(scoringrules.crps_ensemble(4.0, length, estimator="nrg"))
    assert row["members_percentile"] == pytest.approx(100.0 * np.mean(length < 4.0))
    assert row["members_percentile_high"] == pytest.approx(100.0 * np.mean(length < 4.4))
    assert (row["unit"], row["members_count"], row["events_count"]) == ("km", 23, len(events))
    assert row["members_median"] == np.quantile(length, 0.5, method="inverted_cdf")
    height = np.quantile(done["drop_height_m"], 0.5, method="inverted_cdf") / 1e3
    lengths = height / np.array([each.ratio for each in events])
    crps = scoringrules.crps_ensemble(4.0, lengths, estimator="nrg")
    assert row["events_crps"] == pytest.approx(crps) and row["skill"] == pytest.approx(1.0 - row["members_crps"] / crps)
    ratio = scoringrules.crps_ensemble(0.28, np.array([each.ratio for each in events]), estimator="nrg")
    assert found.loc["h_over_l", "events_crps"] == pytest.approx(ratio)
    expected = 0.99 * done["travel_distance_m"] / 40.0 / 60.0
    members = pd.read_csv(tmp_path / "sweep" / "score-members.csv")
    assert members["member"].tolist() == list(range(23))
    assert members["duration"].to_numpy() / 60.0 == pytest.approx(expected.to_numpy(), abs=0.005)
    out = capfd.readouterr().out
    assert "note: 1 of 24 members are not done and do not count" in out and "2 of 23 members still moved" in out
    assert f"events: {len(events)} published ones with 0.4 to 2.5 times the volume" in out
    page = (tmp_path / "sweep" / "score.md").read_text()
    assert page.startswith("# Score of sweep\n\n23 members compared with observations of Joffre Peak (Friele et al.),")
    assert "| travel distance L | 4 ± 0.4 km" in page and "Gneiting and Raftery 2007, Eq. 21" in page


def test_a_column_weight_weighs_the_members(tmp_path: Path, capfd: Capture) -> None:
    weights = [*np.linspace(0.0, 2.0, 23), 9.0]
    done = synthetic_sweep(tmp_path / "sweep", weights)
    row = scored(tmp_path / "sweep", JOFFRE).loc["travel_distance"]
    mass, length = np.array(weights[:23]), done["travel_distance_m"].to_numpy() / 1e3
    assert row["members_crps"] == pytest.approx(scoringrules.crps_ensemble(4.0, length, ens_w=mass, estimator="nrg"))
    assert row["members_percentile"] == pytest.approx(percentile(length, mass, 4.0))
    assert capfd.readouterr().out.count("have no weight") == 1
    done.loc[3, "travel_distance_m"] = np.nan
    done.to_parquet(tmp_path / "sweep" / "members.parquet", index=False)
    scored(tmp_path / "sweep", JOFFRE)
    out = capfd.readouterr().out
    assert "note: 1 of 23 members have no weight\n" in out and "travel distance L: 21 of 22 members have a value" in out
    assert out.count("have no weight") == 1 and "duration: 22 of" not in out
    synthetic_sweep(tmp_path / "other" / "sweep", [-1.0, *weights[1:]])
    assert "weight: not weights (found -1 to 2; allowed:" in failure(tmp_path / "other" / "sweep", JOFFRE, capfd)


def test_events_of_a_similar_volume_and_kind_are_the_baseline() -> None:
    assert "Frank 1903" in {each.name for each in similar_events(36e6, "")}
    assert "Frank 1903" not in {each.name for each in similar_events(36e6, "", "frank 1903")}
    assert similar_events(1e12, "") == [] and baseline_values("h_over_l", [], 100.0) is None
    assert baseline_values("duration", similar_events(2e6, ""), 100.0) is None
    ends = [event.volume * factor for event in published_events() for factor in (1 / VOLUME_FACTOR, VOLUME_FACTOR)]
    compared = {kind for kind in KINDS if any(similar_events(volume, kind) for volume in ends)}
    assert set(comparable_kinds()) == compared == {"rock"}
    assert TABLES["event"]["kind"] == comparable_kinds()


def sweep_with_maps(folder: Path) -> np.ndarray:
    """Write a sweep of three members on 10 x 20 cells; return the maximum thickness of each."""
    random = np.random.default_rng(8)
    thickness = random.uniform(0.0, 2.0, (3, 10, 20))
    thickness[:, :, 15:] = np.nan
    (folder / "members").mkdir(parents=True)
    (folder / "sweep.json").write_text(json.dumps({"members": 3}))
    table = pd.DataFrame({"member": range(3), "status": "done", "weight": [0.2, 0.3, 0.5]})
    table.to_parquet(folder / "members.parquet", index=False)
    for number, values in enumerate(thickness):
        maps = folder / "members" / f"{number:06d}" / "maps"
        write(maps / "max_thickness.tif", values)
        write(maps / "final_thickness.tif", 0.5 * values)
    return np.nan_to_num(thickness)


def test_overlap_counts_cells_of_members_and_of_the_weighted_probability(tmp_path: Path) -> None:
    thickness = sweep_with_maps(tmp_path / "sweep")
    write_box(tmp_path / "outline.geojson", 30.0, 300.0, 920.0, 980.0)  # beyond the maps, which end at x = 200
    text = '[outline]\nfile = "outline.geojson"\nthreshold = 1.0\n'
    file = tmp_path / "observed.toml"
    file.write_text(text)
    assert main([str(tmp_path / "sweep"), "--observed", str(file)]) == 0
    seen = np.zeros((10, 20), bool)
    seen[2:8, 3:] = True
    beyond = 6 * 10  # cells
    members = pd.read_csv(tmp_path / "sweep" / "score-members.csv")
    for number, reached in enumerate(thickness > 1.0):
        hit, false, missed = (reached & seen).sum(), (reached & ~seen).sum(), (~reached & seen).sum() + beyond
        row = members.iloc[number]
        assert row["outline_hit_m2"] == hit * CELL**2 and row["outline_missed_m2"] == missed * CELL**2
        assert row["outline_false_m2"] == false * CELL**2
        assert row["outline_jaccard"] == pytest.approx(hit / (hit + missed + false))
    probable = np.tensordot([0.2, 0.3, 0.5], thickness > 1.0, 1) >= 0.5 - 1e-9
    hit = (probable & seen).sum()
    tables = json.loads((tmp_path / "sweep" / "score.json").read_text())["tables"]
    index = hit / ((probable | seen).sum() + beyond)
    first = ["thickness above 1 m, probability of at least 0.5", number_text(index, 2), area_text(hit * CELL**2)]
    assert tables[0][1][0][:3] == first


def test_thickness_is_that_of_the_cell_and_far_places_are_errors(tmp_path: Path, capfd: Capture) -> None:
    thickness = sweep_with_maps(tmp_path / "sweep")
    point = '[[thickness]]\nname = "{}"\nx = {}\ny = {}\nvalue = 0\nunit = "cm"\nof = "{}"\n'
    text = point.format("A", 49.0, 961.0, "maximum") + point.format("B", 49.0, 961.0, "deposit")
    scored(tmp_path / "sweep", text + point.format("C", 170.0, 905.0, "deposit"))
    members = pd.read_csv(tmp_path / "sweep" / "score-members.csv")
    assert members["thickness at A"].to_numpy() == pytest.approx(thickness[:, 3, 4])
    assert members["thickness at B"].to_numpy() == pytest.approx(0.5 * thickness[:, 3, 4])
    assert not members["thickness at C"].any()
    error = failure(tmp_path / "sweep", point.format("D", 201.0, 950.0, "deposit"), capfd)
    assert "thickness at D: outside the maps (found x = 201, y = 950; allowed 0 to 200, 900 to 1000). Corr" in error
    write_box(tmp_path / "outline.geojson", 4e6, 5e6, 920.0, 980e3)
    error = failure(tmp_path / "sweep", '[outline]\nfile = "outline.geojson"\n', capfd)
    assert "or far from the maps (found corners from" in error


def test_a_forecast_without_the_observed_quantities_is_an_error(tmp_path: Path, capfd: Capture) -> None:
    synthetic_sweep(tmp_path / "sweep")
    write_box(tmp_path / "outline.geojson", 30.0, 300.0, 920.0, 980.0)
    text = '[peak_speed]\nvalue = 50\nunit = "m/s"\n[outline]\nfile = "outline.geojson"\n'
    error = failure(tmp_path / "sweep", text, capfd)
    assert "nothing to compare with" in error
    assert "peak speed: no value in the column peak_speed_m_s; outline: no map" in error
    (tmp_path / "empty").mkdir()
    assert "neither a sweep nor a run (no sweep.json, no run.json)" in failure(tmp_path / "empty", JOFFRE, capfd)
    (tmp_path / "sweep" / "members.parquet").write_bytes(b"no table")
    assert "members.parquet: cannot be read (" in failure(tmp_path / "sweep", JOFFRE, capfd)


@pytest.mark.parametrize("keep", ["maps", "none"])
def test_the_page_of_a_sweep_has_its_score_before_the_maps(
    plane: Path, tmp_path: Path, capfd: Capture, keep: str
) -> None:
    command = [str(plane), "--vary", "basal.friction_angle=5,25", "--output", str(tmp_path / "sweep"), "--keep", keep]
    assert sweep(command) == 0
    page = tmp_path / "sweep" / "sweep.html"
    assert f"{BEGIN}\n\n{END}" in page.read_text()
    write_box(tmp_path / "outline.geojson", 400_040.0, 400_100.0, 6_500_050.0, 6_500_110.0)
    (tmp_path / "force.csv").write_text(
        "time_s,up_N,north_N,east_N\n"
        + "".join(f"{t},{2e6 * np.sin(6.0 * t)},0,{-1e6 * t}\n" for t in np.arange(0, 1, 0.05))
    )
    text = (
        '[travel_distance]\nvalue = 60\nunit = "m"\n[outline]\nfile = "outline.geojson"\n[peak_speed]\nvalue = 9\n'
        'unit = "m/s"\n[affected_area]\nvalue = 0.4\nunit = "ha"\n'
        '[force_record]\nfile = "force.csv"\nperiods = [0.2, 2]\n'
    )
    found = scored(tmp_path / "sweep", text)
    table = pd.read_parquet(tmp_path / "sweep" / "members.parquet")
    area = table["affected_area_m2"].to_numpy() / 1e4
    crps = scoringrules.crps_ensemble(0.4, area, estimator="nrg")
    assert found.loc["affected_area", "members_crps"] == pytest.approx(crps)
    correlation = pd.read_csv(tmp_path / "sweep" / "score-members.csv")["force_correlation"]
    assert correlation.abs().max() <= 1.0 and len(correlation.unique()) == 2
    out = capfd.readouterr().out
    assert ("outline: no map" in out) == (keep == "none") and f"score: {page}\n" in out
    first = page.read_text()
    assert first.index("<h2>Score</h2>") < first.index("<h2>Probability maps</h2>")
    assert ("Jaccard index" in first) == (keep == "maps")
    assert sweep(command) == 0  # the score is stored
    assert stored_section(page.parent) in page.read_text() and stored_section(page.parent) in first


def test_a_single_run_has_differences(plane: Path, tmp_path: Path, capfd: Capture) -> None:
    from thawslide import run

    found = run(plane, tmp_path / "run")
    row = scored(tmp_path / "run", '[peak_speed]\nvalue = 9\nunit = "m/s"\nuncertainty = 1\n').loc["peak_speed"]
    speed = np.nanmax(found.maps["max_speed"].values)
    assert row["difference"] == pytest.approx(speed - 9.0) and row["members_crps"] == pytest.approx(abs(speed - 9.0))
    out = capfd.readouterr().out
    assert "| quantity   | observed  | run " in out and "percentile" not in out.split("events")[0]
    page = tmp_path / "run" / "report.html"
    assert f"note: {page}: not changed. To write it with the score, repeat thawslide report." in out
    make_report(found, names=["motion"])
    assert "<h2>Score</h2>" in page.read_text()
    scored(tmp_path / "run", '[peak_speed]\nvalue = 7\nunit = "m/s"\nuncertainty = 1\n')
    assert "7 ± 1 m/s" in page.read_text() and f"score: {page}\n" in capfd.readouterr().out


def test_the_correlation_is_that_of_both_components_at_the_times_of_the_record() -> None:
    random = np.random.default_rng(4)
    at, times = np.arange(20.0, 40.0), np.arange(0.0, 60.0)
    record = Curves(at, random.normal(size=20), random.normal(size=20), None)
    parts = [np.interp(times, at, part, 0.0, 0.0) for part in (record.up, record.along)]

    def found(up: np.ndarray, along: np.ndarray) -> float:
        return correlation(Curves(times, up, along, None), record)

    assert found(*parts) == pytest.approx(1.0) and found(-3.0 * parts[0], -3.0 * parts[1]) == pytest.approx(-1.0)
    up, along = np.vdot(record.up, record.up), np.vdot(record.along, record.along)
    assert found(parts[0], 0.0 * parts[1]) == pytest.approx(np.sqrt(up / (up + along)))
    assert np.isnan(found(0.0 * parts[0], 0.0 * parts[1]))


@pytest.mark.parametrize("late", [-7.0, 0.0, 12.5])
def test_the_best_alignment_finds_the_delay_of_a_run(late: float) -> None:
    times = np.arange(0.0, 120.0, 0.5)

    def force(start: float) -> tuple[np.ndarray, np.ndarray]:
        up = np.exp(-(((times - start - 12.0) / 6.0) ** 2)) - np.exp(-(((times - start - 30.0) / 5.0) ** 2))
        return up, -np.exp(-(((times - start - 20.0) / 8.0) ** 2))

    record, run = Curves(times, *force(20.0), None), Curves(times, *force(20.0 + late), None)
    shift, best = best_alignment(Comparison(run, record, {}, 0.0, 0.0, True))
    assert shift == pytest.approx(late) and best == pytest.approx(1.0, abs=1e-6)
    flat = Curves(times, 0.0 * times, 0.0 * times, None)
    assert np.isnan(best_alignment(Comparison(flat, record, {}, 0.0, 3.0, True))[1])


def test_extremes_of_a_force_are_in_order() -> None:
    time = np.arange(0.0, 60.0, 0.1)
    up = sum(a * np.exp(-(((time - t) / 3.0) ** 2)) for a, t in ((0.3, 8.0), (1.0, 21.0), (-0.9, 31.0), (0.2, 40.0)))
    found = extreme_times(time, up, -np.exp(-(((time - 29.5) / 9.0) ** 2)))
    assert found["upward"] == pytest.approx(21.0, abs=0.3) and found["downward"] == pytest.approx(31.0, abs=0.3)
    assert 11.0 < found["dip"] < 16.0 and found["along"] == pytest.approx(29.5, abs=0.01)
    single = extreme_times(time, -np.abs(up), up)
    assert np.isnan(single["upward"]) and np.isnan(single["dip"])


def test_a_damaged_score_does_not_prevent_the_page(tmp_path: Path) -> None:
    assert stored_section(tmp_path) == f"{BEGIN}\n\n{END}"
    for text in ("{", '{"opening": 3}', '{"opening": "a", "tables": [1], "notes": []}'):
        (tmp_path / "score.json").write_text(text)
        assert "score.json cannot be read. Repeat thawslide score." in stored_section(tmp_path)


def test_a_score_of_other_weights_is_computed_again_or_removed(tmp_path: Path) -> None:
    folder, said = tmp_path / "sweep", list[str]()
    table = synthetic_sweep(folder)
    equal = scored(folder, JOFFRE)
    table.assign(weight=table["travel_distance_m"]).to_parquet(folder / "members.parquet", index=False)
    renew_score(folder, said.append)
    found = pd.read_csv(folder / "score.csv").set_index("quantity")
    assert said == [f"score: {folder / 'score.json'}"] and not found.equals(equal)
    assert found.equals(scored(folder, JOFFRE))
    (tmp_path / "observed.toml").unlink()
    renew_score(folder, said.append)
    assert "score.json: removed, because it is of other members or weights" in said[1] and "observed.toml" in said[1]
    assert not list(folder.glob("score*"))
    renew_score(folder, said.append)
    assert len(said) == 2


def test_an_output_folder_is_used(tmp_path: Path) -> None:
    synthetic_sweep(tmp_path / "sweep")
    (tmp_path / "observed.toml").write_text(JOFFRE)
    words = ["--observed", str(tmp_path / "observed.toml"), "--output", str(tmp_path / "out")]
    assert main([str(tmp_path / "sweep"), *words]) == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "score.csv", "score.json", "score.md", "score-members.csv",
    }  # fmt: skip
    assert not (tmp_path / "sweep" / "score.json").exists()
