// Gaps opened by tension. A return to the apex or to the tension cut-off creates plastic volume: material separates and
// bears no stress. In classical plasticity, it bears stress immediately on compression, regardless of the gap; loose
// particles then expand without limit and, with their low density, gain excessive speeds. If the material selects it,
// gaps close first (after the volume correction of Tampubolon et al. 2017, Sec. 4.3.4).
#pragma once

#include <cmath>

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

// Part of a volumetric strain increment that closes a gap and bears no stress: from 0 to the gap's volumetric strain.
template <class Value>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Value closing_strain(Value gap, Value volume_strain) {
  return min(gap, max(Value(0), -volume_strain));
}

// Strain increment that causes stress: the remainder, with an isotropic closing part.
template <class Value>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE SymmetricTensor<Value> borne_strain(
    const SymmetricTensor<Value>& strain, Value closing) {
  SymmetricTensor<Value> borne = strain;
  const Value third = closing / Value(3);
  borne[0] += third;
  borne[1] += third;
  borne[2] += third;
  return borne;
}

// Free open gaps: elastic stress is independent of strain (docs/theory/stress.md).

// Returns whether material with an open gap stays at its apex c/tan(phi). Dilation would compress it in shear, and a
// cut-off leaves strength across the gap. Softening reduces c and sin(phi) by the same fraction of their ranges. If the
// apex moves outwards in any of 100 steps of softening, the material can bear tension. Strength: Mohr-Coulomb
// parameters.
template <class Strength>
[[nodiscard]] bool gap_is_free(const Strength& strength) {
  constexpr int fractions = 100;
  constexpr double round_off = 1e-12;
  const auto sine = [](auto degrees) { return std::sin(degrees * pi / 180.0); };
  const auto between = [](double start, double end, double fraction) { return start + fraction * (end - start); };
  const auto apex = [&](double softened) {
    const double s = between(sine(strength.friction_angle), sine(strength.residual_friction_angle), softened);
    return between(strength.cohesion, strength.residual_cohesion, softened) * std::sqrt(1.0 - s * s) / s;
  };
  bool moves_out = false;
  for (int k = 1; k <= fractions; ++k) {
    const double before = apex(static_cast<double>(k - 1) / fractions),
                 after = apex(static_cast<double>(k) / fractions);
    moves_out = moves_out || after > before * (1.0 + round_off);
  }
  return strength.dilation_angle == 0 && std::isinf(strength.tension_cutoff) && !moves_out;
}

// Density after closing the gap, at which elastic stiffness acts again [kg/m3]. A gap sums the volumetric strains of
// steps, each of which is the change of the logarithm of the volume.
[[nodiscard]] inline THAWSLIDE_HD double density_with_gap_closed(double density, double gap) {
  using std::exp;
  return density * exp(gap);
}

}  // namespace thawslide::physics
