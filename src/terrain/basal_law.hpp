// The strength of the base, evaluated over arrays of contact nodes (Eqs. 17, 25 and the cohesion laws).
#pragma once

#include <array>
#include <cstddef>
#include <variant>

#include "mpm/tile.hpp"
#include "physics/basal/laws.hpp"
#include "physics/basal_friction.hpp"

namespace thawslide::terrain {

template <class Real>
struct BasalLaw {
  physics::basal::FrictionLaw<Real> friction;
  physics::basal::CohesionLaw<Real> cohesion;
  physics::FrictionClamp clamp = physics::FrictionClamp::keep_cohesion;
  bool cap_pressure = false;  // P at most N
  Real heat_fraction = 1;     // share of the friction work that becomes heat (conversion coefficient)
};

// State and strength of up to `capacity` contact nodes, one array a quantity.
template <class Real>
struct BasalNodes {
  static constexpr std::size_t capacity = static_cast<std::size_t>(mpm::Tile<3>::nodes);
  template <class T>
  using Column = std::array<T, capacity>;

  std::size_t count = 0;
  // In: normal pressure N [Pa], pore pressure P [Pa], temperature T [C], liquid saturation S, effective solid fraction
  // n_e (Eq. 2), slip [m] and slip speed v [m/s].
  Column<Real> normal_pressure, pore_pressure, temperature, saturation, solid_fraction, slip, speed;
  // Out: friction coefficient mu_e, cohesion c_S [Pa] and sliding strength [Pa].
  Column<Real> friction, cohesion, strength;

  [[nodiscard]] physics::basal::ContactNode<Real> node(std::size_t k, Real time) const {
    return {normal_pressure[k], pore_pressure[k], temperature[k], saturation[k],
            solid_fraction[k],  slip[k],          speed[k],       time};
  }
};

// Fills friction, cohesion and strength of all nodes. time [s]. Each law is chosen once, outside the loop over nodes.
template <class Real>
void evaluate_basal_law(const BasalLaw<Real>& law, Real time, BasalNodes<Real>& nodes) {
  std::visit(
      [&](const auto& friction) {
        for (std::size_t k = 0; k < nodes.count; ++k) {
          nodes.friction[k] = friction.coefficient(nodes.node(k, time));
        }
      },
      law.friction);
  std::visit(
      [&](const auto& cohesion) {
        for (std::size_t k = 0; k < nodes.count; ++k) {
          nodes.cohesion[k] = cohesion.cohesion(nodes.node(k, time));
        }
      },
      law.cohesion);
  for (std::size_t k = 0; k < nodes.count; ++k) {
    nodes.strength[k] = physics::sliding_strength(nodes.friction[k], nodes.normal_pressure[k], nodes.pore_pressure[k],
                                                  nodes.cohesion[k], law.clamp, law.cap_pressure);
  }
}

}  // namespace thawslide::terrain
