// The balance of the water in a melted pore: what fills it, and the pressure that comes of it.
//   (n/K_L + m_v) dP = beta_m(T) dT - n (1 - r) dS - div q dt + m_v dN,   0 <= P <= N
//   beta_m = (1-n) [S + (1-S) r] beta_S + n S beta_L(T) + n (1-S) r beta_I                                  (Eq. 8)
// r = rho_I/rho_L. Eq. 8 with two things it leaves out: the skeleton gives under effective stress, by m_v [1/Pa], and
// water's expansion follows the temperature. With m_v = 0 and a constant beta_L it is Eq. 8 with a rigid pore. Melt
// fills r of the pore that its ice filled: what is left, n (1 - r) dS, is filled before a pressure rises.
//   beta_L(T): -0.7e-4 at 0 C, 2.1e-4 at 20, 4.6e-4 at 50, 7.5e-4 1/K at 100, linear between and beyond (source of the
//   four values: not checked)
// One number says how full a pore is: the surplus w, the volume of water beyond what fills the pore at P = 0, per
// volume of mixture. Below 0 it is a gas void; up to (n/K_L + m_v) N it is under pressure; what is more opens the base.
#pragma once

#include "base/portability.hpp"
#include "base/select.hpp"
#include "physics/mixture.hpp"

namespace thawslide::physics {

enum class WaterExpansionLaw {
  constant,       // Table 1
  by_temperature  // through the four values above
};

// Water's volumetric expansion beta_L [1/K].
template <class Real>
struct WaterExpansion {
  WaterExpansionLaw law = WaterExpansionLaw::constant;
  Real constant = 0;  // [1/K]

  // At a temperature [C].
  template <class Value>
  [[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value at(Value temperature) const {
    if (law == WaterExpansionLaw::constant) {
      return Value(constant);
    }
    Value expansion = on_line<0>(temperature);
    expansion = select(temperature < Value(lower_end<1>()), expansion, on_line<1>(temperature));
    return select(temperature < Value(lower_end<2>()), expansion, on_line<2>(temperature));
  }

  // Its integral between two temperatures [C]: the share by which water swells [1]. Exact, line by line.
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
    Real temperature, expansion;  // [C], [1/K]
  };
  template <int Number>
  THAWSLIDE_HD static constexpr Point point() {
    constexpr Point points[4] = {{Real(0), static_cast<Real>(-0.7e-4)},
                                 {Real(20), static_cast<Real>(2.1e-4)},
                                 {Real(50), static_cast<Real>(4.6e-4)},
                                 {Real(100), static_cast<Real>(7.5e-4)}};
    return points[Number];
  }
  template <int Line>
  THAWSLIDE_HD static constexpr Real lower_end() {
    return point<Line>().temperature;
  }
  // The line through two neighbouring points.
  template <int Line, class Value>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static Value on_line(Value temperature) {
    constexpr Point low = point<Line>(), high = point<Line + 1>();
    constexpr Real slope = (high.expansion - low.expansion) / (high.temperature - low.temperature);
    return low.expansion + slope * (temperature - low.temperature);
  }
  template <int Line, class Value>
  THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE static Value under_line(Value from, Value to) {
    return (to - from) * on_line<Line>(static_cast<Real>(0.5) * (from + to));
  }
};

// Integral of beta_m dT of melted matter (S = 1) between two temperatures [C]: the share of the volume by which grains
// and water swell [1].
template <class Real, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value melted_swelling(const Phases<Real>& phases,
                                                           const WaterExpansion<Real>& water, Value porosity,
                                                           Value from, Value to) {
  return (Real(1) - porosity) * phases.rock_expansion * (to - from) + porosity * water.swelling(from, to);
}

// n/K_L + m_v [1/Pa]: the volume of water that a rise of pressure stores, per volume of mixture. Compressibility m_v of
// the skeleton [1/Pa]; 0: a rigid pore.
template <class Real, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_storage(const Phases<Real>& phases, Value porosity,
                                                        Real skeleton_compressibility) {
  return porosity / phases.water_bulk_modulus + skeleton_compressibility;
}

// n + K_L m_v [1]: what a rigid pore's porosity would have to be to store as much; n of Eqs. 8 and 23 where they divide
// by it.
template <class Real, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value storing_porosity(const Phases<Real>& phases, Value porosity,
                                                            Real skeleton_compressibility) {
  return porosity + phases.water_bulk_modulus * skeleton_compressibility;
}

// n (1 - r) dS: the void that melting leaves, per volume of mixture [1]; melted: dS, share of the pore.
template <class Real, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value melting_void(const Phases<Real>& phases, Value porosity, Value melted) {
  return porosity * (Real(1) - phases.ice_density / phases.water_density) * melted;
}

// dP = m_v dN/(n/K_L + m_v) [Pa]: what a change of the normal load [Pa] brings to a full pore that does not drain. In a
// rigid pore nothing.
template <class Real, class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value undrained_loading(const Phases<Real>& phases, Value porosity,
                                                             Real skeleton_compressibility, Value load_change) {
  return skeleton_compressibility / pore_storage(phases, porosity, skeleton_compressibility) * load_change;
}

// P within 0 <= P <= N [Pa]; a load below 0 counts as none.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value bounded_pore_pressure(Value pressure, Value normal_load) {
  return max(min(pressure, normal_load), Value(0));
}

// What the water of a pore does with its surplus w [1]; of the three at most one of void and pressure is not 0, and the
// base opens only where P = N.
template <class Value>
struct PoreFilling {
  Value pressure;  // P [Pa]
  Value gas_void;  // per volume of mixture [1]
  Value opening;   // volume of water that parts the base, per volume of mixture [1]
};

// storage n/K_L + m_v [1/Pa], above 0. Of a pore that nothing opens: P may pass any load.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE PoreFilling<Value> pore_filling(Value surplus, Value storage) {
  const Value none = 0;
  return {max(surplus / storage, none), max(-surplus, none), none};
}
// The same below a normal load N [Pa], at which the base opens.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE PoreFilling<Value> pore_filling(Value surplus, Value storage, Value normal_load) {
  const Value none = 0;
  return {bounded_pore_pressure(surplus / storage, normal_load), max(-surplus, none),
          max(surplus - storage * max(normal_load, none), none)};
}

// w [1] of a pore that is so filled; the inverse of pore_filling.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value pore_surplus(const PoreFilling<Value>& filling, Value storage) {
  return storage * filling.pressure + filling.opening - filling.gas_void;
}

// P [Pa] when the last ice of a pore melts, while no void takes of it: N - s0, since the water takes over what the ice
// carried of the load N, but not the residual effective stress s0 [Pa]. s0 at N or above: no excess pressure.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value thawing_pressure(Value normal_load, Value residual_stress) {
  return max(normal_load - residual_stress, Value(0));
}

// w [1] then, less what the void takes that melting left.
template <class Value>
THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value thawing_surplus(Value storage, Value normal_load, Value residual_stress,
                                                           Value gas_void) {
  return storage * thawing_pressure(normal_load, residual_stress) - gas_void;
}

}  // namespace thawslide::physics
