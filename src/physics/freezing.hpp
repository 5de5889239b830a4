// Freezing curves: liquid saturation S of the pore as a function of temperature T [C].
//   power law  S = (1 - (T - Tref))^-m below Tref, 1 above                                         (Eq. 24, m = 5)
//   linear     S = 1 + m (T - Tref), between 0 and 1                                               (Sec. 3.1)
// A curve provides S, dS/dT [1/K] (at Tref that of the frozen side, because Sec. 3.1 starts exactly there) and the
// integral of S from Tref to T [K], for the heat content. A new curve needs the same members and its line in the list
// of curves of HeatContent (band/physics.hpp).
#pragma once

#include <cmath>

#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

template <class Value>
struct CurveValues {
  Value saturation, derivative, integral;
};

// The exponent as an integer if it is one between 0 and 16, otherwise -1.
inline THAWSLIDE_HD int whole_exponent(double exponent) {
  constexpr double largest = 16;
  const bool whole = exponent >= 0.0 && exponent <= largest && exponent == std::floor(exponent);
  return whole ? static_cast<int>(exponent) : -1;
}

// base^exponent, by multiplication unless `whole`, the exponent's whole_exponent, is -1.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value power(Value base, double exponent, int whole) {
  if (whole < 0) {
    return cold_call(base, [&](double number) { return std::pow(number, exponent); });
  }
  constexpr int usual = 5;  // Eq. 24
  if (whole == usual) {
    const Value square = base * base;
    return square * square * base;
  }
  Value result = 1;
  for (int k = whole; k > 0; k >>= 1) {
    if ((k & 1) != 0) {
      result *= base;
    }
    base *= base;
  }
  return result;
}

template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value power(Value base, double exponent) {
  return power(base, exponent, whole_exponent(exponent));
}

struct PowerLawCurve {
  double reference_temperature = 0;      // Tref [C]
  double exponent = 1;                   // m
  int whole = whole_exponent(exponent);  // derived from m

  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE CurveValues<Value> at(Value temperature) const {
    const Value above = temperature - reference_temperature;
    const Value base = 1.0 - min(above, Value(0));
    const Value inverse = 1.0 / base;
    const Value s = power(inverse, exponent, whole);
    const Value frozen_integral = exponent == 1.0 ? -map_lanes(base, [](double number) { return std::log(number); })
                                                  : (base * s - 1.0) / (exponent - 1.0);
    return {s, select(above > 0.0, Value(0), exponent * s * inverse), select(above > 0.0, above, frozen_integral)};
  }
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value saturation(Value temperature) const {
    return 1.0 / power(1.0 - min(temperature - reference_temperature, Value(0)), exponent, whole);
  }
  // Temperature [C] at a saturation S, 0 < S <= 1; the lowest one for S = 1.
  [[nodiscard]] THAWSLIDE_HD double temperature(double saturation) const {
    return reference_temperature + 1.0 - std::pow(saturation, -1.0 / exponent);
  }
};

struct LinearCurve {
  double reference_temperature = 0;  // Tref [C]
  double slope = 1;                  // m [1/K]

  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE CurveValues<Value> at(Value temperature) const {
    const Value above = temperature - reference_temperature;
    const double frozen_below = -1.0 / slope;
    const auto melted = above > 0.0;
    const auto frozen = above < frozen_below;
    return {select(melted, Value(1), select(frozen, Value(0), 1.0 + slope * above)),
            select(melted | frozen, Value(0), Value(slope)),
            select(melted, above, select(frozen, Value(0.5 * frozen_below), above * (1.0 + 0.5 * slope * above)))};
  }
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value saturation(Value temperature) const {
    return at(temperature).saturation;
  }
  // Temperature [C] at a saturation S, 0 <= S <= 1; the highest one for S = 0, the lowest one for S = 1.
  [[nodiscard]] THAWSLIDE_HD double temperature(double saturation) const {
    return reference_temperature + (saturation - 1.0) / slope;
  }
};

}  // namespace thawslide::physics
