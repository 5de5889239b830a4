// The order in which sums over many parts go, on the processor and on a device.
#pragma once

#include <cstddef>

namespace thawslide {

// So many parts one after the other, and then what these runs give, one after the other: a device adds up all runs at
// once.
inline constexpr std::size_t parts_of_a_run = 128;
constexpr std::size_t runs_of(std::size_t parts) { return (parts + parts_of_a_run - 1) / parts_of_a_run; }

}  // namespace thawslide
