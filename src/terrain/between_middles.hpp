// Interpolation between the middles of columns of cells. For host and device.
#pragma once

#include <array>
#include <cstddef>

#include "base/portability.hpp"

namespace thawslide::terrain {

// Linear interpolation along each axis. share: fraction of the distance from the middle of a column to the next one.
// at_middle(steps): value at the column offset by 0 or 1 along each axis.
template <std::size_t Axes, class AtMiddle>
THAWSLIDE_HD double between_middles(const std::array<double, Axes>& fraction, const AtMiddle& at_middle) {
  const auto along_x = [&](std::array<int, Axes> steps) {
    steps[0] = 0;
    const double here = at_middle(steps);
    steps[0] = 1;
    return here + fraction[0] * (at_middle(steps) - here);
  };
  std::array<int, Axes> steps{};
  const double here = along_x(steps);
  if constexpr (Axes == 1) {
    return here;
  } else {
    steps[1] = 1;
    return here + fraction[1] * (along_x(steps) - here);
  }
}

}  // namespace thawslide::terrain
