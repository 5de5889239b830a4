// Entrainment: what a slide takes up of an erodible bed.
// Across the surface at which the bed gives way, momentum jumps with the shear (the slide moves at v, the bed rests):
//   rho_b E v = tau - tau_b                                          [Iverson 2012; Iverson and Ouyang 2015]
// E [m/s]: depth of bed taken up per time; rho_b its density [kg/m3]; tau the shear of the slide on it, tau_b what the
// bed withstands there [Pa],
//   tau_b = c_b + N tan(phi_b).
// Two laws choose E, neither above e v, with e the depth per slip [1]:
//   momentum: E = (tau - tau_b)/(rho_b v). What friction brings beyond the bed's strength sets bed matter in motion,
//             and the drag on the slide is tau, eroding or not.
//   strength: E = e v where tau >= tau_b, as with a bed that is weak or ploughed. The impulse rho_b E v is a drag on
//   the
//             slide beside tau.
// What is taken up joins inelastically: m v = (m + dm) v'. The slide loses the work dm v' (v + v')/2, of which dm
// v'^2/2 is motion of what joins and dm v v'/2 is heat.
#pragma once

#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

// What the bed withstands [Pa]: cohesion c_b and normal pressure N [Pa], tan(phi_b) [1].
template <class Real>
THAWSLIDE_HD Real bed_strength(Real cohesion, Real tangent, Real normal_pressure) {
  return cohesion + tangent * normal_pressure;
}

// E of the law of strength [m/s]: tau and tau_b [Pa], speed v [m/s], e [1].
template <class Real>
THAWSLIDE_HD Real erosion_by_strength(Real shear, Real strength, Real speed, Real depth_per_slip) {
  return shear >= strength ? depth_per_slip * speed : Real(0);
}

// E of the law of momentum [m/s]: tau and tau_b [Pa], rho_b [kg/m3], speed v > 0 [m/s], e [1].
template <class Real>
THAWSLIDE_HD Real erosion_by_momentum(Real shear, Real strength, Real density, Real speed, Real depth_per_slip) {
  return min(depth_per_slip * speed, max(shear - strength, Real(0)) / (density * speed));
}

// v' [m/s]: of a mass m at speed v with the mass dm that it took up from rest [kg].
template <class Real>
THAWSLIDE_HD Real speed_with_taken(Real mass, Real speed, Real taken) {
  return mass * speed / (mass + taken);
}

}  // namespace thawslide::physics
