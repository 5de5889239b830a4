// Contact of a node with the rigid terrain (Eqs. 15 and 16; Nairn 2013).
//   N = p.n/(A dt),  S_stick = |p.t|/(A dt),  with p the trial momentum, n the unit normal into the terrain
// The node sticks if S_stick <= S_slide; otherwise the terrain removes S_slide A dt of tangential momentum. The
// correction is made once, from the trial momentum: correcting both the old momentum and the force, as Eq. 15 reads,
// would count contact twice. The tangent points along the slip (Eq. 16 leaves its sign open).
#pragma once

#include "base/portability.hpp"
#include "base/select.hpp"
#include "physics/options.hpp"

namespace thawslide::physics {

// Momentum transferred from a node to the terrain [kg m/s], along n and along the slip.
struct ContactImpulse {
  double normal;
  double tangential;
  bool slides;
};

// normal_momentum p.n > 0 and tangential_momentum |p.t| >= 0 of the trial [kg m/s], contact area [m2], dt [s], sliding
// strength [Pa].
inline THAWSLIDE_HD ContactImpulse contact_impulse(double normal_momentum, double tangential_momentum, double area,
                                                   double dt, double sliding_strength) {
  const double available = sliding_strength * area * dt;
  if (tangential_momentum <= available) {
    return {normal_momentum, tangential_momentum, false};
  }
  return {normal_momentum, available, true};
}

// Basal strength from friction coefficient, pore pressure and cohesion (their laws: basal/laws.hpp).
//   S_slide = mu_e (N - P) + c_S, never negative                                                             (Eq. 17)
// The pore pressure can exceed the normal pressure; results depend strongly on how Eq. 17 is limited to non-negative
// values: FrictionClamp.

// S_slide of Eq. 17 [Pa]. Pressures [Pa]. cap_pressure: P is limited to N.
inline THAWSLIDE_HD double sliding_strength(double friction_coefficient, double normal_pressure, double pore_pressure,
                                            double cohesion, FrictionClamp clamp, bool cap_pressure) {
  double effective = normal_pressure - pore_pressure;
  if (cap_pressure && effective < 0.0) {
    effective = 0.0;
  }
  if (clamp == FrictionClamp::joint) {
    const double strength = friction_coefficient * effective + cohesion;
    return strength > 0.0 ? strength : 0.0;
  }
  return friction_coefficient * (effective > 0.0 ? effective : 0.0) + cohesion;
}

// Slice of a sliding mass on a curved path: Eq. 12 normal to the path, whose normal rotates by kappa per path length.
//   N A = m (g.n + v^2 kappa), at least 0: no load if the ground drops away faster than the slice falls
// kappa: curvature of the path, positive for concave ground; g.n: gravity into the ground. Not in the paper.

// N A [N] of a mass m [kg], with gravity into the ground g.n [m/s2], speed v [m/s] and curvature kappa [1/m].
inline double load_in_bend(double mass, double gravity_into_ground, double speed, double curvature) {
  return max(0.0, mass * (gravity_into_ground + speed * speed * curvature));
}

// Contact of two bodies at a node where both have mass (Bardenhagen et al. 2000; Nairn 2013): impulse between them.

// Impulse [kg m/s]: normal, which keeps the bodies apart, and tangential, by friction along the slip.
struct BodyImpulse {
  double normal, tangential;
};

// Closing speed of two bodies in a step, minus the part that closes the gap [m] between them; 0 if they separate.
inline THAWSLIDE_HD double closing_speed_beyond_gap(double closing_speed, double gap, double dt) {
  return max(0.0, closing_speed - max(0.0, gap) / dt);
}

// N = m (closing speed beyond the gap), T = min(m |slip speed|, mu N), with the mass m of a body that meets a fixed
// one: it leaves the node without a velocity across the contact, and sticks or slides along it by Coulomb's law.
inline THAWSLIDE_HD BodyImpulse impulse_on_fixed_body(double mass, double closing_speed, double slip_speed, double gap,
                                                      double dt, double friction) {
  const double normal = mass * closing_speed_beyond_gap(closing_speed, gap, dt);
  return {normal, min(mass * slip_speed, friction * normal)};
}

// The same with m = m_1 m_2 / (m_1 + m_2): the bodies leave the node with one velocity across the contact.
inline THAWSLIDE_HD BodyImpulse body_impulse(double mass, double other_mass, double closing_speed, double slip_speed,
                                             double gap, double dt, double friction) {
  return impulse_on_fixed_body(mass * other_mass / (mass + other_mass), closing_speed, slip_speed, gap, dt, friction);
}

}  // namespace thawslide::physics
