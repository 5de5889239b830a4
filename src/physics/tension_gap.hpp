// Gaps opened by tension. A return to the apex or to the tension cut-off creates plastic volume: material separates and
// bears no stress. In classical plasticity, it bears stress immediately on compression, regardless of the gap; loose
// particles then expand without limit and, with their low density, gain excessive speeds. If the material selects it,
// gaps close first (after the volume correction of Tampubolon et al. 2017, Sec. 4.3.4).
#pragma once

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

}  // namespace thawslide::physics
