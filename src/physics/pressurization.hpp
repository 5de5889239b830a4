// Thermal pressurization and seepage of the melted pore (Eqs. 8, 22, 23 at S = 1).
//   dP_L/dt = K_L/(n S) [beta_m dT/dt - div q_L],  q_L = -(k_L/gamma_w) grad P_L
#pragma once

#include "physics/mixture.hpp"

namespace thawslide::physics {

// Lambda = K_L beta_m/(n S) [Pa/K]: pressure per kelvin of undrained heating.
template <class Real>
THAWSLIDE_HD Real undrained_pressure_coefficient(const Phases<Real>& phases, Real porosity, Real saturation) {
  return phases.water_bulk_modulus * expansion(phases, porosity, saturation) / (porosity * saturation);
}

// D = K_L k_L/(n S gamma_w) [m2/s]; hydraulic conductivity k_L [m/s].
template <class Real>
THAWSLIDE_HD Real hydraulic_diffusivity(const Phases<Real>& phases, Real porosity, Real saturation,
                                        Real hydraulic_conductivity) {
  return phases.water_bulk_modulus * hydraulic_conductivity / (porosity * saturation * phases.water_unit_weight);
}

}  // namespace thawslide::physics
