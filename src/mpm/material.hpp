// Parameters of a material.
#pragma once

#include "physics/elasticity.hpp"
#include "physics/mohr_coulomb.hpp"

namespace thawslide::mpm {

struct MaterialModel {
  physics::ConstitutiveLaw law;
  physics::Elastic elastic;
  bool gaps_close_first = false;      // physics/tension_gap.hpp
  double viscosity_time = 0;          // Kelvin-Voigt [s]
  double hydraulic_conductivity = 0;  // [m/s]
};

}  // namespace thawslide::mpm
