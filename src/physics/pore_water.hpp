// Water balance of a melted pore: filling and resulting pressure.
//   (n/K_L + m_v) dP = beta_m(T) dT - n (1 - r) dS - div q dt + m_v dN,   0 <= P <= N
//   beta_m = (1-n) [S + (1-S) r] beta_S + n S beta_L(T) + n (1-S) r beta_I                                  (Eq. 8)
// r = rho_I/rho_L. This is Eq. 8 with two additions: the skeleton is compressible under effective stress, by m_v
// [1/Pa], and the expansion of water depends on temperature. With m_v = 0 and a constant beta_L, it is Eq. 8 with a
// rigid pore. Melt fills the fraction r of the pore that its ice filled; the remaining void n (1 - r) dS is filled
// before the pressure rises.
//   beta_L(T): -0.7e-4 at 0 C, 2.1e-4 at 20, 4.6e-4 at 50, 7.5e-4 1/K at 100, linear between and beyond (four values
//   of published tables: docs/theory/pore-pressure.md)
// The state of a pore is given by the surplus w, the volume of water beyond the filling at P = 0, per volume of
// mixture. Below 0, it is a gas void; up to (n/K_L + m_v) N, it is under pressure; the excess opens the base.
#pragma once

#include "base/portability.hpp"
#include "base/select.hpp"
#include "physics/mixture.hpp"
#include "physics/options.hpp"

namespace thawslide::physics {

// Volumetric expansion of water beta_L [1/K].
struct WaterExpansion {
  WaterExpansionLaw law = WaterExpansionLaw::constant;
  double constant = 0;  // [1/K]

  // beta_L at a temperature [C].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value at(Value temperature) const {
    if (law == WaterExpansionLaw::constant) {
      return Value(constant);
    }
    Value expansion = on_line<0>(temperature);
    expansion = select(temperature < Value(lower_end<1>()), expansion, on_line<1>(temperature));
    return select(temperature < Value(lower_end<2>()), expansion, on_line<2>(temperature));
  }

  // Integral between two temperatures [C]: relative swelling of water [1]. Exact, evaluated per line.
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value swelling(Value from, Value to) const {
    if (law == WaterExpansionLaw::constant) {
      return constant * (to - from);
    }
    const Value first = lower_end<1>(), second = lower_end<2>();
    return under_line<0>(min(from, first), min(to, first)) +
           under_line<1>(max(min(from, second), first), max(min(to, second), first)) +
           under_line<2>(max(from, second), max(to, second));
  }

 private:
  struct Point {
    double temperature, expansion;  // [C], [1/K]
  };
  template <int Number>
  THAWSLIDE_HD static constexpr Point point() {
    constexpr Point points[4] = {{0.0, -0.7e-4}, {20.0, 2.1e-4}, {50.0, 4.6e-4}, {100.0, 7.5e-4}};
    return points[Number];
  }
  template <int Line>
  THAWSLIDE_HD static constexpr double lower_end() {
    return point<Line>().temperature;
  }
  // Line through two adjacent points.
  template <int Line, class Value>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static Value on_line(Value temperature) {
    constexpr Point low = point<Line>(), high = point<Line + 1>();
    constexpr double slope = (high.expansion - low.expansion) / (high.temperature - low.temperature);
    return low.expansion + slope * (temperature - low.temperature);
  }
  template <int Line, class Value>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static Value under_line(Value from, Value to) {
    return (to - from) * on_line<Line>(0.5 * (from + to));
  }
};

// Integral of beta_m dT of melted material (S = 1) between two temperatures [C]: swelling of grains and water as a
// fraction of the volume [1].
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value melted_swelling(const Phases& phases, const WaterExpansion& water,
                                                           Value porosity, Value from, Value to) {
  return (1.0 - porosity) * phases.rock_expansion * (to - from) + porosity * water.swelling(from, to);
}

// n/K_L + m_v [1/Pa]: volume of water stored per rise of pressure and volume of mixture. skeleton_compressibility: m_v
// [1/Pa]; 0: rigid pore.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_storage(const Phases& phases, Value porosity,
                                                        double skeleton_compressibility) {
  return porosity / phases.water_bulk_modulus + skeleton_compressibility;
}

// n + K_L m_v [1]: porosity of a rigid pore with the same storage; replaces n in the denominators of Eqs. 8 and 23.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value storing_porosity(const Phases& phases, Value porosity,
                                                            double skeleton_compressibility) {
  return porosity + phases.water_bulk_modulus * skeleton_compressibility;
}

// n (1 - r) dS: void left by melting, per volume of mixture [1]. melted: dS, fraction of the pore.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value melting_void(const Phases& phases, Value porosity, Value melted) {
  return porosity * (1.0 - phases.ice_density / phases.water_density) * melted;
}

// P limited to 0 <= P <= N [Pa]; a negative load counts as 0.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value bounded_pore_pressure(Value pressure, Value normal_load) {
  return max(min(pressure, normal_load), Value(0));
}

// State of pore water with a surplus w [1]. At most one of void and pressure is nonzero, and the base opens only at P =
// N.
template <class Value>
struct PoreFilling {
  Value pressure;  // P [Pa]
  Value gas_void;  // per volume of mixture [1]
  Value opening;   // volume of water that opens the base, per volume of mixture [1]
};

// For a pore without opening: P may exceed any load. storage: n/K_L + m_v [1/Pa], above 0.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE PoreFilling<Value> pore_filling(Value surplus, Value storage) {
  const Value none = 0;
  return {max(surplus / storage, none), max(-surplus, none), none};
}
// The same under a normal load N [Pa], at which the base opens.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE PoreFilling<Value> pore_filling(Value surplus, Value storage, Value normal_load) {
  const Value none = 0;
  return {bounded_pore_pressure(surplus / storage, normal_load), max(-surplus, none),
          max(surplus - storage * max(normal_load, none), none)};
}

// w [1] of a pore in a given state; inverse of pore_filling.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_surplus(const PoreFilling<Value>& filling, Value storage) {
  return storage * filling.pressure + filling.opening - filling.gas_void;
}

// P [Pa] when the last ice of a pore melts, without a void: N - s0, because the water takes over the part of the load N
// that the ice carried, but not the residual effective stress s0 [Pa]. s0 at N or above: no excess pressure.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value thawing_pressure(Value normal_load, Value residual_stress) {
  return max(normal_load - residual_stress, Value(0));
}

// w [1] on thawing, minus the void left by melting.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value thawing_surplus(Value storage, Value normal_load, Value residual_stress,
                                                           Value gas_void) {
  return storage * thawing_pressure(normal_load, residual_stress) - gas_void;
}

}  // namespace thawslide::physics
