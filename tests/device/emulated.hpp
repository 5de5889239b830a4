// Steps as a card takes them, by the processor in its place: thread after thread, in the order that is asked for.
#pragma once

#include "device/host_backend.hpp"
#include "device/solver.hpp"

namespace thawslide::device {

template <int Dim>
SolverFactory<Dim, double> emulated(ThreadOrder order = ThreadOrder::forward);

}  // namespace thawslide::device
