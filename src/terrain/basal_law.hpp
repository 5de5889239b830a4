// Basal strength, evaluated over arrays of contact nodes (Eqs. 17, 25 and the cohesion laws).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

#include "mpm/tile.hpp"
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

// State and strength of up to `capacity` contact nodes, one array per quantity.
struct BasalNodes {
  static constexpr std::size_t capacity = static_cast<std::size_t>(mpm::Tile<3>::nodes);
  template <class T>
  using Column = std::array<T, capacity>;

  std::size_t count = 0;
  // Input: substrate number, normal pressure N [Pa], pore pressure P [Pa], temperature T [C], liquid saturation S,
  // effective solid fraction n_e (Eq. 2), slip [m], slip speed v [m/s] and unit weight rho g of the sliding mass
  // [N/m3].
  Column<int> substrate;
  Column<double> normal_pressure, pore_pressure, temperature, saturation, solid_fraction, slip, speed, unit_weight;
  // Output: friction coefficient mu_e, pore pressure that reduces friction, drag, cohesion c_S and sliding strength
  // [Pa].
  Column<double> friction, relief, drag, cohesion, strength;

  [[nodiscard]] physics::basal::ContactNode node(std::size_t k, double time) const {
    return {normal_pressure[k], pore_pressure[k], temperature[k], saturation[k],
            solid_fraction[k],  slip[k],          speed[k],       time,
            unit_weight[k]};
  }
};

// Computes friction, relief, drag and cohesion of the nodes on one substrate. The laws are dispatched once, outside the
// loop over nodes.
inline void evaluate_ground_law(const GroundLaw& law, int substrate, double time, BasalNodes& nodes) {
  std::visit(
      [&]<class Friction>(const Friction& friction) {
        for (std::size_t k = 0; k < nodes.count; ++k) {
          if (nodes.substrate[k] == substrate) {
            const auto node = nodes.node(k, time);
            nodes.friction[k] = friction.coefficient(node);
            nodes.drag[k] = physics::basal::drag_of(friction, node);
            nodes.relief[k] = Friction::depends_on_pore_pressure ? nodes.pore_pressure[k] : 0.0;
          }
        }
      },
      law.friction);
  std::visit(
      [&](const auto& cohesion) {
        for (std::size_t k = 0; k < nodes.count; ++k) {
          if (nodes.substrate[k] == substrate) {
            nodes.cohesion[k] = cohesion.cohesion(nodes.node(k, time));
          }
        }
      },
      law.cohesion);
}

// Computes friction, cohesion and strength of all nodes. time [s].
inline void evaluate_basal_law(const BasalLaw& law, double time, BasalNodes& nodes) {
  const auto end = nodes.substrate.begin() + static_cast<std::ptrdiff_t>(nodes.count);
  for (std::size_t number = 0; number < law.grounds.size(); ++number) {
    const int substrate = static_cast<int>(number);
    if (std::find(nodes.substrate.begin(), end, substrate) != end) {
      evaluate_ground_law(law.grounds[number], substrate, time, nodes);
    }
  }
  for (std::size_t k = 0; k < nodes.count; ++k) {
    nodes.strength[k] = physics::sliding_strength(nodes.friction[k], nodes.normal_pressure[k], nodes.relief[k],
                                                  nodes.cohesion[k], law.clamp, law.cap_pressure) +
                        nodes.drag[k];
  }
}

}  // namespace thawslide::terrain
