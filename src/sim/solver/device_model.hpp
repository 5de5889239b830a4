// Input of the device solver (src/device).
#pragma once

#include "config/case.hpp"
#include "device/step_model.hpp"
#include "sim/setup/model.hpp"

namespace thawslide::sim {

// starts: true before the first step.
template <int Dim>
device::StepModel<Dim> device_model_of(const config::Case& parameters, const Model<Dim>& model, bool starts);

// Queries of the model's terrain; the model must outlive the result.
template <int Dim>
device::HostCallbacks<Dim> terrain_for_device(const Model<Dim>& model, double cell);

}  // namespace thawslide::sim
