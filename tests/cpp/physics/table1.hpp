// Table 1 of the paper.
#pragma once

#include "physics/mixture.hpp"

namespace thawslide::physics {

inline Phases table1() {
  Phases phases{};
  phases.rock_density = 2750;
  phases.ice_density = 917;
  phases.water_density = 1000;
  phases.rock_heat_capacity = 858;
  phases.ice_heat_capacity = 2040;
  phases.water_heat_capacity = 4180;
  phases.rock_conductivity = 3.0;
  phases.ice_conductivity = 2.22;
  phases.water_conductivity = 0.58;
  phases.rock_expansion = 3e-5;
  phases.ice_expansion = 5.1e-5;
  phases.water_expansion = 2.75e-4;
  phases.water_bulk_modulus = 1e9;
  phases.latent_heat = 333.5e3;
  phases.water_unit_weight = 9810;
  phases.ice_to_rock_density_ratio = 1.0 / 3.0;
  return phases;
}

}  // namespace thawslide::physics
