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
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE AxisWeights<Real> ugimp_weights(Real offset, Real half, Real inverse_cell) {
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

// Quadratic B-spline (Steffen, Kirby and Berzins 2008). offset as above.
template <class Real>
THAWSLIDE_HD AxisWeights<Real> quadratic_weights(Real offset, Real inverse_cell) {
  const Real half = static_cast<Real>(0.5);
  const Real left = half - offset;
  const Real right = half + offset;
  return {{half * left * left, static_cast<Real>(0.75) - offset * offset, half * right * right},
          {-left * inverse_cell, -Real(2) * offset * inverse_cell, right * inverse_cell}};
}

// Second moment of the weights about the particle, in cells^2: sum w_k (x_k - x_p)^2.
template <class Real>
THAWSLIDE_HD Real second_moment(const AxisWeights<Real>& axis, Real offset) {
  return axis.weight[0] + axis.weight[2] - offset * offset;
}

// The weights with which node velocities make the affine velocity of APIC, in place of the slopes:
// w_k (x_k - x_p)/D with the second moment D. Linear hats have no such weights: their D is 0 at nodes, and a node
// without weight, and without mass, would have a full say.
template <class Real>
THAWSLIDE_HD AxisWeights<Real> by_second_moment(const AxisWeights<Real>& axis, Real offset, Real inverse_cell) {
  AxisWeights<Real> affine = axis;
  const Real factor = inverse_cell / second_moment(axis, offset);
  for (std::size_t k = 0; k < 3; ++k) {
    affine.slope[k] = axis.weight[k] * (static_cast<Real>(k) - Real(1) - offset) * factor;
  }
  return affine;
}

// The shape functions a run may use for momentum; heat and pore pressure always use the hats. half: half size of the
// particle in cells. at_side: the nearest node lies on a side of the domain that prescribes velocity.
enum class ShapeKind { ugimp, linear, quadratic };

template <class Real>
struct Ugimp {
  THAWSLIDE_HD static AxisWeights<Real> weights(Real offset, Real half, bool /*at_side*/, Real inverse_cell) {
    return ugimp_weights(offset, half, inverse_cell);
  }
  // D is at least half the particle's half size.
  THAWSLIDE_HD static AxisWeights<Real> affine(const AxisWeights<Real>& axis, Real offset, bool /*at_side*/,
                                               Real inverse_cell) {
    return by_second_moment(axis, offset, inverse_cell);
  }
};

template <class Real>
struct Linear {
  THAWSLIDE_HD static AxisWeights<Real> weights(Real offset, Real /*half*/, bool /*at_side*/, Real inverse_cell) {
    return linear_weights(offset, inverse_cell);
  }
};

// In the half cell at a side the spline would need a node beyond it. What the two nodes within say of that one, going
// on in a straight line, leaves the hats, which join the spline with one slope.
template <class Real>
struct Quadratic {
  THAWSLIDE_HD static AxisWeights<Real> weights(Real offset, Real /*half*/, bool at_side, Real inverse_cell) {
    return at_side ? linear_weights(offset, inverse_cell) : quadratic_weights(offset, inverse_cell);
  }
  // D is 1/4; by hats, w_k (x_k - x_p)/D is the slope.
  THAWSLIDE_HD static AxisWeights<Real> affine(const AxisWeights<Real>& axis, Real offset, bool at_side,
                                               Real inverse_cell) {
    return at_side ? axis : by_second_moment(axis, offset, inverse_cell);
  }
};

// Calls work(shape) with the shape functions of a kind: once per batch, outside the loop over particles.
template <class Real, class Work>
void with_shape(ShapeKind kind, const Work& work) {
  switch (kind) {
    case ShapeKind::ugimp:
      return work(Ugimp<Real>{});
    case ShapeKind::linear:
      return work(Linear<Real>{});
    case ShapeKind::quadratic:
      return work(Quadratic<Real>{});
  }
}

}  // namespace thawslide::mpm
