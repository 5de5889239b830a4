"""Labels of a sweep's page: names and units of keys and results."""

import numpy as np
import pandas as pd

from thawslide.sweeps.declared import declared_columns
from thawslide.sweeps.figures import scatter, tornado
from thawslide.sweeps.labels import label_of_key, label_of_result
from thawslide.sweeps.sensitivity import MORRIS, Index


def test_keys_results_and_histories_have_declared_names_and_units(with_program: None) -> None:
    assert label_of_key("basal.friction_angle") == "basal.friction_angle (degrees)"
    assert label_of_key("body.slide.temperature") == "body.slide.temperature (°C)"
    assert label_of_key("basal.friction") == "basal.friction" and label_of_key("case") == "case"
    assert label_of_result("peak_speed_m_s") == "peak speed (m/s)" and label_of_result("h_over_l") == "H/L"
    assert label_of_result("probe_bend_mean_speed_m_s") == "probe bend mean speed (m/s)"
    assert label_of_result("probe_gate_passed_volume_m3") == "probe gate passed volume (m³)"
    assert label_of_result("own") == "own"
    assert {"time_s", "runout_m", "basal_force_y_N"} <= {*declared_columns(is_block=False)}
    assert "velocity_m_s" in declared_columns(True) and "velocity_m_s" not in declared_columns(False)


def test_axes_have_names_and_units(with_program: None) -> None:
    table = pd.DataFrame({"band.thickness": [0.1, 0.2, 0.3], "peak_speed_m_s": [3.0, 2.0, 1.0]})
    axes = scatter(table, ["band.thickness"], ["peak_speed_m_s"]).axes[0]
    assert axes.get_xlabel() == "band.thickness (m)" and axes.get_ylabel() == "peak speed (m/s)"
    figure = tornado("peak_speed_m_s", [Index("band.thickness", MORRIS, 2.0, 1.0, np.nan)])
    assert figure.axes[0].get_xlabel() == f"{MORRIS} (m/s)"
