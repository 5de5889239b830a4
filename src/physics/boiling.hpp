// Boiling of pore water at its absolute pressure P + P_atm (docs/theory/band-columns.md).
//   L_v(T) = 2.5e6 - 2360 T                                             [J/kg], T in C
//   dP_abs/dT = L_v P_abs/(R_v T^2)                                     Clausius and Clapeyron, steam as an ideal gas
//   ln(P_abs/P_atm) = [A (1/T_b - 1/T) - 2360 ln(T/T_b)]/R_v            its integral, T in K; A = 2.5e6 + 2360 * 273.15
// T_b = 373.15 K is the boiling temperature at P_atm, R_v = R/M the gas constant of water.
#pragma once

#include <cmath>

#include "base/portability.hpp"

namespace thawslide::physics {

struct Steam {
  static constexpr Real atmosphere = static_cast<Real>(101325);            // P_atm [Pa]
  static constexpr Real gas_constant = static_cast<Real>(461.5);           // R_v [J/kg/K]
  static constexpr Real boiling_at_atmosphere = static_cast<Real>(100.0);  // [C]
  static constexpr Real heat_at_zero = static_cast<Real>(2.5e6);           // L_v at 0 C [J/kg]
  static constexpr Real heat_lost_per_kelvin = static_cast<Real>(2360);    // [J/kg/K]
};

// L_v [J/kg] at temperature [C].
inline THAWSLIDE_HD Real heat_of_vaporization(Real temperature) {
  return Steam::heat_at_zero - Steam::heat_lost_per_kelvin * temperature;
}

// Absolute pressure [Pa] at which water of this temperature [C] boils.
inline THAWSLIDE_HD Real saturation_pressure(Real temperature) {
  using Water = Steam;
  const Real absolute = temperature + celsius_to_kelvin;
  const Real at_atmosphere = Water::boiling_at_atmosphere + celsius_to_kelvin;
  const Real extrapolated = Water::heat_at_zero + Water::heat_lost_per_kelvin * celsius_to_kelvin;
  const Real exponent = extrapolated * (Real(1) / at_atmosphere - Real(1) / absolute) -
                        Water::heat_lost_per_kelvin * std::log(absolute / at_atmosphere);
  return Water::atmosphere * std::exp(exponent / Water::gas_constant);
}

// T_sat [C]: boiling temperature at a pore pressure [Pa] above atmospheric pressure.
inline THAWSLIDE_HD Real boiling_temperature(Real pore_pressure) {
  using Water = Steam;
  const Real wanted = std::log(Real(1) + pore_pressure / Water::atmosphere);
  Real temperature = Water::boiling_at_atmosphere;
  constexpr int most_iterations = 20;
  constexpr Real close = 1e-9;
  for (int k = 0; k < most_iterations; ++k) {  // Newton's iteration: ln P is concave in T
    const Real absolute = temperature + celsius_to_kelvin;
    const Real excess = wanted - std::log(saturation_pressure(temperature) / Water::atmosphere);
    const Real change = excess * Water::gas_constant * absolute * absolute / heat_of_vaporization(temperature);
    temperature += change;
    if (std::abs(change) < close) {
      break;
    }
  }
  return temperature;
}

}  // namespace thawslide::physics
