// Contact of a node with the rigid terrain (Eqs. 15 and 16; Nairn 2013).
//   N = p.n/(A dt),  S_stick = |p.t|/(A dt),  with p the trial momentum, n the unit normal into the terrain
// The node sticks if S_stick <= S_slide; otherwise the terrain removes S_slide A dt of tangential momentum. The
// correction is made once, from the trial momentum: correcting both the old momentum and the force, as Eq. 15 reads,
// would count contact twice. The tangent points along the slip (Eq. 16 leaves its sign open).
#pragma once

#include "base/portability.hpp"

namespace thawslide::physics {

// Momentum transferred from a node to the terrain [kg m/s], along n and along the slip.
struct ContactImpulse {
  Real normal;
  Real tangential;
  bool slides;
};

// normal_momentum p.n > 0 and tangential_momentum |p.t| >= 0 of the trial [kg m/s], contact area [m2], dt [s], sliding
// strength [Pa].
inline THAWSLIDE_HD ContactImpulse contact_impulse(Real normal_momentum, Real tangential_momentum, Real area, Real dt,
                                                   Real sliding_strength) {
  const Real available = sliding_strength * area * dt;
  if (tangential_momentum <= available) {
    return {normal_momentum, tangential_momentum, false};
  }
  return {normal_momentum, available, true};
}

}  // namespace thawslide::physics
