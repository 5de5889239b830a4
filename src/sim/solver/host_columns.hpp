// Base of a slide on a device: band columns are computed on the CPU, from nodal values that the device transfers.
#pragma once

#include "device/step_model.hpp"
#include "sim/solver/base.hpp"
#include "sim/solver/clock.hpp"

namespace thawslide::sim {

// Callbacks; empty without band columns. All arguments must outlive them. dt: of the step [s].
template <int Dim>
device::HostColumns columns_for_device(const Setup<Dim>& setup, const Clock& clock, const double& dt, Base<Dim>& base);

}  // namespace thawslide::sim
