// Softening with a length scale: slip across a rupture surface instead of plastic strain (docs/theory/stress.md).
#pragma once

#include <cmath>

#include "base/portability.hpp"

namespace thawslide::physics {

// eps_c of material whose shear localizes in one cell: simple shear gamma without dilation has eps = gamma/sqrt(3); a
// slip s across a cell h is therefore s = sqrt(3) eps h. The fracture energy of a rupture surface is then independent
// of the cell size (crack band: Bazant and Oh 1983). slip: s_c [m]; cell: h [m].
[[nodiscard]] inline double softening_strain_of_slip(double slip, double cell) {
  return slip / (std::sqrt(3.0) * cell);
}

// Largest cell [m] in which a rupture surface releases no more elastic energy than it dissipates; beyond it, the stress
// decreases faster than the cell can follow (snap-back). Across one cell, the displacement is tau h/G + sqrt(3) eps h,
// and initially d(tau)/d(eps) = -(R_0 - R_f)/eps_c, hence h <= s_c G/(R_0 - R_f). slip: s_c [m]; loss: R_0 - R_f [Pa],
// with R = c cos(phi) + p sin(phi) at a mean pressure p.
[[nodiscard]] inline double widest_softening_cell(double slip, double shear_modulus, double loss) {
  return slip * shear_modulus / loss;
}

}  // namespace thawslide::physics
