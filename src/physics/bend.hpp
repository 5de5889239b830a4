// Slice of a sliding mass on a curved path: Eq. 12 normal to the path, whose normal rotates by kappa per path length.
//   N A = m (g.n + v^2 kappa), at least 0: no load if the ground drops away faster than the slice falls
// kappa: curvature of the path, positive for concave ground; g.n: gravity into the ground. Not in the paper.
#pragma once

#include "base/select.hpp"

namespace thawslide::physics {

// N A [N] of a mass m [kg], with gravity into the ground g.n [m/s2], speed v [m/s] and curvature kappa [1/m].
inline Real load_in_bend(Real mass, Real gravity_into_ground, Real speed, Real curvature) {
  return max(Real(0), mass * (gravity_into_ground + speed * speed * curvature));
}

}  // namespace thawslide::physics
