"""Labels and numbers of a sweep's page: names and units of keys and results, and constant results."""

from itertools import pairwise

import numpy as np
import pandas as pd
import pytest

from thawslide import NotInRunError
from thawslide.sweeps.declared import declared_columns
from thawslide.sweeps.design import Design
from thawslide.sweeps.figures import scatter, tornado
from thawslide.sweeps.labels import label_of_key, label_of_result
from thawslide.sweeps.page import number_rows
from thawslide.sweeps.results import WEIGHT
from thawslide.sweeps.sensitivity import MORRIS, Index, indices_of
from thawslide.sweeps.variables import Uniform


def test_keys_results_and_axes_have_declared_names_and_units(with_program: None) -> None:
    assert label_of_key("basal.friction_angle") == "basal.friction_angle (degrees)"
    assert label_of_key("body.slide.temperature") == "body.slide.temperature (°C)"
    assert label_of_key("basal.friction") == "basal.friction" and label_of_key("case") == "case"
    assert label_of_result("peak_speed_m_s") == "peak speed (m/s)" and label_of_result("h_over_l") == "H/L"
    assert label_of_result("probe_bend_mean_speed_m_s") == "probe bend mean speed (m/s)"
    assert label_of_result("probe_gate_passed_volume_m3") == "probe gate passed volume (m³)"
    assert label_of_result("own") == "own"
    assert {"time_s", "runout_m", "basal_force_y_N"} <= {*declared_columns(is_block=False)}
    assert "velocity_m_s" in declared_columns(True) and "velocity_m_s" not in declared_columns(False)
    table = pd.DataFrame({"band.thickness": [0.1, 0.2, 0.3], "peak_speed_m_s": [3.0, 2.0, 1.0]})
    axes = scatter(table, ["band.thickness"], ["peak_speed_m_s"]).axes[0]
    assert axes.get_xlabel() == "band.thickness (m)" and axes.get_ylabel() == "peak speed (m/s)"
    figure = tornado("peak_speed_m_s", [Index("band.thickness", MORRIS, 2.0, 1.0, np.nan)])
    assert figure.axes[0].get_xlabel() == f"{MORRIS} (m/s)"


def test_labels_of_inputs_do_not_overlap() -> None:
    keys = ["material.rock_ice.hydraulic_conductivity", "body.slide.temperature", "basal.residual_friction_angle"] * 2
    keys = [f"{key}{'' if number < 3 else '_again'}" for number, key in enumerate(keys)]
    table = pd.DataFrame({key: [1e-7, 2e-7, 3e-7] for key in keys} | {"peak_speed_m_s": [3.0, 2.0, 1.0]})
    figure = scatter(table, keys, ["peak_speed_m_s"])
    figure.draw_without_rendering()
    boxes = [axes.xaxis.label.get_window_extent() for axes in figure.axes]
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))
    assert not any(axes.xaxis.get_offset_text().get_text() for axes in figure.axes)
    assert "3e−7" in {label.get_text() for label in figure.axes[0].get_xticklabels()}


def test_constant_results_have_no_deviation_and_no_sensitivity() -> None:
    """The mean of equal numbers differs from them by rounding, and so would their standard deviation."""
    values = np.full(12, 51.9e6 / 3.0)
    values[5] = np.nextafter(values[5], 0.0)
    assert values.std(ddof=1) > 0.0
    table = pd.DataFrame({"release_volume_m3": values, "runout_m": np.arange(12.0)})
    for weights in ({}, {WEIGHT: np.arange(12.0)}):
        rows = number_rows(table.assign(**weights), ["release_volume_m3", "runout_m"])
        assert rows[0][2:] == ("m³", "1.73e7", "0", "1.73e7", "1.73e7", "1.73e7")
        assert rows[1][4] != "0"
    design = Design(("case",), (Uniform("a", 0.0, 1.0),), "lhs", 12, 1)
    with pytest.raises(NotInRunError, match="all members have the same value"):
        indices_of(design, values)
