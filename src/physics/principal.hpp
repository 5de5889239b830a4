// Principal values and axes of a symmetric tensor, for one number or for SIMD lanes. In 3D, the value furthest from the
// other two follows from the cubic; its axis leaves a plane problem for the others (Eberly 2014), which is accurate for
// nearly equal values.
#pragma once

#include <cmath>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

template <class Value>
struct Principal {
  Vector<Value, 3> values;  // largest first
  Matrix<Value, 3> axes;    // column k belongs to value k
};

namespace detail {

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void exchange_where(const decltype(Value() < Value())& condition, Value& a,
                                                         Value& b) {
  const Value former = a;
  a = select(condition, b, a);
  b = select(condition, former, b);
}

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE void sort_descending(Principal<Value>& principal) {
  const auto order = [&](int a, int b) THAWSLIDE_INLINE_LAMBDA {
    const auto wrong = principal.values[a] < principal.values[b];
    exchange_where(wrong, principal.values[a], principal.values[b]);
    for (int row = 0; row < 3; ++row) {
      exchange_where(wrong, principal.axes(row, a), principal.axes(row, b));
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
}

// Cosine and sine of the axis of the larger value of [xx xy; xy yy]. radius: distance of the values from their mean.
template <class Value>
struct PlaneAxis {
  Value cosine, sine, radius;

  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE PlaneAxis(Value xx, Value yy, Value xy) {
    using std::abs, std::sqrt;
    const Value half_difference = 0.5 * (xx - yy);
    radius = sqrt(half_difference * half_difference + xy * xy);
    const auto distinct = radius > Value(0);
    const Value divisor = select(distinct, radius, Value(1));
    // The larger of the two half-angle forms is free of cancellation.
    const Value cosine2 = select(distinct, half_difference / divisor, Value(1));
    const Value larger = sqrt(0.5 * (1.0 + abs(cosine2)));
    const Value smaller = 0.5 * xy / (divisor * larger);
    const auto flipped = cosine2 < Value(0);
    cosine = select(flipped, abs(smaller), larger);
    sine = select(flipped, select(xy < Value(0), -larger, larger), smaller);
  }
};

// Root x of x^3 - 3x = 2h furthest from the other two, h within [-1, 1]: 2 cos(acos(h)/3) for h >= 0. Newton's
// iteration: the initial error is below 0.003, and the slope there is at least 6.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value isolated_root(Value h) {
  using std::abs;
  const Value size = abs(h);
  const double root_of_3 = 1.7320508075688772935;
  Value x = root_of_3 + size * (1.0 / 3.0 - size * (root_of_3 + 1.0 / 3.0 - 2.0));
  for (int k = 0; k < 3; ++k) {
    x -= (x * (x * x - 3.0) - 2.0 * size) / (3.0 * (x * x - 1.0));
  }
  return select(h < Value(0), -x, x);
}

// Axis of the value furthest from the other two; an arbitrary axis if all are equal.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, 3> isolated_axis(const Matrix<Value, 3>& deviator) {
  using std::sqrt;
  const Value size = sqrt(deviator.squaredNorm() / 6.0);
  const Value inverse = 1.0 / select(size > Value(0), size, Value(1));
  const Matrix<Value, 3> scaled = inverse * deviator;
  const Value value = isolated_root(Value(max(min(0.5 * scaled.determinant(), Value(1)), Value(-1))));
  // The rows (or columns) of scaled - value I span the plane normal to the axis. The pair with the largest cross
  // product is used.
  const Matrix<Value, 3> rows = scaled - value * Matrix<Value, 3>::Identity();
  Vector<Value, 3> axis = rows.col(0).cross(rows.col(1));
  Value most = axis.squaredNorm();
  for (int k = 1; k < 3; ++k) {
    const Vector<Value, 3> other = rows.col(k).cross(rows.col((k + 1) % 3));
    const auto is_longer = other.squaredNorm() > most;
    most = select(is_longer, other.squaredNorm(), most);
    for (int row = 0; row < 3; ++row) {
      axis[row] = select(is_longer, other[row], axis[row]);
    }
  }
  // If the deviator consists of round-off, its trace is not 0 and all products may vanish.
  const auto some = most > Value(0);
  axis[0] = select(some, axis[0], Value(1));
  return axis / sqrt(select(some, most, Value(1)));
}

// Unit vector normal to an axis.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Value, 3> across(const Vector<Value, 3>& axis) {
  using std::abs, std::sqrt;
  const auto mostly_x = abs(axis[0]) > abs(axis[1]);
  const Value zero = 0;
  const Vector<Value, 3> other(select(mostly_x, -axis[2], zero), select(mostly_x, zero, axis[2]),
                               select(mostly_x, axis[0], -axis[1]));
  return other / sqrt(other.squaredNorm());
}

}  // namespace detail

// tensor: xx yy zz xy yz xz. Dim 2: plane strain, with yz = xz = 0.
template <int Dim = 3, class Value>
THAWSLIDE_HD Principal<Value> principal(const SymmetricTensor<Value>& tensor) {
  Principal<Value> result;
  if constexpr (Dim == 2) {
    const detail::PlaneAxis<Value> plane(tensor[0], tensor[1], tensor[3]);
    const Value centre = 0.5 * (tensor[0] + tensor[1]), zero = 0;
    result.values << centre + plane.radius, centre - plane.radius, tensor[2];
    result.axes << plane.cosine, -plane.sine, zero, plane.sine, plane.cosine, zero, zero, zero, Value(1);
  } else {
    const Value mean = (tensor[0] + tensor[1] + tensor[2]) / 3.0;
    Matrix<Value, 3> full;
    full << tensor[0] - mean, tensor[3], tensor[5], tensor[3], tensor[1] - mean, tensor[4], tensor[5], tensor[4],
        tensor[2] - mean;
    const Vector<Value, 3> isolated = detail::isolated_axis(full);
    const Vector<Value, 3> first = detail::across(isolated);
    const Vector<Value, 3> second = isolated.cross(first);
    const Value xx = first.dot(full * first);
    const Value yy = second.dot(full * second);
    const detail::PlaneAxis<Value> plane(xx, yy, first.dot(full * second));
    const Value centre = mean + 0.5 * (xx + yy);
    result.values << centre + plane.radius, centre - plane.radius, mean + isolated.dot(full * isolated);
    result.axes << plane.cosine * first + plane.sine * second, plane.cosine * second - plane.sine * first, isolated;
  }
  detail::sort_descending(result);
  return result;
}

// Tensor with given principal values and axes.
template <class Value>
THAWSLIDE_HD SymmetricTensor<Value> from_principal(const Principal<Value>& principal) {
  SymmetricTensor<Value> tensor = SymmetricTensor<Value>::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vector<Value, 3> axis = principal.axes.col(k);
    const Vector<Value, 3> scaled = principal.values[k] * axis;
    tensor[0] += scaled[0] * axis[0];
    tensor[1] += scaled[1] * axis[1];
    tensor[2] += scaled[2] * axis[2];
    tensor[3] += scaled[0] * axis[1];
    tensor[4] += scaled[1] * axis[2];
    tensor[5] += scaled[0] * axis[2];
  }
  return tensor;
}

}  // namespace thawslide::physics
