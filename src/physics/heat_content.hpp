// Enthalpy of material with a freezing curve (Eq. 9), per volume or per area of the base.
//   H(T) = C_f (T - Tref) + C_r integral of S dT from Tref + L S(T)       0 for frozen material at Tref
//   dH/dT = C_f + C_r S + L dS/dT
// C_f: capacity of frozen material; C_r: its increase by melting; L: latent heat. H increases strictly with T, and is
// convex below Tref and linear above.
#pragma once

#include <cmath>

#include "physics/freezing.hpp"
#include "physics/mixture.hpp"

namespace thawslide::physics {

// Capacities per kelvin and latent heat, per volume or per area.
template <class Value>
struct EnthalpyCoefficients {
  Value frozen, rise, melting;
};

// H at temperature [C].
template <class Curve, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value enthalpy(const Curve& curve, const EnthalpyCoefficients<Value>& of,
                                                    Value temperature) {
  const CurveValues<Value> values = curve.at(temperature);
  return of.frozen * (temperature - curve.reference_temperature) + of.rise * values.integral +
         of.melting * values.saturation;
}

// dH/dT, at Tref that of the frozen side.
template <class Curve, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value apparent_capacity(const Curve& curve, const EnthalpyCoefficients<Value>& of,
                                                             Value temperature) {
  const CurveValues<Value> values = curve.at(temperature);
  return of.frozen + of.rise * values.saturation + of.melting * values.derivative;
}

// Temperature [C] at an enthalpy. guess: initial value. Closed form above Tref; Newton's iteration below, where
// convexity guarantees convergence from any start.
template <class Curve, class Value>
THAWSLIDE_HD Value temperature_of_enthalpy(const Curve& curve, const EnthalpyCoefficients<Value>& of, Value heat,
                                           Value guess) {
  using std::abs;
  const auto melted = heat >= of.melting;
  constexpr int most_iterations = 100;
  constexpr double close = 1e-6;  // converges quadratically: the next change is round-off
  Value below = min(guess - curve.reference_temperature, Value(0));
  auto open = !melted;
  for (int k = 0; k < most_iterations && any(open); ++k) {
    const CurveValues<Value> values = curve.at(curve.reference_temperature + below);
    const Value excess = of.frozen * below + of.rise * values.integral + of.melting * values.saturation - heat;
    const Value change = -excess / (of.frozen + of.rise * values.saturation + of.melting * values.derivative);
    below = select(open, min(below + change, Value(0)), below);
    open = open & (abs(change) >= close);
  }
  return curve.reference_temperature + select(melted, (heat - of.melting) / (of.frozen + of.rise), below);
}

// Heat content of the mixture and its inverse: the enthalpy form of Eq. 9.
//   H(T) = integral of C dT from Tref + rho_I n L_f S(T)    [J/m3], 0 for frozen material at Tref
//   dH/dT = C + rho_I n L_f dS/dT                            apparent capacity [J/m3/K]
// L_f is per kilogram (Table 1 has J/m3, an erratum).

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
