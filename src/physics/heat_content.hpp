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
  [[nodiscard]] THAWSLIDE_HD Real content(Real temperature, Real porosity) const {
    const CurveValues<Real> values = curve.at(temperature);
    return frozen_capacity(porosity) * (temperature - curve.reference_temperature) +
           capacity_rise(porosity) * values.integral + melting_heat(porosity) * values.saturation;
  }

  // dH/dT [J/m3/K], at Tref the one of the frozen side.
  [[nodiscard]] THAWSLIDE_HD Real apparent_capacity(Real temperature, Real porosity) const {
    const CurveValues<Real> values = curve.at(temperature);
    return frozen_capacity(porosity) + capacity_rise(porosity) * values.saturation +
           melting_heat(porosity) * values.derivative;
  }

  // Whether a change of temperature [K] is too small to show in the content's digits.
  [[nodiscard]] THAWSLIDE_HD bool drowns_in_round_off(Real change) const {
    constexpr Real smallest_change = static_cast<Real>(1e-7);
    return std::abs(change) < smallest_change;
  }

  // (H(T + change) - H(T)) / change [J/m3/K]; the apparent capacity where the change drowns in round-off.
  [[nodiscard]] THAWSLIDE_HD Real secant_capacity(Real temperature, Real change, Real porosity) const {
    if (drowns_in_round_off(change)) {
      return apparent_capacity(temperature, porosity);
    }
    return (content(temperature + change, porosity) - content(temperature, porosity)) / change;
  }

  // The temperature [C] at which the content is H, from a guess near it: closed above Tref, Newton's iteration below,
  // where convexity makes it converge from any start.
  [[nodiscard]] THAWSLIDE_HD Real temperature(Real heat, Real porosity, Real guess) const {
    const Real frozen = frozen_capacity(porosity);
    const Real rise = capacity_rise(porosity);
    const Real melting = melting_heat(porosity);
    if (heat >= melting) {
      return curve.reference_temperature + (heat - melting) / (frozen + rise);
    }
    constexpr int most_iterations = 100;
    constexpr Real close = static_cast<Real>(1e-6);  // converges quadratically: the next change is round-off
    Real below = guess < curve.reference_temperature ? guess - curve.reference_temperature : Real(0);
    for (int k = 0; k < most_iterations; ++k) {
      const CurveValues<Real> values = curve.at(curve.reference_temperature + below);
      const Real excess = frozen * below + rise * values.integral + melting * values.saturation - heat;
      const Real change = -excess / (frozen + rise * values.saturation + melting * values.derivative);
      below = below + change < Real(0) ? below + change : Real(0);
      if (std::abs(change) < close) {
        break;
      }
    }
    return curve.reference_temperature + below;
  }

  // rho_I n L_f: what melting takes [J/m3].
  [[nodiscard]] THAWSLIDE_HD Real melting_heat(Real porosity) const {
    return latent ? phases.ice_density * porosity * phases.latent_heat : Real(0);
  }

 private:
  [[nodiscard]] THAWSLIDE_HD Real frozen_capacity(Real porosity) const {
    return heat_capacity(phases, porosity, Real(0));
  }
  [[nodiscard]] THAWSLIDE_HD Real capacity_rise(Real porosity) const {
    return porosity *
           (phases.water_density * phases.water_heat_capacity - phases.ice_density * phases.ice_heat_capacity);
  }
};

}  // namespace thawslide::physics
