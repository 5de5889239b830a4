// Freezing curves: the liquid saturation S of the pore as a function of temperature T [C].
//   power law  S = (1 - (T - Tref))^-m below Tref, 1 above                                         (Eq. 24, m = 5)
//   linear     S = 1 + m (T - Tref), between 0 and 1                                               (Sec. 3.1)
// A curve gives S, dS/dT [1/K] (at Tref the one of the frozen side: Sec. 3.1 starts exactly there) and the integral of
// S from Tref to T [K], which the heat content needs. A new curve needs the same members and its line in HeatContent's
// list of curves (band/model.hpp).
#pragma once

#include <cmath>

#include "base/portability.hpp"

namespace thawslide::physics {

template <class Real>
struct CurveValues {
  Real saturation, derivative, integral;
};

// base^exponent; whole exponents up to 16, the usual ones, by multiplication.
template <class Real>
THAWSLIDE_HD Real power(Real base, Real exponent) {
  constexpr Real largest_whole = 16;
  if (!(exponent >= Real(0) && exponent <= largest_whole) || exponent != std::floor(exponent)) {
    return std::pow(base, exponent);
  }
  Real result = 1;
  for (int k = static_cast<int>(exponent); k > 0; k >>= 1) {
    result *= (k & 1) != 0 ? base : Real(1);
    base *= base;
  }
  return result;
}

template <class Real>
struct PowerLawCurve {
  Real reference_temperature;  // Tref [C]
  Real exponent;               // m

  [[nodiscard]] THAWSLIDE_HD CurveValues<Real> at(Real temperature) const {
    const Real above = temperature - reference_temperature;
    if (above > Real(0)) {
      return {Real(1), Real(0), above};
    }
    const Real base = Real(1) - above;
    const Real inverse = Real(1) / base;
    const Real s = power(inverse, exponent);
    const Real integral = exponent == Real(1) ? -std::log(base) : (base * s - Real(1)) / (exponent - Real(1));
    return {s, exponent * s * inverse, integral};
  }
  [[nodiscard]] THAWSLIDE_HD Real saturation(Real temperature) const {
    const Real above = temperature - reference_temperature;
    return above >= Real(0) ? Real(1) : Real(1) / power(Real(1) - above, exponent);
  }
};

template <class Real>
struct LinearCurve {
  Real reference_temperature;  // Tref [C]
  Real slope;                  // m [1/K]

  [[nodiscard]] THAWSLIDE_HD CurveValues<Real> at(Real temperature) const {
    const Real above = temperature - reference_temperature;
    if (above > Real(0)) {
      return {Real(1), Real(0), above};
    }
    const Real frozen_below = -Real(1) / slope;
    if (above < frozen_below) {
      return {Real(0), Real(0), Real(0.5) * frozen_below};
    }
    return {Real(1) + slope * above, slope, above * (Real(1) + Real(0.5) * slope * above)};
  }
  [[nodiscard]] THAWSLIDE_HD Real saturation(Real temperature) const { return at(temperature).saturation; }
};

}  // namespace thawslide::physics
