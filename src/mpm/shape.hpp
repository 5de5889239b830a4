// Shape functions. Those of momentum use the 3 nodes per axis around the node nearest to the particle; the linear ones
// of heat and pore pressure use the 2 nodes per axis of the particle's cell.
#pragma once

#include <cstddef>
#include <type_traits>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"
#include "physics/options.hpp"

namespace thawslide::mpm {

using physics::ShapeFunction;

// Weights and their derivatives [1/m] at adjacent nodes along one axis, lowest first: nearest-1, nearest, nearest+1,
// or, with a width of 2, the two ends of the particle's cell. Value: one number, or Simd for a batch.
template <class Value, std::size_t Width = 3>
struct AxisWeights {
  Value weight[Width];
  Value slope[Width];
};

// Linear shape functions. offset: particle minus nearest node, in cells, within [-1/2, 1/2].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE AxisWeights<Value> linear_weights(Value offset, double inverse_cell) {
  const auto right = offset >= 0.0;
  const Value zero = 0.0, slope = inverse_cell;
  const Value left_part = select(right, zero, -offset);
  const Value right_part = select(right, offset, zero);
  return {{left_part, 1.0 - left_part - right_part, right_part},
          {select(right, zero, -slope), select(right, -slope, slope), select(right, slope, zero)}};
}

// Half size of a particle and its inverse.
template <class Value>
struct HalfSize {
  Value half, inverse;  // inverse: 1/half

  HalfSize() = default;
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE HalfSize(Value size) : half(size), inverse(Value(1) / size) {}
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE HalfSize(Value size, Value inverse_size) : half(size), inverse(inverse_size) {}
};

// uGIMP (Bardenhagen and Kober 2004): linear shape function averaged over the undeformed particle. size: in cells.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE AxisWeights<Value> ugimp_weights(Value offset,
                                                                      const std::type_identity_t<HalfSize<Value>>& size,
                                                                      double inverse_cell) {
  const Value half = size.half;
  const auto in_right_cell = offset >= half;
  const auto in_left_cell = offset <= -half;
  const Value zero = 0.0, slope = inverse_cell;
  const Value to_left = half - offset, to_right = half + offset;
  const Value quarter = 0.25 * size.inverse;
  const Value half_slope = 2.0 * inverse_cell * quarter;
  const Value left = select(in_right_cell, zero, select(in_left_cell, -offset, to_left * to_left * quarter));
  const Value right = select(in_left_cell, zero, select(in_right_cell, offset, to_right * to_right * quarter));
  const Value slope_left = select(in_right_cell, zero, select(in_left_cell, -slope, -to_left * half_slope));
  const Value slope_right = select(in_left_cell, zero, select(in_right_cell, slope, to_right * half_slope));
  return {{left, 1.0 - left - right, right}, {slope_left, -slope_left - slope_right, slope_right}};
}

// Quadratic B-spline (Steffen, Kirby and Berzins 2008). offset as above.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE AxisWeights<Value> quadratic_weights(Value offset, double inverse_cell) {
  const double half = 0.5;
  const Value left = half - offset;
  const Value right = half + offset;
  return {{half * left * left, 0.75 - offset * offset, half * right * right},
          {-left * inverse_cell, -2.0 * offset * inverse_cell, right * inverse_cell}};
}

// Second moment of the weights around the particle, in cells^2: sum w_k (x_k - x_p)^2.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value second_moment(const AxisWeights<Value>& axis, Value offset) {
  return axis.weight[0] + axis.weight[2] - offset * offset;
}

// Weights of APIC, which give the affine velocity from node velocities and replace the slopes: w_k (x_k - x_p)/D with
// the second moment D.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE AxisWeights<Value> by_second_moment(const AxisWeights<Value>& axis, Value offset,
                                                                         double inverse_cell) {
  AxisWeights<Value> affine = axis;
  const Value factor = inverse_cell / second_moment(axis, offset);
  for (std::size_t k = 0; k < 3; ++k) {
    affine.slope[k] = axis.weight[k] * (static_cast<double>(k) - 1.0 - offset) * factor;
  }
  return affine;
}

// Selects one of two sets of weights, by lane.
template <class Condition, class Value, std::size_t Width>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE AxisWeights<Value, Width> select(const Condition& condition,
                                                                      const AxisWeights<Value, Width>& a,
                                                                      const AxisWeights<Value, Width>& b) {
  using thawslide::select;
  AxisWeights<Value, Width> chosen;
  for (std::size_t k = 0; k < Width; ++k) {
    chosen.weight[k] = select(condition, a.weight[k], b.weight[k]);
    chosen.slope[k] = select(condition, a.slope[k], b.slope[k]);
  }
  return chosen;
}

// size: of the particle, in cells. at_side: the nearest node lies on a side of the domain that prescribes velocity.
struct Ugimp {
  template <class Value, class Condition>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static AxisWeights<Value> weights(
      Value offset, const std::type_identity_t<HalfSize<Value>>& size, Condition /*at_side*/, double inverse_cell) {
    return ugimp_weights(offset, size, inverse_cell);
  }
  // D is at least half the particle's half size.
  template <class Value, class Condition>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static AxisWeights<Value> affine(const AxisWeights<Value>& axis, Value offset,
                                                                        Condition /*at_side*/, double inverse_cell) {
    return by_second_moment(axis, offset, inverse_cell);
  }
};

// In the half cell at a side, the spline would need a node outside the domain. Linear extrapolation from the two nodes
// inside gives the linear shape functions, which join the spline with a continuous slope.
struct Quadratic {
  template <class Value, class Condition>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static AxisWeights<Value> weights(
      Value offset, const std::type_identity_t<HalfSize<Value>>& /*size*/, Condition at_side, double inverse_cell) {
    return select(at_side, linear_weights(offset, inverse_cell), quadratic_weights(offset, inverse_cell));
  }
  // D is 1/4; with linear shape functions, w_k (x_k - x_p)/D equals the slope.
  template <class Value, class Condition>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static AxisWeights<Value> affine(const AxisWeights<Value>& axis, Value offset,
                                                                        Condition at_side, double inverse_cell) {
    return select(at_side, axis, by_second_moment(axis, offset, inverse_cell));
  }
};

// Calls work(shape) with the shape functions of a kind, for code that is compiled for each of them.
template <class Work>
void with_shape(ShapeFunction kind, const Work& work) {
  switch (kind) {
    case ShapeFunction::ugimp:
      return work(Ugimp{});
    case ShapeFunction::quadratic:
      return work(Quadratic{});
  }
}

}  // namespace thawslide::mpm
