// Open gaps (physics/tension_gap.hpp) that are free: elastic stress answers to no strain (theory, chapter 9).
#pragma once

#include <cmath>

#include "base/portability.hpp"

namespace thawslide::physics {

// Whether material with an open gap stays at its apex. Dilation would compress it in shear, a cut-off leaves it
// strength across the gap, and an apex that moves away as the material softens lets it bear tension. Strength: of
// Mohr-Coulomb.
template <class Strength>
[[nodiscard]] bool gap_is_free(const Strength& strength) {
  const auto apex = [](auto cohesion, auto degrees) { return cohesion / std::tan(degrees * pi<double> / 180.0); };
  return strength.dilation_angle == 0 && std::isinf(strength.tension_cutoff) &&
         apex(strength.residual_cohesion, strength.residual_friction_angle) <=
             apex(strength.cohesion, strength.friction_angle);
}

// The density once the gap is closed, at which elastic stiffness acts again [kg/m3]. A gap sums the volumetric strains
// of steps, each of which is the change of the logarithm of the volume.
template <class Real>
[[nodiscard]] THAWSLIDE_HD Real density_with_gap_closed(Real density, Real gap) {
  using std::exp;
  return density * exp(gap);
}

}  // namespace thawslide::physics
