// Conditions at nodes, one kind per line. The CPU and devices apply those of a case in its order. A kind has
//   moves                                  true: its work is that of frames in the budget, and settling omits it;
//                                          false: its work is a loss
//   may_apply(lower, upper, time)          true if it may apply at positions between two corners; exact at one position
//   apply(position, mass, time, momentum)  sets the prescribed components of the momentum of a node where it applies
// The last two are for host and device.
#pragma once

#include <variant>

#include "mpm/domain_faces.hpp"
#include "mpm/rigid_frame.hpp"

namespace thawslide::mpm {

template <int Dim>
using NodeCondition = std::variant<  //
    DomainFaces<Dim>,                //
    RigidFrame<Dim>>;

// Calls function(condition) with the kind of the condition. A device cannot call std::visit.
template <class... Kinds, class Function>
THAWSLIDE_HD void visit_condition(const std::variant<Kinds...>& of, const Function& function) {
  const auto visit = [&](const auto* condition) {
    if (condition != nullptr) {
      function(*condition);
    }
  };
  (visit(std::get_if<Kinds>(&of)), ...);
}

}  // namespace thawslide::mpm
