"""Band-pass filter of forces, and reported forces with a band."""

import re
from pathlib import Path

import numpy as np
import pytest
from conftest import TARGETS, MakeRun, page_of

from thawslide.band_pass import band_passed, response
from thawslide.errors import ReportError
from thawslide.figures.force import force_in_band, reported_bands, seismic_force
from thawslide.key_numbers import found_for, key_numbers, quantity_text
from thawslide.report_page import make_report
from thawslide.run_folder import Run
from thawslide.targets import Band, Target, band_of

TIME = np.arange(0.0, 2000.0, 0.1)
INNER = (TIME > 600.0) & (TIME < 1400.0)  # four of the longest periods from either end


def sine(period: float, time: np.ndarray = TIME) -> np.ndarray:
    return np.asarray(np.sin(2.0 * np.pi * time / period + 0.3))


@pytest.mark.parametrize("period", [50.0, 60.0, 72.0, 90.0, 100.0])
def test_sine_in_the_band_is_unchanged(period: float) -> None:
    passed = band_passed(TIME, sine(period), 35.0, 150.0)
    # 1/(1 + (T/150)^8) and 1/(1 + (35/T)^8) are the response: at least 0.946 from 50 to 100 s.
    assert np.abs(passed - sine(period))[INNER].max() < 0.06
    exact = response(np.array([1.0 / period]), 35.0, 150.0)[0]
    assert np.abs(passed - exact * sine(period))[INNER].max() < 1e-3, "no phase, and the amplitude of the response"


def test_band_passes_its_middle_half_of_its_ends_and_no_constant() -> None:
    middle = np.sqrt(35.0 * 150.0)
    assert np.abs(band_passed(TIME, sine(middle), 35.0, 150.0))[INNER].max() == pytest.approx(1.0, abs=0.01)
    for period in (35.0, 150.0):
        assert np.abs(band_passed(TIME, sine(period), 35.0, 150.0))[INNER].max() == pytest.approx(0.5, abs=0.005)
    for end in (3.0, 60.0, 200.0, 1000.0):
        time = np.arange(0.0, end, 0.1)
        assert np.abs(band_passed(time, np.full_like(time, 7.0), 35.0, 150.0)).max() < 1e-12


@pytest.mark.parametrize("period", [1.0, 5.0, 15.0, 20.0, 300.0, 500.0])
def test_sine_outside_the_band_is_removed(period: float) -> None:
    assert np.abs(band_passed(TIME, sine(period), 35.0, 150.0))[INNER].max() < 0.013


def pulse(time: np.ndarray) -> np.ndarray:
    """Return a force that begins and ends at rest and changes its sign between."""
    s = np.clip((time - 20.0) / 80.0, 0.0, 1.0)
    return np.asarray(np.sin(2.0 * np.pi * s) * np.sin(np.pi * s) ** 2)


def test_short_record_is_filtered_as_a_part_of_a_long_one() -> None:
    # The force is zero before and after: the extension of the record is exact.
    short, long = np.arange(0.0, 120.0, 0.1), np.arange(-600.0, 800.0, 0.1)
    passed = band_passed(short, pulse(short), 35.0, 150.0)
    whole = np.interp(short, long, band_passed(long, pulse(long), 35.0, 150.0))
    assert np.abs(passed).max() > 0.5
    assert np.abs(passed - whole).max() < 2e-3


def test_uneven_and_missing_rows_have_no_effect() -> None:
    time = np.concatenate((np.arange(0.0, 120.0, 0.1), [120.03, 120.3]))
    values = pulse(time)
    values[0] = np.nan  # no step yet
    even = np.arange(0.0, 120.0, 0.1)
    found = np.interp(even, time, band_passed(time, values, 35.0, 150.0))
    assert np.abs(found - band_passed(even, pulse(even), 35.0, 150.0)).max() < 1e-3
    coarse = np.arange(0.0, 121.0, 1.0)
    assert np.abs(band_passed(coarse, pulse(coarse), 35.0, 150.0)).max() == pytest.approx(np.abs(found).max(), rel=0.01)
    assert band_passed(np.zeros(1), np.ones(1), 35.0, 150.0).tolist() == [0.0]
    with pytest.raises(ValueError, match="the first period must be the shorter one"):
        band_passed(even, pulse(even), 150.0, 35.0)


def target(quantity: str, time: float = 5.0, value: float = 1e11, unit: str = "N") -> Target:
    return Target(quantity, time, value, unit, "somebody")


def test_name_of_a_reported_force_has_the_band() -> None:
    assert band_of(target("max_seismic_force_35_150_s")) == Band(35.0, 150.0)
    assert band_of(target("max_seismic_force_0.5_2.5_s")) == Band(0.5, 2.5)
    assert band_of(target("max_seismic_force")) is None
    assert band_of(target("mean_velocity")) is None


def test_report_has_a_value_of_the_run_for_each_reported_one(make_run: MakeRun) -> None:
    run = Run(make_run())
    assert reported_bands(run) == [Band(2.0, 8.0)]
    largest = quantity_text(float(np.nanmax(force_in_band(run, Band(2.0, 8.0)))), "N")
    found = {row.words: row.value for row in key_numbers(run)}
    assert found["Maximum seismic force, band-pass 2 to 8 s"] == largest
    assert found["Maximum seismic force"] == quantity_text(float(np.nanmax(seismic_force(run)[1])), "N") != largest
    assert found_for(run, target("mean_velocity", 5.0, 11.0, "m/s")) == "12 m/s"
    assert found_for(run, target("band_SL", 5.0, 0.4, "-")) == "0.5"
    outside = "not compared: time outside the run (0 to 10 s)"
    assert found_for(run, target("mean_velocity", 11.0, 11.0, "m/s")) == outside, "after the end"
    assert found_for(run, target("mean_velocity", -100.0, 11.0, "m/s")) == outside, "not with the nearest, at 0 s"
    assert found_for(run, target("source_volume", 0.0, 1.0, "m3")) == "800 m³", "80 particles of 1 m2 on 10 m of width"
    page = re.sub(r'<td data-column="[^"]*">', "<td>", page_of(run.folder, "force"))
    cells = f"maximum seismic force, band-pass 2 to 8 s</th><td>5 s</td><td>110 GN</td><td>{largest}</td><td>waves</td>"
    assert cells in page and '<th scope="col">this run</th>' in page


def test_force_per_metre_is_not_compared(make_run: MakeRun) -> None:
    found = found_for(Run(make_run(width=0.0)), target("max_seismic_force_2_8_s"))
    assert found == "not available: no case.width"


def test_invalid_band_is_an_error(make_run: MakeRun, tmp_path: Path) -> None:
    folder = make_run(targets=TARGETS.replace("_2_8_s", "_8_2_s"))
    words = r"targets\.csv:9: max_seismic_force_8_2_s: give the shorter period first, both"
    with pytest.raises(ReportError, match=words):
        make_report(Run(folder), tmp_path / "out", dpi=50)
