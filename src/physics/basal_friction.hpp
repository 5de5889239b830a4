// Basal strength from friction coefficient, pore pressure and cohesion (their laws: basal/laws.hpp).
//   S_slide = mu_e (N - P) + c_S, never negative                                                             (Eq. 17)
// The pore pressure can exceed the normal pressure; results depend strongly on how Eq. 17 is limited to non-negative
// values: FrictionClamp.
#pragma once

#include "base/portability.hpp"
#include "physics/options.hpp"

namespace thawslide::physics {

// S_slide of Eq. 17 [Pa]. Pressures [Pa]. cap_pressure: P is limited to N.
inline THAWSLIDE_HD Real sliding_strength(Real friction_coefficient, Real normal_pressure, Real pore_pressure,
                                          Real cohesion, FrictionClamp clamp, bool cap_pressure) {
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
