// Principal values and axes of a symmetric tensor, without iteration. In space the value that lies furthest from the
// other two comes from the cubic; its axis leaves a plane problem for the others (Eberly 2014), which keeps all digits
// where values meet.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::physics {

template <class Real>
struct Principal {
  Vector<Real, 3> values;  // largest first
  Matrix<Real, 3> axes;    // column k belongs to value k
};

namespace detail {

template <class Real>
THAWSLIDE_HD void sort_descending(Principal<Real>& principal) {
  const auto order = [&](int a, int b) {
    if (principal.values[a] < principal.values[b]) {
      std::swap(principal.values[a], principal.values[b]);
      principal.axes.col(a).swap(principal.axes.col(b));
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
}

// The cosine and sine of the axis of the larger value of [xx xy; xy yy], and how far the values lie from their mean.
template <class Real>
struct PlaneAxis {
  Real cosine = 1, sine = 0, radius;

  THAWSLIDE_HD PlaneAxis(Real xx, Real yy, Real xy) {
    const Real half_difference = Real(0.5) * (xx - yy);
    radius = std::sqrt(half_difference * half_difference + xy * xy);
    if (!(radius > Real(0))) {
      return;
    }
    // The larger of the two half-angle forms keeps its digits.
    const Real cosine2 = half_difference / radius;
    const Real larger = std::sqrt(Real(0.5) * (Real(1) + std::abs(cosine2)));
    const Real smaller = Real(0.5) * xy / (radius * larger);
    cosine = cosine2 < Real(0) ? std::abs(smaller) : larger;
    sine = cosine2 < Real(0) ? (xy < Real(0) ? -larger : larger) : smaller;
  }
};

// The axis of the value that lies furthest from the other two, of a deviator that is not zero.
template <class Real>
THAWSLIDE_HD Vector<Real, 3> isolated_axis(const Matrix<Real, 3>& deviator) {
  const Matrix<Real, 3> scaled = deviator / std::sqrt(deviator.squaredNorm() / Real(6));
  const Real half_determinant = std::clamp(Real(0.5) * scaled.determinant(), Real(-1), Real(1));
  const Real angle = std::acos(half_determinant) / Real(3);
  const Real value = Real(2) * std::cos(half_determinant >= Real(0) ? angle : angle + Real(2) * pi<Real> / Real(3));
  // Of the rows (or columns) of scaled - value I, which span the plane across the axis, the two that say most.
  const Matrix<Real, 3> rows = scaled - value * Matrix<Real, 3>::Identity();
  Vector<Real, 3> axis = rows.col(0).cross(rows.col(1));
  for (const Vector<Real, 3>& other :
       {Vector<Real, 3>(rows.col(1).cross(rows.col(2))), Vector<Real, 3>(rows.col(2).cross(rows.col(0)))}) {
    if (other.squaredNorm() > axis.squaredNorm()) {
      axis = other;
    }
  }
  return axis.normalized();
}

// A unit vector across an axis.
template <class Real>
THAWSLIDE_HD Vector<Real, 3> across(const Vector<Real, 3>& axis) {
  const bool mostly_x = std::abs(axis[0]) > std::abs(axis[1]);
  const Vector<Real, 3> other =
      mostly_x ? Vector<Real, 3>(-axis[2], Real(0), axis[0]) : Vector<Real, 3>(Real(0), axis[2], -axis[1]);
  return other.normalized();
}

}  // namespace detail

// Principal values alone, largest first, where yz = xz = 0 (plane strain).
template <class Real>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Vector<Real, 3> plane_principal_values(const SymmetricTensor<Real>& tensor) {
  const Real centre = Real(0.5) * (tensor[0] + tensor[1]);
  const Real half_difference = Real(0.5) * (tensor[0] - tensor[1]);
  const Real radius = std::sqrt(half_difference * half_difference + tensor[3] * tensor[3]);
  const Real high = centre + radius;
  const Real low = centre - radius;
  const Real out = tensor[2];
  return out >= high  ? Vector<Real, 3>(out, high, low)
         : out <= low ? Vector<Real, 3>(high, low, out)
                      : Vector<Real, 3>(high, out, low);
}

// Of a tensor xx yy zz xy yz xz.
template <class Real>
THAWSLIDE_HD Principal<Real> principal(const SymmetricTensor<Real>& tensor) {
  Principal<Real> result;
  result.axes.setIdentity();
  const Real mean = (tensor[0] + tensor[1] + tensor[2]) / Real(3);
  Matrix<Real, 3> full;
  full << tensor[0] - mean, tensor[3], tensor[5], tensor[3], tensor[1] - mean, tensor[4], tensor[5], tensor[4],
      tensor[2] - mean;
  if (tensor[4] == Real(0) && tensor[5] == Real(0)) {
    const detail::PlaneAxis<Real> plane(tensor[0], tensor[1], tensor[3]);
    const Real centre = Real(0.5) * (tensor[0] + tensor[1]);
    result.values << centre + plane.radius, centre - plane.radius, tensor[2];
    result.axes.col(0) << plane.cosine, plane.sine, Real(0);
    result.axes.col(1) << -plane.sine, plane.cosine, Real(0);
  } else {
    const Vector<Real, 3> isolated = detail::isolated_axis(full);
    const Vector<Real, 3> first = detail::across(isolated);
    const Vector<Real, 3> second = isolated.cross(first);
    const Real xx = first.dot(full * first);
    const Real yy = second.dot(full * second);
    const detail::PlaneAxis<Real> plane(xx, yy, first.dot(full * second));
    const Real centre = mean + Real(0.5) * (xx + yy);
    result.values << centre + plane.radius, centre - plane.radius, mean + isolated.dot(full * isolated);
    result.axes << plane.cosine * first + plane.sine * second, plane.cosine * second - plane.sine * first, isolated;
  }
  detail::sort_descending(result);
  return result;
}

// The tensor with given principal values on given axes.
template <class Real>
THAWSLIDE_HD SymmetricTensor<Real> from_principal(const Principal<Real>& principal) {
  SymmetricTensor<Real> tensor = SymmetricTensor<Real>::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vector<Real, 3> axis = principal.axes.col(k);
    const Real value = principal.values[k];
    tensor[0] += value * axis[0] * axis[0];
    tensor[1] += value * axis[1] * axis[1];
    tensor[2] += value * axis[2] * axis[2];
    tensor[3] += value * axis[0] * axis[1];
    tensor[4] += value * axis[1] * axis[2];
    tensor[5] += value * axis[0] * axis[2];
  }
  return tensor;
}

}  // namespace thawslide::physics
