// Steps of the GPU backend emulated on the CPU, one thread at a time, in the requested order. threads: of a group; 0:
// as the backend requests.
#pragma once

#include "device/host_backend.hpp"
#include "device/solver.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim> emulated(ThreadOrder order = ThreadOrder::forward, std::size_t threads = 0);

}  // namespace thawslide::device
