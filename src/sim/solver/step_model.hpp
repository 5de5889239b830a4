// Input of the device solver (src/device).
#pragma once

#include "config/case.hpp"
#include "device/step_model.hpp"
#include "sim/setup/model.hpp"
#include "sim/solver/clock.hpp"

namespace thawslide::sim {

// clock: before the first step on the device.
template <int Dim>
device::StepModel<Dim> step_model_of(const config::Case& parameters, const Model<Dim>& model, const Clock& clock);

// Queries of the model's terrain; the model must outlive the result.
template <int Dim>
device::HostCallbacks<Dim> host_callbacks_of(const Model<Dim>& model, double cell);

}  // namespace thawslide::sim
