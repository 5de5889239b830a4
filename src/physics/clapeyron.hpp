// Pressures of ice, water and pore while ice and water coexist (Eqs. 4 and 21).
//   P_I = rho_I g H                                        ice carries the overburden, H normal to the terrain
//   P_L = P_I/r + rho_L L_f ln(T/Tref),  r = rho_I/rho_L   generalized Clapeyron equation, T absolute        (Eq. 4)
//   P_pore = S P_L + (1 - S) P_I                                                                            (Eq. 21)
// Eq. 4 is published with a minus sign. With it, the pore pressure rises while the band thaws; with a plus sign, it
// falls and then recovers, as the paper describes. Plus is the default; the published sign is an option.
#pragma once

#include <cmath>

#include "physics/mixture.hpp"

namespace thawslide::physics {

// P_I [Pa]; gravity [m/s2], depth H [m].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value ice_pressure(const Phases& phases, double gravity, Value depth) {
  return phases.ice_density * gravity * depth;
}

// P_L of Eq. 4 [Pa]; temperatures [C]; sign +1, or -1 as published. Only meaningful with the weights of Eq. 21: far
// below 0 C it is about -12 MPa times a saturation of 1e-5.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value liquid_pressure_clapeyron(const Phases& phases, Value ice_pressure,
                                                                     Value temperature, double reference_temperature,
                                                                     double sign) {
  const Value absolute = temperature + celsius_to_kelvin;
  const double reference = reference_temperature + celsius_to_kelvin;
  return phases.water_density / phases.ice_density * ice_pressure +
         sign * phases.water_density * phases.latent_heat * log_of_ratio(absolute, Value(reference));
}

// P_pore of Eq. 21 [Pa].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_pressure(Value saturation, Value liquid_pressure, Value ice_pressure) {
  return saturation * liquid_pressure + (Value(1) - saturation) * ice_pressure;
}

}  // namespace thawslide::physics
