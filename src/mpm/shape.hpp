// Shape functions: those of momentum act on the 3 nodes of each axis about the node nearest to the particle, the hats
// of heat and pore pressure on the 2 nodes of the particle's cell.
#pragma once

#include <cstddef>

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::mpm {

// Weights and their derivatives [1/m] of neighbouring nodes along one axis, lowest first: nearest-1, nearest,
// nearest+1, or with a width of 2 the two ends of the particle's cell.
template <class Real, std::size_t Width = 3>
struct AxisWeights {
  Real weight[Width];
  Real slope[Width];
};

// Linear hat functions. offset: particle minus nearest node, in cells, within [-1/2, 1/2].
template <class Real>
THAWSLIDE_HD AxisWeights<Real> linear_weights(Real offset, Real inverse_cell) {
  const bool right = offset >= Real(0);
  const Real left_part = right ? Real(0) : -offset;
  const Real right_part = right ? offset : Real(0);
  return {{left_part, Real(1) - left_part - right_part, right_part},
          {right ? Real(0) : -inverse_cell, right ? -inverse_cell : inverse_cell, right ? inverse_cell : Real(0)}};
}

// uGIMP (Bardenhagen and Kober 2004): the hat averaged over the undeformed particle of half size `half` (in cells).
template <class Real>
THAWSLIDE_HD AxisWeights<Real> ugimp_weights(Real offset, Real half, Real inverse_cell) {
  const Real d = offset;
  if (d >= half) {
    return {{Real(0), Real(1) - d, d}, {Real(0), -inverse_cell, inverse_cell}};
  }
  if (d <= -half) {
    return {{-d, Real(1) + d, Real(0)}, {-inverse_cell, inverse_cell, Real(0)}};
  }
  const Real quarter = Real(1) / (Real(4) * half);
  const Real left = (half - d) * (half - d) * quarter;
  const Real right = (half + d) * (half + d) * quarter;
  const Real slope_left = -Real(2) * (half - d) * quarter * inverse_cell;
  const Real slope_right = Real(2) * (half + d) * quarter * inverse_cell;
  return {{left, Real(1) - left - right, right}, {slope_left, -slope_left - slope_right, slope_right}};
}

// The shape functions a run may use for momentum; heat and pore pressure always use the hats.
template <class Real>
struct Ugimp {
  THAWSLIDE_HD static AxisWeights<Real> weights(Real offset, Real half, Real inverse_cell) {
    return ugimp_weights(offset, half, inverse_cell);
  }
};
template <class Real>
struct Linear {
  THAWSLIDE_HD static AxisWeights<Real> weights(Real offset, Real /*half*/, Real inverse_cell) {
    return linear_weights(offset, inverse_cell);
  }
};

}  // namespace thawslide::mpm
