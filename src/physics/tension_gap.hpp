// Gaps that tension tears open. A return to the apex or to the tension cut-off gives plastic volume: matter comes apart
// and bears nothing. Classical plasticity lets it bear again at once when it is pressed together, however wide apart it
// is: loose particles swell without limit and, light as they are for their size, are then thrown about. Here, where the
// material asks for it, the gap closes first (after the volume correction of Tampubolon et al. 2017, Sec. 4.3.4).
#pragma once

#include "base/linear.hpp"
#include "base/portability.hpp"
#include "base/select.hpp"

namespace thawslide::physics {

// Of a volumetric strain increment, what closes a gap and so bears no stress: 0 to the gap's volumetric strain.
template <class Real>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE Real closing_strain(Real gap, Real volume_strain) {
  return min(gap, max(Real(0), -volume_strain));
}

// The strain increment that stress answers: the rest of it, the closing being equal in all directions.
template <class Real>
[[nodiscard]] THAWSLIDE_HD THAWSLIDE_ALWAYS_INLINE SymmetricTensor<Real> borne_strain(
    const SymmetricTensor<Real>& strain, Real closing) {
  SymmetricTensor<Real> borne = strain;
  const Real third = closing / Real(3);
  borne[0] += third;
  borne[1] += third;
  borne[2] += third;
  return borne;
}

}  // namespace thawslide::physics
