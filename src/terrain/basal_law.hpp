// The strength of the base, evaluated over arrays of contact nodes (Eqs. 17, 25 and the cohesion laws).
#pragma once

#include <array>
#include <cstddef>

#include "mpm/tile.hpp"
#include "physics/basal_friction.hpp"
#include "physics/mixture.hpp"

namespace thawslide::terrain {

// How cohesion along the surface is lost.
enum class CohesionLoss { constant, slip, ice, time };

template <class Real>
struct BasalLaw {
  Real friction_coefficient = 0;  // tan(phi_f)
  bool lubricated = false;        // Eq. 25
  Real lubrication_exponent = 2, min_solid_fraction = 0, max_solid_fraction = 1;
  Real cohesion = 0, residual_cohesion = 0;  // [Pa]
  CohesionLoss cohesion_loss = CohesionLoss::constant;
  Real slip_distance = 1;       // d_c [m]
  Real cohesion_loss_time = 0;  // [s]
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
  // Out: friction coefficient mu_e and sliding strength [Pa].
  Column<Real> friction, strength;
};

// Fills friction and strength of all nodes. time [s].
template <class Real>
void evaluate_basal_law(const BasalLaw<Real>& law, Real time, BasalNodes<Real>& nodes) {
  for (std::size_t k = 0; k < nodes.count; ++k) {
    const Real factor = law.lubricated ? physics::lubrication_factor(nodes.solid_fraction[k], law.min_solid_fraction,
                                                                     law.max_solid_fraction, law.lubrication_exponent)
                                       : Real(1);
    nodes.friction[k] = factor * law.friction_coefficient;
    Real cohesion = law.cohesion;
    switch (law.cohesion_loss) {
      case CohesionLoss::constant:
        break;
      case CohesionLoss::slip:
        cohesion = physics::cohesion_after_slip(law.cohesion, law.residual_cohesion, nodes.slip[k], law.slip_distance);
        break;
      case CohesionLoss::ice:
        cohesion = physics::cohesion_of_ice(law.cohesion, nodes.saturation[k]);
        break;
      case CohesionLoss::time:
        cohesion = physics::cohesion_until(law.cohesion, law.residual_cohesion, time, law.cohesion_loss_time);
        break;
    }
    nodes.strength[k] = physics::sliding_strength(nodes.friction[k], nodes.normal_pressure[k], nodes.pore_pressure[k],
                                                  cohesion, law.clamp, law.cap_pressure);
  }
}

}  // namespace thawslide::terrain
