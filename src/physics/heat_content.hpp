// Heat content of the mixture and its inverse: the enthalpy form of Eq. 9.
//   H(T) = integral of C dT from Tref + rho_I n L_f S(T)    [J/m3], 0 for frozen matter at Tref
//   dH/dT = C + rho_I n L_f dS/dT                            apparent capacity [J/m3/K]
// L_f is per kilogram (Table 1 prints J/m3). H rises strictly with T and is convex below Tref, linear above.
#pragma once

#include <cmath>

#include "physics/freezing.hpp"
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
    const CurveValues<Value> values = curve.at(temperature);
    return frozen_capacity(porosity) * (temperature - curve.reference_temperature) +
           capacity_rise(porosity) * values.integral + melting_heat(porosity) * values.saturation;
  }

  // dH/dT [J/m3/K], at Tref the one of the frozen side.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value apparent_capacity(Value temperature, Value porosity) const {
    const CurveValues<Value> values = curve.at(temperature);
    return frozen_capacity(porosity) + capacity_rise(porosity) * values.saturation +
           melting_heat(porosity) * values.derivative;
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

  // The temperature [C] at which the content is H, from a guess near it: closed above Tref, Newton's iteration below,
  // where convexity makes it converge from any start.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD Value temperature(Value heat, Value porosity, Value guess) const {
    using std::abs;
    const Value frozen = frozen_capacity(porosity);
    const Value rise = capacity_rise(porosity);
    const Value melting = melting_heat(porosity);
    const auto melted = heat >= melting;
    constexpr int most_iterations = 100;
    constexpr Real close = by_precision<Real>(1e-6, 1e-3);  // converges quadratically: the next change is round-off
    Value below = min(guess - curve.reference_temperature, Value(0));
    auto open = !melted;
    for (int k = 0; k < most_iterations && any(open); ++k) {
      const CurveValues<Value> values = curve.at(curve.reference_temperature + below);
      const Value excess = frozen * below + rise * values.integral + melting * values.saturation - heat;
      const Value change = -excess / (frozen + rise * values.saturation + melting * values.derivative);
      below = select(open, min(below + change, Value(0)), below);
      open = open & (abs(change) >= close);
    }
    return curve.reference_temperature + select(melted, (heat - melting) / (frozen + rise), below);
  }

  // rho_I n L_f: what melting takes [J/m3].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value melting_heat(Value porosity) const {
    return latent ? phases.ice_density * porosity * phases.latent_heat : Value(0);
  }

 private:
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value frozen_capacity(Value porosity) const {
    return heat_capacity(phases, porosity, Value(0));
  }
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value capacity_rise(Value porosity) const {
    return porosity *
           (phases.water_density * phases.water_heat_capacity - phases.ice_density * phases.ice_heat_capacity);
  }
};

}  // namespace thawslide::physics
