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

  // Sets what a law of friction or cohesion determines.
  template <class Law>
  THAWSLIDE_HD void evaluate(const Law& law) {
    if constexpr (requires { law.coefficient(state); }) {
      friction = law.coefficient(state);
      drag = physics::basal::drag_of(law, state);
      relief = Law::depends_on_pore_pressure ? state.pore_pressure : 0.0;
    } else {
      cohesion = law.cohesion(state);
    }
  }
  // Of the base, against sliding [Pa].
  [[nodiscard]] THAWSLIDE_HD double strength(physics::FrictionClamp clamp, bool cap_pressure) const {
    return physics::sliding_strength(friction, state.normal_pressure, relief, cohesion, clamp, cap_pressure) + drag;
  }
};

// Evaluates a law at nodes in contact on one substrate.
template <class Law>
struct EvaluateLaw {
  Law law;
  int substrate;
  BasalNode* nodes;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    if (nodes[k].area > 0.0 && nodes[k].substrate == substrate) {
      nodes[k].evaluate(law);
    }
  }
};

// Computes friction and cohesion of the nodes in contact. for_each(kernel): calls kernel(k) for all nodes. Laws are
// dispatched once, outside the loop over nodes.
template <class ForEach>
void evaluate_basal_law(const BasalLaw& law, BasalNode* nodes, const ForEach& for_each) {
  for (std::size_t number = 0; number < law.grounds.size(); ++number) {
    const auto evaluate = [&]<class Law>(const Law& one) {
      for_each(EvaluateLaw<Law>{one, static_cast<int>(number), nodes});
    };
    std::visit(evaluate, law.grounds[number].friction);
    std::visit(evaluate, law.grounds[number].cohesion);
  }
}
inline void evaluate_basal_law(const BasalLaw& law, std::span<BasalNode> nodes) {
  evaluate_basal_law(law, nodes.data(), [&](const auto& kernel) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      kernel(k);
    }
  });
}

}  // namespace thawslide::terrain
