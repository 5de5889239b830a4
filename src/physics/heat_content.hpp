// Heat content of the mixture and its inverse: the enthalpy form of Eq. 9.
//   H(T) = integral of C dT from Tref + rho_I n L_f S(T)    [J/m3], 0 for frozen material at Tref
//   dH/dT = C + rho_I n L_f dS/dT                            apparent capacity [J/m3/K]
// L_f is per kilogram (Table 1 has J/m3, an erratum).
#pragma once

#include <cmath>

#include "physics/enthalpy.hpp"
#include "physics/mixture.hpp"

namespace thawslide::physics {

template <class Curve>
struct HeatContent {
  Phases phases;
  Curve curve;
  bool latent;  // off: melting consumes no heat (required by the 5 s of Sec. 3.2)

  // H [J/m3] at temperature [C].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value content(Value temperature, Value porosity) const {
    return enthalpy(curve, coefficients(porosity), temperature);
  }

  // dH/dT [J/m3/K], at Tref that of the frozen side.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value apparent_capacity(Value temperature, Value porosity) const {
    return physics::apparent_capacity(curve, coefficients(porosity), temperature);
  }

  // True if a change of temperature [K] is too small to affect the digits of the content.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE auto is_negligible(Value change) const {
    using std::abs;
    constexpr double smallest_change = 1e-7;
    return abs(change) < smallest_change;
  }

  // (H(T + change) - H(T)) / change [J/m3/K]; the apparent capacity if the change is negligible.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value secant_capacity(Value temperature, Value change,
                                                                           Value porosity) const {
    const auto negligible = is_negligible(change);
    const Value rise = content(temperature + change, porosity) - content(temperature, porosity);
    return select(negligible, apparent_capacity(temperature, porosity), rise / select(negligible, Value(1), change));
  }

  // Temperature [C] at a content H. guess: initial value.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Value temperature(Value heat, Value porosity, Value guess) const {
    return temperature_of_enthalpy(curve, coefficients(porosity), heat, guess);
  }

  // Per volume [J/m3/K] and [J/m3]; rho_I n L_f is the latent heat of melting.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE EnthalpyCoefficients<Value> coefficients(Value porosity) const {
    return {
        heat_capacity(phases, porosity, Value(0)),
        porosity * (phases.water_density * phases.water_heat_capacity - phases.ice_density * phases.ice_heat_capacity),
        latent ? phases.ice_density * porosity * phases.latent_heat : Value(0)};
  }
};

}  // namespace thawslide::physics
