// Parameters of a material.
#pragma once

#include "physics/elasticity.hpp"
#include "physics/mohr_coulomb.hpp"

namespace thawslide::mpm {

template <class Real>
struct MaterialModel {
  physics::ConstitutiveLaw<Real> law;
  physics::Elastic<Real> elastic;
  bool gaps_close_first = false;    // physics/tension_gap.hpp
  Real viscosity_time = 0;          // Kelvin-Voigt [s]
  Real hydraulic_conductivity = 0;  // [m/s]
};

}  // namespace thawslide::mpm
