// Mixture of rock grains, water and ice in a particle (Sec. 2.1).
//   n porosity, S liquid saturation (fraction of the pore), n_S = 1 - n, n_L = n S, n_I = n (1 - S)        (Eq. 1)
//   n_e = n_S + n_I rho_I/rho_S   effective solid fraction                                                   (Eq. 2)
//   dn/dt = (1 - n) div v - (1 - n) beta_S dT/dt                                                             (Eq. 6)
//   C = sum n_a rho_a C_a [J/m3/K],  k = sum n_a k_a [W/m/K]                                                 (Eq. 9)
//   beta_m = (1-n) [S + (1-S) r] beta_S + n S beta_L + n (1-S) r beta_I,  r = rho_I/rho_L                    (Eq. 8)
// Intrinsic densities are constant: Eq. 3 acts only through the expansion coefficients and K_L.
#pragma once

#include <cmath>

#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

// Properties of the three phases (Table 1). The paper rounds rho_I/rho_S of Eq. 2 to 1/3; the ratio is a separate
// parameter because the limits of Eq. 25 were chosen with the rounded value.
struct Phases {
  double rock_density, ice_density, water_density;                    // rho [kg/m3]
  double rock_heat_capacity, ice_heat_capacity, water_heat_capacity;  // C [J/kg/K]
  double rock_conductivity, ice_conductivity, water_conductivity;     // k [W/m/K]
  double rock_expansion, ice_expansion, water_expansion;              // beta, volumetric [1/K]
  double water_bulk_modulus;                                          // K_L [Pa]
  double latent_heat;                                                 // L_f [J/kg]
  double water_unit_weight;                                           // gamma_w [N/m3]
  double ice_to_rock_density_ratio;                                   // of Eq. 2
};

// Bounds of the porosity: a particle always contains some rock and some pore.
inline constexpr double smallest_porosity = 1e-6;
inline constexpr double largest_porosity = 0.95;

// n_e of Eq. 2.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value effective_solid_fraction(const Phases& phases, Value porosity,
                                                                    Value saturation) {
  return 1.0 - porosity + porosity * (1.0 - saturation) * phases.ice_to_rock_density_ratio;
}

// Density of the mixture [kg/m3].
template <class Value>
THAWSLIDE_HD Value mixture_density(const Phases& phases, Value porosity, Value saturation) {
  return (1.0 - porosity) * phases.rock_density +
         porosity * (saturation * phases.water_density + (1.0 - saturation) * phases.ice_density);
}

// C of Eq. 9 [J/m3/K], depending on saturation.
template <class Value>
THAWSLIDE_HD Value heat_capacity(const Phases& phases, Value porosity, Value saturation) {
  return (1.0 - porosity) * phases.rock_density * phases.rock_heat_capacity +
         porosity * (saturation * phases.water_density * phases.water_heat_capacity +
                     (1.0 - saturation) * phases.ice_density * phases.ice_heat_capacity);
}

// k of Eq. 9 [W/m/K], depending on saturation.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value conductivity(const Phases& phases, Value porosity, Value saturation) {
  return (1.0 - porosity) * phases.rock_conductivity +
         porosity * (saturation * phases.water_conductivity + (1.0 - saturation) * phases.ice_conductivity);
}

// beta_m of Eq. 8 [1/K], with r = rho_I/rho_L (the paper has rho_L/rho_L, an erratum). water_expansion [1/K]: at the
// current temperature.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value expansion(const Phases& phases, Value porosity, Value saturation,
                                                     Value water_expansion) {
  const double ratio = phases.ice_density / phases.water_density;
  return (1.0 - porosity) * (saturation + (1.0 - saturation) * ratio) * phases.rock_expansion +
         porosity * saturation * water_expansion + porosity * (1.0 - saturation) * ratio * phases.ice_expansion;
}

// The same with the constant expansion of Table 1.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value expansion(const Phases& phases, Value porosity, Value saturation) {
  return expansion(phases, porosity, saturation, Value(phases.water_expansion));
}

// Quantity per volume of a mixture by volume. share: fraction of the first material.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value mixed(Value first, Value second, Value fraction) {
  return fraction * first + (Value(1) - fraction) * second;
}

// exp(x) - 1. Small arguments, as in a step, use the series, which is exact to round-off and much faster.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value exponential_minus_one(Value x) {
  using std::abs;
  const auto is_small = abs(x) < (1e-2);
  const auto one_over = [](int divisor) { return Value(1.0 / static_cast<double>(divisor)); };
  const Value tail = one_over(6) + x * (one_over(24) + x * (one_over(120) + x * one_over(720)));
  const Value series = x * (Value(1) + x * (one_over(2) + x * tail));
  if (!any(!is_small)) {
    return series;
  }
  return select(is_small, series, cold_call(x, [](auto number) { return std::expm1(number); }));
}

// log(a/b). Ratios near 1, as of absolute temperatures, use the series 2 artanh((a - b)/(a + b)), which is exact to
// round-off and much faster.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value log_of_ratio(Value a, Value b) {
  using std::abs;
  constexpr int terms = 9;
  const Value argument = (a - b) / (a + b);
  const auto is_small = abs(argument) < 0.112;  // the first omitted term is below 1e-17
  const Value square = argument * argument;
  Value series = 0;
  for (int k = terms - 1; k >= 0; --k) {
    series = series * square + Value(2.0 / static_cast<double>(2 * k + 1));
  }
  series *= argument;
  if (!any(!is_small)) {
    return series;
  }
  return select(is_small, series, cold_call(a / b, [](auto number) { return std::log(number); }));
}

// Eq. 6 integrated over a step: the grains conserve mass; 1 - n therefore decreases with the volume and increases with
// their thermal expansion. volume_strain: change of the logarithm of the volume, approximated by the mid-point strain
// of a step (error of third order). temperature_change [K].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value updated_porosity(const Phases& phases, Value porosity, Value volume_strain,
                                                            Value temperature_change) {
  const Value exponent = phases.rock_expansion * temperature_change - volume_strain;
  const Value updated = porosity - (1.0 - porosity) * exponential_minus_one(exponent);
  return max(min(updated, Value(largest_porosity)), Value(smallest_porosity));
}

}  // namespace thawslide::physics
