// What the step on a device (src/device) needs to know of a run, and what of runs it does not do yet.
#pragma once

#include <string>

#include "config/case.hpp"
#include "device/step_model.hpp"
#include "sim/model.hpp"

namespace thawslide::sim {

// In words, with its key, what of a case no device does yet; empty: it does all of it.
template <int Dim, class Real>
std::string not_on_devices(const config::Case& parameters, const Model<Dim, Real>& model);

// starts: no step has been taken yet.
template <int Dim, class Real>
device::StepModel<Dim, Real> device_model_of(const config::Case& parameters, const Model<Dim, Real>& model,
                                             bool starts);

// What is asked of the model's terrain, which must outlive it.
template <int Dim, class Real>
device::HostCallbacks<Dim, Real> terrain_for_device(const Model<Dim, Real>& model, double cell);

}  // namespace thawslide::sim
