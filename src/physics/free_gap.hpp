// Free open gaps (physics/tension_gap.hpp): elastic stress is independent of strain (theory, chapter 9).
#pragma once

#include <cmath>

#include "base/portability.hpp"

namespace thawslide::physics {

// Returns whether material with an open gap stays at its apex c/tan(phi). Dilation would compress it in shear, and a
// cut-off leaves strength across the gap. Softening reduces c and sin(phi) by the same fraction of their ranges. If the
// apex moves outwards in any of 100 steps of softening, the material can bear tension. Strength: Mohr-Coulomb
// parameters.
template <class Strength>
[[nodiscard]] bool gap_is_free(const Strength& strength) {
  constexpr int shares = 100;
  constexpr double round_off = 1e-12;
  const auto sine = [](auto degrees) { return std::sin(static_cast<double>(degrees) * pi / 180.0); };
  const auto between = [](double start, double end, double share) { return start + share * (end - start); };
  const auto apex = [&](double softened) {
    const double s = between(sine(strength.friction_angle), sine(strength.residual_friction_angle), softened);
    return between(static_cast<double>(strength.cohesion), static_cast<double>(strength.residual_cohesion), softened) *
           std::sqrt(1.0 - s * s) / s;
  };
  bool moves_out = false;
  for (int k = 1; k <= shares; ++k) {
    const double before = apex(static_cast<double>(k - 1) / shares), after = apex(static_cast<double>(k) / shares);
    moves_out = moves_out || after > before * (1.0 + round_off);
  }
  return strength.dilation_angle == 0 && std::isinf(strength.tension_cutoff) && !moves_out;
}

// Density after closing the gap, at which elastic stiffness acts again [kg/m3]. A gap sums the volumetric strains of
// steps, each of which is the change of the logarithm of the volume.
[[nodiscard]] inline THAWSLIDE_HD Real density_with_gap_closed(Real density, Real gap) {
  using std::exp;
  return density * exp(gap);
}

}  // namespace thawslide::physics
