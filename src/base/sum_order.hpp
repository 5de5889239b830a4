// Order of sums over many parts, on the CPU and on a device.
#pragma once

#include <cstddef>

namespace thawslide {

// Parts are added in runs of this size, each in order; then the sums of the runs are added in order. A device can add
// all runs in parallel.
inline constexpr std::size_t parts_of_a_run = 128;
constexpr std::size_t runs_of(std::size_t parts) { return (parts + parts_of_a_run - 1) / parts_of_a_run; }

}  // namespace thawslide
