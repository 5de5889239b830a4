// Entrainment of an erodible bed. Across the surface at which the bed yields, momentum jumps with the shear stress (the
// sliding mass moves at v, the bed is at rest):
//   rho_b E v = tau - tau_b                                          [Iverson 2012; Iverson and Ouyang 2015]
// E [m/s]: entrained depth per time; rho_b: density of the bed; tau: shear stress of the sliding mass on it; tau_b:
// strength of the bed [Pa],
//   tau_b = c_b + N tan(phi_b).
// Two laws determine E, both limited to e v, with e the depth per slip [1]:
//   momentum: E = (tau - tau_b)/(rho_b v). Friction in excess of the bed's strength accelerates bed material, and the
//             drag on the sliding mass is tau with or without erosion.
//   strength: E = e v if tau >= tau_b, as for a weak or ploughed bed. The impulse rho_b E v is a drag on the sliding
//             mass in addition to tau.
// Entrained mass joins inelastically: m v = (m + dm) v'. The sliding mass loses the work dm v' (v + v')/2, of which
// dm v'^2/2 is kinetic energy of the entrained mass and dm v v'/2 is heat.
#pragma once

#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

// Bed strength [Pa]: cohesion c_b and normal pressure N [Pa], tan(phi_b) [1].
inline THAWSLIDE_HD double bed_strength(double cohesion, double tangent, double normal_pressure) {
  return cohesion + tangent * normal_pressure;
}

// E of the strength law [m/s]: tau and tau_b [Pa], speed v [m/s], e [1].
inline THAWSLIDE_HD double erosion_by_strength(double shear, double strength, double speed, double depth_per_slip) {
  return shear >= strength ? depth_per_slip * speed : 0.0;
}

// E of the momentum law [m/s]: tau and tau_b [Pa], rho_b [kg/m3], speed v > 0 [m/s], e [1].
inline THAWSLIDE_HD double erosion_by_momentum(double shear, double strength, double density, double speed,
                                               double depth_per_slip) {
  return min(depth_per_slip * speed, max(shear - strength, 0.0) / (density * speed));
}

// v' [m/s] of a mass m at speed v after entraining the mass dm from rest [kg].
inline THAWSLIDE_HD double speed_after_entrainment(double mass, double speed, double entrained) {
  return mass * speed / (mass + entrained);
}

}  // namespace thawslide::physics
