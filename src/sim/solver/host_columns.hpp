// Band columns of a slide on a device: computed on the CPU, from nodal values that the device transfers.
#pragma once

#include "device/step_model.hpp"
#include "sim/solver/base.hpp"
#include "sim/solver/clock.hpp"

namespace thawslide::sim {

// Callbacks; empty without band columns. All arguments must outlive them. dt: of the step [s].
template <int Dim>
device::HostColumns host_columns_of(const Setup<Dim>& setup, const Clock& clock, const double& dt, Base<Dim>& base);

}  // namespace thawslide::sim
