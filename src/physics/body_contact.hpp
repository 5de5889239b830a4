// Contact of two bodies at a node where both have mass (Bardenhagen et al. 2000; Nairn 2013): impulse between them.
#pragma once

#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

// Impulse [kg m/s]: normal, which keeps the bodies apart, and tangential, by friction along the slip.
struct BodyImpulse {
  Real normal, tangential;
};

// Closing speed of two bodies in a step, minus the part that closes the gap [m] between them; 0 if they separate.
inline THAWSLIDE_HD Real closing_speed_beyond_gap(Real closing_speed, Real gap, Real dt) {
  return max(Real(0), closing_speed - max(Real(0), gap) / dt);
}

// N = m (closing speed beyond the gap), T = min(m |slip speed|, mu N), m = m_1 m_2 / (m_1 + m_2): the bodies leave the
// node with one velocity across the contact, and stick or slide along it by Coulomb's law.
inline THAWSLIDE_HD BodyImpulse body_impulse(Real mass, Real other_mass, Real closing_speed, Real slip_speed, Real gap,
                                             Real dt, Real friction) {
  const Real reduced_mass = mass * other_mass / (mass + other_mass);
  const Real normal = reduced_mass * closing_speed_beyond_gap(closing_speed, gap, dt);
  return {normal, min(reduced_mass * slip_speed, friction * normal)};
}

}  // namespace thawslide::physics
