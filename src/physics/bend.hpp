// A slice of a slide on a bent path: Eq. 12 across the path, whose normal turns by kappa per length of way.
//   N A = m (g.n + v^2 kappa), never below 0: where the ground falls away faster than the slice, it bears nothing
// kappa: curvature of the path, positive where the ground is hollow; g.n: gravity into the ground. Not in the paper.
#pragma once

#include "base/select.hpp"

namespace thawslide::physics {

// N A [N] of a mass m [kg], with gravity into the ground g.n [m/s2], speed v [m/s] and curvature kappa [1/m].
template <class Real>
Real load_in_bend(Real mass, Real gravity_into_ground, Real speed, Real curvature) {
  return max(Real(0), mass * (gravity_into_ground + speed * speed * curvature));
}

}  // namespace thawslide::physics
