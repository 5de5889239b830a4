// Basal strength at contact nodes (Eqs. 17, 25 and the cohesion laws).
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "base/portability.hpp"
#include "physics/basal/laws.hpp"
#include "physics/contact.hpp"

namespace thawslide::terrain {

// Laws of one substrate.
struct GroundLaw {
  physics::basal::FrictionLaw friction;
  physics::basal::CohesionLaw cohesion;
};

struct BasalLaw {
  // By substrate number; entry 0 applies outside all substrates.
  std::vector<GroundLaw> grounds{1};
  physics::FrictionClamp clamp = physics::FrictionClamp::keep_cohesion;
  bool cap_pressure = false;  // P at most N
  double heat_fraction = 1;   // fraction of the friction work converted to heat (conversion coefficient)
  double gravity = 0;         // [m/s2]

  // True if a law depends on temperature, saturation, solid fraction or slip of the mass.
  [[nodiscard]] bool depends_on_mass() const {
    const auto of_law = []<class Law>(const Law& /*law*/) { return Law::depends_on_mass; };
    return std::any_of(grounds.begin(), grounds.end(), [&](const GroundLaw& each) {
      return std::visit(of_law, each.friction) || std::visit(of_law, each.cohesion);
    });
  }
};

// State of a contact node, and its friction and cohesion. For host and device.
struct BasalNode {
  physics::basal::ContactNode state;
  int substrate = 0;  // number
  double area = 0;    // of contact [m2]; 0: none
  // Coefficient mu_e, pore pressure that reduces friction [Pa], drag [Pa] and c_S [Pa].
  double friction = 0, relief = 0, drag = 0, cohesion = 0;

  template <class Law>
  THAWSLIDE_HD void set_friction(const Law& law) {
    friction = law.coefficient(state);
    drag = physics::basal::drag_of(law, state);
    relief = Law::depends_on_pore_pressure ? state.pore_pressure : 0.0;
  }
  // Of the base, against sliding [Pa].
  [[nodiscard]] THAWSLIDE_HD double strength(physics::FrictionClamp clamp, bool cap_pressure) const {
    return physics::sliding_strength(friction, state.normal_pressure, relief, cohesion, clamp, cap_pressure) + drag;
  }
};

// Calls work(node) for the nodes on one substrate that are in contact.
template <class Work>
void for_nodes_on(int substrate, std::span<BasalNode> nodes, const Work& work) {
  for (BasalNode& node : nodes) {
    if (node.area > 0.0 && node.substrate == substrate) {
      work(node);
    }
  }
}

// Computes friction and cohesion of the nodes in contact. Laws are dispatched once, outside the loop over nodes.
inline void evaluate_basal_law(const BasalLaw& law, std::span<BasalNode> nodes) {
  for (std::size_t number = 0; number < law.grounds.size(); ++number) {
    const int substrate = static_cast<int>(number);
    std::visit(
        [&](const auto& friction) {
          for_nodes_on(substrate, nodes, [&](BasalNode& node) { node.set_friction(friction); });
        },
        law.grounds[number].friction);
    std::visit(
        [&](const auto& cohesion) {
          for_nodes_on(substrate, nodes, [&](BasalNode& node) { node.cohesion = cohesion.cohesion(node.state); });
        },
        law.grounds[number].cohesion);
  }
}

}  // namespace thawslide::terrain
