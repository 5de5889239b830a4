// Condition at nodes: a box that moves along one axis and prescribes that component of velocity at the nodes inside
// (Sec. 3.2).
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"

namespace thawslide::mpm {

template <int Dim>
struct RigidFrame {
  static constexpr bool moves = true;

  Vector<double, Dim> lower, upper;  // at t = 0 [m], relative to the domain's lower corner
  int axis = 0;
  double velocity = 0;  // [m/s]

  // given: parameters of the case. zero: origin of its coordinates.
  template <class Given>
  static RigidFrame from(const Given& given, const Vector<double, Dim>& zero) {
    RigidFrame frame;
    for (int a = 0; a < Dim; ++a) {
      frame.lower[a] = given.min[static_cast<std::size_t>(a)] - zero[a];
      frame.upper[a] = given.max[static_cast<std::size_t>(a)] - zero[a];
    }
    frame.axis = given.axis == "x" ? 0 : given.axis == "y" ? 1 : 2;
    frame.velocity = given.velocity;
    return frame;
  }

  [[nodiscard]] THAWSLIDE_HD bool may_apply(const Vector<double, Dim>& from, const Vector<double, Dim>& to,
                                            double time) const {
    for (int a = 0; a < Dim; ++a) {
      const double shift = a == axis ? velocity * time : 0.0;
      if (!(to[a] - shift >= lower[a] && from[a] - shift <= upper[a])) {
        return false;
      }
    }
    return true;
  }
  THAWSLIDE_HD void apply(const Vector<double, Dim>& /*position*/, double mass, double /*time*/,
                          Vector<double, Dim>& momentum) const {
    momentum[axis] = mass * velocity;
  }
};

}  // namespace thawslide::mpm
