// Strength of the base: friction of the melting band, pore pressure and cohesion (Eqs. 17 and 25).
//   mu_e = tan(phi_f) [1 - (1 - x)^omega],  x = (n_e - n_min)/(n_max - n_min) within [0, 1]                  (Eq. 25)
//   S_slide = mu_e (N - P) + c_S, never negative                                                             (Eq. 17)
// The pore pressure can pass the normal pressure, so where Eq. 17 is kept from going negative decides much:
// FrictionClamp.
#pragma once

#include <cmath>

#include "base/portability.hpp"
#include "physics/freezing.hpp"

namespace thawslide::physics {

enum class FrictionClamp {
  keep_cohesion,  // mu max(0, N - P) + c_S: pressure takes friction away, cohesion stays (default)
  joint           // max(0, mu (N - P) + c_S): excess pressure cancels cohesion as well
};

// mu_e/tan(phi_f) of Eq. 25; effective solid fraction n_e of Eq. 2 with its limits, exponent omega.
template <class Real>
THAWSLIDE_HD Real lubrication_factor(Real solid_fraction, Real min_solid_fraction, Real max_solid_fraction,
                                     Real exponent) {
  const Real ratio = (solid_fraction - min_solid_fraction) / (max_solid_fraction - min_solid_fraction);
  const Real clamped = ratio < Real(0) ? Real(0) : ratio > Real(1) ? Real(1) : ratio;
  return Real(1) - power(Real(1) - clamped, exponent);
}

// c_S [Pa] lost with slip [m] to a residual: c_r + (c_0 - c_r) exp(-slip/d_c).
template <class Real>
THAWSLIDE_HD Real cohesion_after_slip(Real cohesion, Real residual, Real slip, Real slip_distance) {
  return residual + (cohesion - residual) * std::exp(-slip / slip_distance);
}

// c_S [Pa] in proportion to the ice in the pore: c_0 (1 - S).
template <class Real>
THAWSLIDE_HD Real cohesion_of_ice(Real cohesion, Real saturation) {
  return cohesion * (Real(1) - saturation);
}

// c_S [Pa] lost to a residual at a given time [s].
template <class Real>
THAWSLIDE_HD Real cohesion_until(Real cohesion, Real residual, Real time, Real loss_time) {
  return time < loss_time ? cohesion : residual;
}

// S_slide of Eq. 17 [Pa]. Pressures [Pa]; cap_pressure: P counts as N at most.
template <class Real>
THAWSLIDE_HD Real sliding_strength(Real friction_coefficient, Real normal_pressure, Real pore_pressure, Real cohesion,
                                   FrictionClamp clamp, bool cap_pressure) {
  Real effective = normal_pressure - pore_pressure;
  if (cap_pressure && effective < Real(0)) {
    effective = Real(0);
  }
  if (clamp == FrictionClamp::joint) {
    const Real strength = friction_coefficient * effective + cohesion;
    return strength > Real(0) ? strength : Real(0);
  }
  return friction_coefficient * (effective > Real(0) ? effective : Real(0)) + cohesion;
}

}  // namespace thawslide::physics
