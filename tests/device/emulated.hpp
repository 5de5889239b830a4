// Steps of the GPU backend emulated on the CPU, one thread at a time, in the requested order.
#pragma once

#include "device/host_backend.hpp"
#include "device/solver.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim> emulated(ThreadOrder order = ThreadOrder::forward);

}  // namespace thawslide::device
