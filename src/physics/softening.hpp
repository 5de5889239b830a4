// Softening with a length: a slip across a surface of rupture instead of a plastic strain (docs/theory/stress.md).
#pragma once

#include <cmath>

namespace thawslide::physics {

// eps_c of material whose shear gathers in one cell: simple shear gamma without dilation has eps = gamma/sqrt(3), so a
// slip s across a cell h is s = sqrt(3) eps h. A surface of rupture then takes the same energy on every cell (crack
// band: Bazant and Oh 1983). slip: s_c [m]; cell: h [m].
template <class Real>
[[nodiscard]] Real softening_strain_of_slip(Real slip, Real cell) {
  return slip / (std::sqrt(Real(3)) * cell);
}

// The widest cell [m] in which a surface of rupture releases no more elastic energy than it takes: beyond it the
// stress would fall faster than the cell can follow (snap-back). Across one cell the displacement is tau h/G + sqrt(3)
// eps h, and d(tau)/d(eps) = -(R_0 - R_f)/eps_c at first, so that h <= s_c G/(R_0 - R_f). slip: s_c [m]; loss: R_0 -
// R_f [Pa], with R = c cos(phi) + p sin(phi) at a mean pressure p.
template <class Real>
[[nodiscard]] Real widest_softening_cell(Real slip, Real shear_modulus, Real loss) {
  return slip * shear_modulus / loss;
}

}  // namespace thawslide::physics
