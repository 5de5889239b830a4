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
  static constexpr double atmosphere = static_cast<double>(101325);          // P_atm [Pa]
  static constexpr double gas_constant = 461.5;                              // R_v [J/kg/K]
  static constexpr double boiling_at_atmosphere = 100.0;                     // [C]
  static constexpr double heat_at_zero = 2.5e6;                              // L_v at 0 C [J/kg]
  static constexpr double heat_lost_per_kelvin = static_cast<double>(2360);  // [J/kg/K]
};

// L_v [J/kg] at temperature [C].
inline THAWSLIDE_HD double heat_of_vaporization(double temperature) {
  return Steam::heat_at_zero - Steam::heat_lost_per_kelvin * temperature;
}

// Absolute pressure [Pa] at which water of this temperature [C] boils.
inline THAWSLIDE_HD double saturation_pressure(double temperature) {
  using Water = Steam;
  const double absolute = temperature + celsius_to_kelvin;
  const double at_atmosphere = Water::boiling_at_atmosphere + celsius_to_kelvin;
  const double extrapolated = Water::heat_at_zero + Water::heat_lost_per_kelvin * celsius_to_kelvin;
  const double exponent = extrapolated * (1.0 / at_atmosphere - 1.0 / absolute) -
                          Water::heat_lost_per_kelvin * std::log(absolute / at_atmosphere);
  return Water::atmosphere * std::exp(exponent / Water::gas_constant);
}

// T_sat [C]: boiling temperature at a pore pressure [Pa] above atmospheric pressure.
inline THAWSLIDE_HD double boiling_temperature(double pore_pressure) {
  using Water = Steam;
  const double wanted = std::log(1.0 + pore_pressure / Water::atmosphere);
  double temperature = Water::boiling_at_atmosphere;
  constexpr int most_iterations = 20;
  constexpr double close = 1e-9;
  for (int k = 0; k < most_iterations; ++k) {  // Newton's iteration: ln P is concave in T
    const double absolute = temperature + celsius_to_kelvin;
    const double excess = wanted - std::log(saturation_pressure(temperature) / Water::atmosphere);
    const double change = excess * Water::gas_constant * absolute * absolute / heat_of_vaporization(temperature);
    temperature += change;
    if (std::abs(change) < close) {
      break;
    }
  }
  return temperature;
}

}  // namespace thawslide::physics
