// Heat content of the mixture and its inverse: the enthalpy form of Eq. 9.
//   H(T) = integral of C dT from Tref + rho_I n L_f S(T)    [J/m3], 0 for frozen matter at Tref
//   dH/dT = C + rho_I n L_f dS/dT                            apparent capacity [J/m3/K]
// L_f is per kilogram (Table 1 prints J/m3).
#pragma once

#include <cmath>

#include "physics/enthalpy.hpp"
#include "physics/mixture.hpp"

namespace thawslide::physics {

template <class Real, class Curve>
struct HeatContent {
  Phases<Real> phases;
  Curve curve;
  bool latent;  // off: melting takes no heat (Sec. 3.2's 5 s need that)

  // H [J/m3] at temperature [C].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value content(Value temperature, Value porosity) const {
    return enthalpy(curve, coefficients(porosity), temperature);
  }

  // dH/dT [J/m3/K], at Tref the one of the frozen side.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value apparent_capacity(Value temperature, Value porosity) const {
    return physics::apparent_capacity(curve, coefficients(porosity), temperature);
  }

  // Whether a change of temperature [K] is too small to show in the content's digits.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto is_negligible(Value change) const {
    using std::abs;
    constexpr Real smallest_change = by_precision<Real>(1e-7, 1e-3);
    return abs(change) < smallest_change;
  }

  // (H(T + change) - H(T)) / change [J/m3/K]; the apparent capacity where the change is negligible.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value secant_capacity(Value temperature, Value change,
                                                                           Value porosity) const {
    const auto negligible = is_negligible(change);
    const Value rise = content(temperature + change, porosity) - content(temperature, porosity);
    return select(negligible, apparent_capacity(temperature, porosity), rise / select(negligible, Value(1), change));
  }

  // The temperature [C] at which the content is H, from a guess near it.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Value temperature(Value heat, Value porosity, Value guess) const {
    return temperature_of_enthalpy(curve, coefficients(porosity), heat, guess);
  }

  // Per volume [J/m3/K] and [J/m3]; rho_I n L_f is what melting takes.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE EnthalpyCoefficients<Value> coefficients(Value porosity) const {
    return {
        heat_capacity(phases, porosity, Value(0)),
        porosity * (phases.water_density * phases.water_heat_capacity - phases.ice_density * phases.ice_heat_capacity),
        latent ? phases.ice_density * porosity * phases.latent_heat : Value(0)};
  }
};

}  // namespace thawslide::physics
