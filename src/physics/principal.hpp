// Principal values and axes of a symmetric tensor: closed in the plane, else by rotations (Jacobi 1846).
#pragma once

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

// One of Jacobi's rotations: makes component (p, q) of `full` zero.
template <class Real>
THAWSLIDE_HD void jacobi_rotation(int p, int q, Matrix<Real, 3>& full, Matrix<Real, 3>& axes) {
  if (full(p, q) == Real(0)) {
    return;
  }
  const Real theta = (full(q, q) - full(p, p)) / (Real(2) * full(p, q));
  const Real t = (theta >= Real(0) ? Real(1) : Real(-1)) / (std::abs(theta) + std::sqrt(theta * theta + Real(1)));
  const Real c = Real(1) / std::sqrt(t * t + Real(1));
  const Real s = t * c;
  for (int k = 0; k < 3; ++k) {
    const Real kp = full(k, p);
    const Real kq = full(k, q);
    full(k, p) = c * kp - s * kq;
    full(k, q) = s * kp + c * kq;
  }
  for (int k = 0; k < 3; ++k) {
    const Real pk = full(p, k);
    const Real qk = full(q, k);
    full(p, k) = c * pk - s * qk;
    full(q, k) = s * pk + c * qk;
    const Real kp = axes(k, p);
    const Real kq = axes(k, q);
    axes(k, p) = c * kp - s * kq;
    axes(k, q) = s * kp + c * kq;
  }
}

}  // namespace detail

// Principal values alone, largest first, where yz = xz = 0 (plane strain).
template <class Real>
THAWSLIDE_HD Vector<Real, 3> plane_principal_values(const SymmetricTensor<Real>& tensor) {
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

// Of a tensor xx yy zz xy yz xz: closed where yz = xz = 0 (plane strain), else by Jacobi's rotations to round-off.
template <class Real>
THAWSLIDE_HD Principal<Real> principal(const SymmetricTensor<Real>& tensor) {
  Principal<Real> result;
  result.axes.setIdentity();
  if (tensor[4] == Real(0) && tensor[5] == Real(0)) {
    const Real centre = Real(0.5) * (tensor[0] + tensor[1]);
    const Real half_difference = Real(0.5) * (tensor[0] - tensor[1]);
    const Real radius = std::sqrt(half_difference * half_difference + tensor[3] * tensor[3]);
    result.values << centre + radius, centre - radius, tensor[2];
    if (radius > Real(0)) {
      // The larger of the two half-angle forms keeps its digits.
      const Real cosine2 = half_difference / radius;
      Real c = std::sqrt(Real(0.5) * (Real(1) + std::abs(cosine2)));
      Real s = Real(0.5) * tensor[3] / (radius * c);
      if (cosine2 < Real(0)) {
        const Real magnitude = c;
        c = std::abs(s);
        s = tensor[3] < Real(0) ? -magnitude : magnitude;
      }
      result.axes << c, -s, Real(0), s, c, Real(0), Real(0), Real(0), Real(1);
    }
  } else {
    Matrix<Real, 3> full;
    full << tensor[0], tensor[3], tensor[5], tensor[3], tensor[1], tensor[4], tensor[5], tensor[4], tensor[2];
    constexpr int most_sweeps = 30;
    constexpr Real round_off = static_cast<Real>(1e-32);
    const Real size = full.squaredNorm();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const Real off = full(0, 1) * full(0, 1) + full(0, 2) * full(0, 2) + full(1, 2) * full(1, 2);
      if (off <= round_off * size) {
        break;
      }
      detail::jacobi_rotation(0, 1, full, result.axes);
      detail::jacobi_rotation(0, 2, full, result.axes);
      detail::jacobi_rotation(1, 2, full, result.axes);
    }
    result.values = full.diagonal();
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
