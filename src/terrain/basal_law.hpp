// Basal strength at contact nodes (Eqs. 17, 25 and the cohesion laws), by the laws of the case or by the caller of a
// step: one call with all loaded nodes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
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

  // Of the base, against sliding [Pa].
  [[nodiscard]] THAWSLIDE_HD double strength(physics::FrictionClamp clamp, bool cap_pressure) const {
    return physics::sliding_strength(friction, state.normal_pressure, relief, cohesion, clamp, cap_pressure) + drag;
  }
};

// Evaluates a law of friction or cohesion at nodes in contact on one substrate.
template <class Law>
struct EvaluateLaw {
  Law law;
  int substrate;
  BasalNode* nodes;

  THAWSLIDE_HD void operator()(std::size_t k) const {
    BasalNode& node = nodes[k];
    if (!(node.area > 0.0) || node.substrate != substrate) {
      return;
    }
    if constexpr (requires { law.coefficient(node.state); }) {
      node.friction = law.coefficient(node.state);
      node.drag = physics::basal::drag_of(law, node.state);
      node.relief = Law::depends_on_pore_pressure ? node.state.pore_pressure : 0.0;
    } else {
      node.cohesion = law.cohesion(node.state);
    }
  }
};

// Computes friction and cohesion of the nodes in contact, in memory of the executor. Laws are dispatched once, outside
// the loop over nodes.
template <class Executor>
void evaluate_basal_law(Executor& executor, const BasalLaw& law, BasalNode* nodes, std::size_t count) {
  for (std::size_t number = 0; number < law.grounds.size(); ++number) {
    const auto evaluate = [&]<class Law>(const Law& one) {
      executor.for_each(count, EvaluateLaw<Law>{one, static_cast<int>(number), nodes});
    };
    std::visit(evaluate, law.grounds[number].friction);
    std::visit(evaluate, law.grounds[number].cohesion);
  }
}

// Loaded contact nodes of a step, one array per quantity. Their order is that of the blocks and of the nodes in a
// block, independent of the number of threads. Quantities are those of BasalNode.
struct LoadedNodes {
  double time = 0, dt = 0;       // begin and duration of the step [s]
  std::vector<double> position;  // Dim numbers per node [m], relative to the domain's lower corner
  std::vector<double> area;      // of contact [m2]
  std::vector<int> substrate;
  std::vector<double> normal_pressure, pore_pressure, temperature, saturation, solid_fraction, slip, speed, unit_weight;
  std::vector<double> strength;  // of the case's laws [Pa]; the law of the caller replaces the values
};

// Called by the thread that performs the step, before the step changes particles.
using StrengthLaw = std::function<void(LoadedNodes&)>;

}  // namespace thawslide::terrain
