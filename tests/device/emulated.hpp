// Steps as a card takes them, by the processor in its place: thread after thread, in the order that is asked for.
#pragma once

#include "device/any_step.hpp"
#include "device/host_backend.hpp"

namespace thawslide::device {

template <int Dim>
MakeStep<Dim, double> emulated(ThreadOrder order = ThreadOrder::forward);

}  // namespace thawslide::device
