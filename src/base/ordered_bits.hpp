// Numbers as integers of the same order, for radix sorting.
#pragma once

#include <bit>
#include <cstdint>

#include "base/portability.hpp"

namespace thawslide {

// Of two numbers, neither NaN, the larger one has the larger bits; -0 has those of 0.
[[nodiscard]] THAWSLIDE_HD inline std::uint64_t ordered_bits(double number) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(number + 0.0);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

}  // namespace thawslide
