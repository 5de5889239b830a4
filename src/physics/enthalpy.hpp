// Enthalpy of material with a freezing curve (Eq. 9), per volume or per area of the base.
//   H(T) = C_f (T - Tref) + C_r integral of S dT from Tref + L S(T)       0 for frozen material at Tref
//   dH/dT = C_f + C_r S + L dS/dT
// C_f: capacity of frozen material; C_r: its increase by melting; L: latent heat. H increases strictly with T, and is
// convex below Tref and linear above.
#pragma once

#include <cmath>

#include "physics/freezing.hpp"

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

}  // namespace thawslide::physics
