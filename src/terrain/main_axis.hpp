// Grid axis closest to the ground's normal.
#pragma once

#include <cmath>

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::terrain {

// At 45 degrees, the vertical axis is chosen with a tolerance, to be independent of round-off.
template <int Dim>
THAWSLIDE_HD int main_axis(const Vector<Real, Dim>& normal) {
  int axis = Dim - 1;
  for (int a = Dim - 2; a >= 0; --a) {
    if (std::abs(normal[a]) > (Real(1) + round_off) * std::abs(normal[axis])) {
      axis = a;
    }
  }
  return axis;
}

}  // namespace thawslide::terrain
