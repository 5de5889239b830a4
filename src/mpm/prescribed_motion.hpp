// Motion prescribed at nodes by the conditions of a case (mpm/node_conditions.hpp). For host and device.
#pragma once

#include <cstddef>

#include "mpm/node_conditions.hpp"

namespace thawslide::mpm {

template <int Dim>
struct PrescribedMotion {
  const NodeCondition<Dim>* conditions = nullptr;
  std::size_t count = 0;

  // True if apply may set a component at positions between two corners.
  [[nodiscard]] THAWSLIDE_HD bool may_apply(const Vector<double, Dim>& lower, const Vector<double, Dim>& upper,
                                            double time) const {
    bool found = false;
    for (std::size_t k = 0; k < count && !found; ++k) {
      visit_condition(conditions[k], [&](const auto& condition) { found = condition.may_apply(lower, upper, time); });
    }
    return found;
  }
  // Sets the prescribed components of a node's momentum; true if a condition that moves has set one.
  THAWSLIDE_HD bool apply(const Vector<double, Dim>& position, double mass, double time,
                          Vector<double, Dim>& momentum) const {
    bool moves = false;
    for (std::size_t k = 0; k < count; ++k) {
      visit_condition(conditions[k], [&](const auto& condition) {
        if (condition.may_apply(position, position, time)) {
          condition.apply(position, mass, time, momentum);
          moves = moves || condition.moves;
        }
      });
    }
    return moves;
  }
};

// Constraints on one node in a step.
template <int Dim>
struct NodeConstraints {
  const PrescribedMotion<Dim>& motion;
  Vector<double, Dim> position;  // [m]
  double time;                   // [s]
  bool held;                     // the node belongs to a held body, which is fixed
  bool may_apply;                // off: no motion is prescribed near the node, and the position is not used

  [[nodiscard]] THAWSLIDE_HD bool any() const { return held || may_apply; }
  [[nodiscard]] THAWSLIDE_HD bool is_held() const { return held; }
  // Sets the prescribed components of the node's momentum; true if a condition that moves has set one.
  THAWSLIDE_HD bool apply(double mass, Vector<double, Dim>& momentum) const {
    if (held) {
      momentum.setZero();
      return false;
    }
    return may_apply && motion.apply(position, mass, time, momentum);
  }
};

}  // namespace thawslide::mpm
